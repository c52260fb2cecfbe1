"""Contact problems of matrices of your own."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy

from . import _epafi, parameters as _parameters
from .progress import shown
from .qp import finite, rows_of
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
    """A number for each of so many rows, or one for all."""
    values = numpy.ravel(numpy.asarray(given, dtype=float))
    if len(values) not in (1, count):
        raise _epafi.InputError(f"{what} have {len(values)} entries, but there are {count} rows")
    return finite(numpy.broadcast_to(values, count), what)


class Problem:
    """Bodies with matrices of yours, min u'Ku/2 - f'u subject to Bu <= c and Eu = d. On this rank alone.

    A node has `components` unknowns, which follow each other; nodes, and so unknowns, are numbered through the bodies in the
    order in which they are added. Bodies that nothing holds are found out. Factors are made by the first solve and kept.
    """

    def __init__(self, dimension: int, components: int | None = None):
        self.dimension, self.components = dimension, dimension if components is None else components
        self.nodes = 0
        self._bodies: list[tuple] = []
        self._contact: tuple | None = None
        self._friction: tuple | None = None
        self._ties: tuple | None = None
        self._gaps = 3 * [numpy.zeros(0)]  # of contact, friction and ties
        self._points: list[numpy.ndarray] = []
        self._problem: Any = None

    @property
    def unknowns(self) -> int:
        """Of all bodies so far."""
        return self.nodes * self.components

    def _require_unsolved(self) -> None:
        if self._problem is not None:
            raise _epafi.InputError("the problem is solved already: bodies, contact and ties come before the first solve")

    def _places(self, coordinates: Any, held: Mapping[int, float] | None) -> tuple:
        self._require_unsolved()
        places = finite(numpy.asarray(coordinates, dtype=float), "the coordinates")
        if places.ndim != 2 or places.shape[1] != self.dimension:
            raise _epafi.InputError(f"coordinates have shape {places.shape}, but must have {self.dimension} columns")
        first = self.unknowns
        return places, self.nodes, {first + int(number): float(value) for number, value in (held or {}).items()}

    def _numbers(self, numbers: Any, places: numpy.ndarray) -> numpy.ndarray:
        numbers, most = numpy.asarray(numbers, dtype=numpy.int64), len(places) * self.components
        if numbers.size and not 0 <= numbers.min() <= numbers.max() < most:
            raise _epafi.InputError(f"unknowns are numbered from 0 to {most - 1} in a body of {len(places)} nodes, not "
                                    f"{numbers.min()} to {numbers.max()}")
        return numbers + self.unknowns

    def add_body(self, stiffness: Any, coordinates: Any, *, held: Mapping[int, float] | None = None, unknowns: Any = None,
                 name: str = "") -> range:
        """Adds a body that stays whole, one subdomain; returns the numbers of its unknowns.

        stiffness    K, symmetric positive semidefinite, both triangles stored: a SciPy matrix or an array
        coordinates  nodes x dimension
        held         values of unknowns that supports prescribe, by their numbers in the body; they have rows in K all the same
        unknowns     numbers in the body of the rows of K, if supports are eliminated from it
        """
        places, first, held = self._places(coordinates, held)
        rows = rows_of(stiffness)
        numbers = self._numbers(numpy.arange(len(places) * self.components) if unknowns is None else unknowns, places)
        if len(numbers) != len(rows[0]) - 1:
            raise _epafi.InputError(f"the stiffness has {len(rows[0]) - 1} rows, but the body {len(numbers)} unknowns")
        if len(rows[1]) and not 0 <= rows[1].min() <= rows[1].max() < len(numbers):
            raise _epafi.InputError(f"the stiffness has {len(numbers)} rows, but an entry in column {rows[1].max()}")
        self._bodies.append(("add", name, (numbers, rows, places, first, held)))
        return self._added(places)

    def add_elements(self, unknowns: Any, stiffness: Any, coordinates: Any, *, parts: Any = 1,
                     held: Mapping[int, float] | None = None, name: str = "") -> range:
        """Adds a body by its elements, which is cut into subdomains; returns the numbers of its unknowns.

        unknowns     elements x e: numbers in the body, those of a node after each other
        stiffness    elements x e x e, symmetric
        coordinates  nodes x dimension
        parts        how many subdomains METIS cuts it into, or the number of the subdomain of each element
        held         as in `add_body`
        """
        places, first, held = self._places(coordinates, held)
        numbers = self._numbers(unknowns, places)
        matrices = finite(numpy.asarray(stiffness, dtype=float), "the element matrices")
        if matrices.shape != (*numbers.shape, numbers.shape[-1]):
            raise _epafi.InputError(f"element matrices have shape {matrices.shape}, but their unknowns {numbers.shape}")
        if numpy.ndim(parts) == 0:
            nodes = (numbers[:, ::self.components] - self.unknowns) // self.components
            parts = _epafi.parts_of(nodes, len(places), int(parts), self.dimension)
        if len(parts) != len(numbers):
            raise _epafi.InputError(f"there are {len(parts)} numbers of parts, but {len(numbers)} elements")
        self._bodies.append(("add_elements", name, (numbers, matrices, numpy.asarray(parts), places, first, held)))
        return self._added(places)

    def _added(self, places: numpy.ndarray) -> range:
        self._points.append(places)
        self.nodes += len(places)
        return range(self.unknowns - len(places) * self.components, self.unknowns)

    def _held(self) -> set[int]:
        """Unknowns that supports hold, eliminated or not."""
        free = numpy.zeros(self.unknowns, dtype=bool)
        for _, _, (numbers, *_, held) in self._bodies:
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
        self._require_unsolved()
        matrix = rows_of(rows)
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
        along = None if tangents is None else rows_of(tangents)
        self._gaps[1] = _per_row(slips, len(nodes) * (self.components - 1) if along is None else len(along[0]) - 1, "the slips")
        self._friction = (None if along is None else (along, self._gaps[1]), nodes.tolist(), *of_nodes, self.unknowns)

    def set_ties(self, rows: Any, gaps: Any = 0) -> None:
        """Eu = d: E, rows x unknowns of all bodies, and d, of each row or one for all; rows may depend on each other."""
        self._require_unsolved()
        matrix = rows_of(rows)
        self._gaps[2] = _per_row(gaps, len(matrix[0]) - 1, "the gaps of ties")
        self._ties = (True, matrix, self._gaps[2], self.unknowns)

    def solve(self, loads: Any, *, gaps: Any = None, slips: Any = None, tie_gaps: Any = None, tolerance: float = 1e-6,
              parameters: Mapping[str, Any] | None = None, progress: bool | Callable | None = None,
              check: bool = True) -> Solution:
        """Solves for loads (of all unknowns) and, if given, new gaps of contact and ties, and slips. Later calls need no new
        factors, and start from the last solution; tolerance and parameters (those of `Solver` in docs/parameters.md) are the
        first call's.

        Raises as `epafi.solve`; NotConverged has the Solution.
        """
        loads = finite(numpy.asarray(loads, dtype=float), "the loads")
        if loads.shape != (self.unknowns,):
            raise _epafi.InputError(f"loads have shape {loads.shape}, but there are {self.unknowns} unknowns")
        for kind, (given, what) in enumerate(((gaps, "the gaps"), (slips, "the slips"), (tie_gaps, "the gaps of ties"))):
            if given is not None:
                self._gaps[kind] = _per_row(given, len(self._gaps[kind]), what)
        if self._problem is None:
            self._problem = self._made({"Tolerance": tolerance, **(parameters or {})})
        with shown(progress, None) as tell:
            solution = Solution(**self._problem.solve(loads, numpy.concatenate(self._gaps), tell))
        if check and not solution.converged:
            raise NotConverged(solution)
        return solution

    def _made(self, parameters: Mapping[str, Any]) -> Any:
        names = [body[1] or f"body {number}" for number, body in enumerate(self._bodies)]
        problem = _epafi.Problem(self.dimension, self.components, names)
        for number, (kind, _, arguments) in enumerate(self._bodies):
            getattr(problem, kind)(number, *arguments)
        for rows in (self._contact, self._ties):
            if rows is not None:
                problem.set_rows(*rows)
        if self._friction is not None:
            problem.set_friction(*self._friction)
        problem.complete(_parameters.xml(parameters, _epafi.solver_schema(), "Solver"))
        return problem
