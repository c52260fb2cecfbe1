"""Quadratic programs alone: no scene, no contact."""

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy

from . import _epafi, parameters as _parameters
from .progress import shown
from .result import NotConverged


@dataclasses.dataclass(eq=False)
class QpResult:
    """A point with its certificate; residuals are recomputed at x, relative but for `feasibility`."""

    x: numpy.ndarray  #: n
    bound_multiplier: numpy.ndarray  #: n: Ax - b + B'mu where a bound holds x, >= 0 at a lower one, else 0
    equality_multiplier: numpy.ndarray | None  #: m: mu, of the equations
    status: str  #: "Converged", ...
    reason: str
    objective: float  #: x'Ax/2 - b'x
    certificate: numpy.ndarray | None  #: where there is no solution: a direction or combination of rows that shows it
    kkt: dict[str, float]  #: stationarity, dual_feasibility, feasibility, complementarity, equality
    products: int  #: with A

    @property
    def converged(self) -> bool:
        return self.status == "Converged"


def finite(values: Any, what: str) -> Any:
    """The same array. Raises InputError where an entry is none."""
    if not numpy.isfinite(numpy.sum(values)) and not numpy.isfinite(values).all():  # the first is quick
        place = numpy.unravel_index(numpy.flatnonzero(~numpy.isfinite(values))[0], numpy.shape(values))
        where = ", ".join(map(str, map(int, place)))
        raise _epafi.InputError(f"entry {where} of {what} is {values[place]}, which is not a finite number")
    return values


def reals(given: Any, what: str) -> numpy.ndarray:
    """As an array of doubles. Raises InputError where numbers are complex or not finite."""
    if numpy.iscomplexobj(given):
        raise _epafi.InputError(f"{what}: the numbers are complex, but must be real")
    return finite(numpy.asarray(given, dtype=float), what)


def rows_of(matrix: Any) -> tuple[numpy.ndarray, numpy.ndarray, numpy.ndarray]:
    """indptr, indices and data of a SciPy matrix, or of a dense array; all numbers are real and finite."""
    if hasattr(matrix, "tocsr"):
        matrix = matrix.tocsr()
        if not matrix.has_canonical_format:
            matrix = matrix.copy()
            matrix.sum_duplicates()
        return matrix.indptr, matrix.indices, reals(matrix.data, "a matrix's data")
    matrix = numpy.atleast_2d(reals(matrix, "a matrix"))
    row, column = numpy.nonzero(matrix)
    return numpy.searchsorted(row, numpy.arange(len(matrix) + 1)), column, matrix[row, column]


def _operator(given: Any, size: int) -> Any:
    if given is None:
        return None
    if is_sparse := hasattr(given, "tocsr"):
        given = given.tocsr()
    elif not hasattr(given, "matvec") and not callable(given):
        given = numpy.atleast_2d(given)
    if (shape := getattr(given, "shape", (size, size))) != (size, size):
        raise _epafi.InputError(f"an operator is {shape[0]} x {shape[-1]}, but the linear term has {size} entries")
    if is_sparse or isinstance(given, numpy.ndarray):
        rows = rows_of(given)
        is_within = len(rows[1]) > 0 and 0 <= rows[1].min() <= rows[1].max() < size
        if is_within and abs(given - given.T).max() > 1e-6 * abs(given).max():
            raise _epafi.InputError("a matrix is not symmetric; both triangles must be stored, equal to round-off")
        return rows
    if numpy.iscomplexobj(given):
        raise _epafi.InputError("an operator: the numbers are complex, but must be real")
    return given.matvec if hasattr(given, "matvec") else given


def solve_qp(hessian: Any, linear_term: Any, *, lower: Any = None, upper: Any = None, discs: Any = None,
             equalities: tuple[Any, Any] | None = None, preconditioner: Any = None, start: Any = None,
             tolerance: float = 1e-6, parameters: Mapping[str, Any] | None = None,
             progress: bool | Callable | None = None, check: bool = True) -> QpResult:
    """Minimises x'Ax/2 - b'x within bounds and discs, subject to Bx = c. On this rank alone.

    hessian         A, n x n, symmetric positive semidefinite: a SciPy matrix or an array with both triangles, a LinearOperator,
                    or x -> Ax
    linear_term     b, n
    lower, upper    n, or one number for all; infinities for "no bound"
    discs           (pairs m x 2, radii m) or (pairs, radii, centres m x 2): two entries of x each, |x - centre| <= radius
    equalities      (B m x n, c m); rows may depend on each other
    preconditioner  M, close to the inverse of A, symmetric positive definite, as A may be given
    start           n; 0 if not given
    tolerance       of the projected gradient relative to b, and of the equations
    parameters      those of docs/qp.md by name: {"Algorithm": "active set", "MPRGP": {...}}

    Raises SolvabilityError where there is no solution, NotConverged (with `result`) where the tolerance is not reached, unless
    `check` is False; InputError for what does not fit.
    """
    b = reals(linear_term, "the linear term").ravel()

    def bound(given: Any) -> Any:
        if given is not None and numpy.size(given) not in (1, len(b)):
            raise _epafi.InputError(f"bounds have {numpy.size(given)} entries, but the linear term has {len(b)}")
        return None if given is None else numpy.broadcast_to(numpy.ravel(numpy.asarray(given, dtype=float)), b.shape)

    flat = []
    if discs is not None:
        pairs, radii = numpy.reshape(discs[0], (-1, 2)), numpy.ravel(discs[1])
        centres = numpy.reshape(discs[2], (-1, 2)) if len(discs) > 2 else numpy.zeros(pairs.shape)
        used = numpy.sort(pairs, axis=None)
        if len(used) and (used[0] < 0 or used[-1] >= len(b) or (used[1:] == used[:-1]).any()):
            raise _epafi.InputError(f"discs are pairs of different entries from 0 to {len(b) - 1}, none in two of them")
        flat = [(int(i), int(j), float(r), float(x), float(y)) for (i, j), r, (x, y) in zip(pairs, radii, centres, strict=True)]
    rows = None if equalities is None else (rows_of(equalities[0]), numpy.ravel(equalities[1]).astype(float))
    given = {"Tolerance": tolerance, "Constraint Tolerance": tolerance, **(parameters or {})}
    text = _parameters.xml(given, _epafi.program_schema(), "QP")
    with shown(progress, None) as tell:
        found = _epafi.solve_program(_operator(hessian, len(b)), b, bound(lower), bound(upper), flat, rows,
                                     _operator(preconditioner, len(b)),
                                     numpy.zeros(len(b)) if start is None else numpy.asarray(start, dtype=float), text, tell)
    result = QpResult(**found)
    if check and result.status in ("Infeasible", "Unbounded", "NotUnique", "IndefiniteOperator"):
        raise _epafi.SolvabilityError(f"{result.status}: {result.reason}")
    if check and not result.converged:
        raise NotConverged(result)
    return result
