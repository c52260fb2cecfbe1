"""Contact problems of matrices of your own."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy

from . import _epafi, parameters as _parameters
from .progress import shown
from .qp import rows_of
from .result import NotConverged


@dataclasses.dataclass(eq=False)
class Solution:
    """Displacements and contact forces, with residuals that are recomputed from them."""

    u: numpy.ndarray  #: of all unknowns, one body after the other; 0 where a body has none
    forces: numpy.ndarray  #: of the rows of contact, >= 0, in the unit of the loads over that of B
    energy: float  #: u'Ku/2 - f'u
    status: str  #: "Converged", ...
    reason: str
    products: int  #: with the dual operator
    setup_seconds: float  #: of the last set-up, which only the first solve makes
    subdomains: int
    feasibility: float
    complementarity: float
    projected_gradient: float

    @property
    def converged(self) -> bool:
        return self.status == "Converged"


class Problem:
    """Bodies with matrices of yours, min u'Ku/2 - f'u subject to Bu <= c. On this rank alone.

    A node has `components` unknowns, which follow each other; nodes, and so unknowns, are numbered through the bodies in the
    order in which they are added. Bodies that nothing holds are found out. Factors are made by the first solve and kept.
    """

    def __init__(self, dimension: int, components: int | None = None):
        self.dimension, self.components = dimension, dimension if components is None else components
        self.nodes = 0
        self._bodies: list[tuple] = []
        self._contact: tuple | None = None
        self._problem: Any = None

    @property
    def unknowns(self) -> int:
        """Of all bodies so far."""
        return self.nodes * self.components

    def _places(self, coordinates: Any, held: Mapping[int, float] | None) -> tuple:
        if self._problem is not None:
            raise _epafi.InputError("the problem is solved already: bodies and contact come before the first solve")
        places = numpy.asarray(coordinates, dtype=float)
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
        self._bodies.append(("add", name, (numbers, rows, places, first, held)))
        return self._added(len(places))

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
        matrices = numpy.asarray(stiffness, dtype=float)
        if matrices.shape != (*numbers.shape, numbers.shape[-1]):
            raise _epafi.InputError(f"element matrices have shape {matrices.shape}, but their unknowns {numbers.shape}")
        if numpy.ndim(parts) == 0:
            nodes = (numbers[:, ::self.components] - self.unknowns) // self.components
            parts = _epafi.parts_of(nodes, len(places), int(parts), self.dimension)
        if len(parts) != len(numbers):
            raise _epafi.InputError(f"there are {len(parts)} numbers of parts, but {len(numbers)} elements")
        self._bodies.append(("add_elements", name, (numbers, matrices, numpy.asarray(parts), places, first, held)))
        return self._added(len(places))

    def _added(self, nodes: int) -> range:
        self.nodes += nodes
        return range(self.unknowns - nodes * self.components, self.unknowns)

    def set_contact(self, rows: Any, gaps: Any, friction: Any = None) -> None:
        """Bu <= c: B, rows x unknowns of all bodies, and c; `friction` is Coulomb's coefficient, of each row or one for all."""
        matrix, gaps = rows_of(rows), numpy.atleast_1d(numpy.asarray(gaps, dtype=float))
        count = len(matrix[0]) - 1
        of_rows = [] if friction is None else numpy.broadcast_to(numpy.asarray(friction, dtype=float), count).tolist()
        self._contact = (matrix, numpy.broadcast_to(gaps, count) if len(gaps) == 1 else gaps, self.unknowns, of_rows)

    def solve(self, loads: Any, *, gaps: Any = None, tolerance: float = 1e-6, parameters: Mapping[str, Any] | None = None,
              progress: bool | Callable | None = None, check: bool = True) -> Solution:
        """Solves for loads (of all unknowns) and, if given, new gaps. Later calls need no new factors, and start from the last
        solution; tolerance and parameters (those of `Solver` in docs/parameters.md) are the first call's.

        Raises as `epafi.solve`; NotConverged has the Solution.
        """
        loads = numpy.asarray(loads, dtype=float)
        if loads.shape != (self.unknowns,):
            raise _epafi.InputError(f"loads have shape {loads.shape}, but there are {self.unknowns} unknowns")
        if self._problem is None:
            self._problem = self._made({"Tolerance": tolerance, **(parameters or {})})
        with shown(progress, None) as tell:
            solution = Solution(**self._problem.solve(loads, None if gaps is None else numpy.asarray(gaps, dtype=float), tell))
        if check and not solution.converged:
            raise NotConverged(solution)
        return solution

    def _made(self, parameters: Mapping[str, Any]) -> Any:
        names = [body[1] or f"body {number}" for number, body in enumerate(self._bodies)]
        problem = _epafi.Problem(self.dimension, self.components, names)
        for number, (kind, _, arguments) in enumerate(self._bodies):
            getattr(problem, kind)(number, *arguments)
        if self._contact is not None:
            problem.set_contact(*self._contact)
        problem.complete(_parameters.xml(parameters, _epafi.solver_schema(), "Solver"))
        return problem
