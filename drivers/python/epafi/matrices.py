"""Contact problems of matrices of your own."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy

from . import _epafi, parameters as _parameters
from .progress import shown
from .qp import reals, rows_of
from .result import NotConverged


@dataclasses.dataclass(eq=False)
class Solution:
    """Displacements and contact forces, with residuals that are recomputed from them."""

    u: numpy.ndarray  #: of all unknowns, one body after the other; 0 where a body has none
    forces: numpy.ndarray  #: of the rows of contact, >= 0, in the unit of the loads over that of B
    tangential: numpy.ndarray  #: of rows T of friction
    tie_forces: numpy.ndarray  #: of rows E of ties: Ku + B' forces + T' tangential + E' tie_forces = f
    energy: float  #: u'Ku/2 - f'u
    status: str  #: "Converged", ...
    reason: str
    products: int  #: with the dual operator
    setup_seconds: float  #: of the last set-up, which only the first solve makes
    seconds: float  #: of the library in this call, without Python's, and of its set-up in the first
    subdomains: int
    feasibility: float
    complementarity: float
    projected_gradient: float

    @property
    def converged(self) -> bool:
        return self.status == "Converged"


@dataclasses.dataclass(eq=False)
class Joint:
    """Rows between two surfaces, for `Problem.set_contact`, where the first surface has one a node, or for `Problem.set_ties`."""

    rows: Any  #: B or E, m x unknowns of all bodies, a csr_matrix of SciPy; a row's multiplier is a force
    gaps: numpy.ndarray  #: m: distances along the normals; of ties 0
    areas: numpy.ndarray  #: m: what of the first surface (in the plane: its length) a row's force acts on
    nodes: numpy.ndarray  #: m: numbers through all bodies
    directions: numpy.ndarray  #: m x components: of contact towards the second surface, of length 1


def _outwards(facets: Any, cells: Any, places: numpy.ndarray) -> numpy.ndarray:
    """Facets in the order of nodes in which their normals point out of the cells that they belong to."""
    facets, cells = numpy.atleast_2d(facets).astype(numpy.int64), numpy.atleast_2d(cells).astype(numpy.int64)
    if facets.shape[1] not in ((2,) if places.shape[1] == 2 else (3, 4)):
        raise _epafi.InputError(f"facets have {facets.shape[1]} nodes, but must have {'2' if places.shape[1] == 2 else '3 or 4'}")
    for numbers in (facets, cells):
        if numbers.size == 0 or not 0 <= numbers.min() <= numbers.max() < len(places):
            raise _epafi.InputError(f"facets and cells are nodes, numbered from 0 to {len(places) - 1}, at least one of each")
    at_surface = numpy.zeros(len(places), dtype=bool)
    at_surface[facets] = True
    cells = cells[at_surface[cells].sum(axis=1) >= facets.shape[1]]
    order = numpy.argsort(cells, axis=None, kind="stable")
    sorted_nodes = cells.ravel()[order]
    first, last = (numpy.searchsorted(sorted_nodes, facets[:, 0], side) for side in ("left", "right"))
    own = numpy.full(len(facets), -1)
    for k in range(int((last - first).max(initial=0))):
        cell = order[numpy.minimum(first + k, len(order) - 1)] // cells.shape[1]
        holds = (cells[cell][:, :, None] == facets[:, None, :]).any(axis=1).all(axis=1) & (first + k < last)
        own[holds] = cell[holds]
    if (own < 0).any():
        raise _epafi.InputError(f"facet {numpy.flatnonzero(own < 0)[0]} belongs to no cell")
    corner = places[facets[:, :3]]
    along, inwards = corner[:, 1] - corner[:, 0], places[cells[own]].mean(axis=1) - corner[:, 0]
    normal = (numpy.column_stack([along[:, 1], -along[:, 0]]) if places.shape[1] == 2 else
              numpy.cross(along, corner[:, 2] - corner[:, 0]))
    return numpy.where(numpy.sum(normal * inwards, axis=1)[:, None] > 0, facets[:, ::-1], facets)


def _per_row(given: Any, count: int, what: str) -> numpy.ndarray:
    """A number for each of so many rows, or one for all; a copy."""
    values = reals(numpy.ravel(given), what)
    if len(values) not in (1, count):
        raise _epafi.InputError(f"{what} have {len(values)} entries, but there are {count} rows")
    return numpy.array(numpy.broadcast_to(values, count))


def _integers(given: Any, what: str) -> numpy.ndarray:
    values = numpy.asarray(given)
    if values.size and values.dtype.kind not in "iu":
        raise _epafi.InputError(f"{what} are numbers of type {values.dtype}, but must be integers")
    return values.astype(numpy.int64)


class Problem:
    """Bodies with matrices of yours, min u'Ku/2 - f'u subject to Bu <= c and Eu = d. On this rank alone.

    A node has `components` unknowns, which follow each other; nodes, and so unknowns, are numbered through the bodies in the
    order in which they are added. Bodies that nothing holds are found out. Factors are made by the first solve and kept.
    """

    def __init__(self, dimension: int, components: int | None = None):
        self.dimension, self.components = dimension, dimension if components is None else components
        self.nodes = 0
        self._bodies: list[tuple] = []  # name, unknowns of the matrices, and held values
        self._contact: tuple | None = None
        self._friction: tuple | None = None
        self._ties: tuple | None = None
        self._gaps = 3 * [numpy.zeros(0)]  # of contact, friction and ties
        self._points: list[numpy.ndarray] = []
        self._problem = _epafi.Problem(self.dimension, self.components)
        self._is_complete = False
        self._failure: _epafi.Error | None = None  # of what made it complete

    @property
    def unknowns(self) -> int:
        """Of all bodies so far."""
        return self.nodes * self.components

    def _require_unsolved(self) -> None:
        if self._is_complete:
            raise _epafi.InputError("the problem is solved already: bodies, contact and ties come before the first solve")

    def _places(self, coordinates: Any) -> numpy.ndarray:
        self._require_unsolved()
        places = numpy.array(reals(coordinates, "the coordinates"))
        if places.ndim != 2 or places.shape[1] != self.dimension:
            raise _epafi.InputError(f"coordinates have shape {places.shape}, but must have {self.dimension} columns")
        return places

    def _numbers(self, numbers: Any, places: numpy.ndarray, what: str = "unknowns") -> numpy.ndarray:
        numbers, most = _integers(numbers, what), len(places) * self.components
        if numbers.size and not 0 <= numbers.min() <= numbers.max() < most:
            raise _epafi.InputError(f"{what} are numbered from 0 to {most - 1} in a body of {len(places)} nodes, not "
                                    f"{numbers.min()} to {numbers.max()}")
        return numbers + self.unknowns

    def _supports(self, held: Mapping[int, float] | None, numbers: numpy.ndarray, places: numpy.ndarray) -> dict[int, float]:
        """Values by numbers through all bodies, of unknowns that are among those of the matrices."""
        held = held or {}
        supported = self._numbers(list(held), places, "held unknowns")
        has_row = numpy.zeros(len(places) * self.components, dtype=bool)
        has_row[numbers - self.unknowns] = True
        if (missing := numpy.flatnonzero(~has_row[supported - self.unknowns])).size:
            raise _epafi.InputError(f"unknown {supported[missing[0]] - self.unknowns} is held, but has no row in the matrices of "
                                    "the body")
        return dict(zip(supported.tolist(), reals(list(held.values()), "held values").tolist()))

    def _rows(self, matrix: Any) -> tuple:
        """Copies of its arrays: the caller's own may be others by the first solve."""
        self._require_unsolved()
        if (columns := numpy.shape(matrix)[-1]) != self.unknowns:
            raise _epafi.InputError(f"rows have {columns} columns, but there are {self.unknowns} unknowns of the bodies so far")
        return tuple(numpy.array(values) for values in rows_of(matrix))

    def add_body(self, stiffness: Any, coordinates: Any, *, held: Mapping[int, float] | None = None, unknowns: Any = None,
                 name: str = "") -> range:
        """Adds a body that stays whole, one subdomain; returns the numbers of its unknowns.

        stiffness    K, symmetric positive semidefinite, both triangles stored: a SciPy matrix or an array
        coordinates  nodes x dimension
        held         values of unknowns that supports prescribe, by their numbers in the body; they have rows in K all the same
        unknowns     numbers in the body of the rows of K, if supports are eliminated from it
        """
        places = self._places(coordinates)
        rows = rows_of(stiffness)
        numbers = self._numbers(numpy.arange(len(places) * self.components) if unknowns is None else unknowns, places)
        if len(numbers) != len(rows[0]) - 1:
            raise _epafi.InputError(f"the stiffness has {len(rows[0]) - 1} rows, but the body {len(numbers)} unknowns")
        if len(rows[1]) and not 0 <= rows[1].min() <= rows[1].max() < len(numbers):
            raise _epafi.InputError(f"the stiffness has {len(numbers)} rows, but an entry in column {rows[1].max()}")
        return self._added(self._problem.add, name, places, held, numbers, rows)

    def add_elements(self, unknowns: Any, stiffness: Any, coordinates: Any, *, parts: Any = 1,
                     held: Mapping[int, float] | None = None, name: str = "") -> range:
        """Adds a body by its elements, which is cut into subdomains; returns the numbers of its unknowns.

        unknowns     elements x e: numbers in the body, those of a node after each other
        stiffness    elements x e x e, symmetric
        coordinates  nodes x dimension
        parts        how many subdomains METIS cuts it into, or the number of the subdomain of each element
        held         as in `add_body`
        """
        places = self._places(coordinates)
        numbers = self._numbers(unknowns, places)
        matrices = reals(stiffness, "the element matrices")
        if matrices.shape != (*numbers.shape, numbers.shape[-1]):
            raise _epafi.InputError(f"element matrices have shape {matrices.shape}, but their unknowns {numbers.shape}")
        parts = _integers(parts, "parts")
        if parts.ndim == 0:
            if not 1 <= parts <= max(1, len(numbers)):
                raise _epafi.InputError(f"{len(numbers)} elements cannot be cut into {parts} parts")
            nodes = (numbers[:, ::self.components] - self.unknowns) // self.components
            parts = _epafi.parts_of(nodes, len(places), int(parts), self.dimension)
        if len(parts) != len(numbers):
            raise _epafi.InputError(f"there are {len(parts)} numbers of parts, but {len(numbers)} elements")
        return self._added(self._problem.add_elements, name, places, held, numbers, matrices, parts)

    def _added(self, add: Callable, name: str, places: numpy.ndarray, held: Mapping[int, float] | None, numbers: numpy.ndarray,
               *matrices: Any) -> range:
        """Copies the matrices: the caller's arrays may be others by the first solve."""
        supports = self._supports(held, numbers, places)
        add(len(self._bodies), numbers, *matrices, places, self.nodes, supports)
        self._bodies.append((name, numbers, supports))
        self._points.append(places)
        self.nodes += len(places)
        return range(self.unknowns - len(places) * self.components, self.unknowns)

    def _held(self) -> set[int]:
        """Unknowns that supports hold, eliminated or not."""
        free = numpy.zeros(self.unknowns, dtype=bool)
        for _, numbers, held in self._bodies:
            free[numbers] = True
            free[list(held)] = False
        return set(numpy.flatnonzero(~free).tolist())

    def joint(self, first: tuple[range, Any, Any], second: tuple[range, Any, Any], *, tied: bool = False,
              distance: float = numpy.inf, gap: float = 0.0, name: str = "joint") -> Joint:
        """Rows between two surfaces, meshed alike or apart, by mortars with dual multipliers. Needs SciPy.

        first, second  (unknowns, facets, cells): what `add_body` returned, nodes of the facets, two in the plane, three or four
                       in space, and of the body's cells, of order 1, both by their numbers in the body; facets may be
                       seen from either side. The first, best the finer and softer one, has the rows
        tied           rows for `set_ties` that hold displacements equal, all components but those that supports hold
        distance       nodes farther from the other surface get no row
        gap            added to the distances
        """
        import scipy.sparse
        starts = numpy.cumsum([0, *map(len, self._points)])
        sides = []
        for unknowns, facets, cells in (first, second):
            body = int(numpy.searchsorted(starts, unknowns.start // self.components, "right")) - 1
            if body >= len(self._points) or len(unknowns) != len(self._points[body]) * self.components:
                raise _epafi.InputError(f"{unknowns} are not the unknowns of a body of this problem")
            sides.append(starts[body] + _outwards(facets, cells, self._points[body]))
        held = self._held() if tied else None
        found = _epafi.joint_of(name, self.components, numpy.concatenate(self._points), *sides, distance, gap, held)
        indptr, indices, data = found.pop("rows")
        return Joint(scipy.sparse.csr_matrix((data, indices, indptr), shape=(len(indptr) - 1, self.unknowns)), **found)

    def set_contact(self, rows: Any, gaps: Any, friction: Any = None, *, bound: Any = None, tangents: Any = None, slips: Any = 0,
                    nodes: Any = None) -> None:
        """Bu <= c: B, rows x unknowns of all bodies, and c. With friction a node's tangential force is at most `bound` +
        `friction` times its normal force, and along its slip Tu - s.

        friction  Coulomb's coefficient, of each row or one for all
        bound     a force (Tresca), likewise
        tangents  T: of each row of B one row less than a node has components, one after the other; None: along the tangents of
                  the direction in which a row of B acts
        slips     s, of each row of T or one for all: what has slipped before
        nodes     with `tangents`: rows of B that have friction, if not all; friction and bound are theirs then
        """
        matrix = self._rows(rows)
        count = len(matrix[0]) - 1
        self._gaps[:2] = _per_row(gaps, count, "the gaps"), numpy.zeros(0)
        self._contact, self._friction = (False, matrix, self._gaps[0], self.unknowns), None
        if friction is None and bound is None:
            return
        if tangents is None and (nodes is not None or numpy.any(slips)):
            raise _epafi.InputError("nodes and slips belong to tangents of your own; give these too, or leave them out")
        nodes = numpy.arange(count) if nodes is None else numpy.ravel(nodes)
        if nodes.dtype.kind not in "iu":
            raise _epafi.InputError("nodes with friction are numbers of rows: integers")
        if len(numpy.unique(nodes)) < len(nodes) or not ((nodes >= 0) & (nodes < count)).all():
            raise _epafi.InputError(f"nodes with friction are different rows of contact from 0 to {count - 1}")
        of_nodes = [_per_row(0 if law is None else law, len(nodes), what).tolist()
                    for law, what in ((friction, "coefficients of friction"), (bound, "bounds of friction"))]
        along = None if tangents is None else self._rows(tangents)
        self._gaps[1] = _per_row(slips, len(nodes) * (self.components - 1) if along is None else len(along[0]) - 1, "the slips")
        self._friction = (None if along is None else (along, self._gaps[1]), nodes.tolist(), *of_nodes, self.unknowns)

    def set_ties(self, rows: Any, gaps: Any = 0) -> None:
        """Eu = d: E, rows x unknowns of all bodies, and d, of each row or one for all; rows may depend on each other."""
        matrix = self._rows(rows)
        self._gaps[2] = _per_row(gaps, len(matrix[0]) - 1, "the gaps of ties")
        self._ties = (True, matrix, self._gaps[2], self.unknowns)

    def solve(self, loads: Any, *, gaps: Any = None, slips: Any = None, tie_gaps: Any = None, tolerance: float | None = None,
              parameters: Mapping[str, Any] | None = None, progress: bool | Callable | None = None,
              check: bool = True) -> Solution:
        """Solves for loads (of all unknowns) and, if given, new gaps of contact and ties, and slips. Later calls need no new
        factors, and start from the last solution; tolerance (1e-6) and parameters (those of `Solver` in docs/parameters.md) are
        the first call's.

        Raises as `epafi.solve`; NotConverged has the Solution.
        """
        loads = reals(loads, "the loads")
        if loads.shape != (self.unknowns,):
            raise _epafi.InputError(f"loads have shape {loads.shape}, but there are {self.unknowns} unknowns")
        for kind, (given, what) in enumerate(((gaps, "the gaps"), (slips, "the slips"), (tie_gaps, "the gaps of ties"))):
            if given is not None:
                self._gaps[kind] = _per_row(given, len(self._gaps[kind]), what)
        with shown(progress, None) as tell:
            asked = {**({} if tolerance is None else {"Tolerance": tolerance}), **(parameters or {})}
            if not self._is_complete:
                self._complete(_parameters.xml({"Tolerance": 1e-6, **asked}, _epafi.solver_schema(), "Solver"))
                self._asked = asked
            elif asked and asked != self._asked:
                raise _epafi.InputError("tolerance and parameters are those of the first solve; make another Problem for others")
            solution = Solution(**self._problem.solve(loads, numpy.concatenate(self._gaps), tell))
        if check and not solution.converged:
            raise NotConverged(solution)
        return solution

    def _complete(self, parameters: str) -> None:
        if self._failure is not None:
            raise self._failure
        self._problem.begin([name or f"body {number}" for number, (name, _, _) in enumerate(self._bodies)], parameters)
        try:
            for rows in (self._contact, self._ties):
                if rows is not None:
                    self._problem.set_rows(*rows)
            if self._friction is not None:
                self._problem.set_friction(*self._friction)
            self._problem.complete()
        except _epafi.Error as failure:
            self._failure = failure
            raise
        self._is_complete = True
