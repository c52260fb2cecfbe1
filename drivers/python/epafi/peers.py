"""Solvers for the problems of problems.py, ours and others: functions of a problem that return an Answer."""

import glob
import sys
import warnings
from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import Any

import numpy
import scipy.sparse
import scipy.sparse.linalg

from . import condensed as _condensed
from ._epafi import SolvabilityError
from .condensed import Answer, Condensed, ManySolutions, NoSolution
from .matrices import Problem
from .problems import ContactProblem
from .qp import solve_qp

TOLERANCE, NONE = 1e-10, numpy.zeros(0)


class Unfit(Exception):
    """Why a solver cannot take a problem: two or three words."""


class Absent(Exception):
    """The package that is not installed."""


def active_set(problem: ContactProblem) -> Answer:
    """Primal-dual active sets with SuperLU: with bounds a factorization a step, else one of all, and dense steps."""
    if not problem.is_bounded:
        return _condensed.active_set(problem)
    stiffness, diagonal = problem.stiffness.tocsc(), problem.stiffness.diagonal()
    u = numpy.clip(numpy.zeros(len(problem.load)), problem.lower, problem.upper)
    side = None
    for step in range(1, 200):
        trial = u - (stiffness @ u - problem.load) / diagonal
        then = (trial > problem.upper).astype(int) - (trial < problem.lower)
        if side is not None and (then == side).all():
            return Answer(u, NONE, NONE, step - 1, "factorizations")
        side, free = then, numpy.flatnonzero(then == 0)
        u = numpy.where(side > 0, problem.upper, numpy.where(side < 0, problem.lower, 0))
        inner = stiffness[:, free][free]
        factor = scipy.sparse.linalg.splu(inner, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
        u[free] = factor.solve((problem.load - stiffness @ u)[free])
        u[free] += factor.solve((problem.load - stiffness @ u)[free])
    raise RuntimeError("the active set does not settle")


def fetidp(problem: ContactProblem, algorithm: str, parameters: Mapping[str, Any] = MappingProxyType({})) -> Answer:
    """`epafi.Problem`, each body whole."""
    if problem.is_bounded:
        raise Unfit("bounds")
    if (problem.direction.max(axis=1) < 1).any():
        raise Unfit("turned axes")
    dimension = 3 if numpy.ptp(problem.coordinates[:, 2]) > 0 else 2
    solver, places = Problem(dimension, problem.components), numpy.zeros(len(problem.load), dtype=int)
    for body in range(len(problem.bodies)):
        own = numpy.flatnonzero(problem.body == body)
        nodes, first, node = numpy.unique(problem.node[own], return_index=True, return_inverse=True)
        unknowns = node * problem.components + (problem.direction[own].argmax(axis=1) if problem.components > 1 else 0)
        all_unknowns = solver.add_body(problem.stiffness[own][:, own], problem.coordinates[own[first], :dimension],
                                       unknowns=unknowns, name=problem.bodies[body])
        places[own] = all_unknowns[0] + unknowns
    spread = scipy.sparse.csr_matrix((numpy.ones(len(places)), (numpy.arange(len(places)), places)),
                                     shape=(len(places), solver.unknowns))
    friction = dict(friction=problem.friction, bound=problem.friction_bound, tangents=problem.tangent @ spread,
                    slips=problem.tangent_gap, nodes=problem.friction_row) if len(problem.friction_row) else {}
    rows, contacts = problem.constraint @ spread, problem.contacts
    solver.set_contact(rows[:contacts], problem.gap[:contacts], **friction)
    if contacts < len(problem.gap):
        solver.set_ties(rows[contacts:], problem.gap[contacts:])
    try:
        found = solver.solve(spread.T @ problem.load, tolerance=TOLERANCE,
                             parameters={"Algorithm": algorithm, "Equilibrium Tolerance": TOLERANCE, **parameters})
    except SolvabilityError as error:
        raise (ManySolutions if str(error).startswith("not unique") else NoSolution)(str(error)) from error
    return Answer(found.u[places], numpy.append(found.forces, found.tie_forces), found.tangential, found.products, "products")


def program(problem: ContactProblem, algorithm: str, parameters: Mapping[str, Any] = MappingProxyType({}),
            is_preconditioned: bool = False) -> Answer:
    """`epafi.solve_qp`: of u where there are bounds alone, with the inverse of K as preconditioner or without, else of the
    multipliers."""
    parameters = {"Algorithm": algorithm, **parameters}
    if problem.is_bounded:
        inverse = scipy.sparse.linalg.splu(problem.stiffness.tocsc()).solve if is_preconditioned else None
        found = solve_qp(problem.stiffness, problem.load, lower=problem.lower, upper=problem.upper, tolerance=TOLERANCE,
                         preconditioner=inverse, parameters=parameters)
        return Answer(found.x, NONE, NONE, found.products, "products")
    if (problem.friction > 0).any():
        raise Unfit("Coulomb")
    dual, rows = Condensed(problem), len(problem.gap)
    lower, upper = numpy.full(len(dual.d), -numpy.inf), numpy.full(len(dual.d), numpy.inf)
    lower[:problem.contacts] = 0
    discs = None
    if len(problem.tangent_gap) == len(problem.friction_row):
        lower[rows:], upper[rows:] = -problem.friction_bound, problem.friction_bound
    else:
        discs = numpy.arange(rows, len(dual.d)).reshape(-1, 2), problem.friction_bound
    scale = 1 / numpy.linalg.norm(dual.G, axis=1)[:, None] if len(dual.e) else 1
    equalities = (scale * dual.G, (scale * dual.e[:, None]).ravel()) if len(dual.e) else None
    try:
        found = solve_qp(dual.product, dual.d, lower=lower, upper=upper, discs=discs, tolerance=TOLERANCE,
                         parameters=parameters, equalities=equalities)
    except SolvabilityError as error:
        raise NoSolution(str(error)) from error
    return dual.answer(found.x, dual.motion_of(found.x), found.products, "products")


def _petsc() -> Any:
    sys.path.extend(sorted(glob.glob("/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages")))  # as Debian has it
    try:
        import petsc4py
        petsc4py.init(["epafi"])
        from petsc4py import PETSc
    except ImportError:
        raise Absent("petsc4py") from None
    return PETSc


def petsc(problem: ContactProblem, kind: str) -> Answer:
    """Of u where there are bounds alone, else of the multipliers with the dense F. SNESVI: Newton's method on faces with PETSc's
    Cholesky; TAO's BLMVM: a quasi-Newton method."""
    PETSc = _petsc()
    dual = None if problem.is_bounded else Condensed(problem)
    if dual is not None and len(problem.friction_row):
        raise Unfit("friction")
    if dual is not None and (dual.motions.shape[1] or problem.contacts < len(problem.gap)):
        raise Unfit("equations")
    matrix, right, lower, upper = (problem.stiffness, problem.load, problem.lower, problem.upper) if dual is None else (
        scipy.sparse.csr_matrix(dual.F), dual.d, 0 * dual.d, numpy.inf + dual.d)
    a = PETSc.Mat().createAIJ(matrix.shape, csr=(matrix.indptr, matrix.indices, matrix.data), comm=PETSc.COMM_SELF)
    a.setOption(PETSc.Mat.Option.SPD, True)
    b, low, high, x = (PETSc.Vec().createWithArray(numpy.clip(values, -1e30, 1e30), comm=PETSc.COMM_SELF)
                       for values in (right, lower, upper, numpy.clip(0 * right, lower, upper)))
    work, reason = (_snesvi if kind == "SNESVI" else _blmvm)(PETSc, a, b, low, high, x)
    if reason <= 0:
        raise RuntimeError(f"stops with reason {reason}")
    values, unit = x.getArray().copy(), "factorizations" if kind == "SNESVI" else "products"
    return Answer(values, NONE, NONE, work, unit) if dual is None else dual.answer(values, NONE, work, unit)


def _snesvi(PETSc: Any, a: Any, b: Any, low: Any, high: Any, x: Any) -> tuple[int, int]:
    solver = PETSc.SNES().create(PETSc.COMM_SELF)
    solver.setType("vinewtonrsls")

    def gradient(_: object, z: Any, out: Any) -> None:
        a.mult(z, out)
        out.axpy(-1.0, b)

    solver.setFunction(gradient, b.duplicate())
    solver.setJacobian(lambda *_: None, a)
    solver.setVariableBounds(low, high)
    solver.setTolerances(rtol=TOLERANCE, atol=TOLERANCE * b.norm(), stol=0, max_it=200)
    solver.getKSP().setType("preonly")
    solver.getKSP().getPC().setType("cholesky")
    solver.solve(None, x)
    return solver.getIterationNumber(), solver.getConvergedReason()


def _blmvm(PETSc: Any, a: Any, b: Any, low: Any, high: Any, x: Any) -> tuple[int, int]:
    solver, products = PETSc.TAO().create(PETSc.COMM_SELF), 0

    def objective(_: object, z: Any, out: Any) -> float:
        nonlocal products
        products += 1
        a.mult(z, out)
        value = out.dot(z) / 2 - b.dot(z)
        out.axpy(-1.0, b)
        return value

    solver.setType("blmvm")
    solver.setObjectiveGradient(objective, b.duplicate())
    solver.setVariableBounds(low, high)
    solver.setTolerances(gatol=TOLERANCE * b.norm(), grtol=0, gttol=0)
    solver.setMaximumIterations(5000)
    solver.setSolution(x)
    solver.solve()
    return products, solver.getConvergedReason()


def _inequalities(problem: ContactProblem) -> tuple:
    """All rows of B and bounds as Au <= c (the equations first), and how many are equations."""
    if len(problem.friction_row):
        raise Unfit("friction")
    n, m = len(problem.load), problem.contacts
    low, high = (numpy.flatnonzero(numpy.isfinite(bound)) for bound in (problem.lower, problem.upper))
    one = scipy.sparse.identity(n, format="csr")
    rows = scipy.sparse.vstack([problem.constraint[m:], problem.constraint[:m], -one[low], one[high]]).tocsc()
    return rows, numpy.concatenate([problem.gap[m:], problem.gap[:m], -problem.lower[low], problem.upper[high]]), len(problem.gap) - m


def clarabel(problem: ContactProblem) -> Answer:
    """Interior points."""
    try:
        import clarabel as package
    except ImportError:
        raise Absent("clarabel") from None
    rows, right, equations = _inequalities(problem)
    settings = package.DefaultSettings()
    settings.verbose, settings.tol_gap_abs, settings.tol_gap_rel, settings.tol_feas = False, 1e-9, 1e-9, 1e-9
    cones = [package.ZeroConeT(equations), package.NonnegativeConeT(len(right) - equations)]
    found = package.DefaultSolver(scipy.sparse.triu(problem.stiffness).tocsc(), -problem.load, rows, right, cones, settings).solve()
    status = str(found.status)
    if "Infeasible" in status:
        raise NoSolution(status)
    if "Solved" not in status:
        raise RuntimeError(status)
    z = numpy.array(found.z)
    m = problem.contacts
    return Answer(numpy.array(found.x), numpy.concatenate([z[equations:equations + m], z[:equations]]), NONE,
                  found.iterations, "factorizations")


def osqp(problem: ContactProblem) -> Answer:
    """Alternating directions."""
    try:
        import osqp as package
    except ImportError:
        raise Absent("osqp") from None
    rows, right, equations = _inequalities(problem)
    least = numpy.full(len(right), -numpy.inf)
    least[:equations] = right[:equations]
    solver = package.OSQP()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        solver.setup(scipy.sparse.triu(problem.stiffness).tocsc(), -problem.load, rows, least, right, verbose=False, eps_abs=1e-8,
                     eps_rel=1e-8, max_iter=20000, polishing=True)
        found = solver.solve()
    if "infeasible" in found.info.status:
        raise NoSolution(found.info.status)
    if "solved" not in found.info.status:
        raise RuntimeError(found.info.status)
    m = problem.contacts
    return Answer(found.x, numpy.concatenate([found.y[equations:equations + m], found.y[:equations]]), NONE,
                  found.info.iter, "steps")


SOLVERS: dict[str, Callable[[ContactProblem], Answer]] = {
    "FETI-DP, MPRGP": partial(fetidp, algorithm="MPRGP"),
    "FETI-DP, active set": partial(fetidp, algorithm="active set"),
    "solve_qp, MPRGP": partial(program, algorithm="MPRGP"),
    "solve_qp, active set": partial(program, algorithm="active set"),
    "SciPy active set": active_set,
    "PETSc SNESVI": partial(petsc, kind="SNESVI"),
    "PETSc TAO blmvm": partial(petsc, kind="BLMVM"),
    "Clarabel": clarabel,
    "OSQP": osqp,
}


def by_name(problem: ContactProblem, algorithm: str, expansion: str = "auto", is_preconditioned: bool = True) -> Answer:
    """An algorithm of Epafi's on the operator that all of them share: F of `epafi.Problem`, each body whole, or K where
    unknowns have bounds. Where bodies float SMALBE-M is around MPRGP."""
    steps = {"MPRGP": {"Expansion": expansion}, "SMALBE": {"Update": "balance"}} if algorithm == "MPRGP" else {}
    has_coulomb = (problem.friction > 0).any()
    if problem.is_bounded:
        if algorithm == "fixed point":
            raise Unfit("no friction")
        return program(problem, algorithm, steps, is_preconditioned)
    if algorithm == ("MPRGP" if has_coulomb else "fixed point"):
        raise Unfit("Coulomb" if has_coulomb else "no friction")
    return fetidp(problem, algorithm, steps if is_preconditioned else {**steps, "Preconditioner": {"Type": "none"}})


#: By name, on the same F. In face: with M restricted to the free set (Kruzik, Horak 2025).
ALGORITHMS: dict[str, Callable[[ContactProblem], Answer]] = {
    "default": partial(by_name, algorithm="auto"),
    "MPRGP": partial(by_name, algorithm="MPRGP", expansion="fixed step", is_preconditioned=False),
    "MPPCG": partial(by_name, algorithm="MPRGP", expansion="projected CG", is_preconditioned=False),
    "MPRGP, M in face": partial(by_name, algorithm="MPRGP", expansion="fixed step"),
    "MPPCG, M in face": partial(by_name, algorithm="MPRGP", expansion="projected CG"),
    "active set": partial(by_name, algorithm="active set", is_preconditioned=False),
    "active set, M in face": partial(by_name, algorithm="active set"),
    "fixed point": partial(by_name, algorithm="fixed point"),
}
