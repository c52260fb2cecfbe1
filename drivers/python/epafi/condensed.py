"""A contact problem in its multipliers alone, with dense matrices: for problems whose rows are few."""

import dataclasses
import functools
from typing import Any

import numpy
import scipy.linalg
import scipy.optimize
import scipy.sparse.linalg

from .problems import ContactProblem


class NoSolution(Exception):
    """The loads go on working along a motion that nothing hinders, or rows contradict each other."""


class ManySolutions(Exception):
    """A solver that returns none where there is more than one."""


@dataclasses.dataclass(eq=False)
class Answer:
    """What a solver returns."""

    u: numpy.ndarray
    multiplier: numpy.ndarray  #: of rows of B, lambda
    tangential: numpy.ndarray  #: of rows of T, t
    work: int  #: how many products or factorizations
    unit: str  #: which of them


def rigid_motions(problem: ContactProblem) -> numpy.ndarray:
    """R, n x r: of each body all rigid motions under which it is not deformed."""
    found = [numpy.zeros((len(problem.load), 0))]
    scale = numpy.sqrt(problem.stiffness.diagonal())
    for body in range(len(problem.bodies)):
        own = numpy.flatnonzero(problem.body == body)
        place, direction = problem.coordinates[own], problem.direction[own]
        place = (place - place.mean(axis=0)) / max(numpy.ptp(place), 1e-300)
        turns = [numpy.cross(axis, place) for axis in numpy.eye(3)] if problem.components > 1 else []
        motions = numpy.zeros((len(problem.load), 3 + len(turns)))
        motions[own] = numpy.column_stack([direction, *(numpy.sum(turn * direction, axis=1) for turn in turns)])
        basis = scipy.linalg.orth(scale[:, None] * motions, rcond=1e-10) / scale[:, None]
        resistance = (problem.stiffness @ basis) / scale[:, None]
        _, values, right = numpy.linalg.svd(resistance, full_matrices=False)
        found.append(basis @ right[values < 1e-7].T)
    return numpy.hstack(found)


class Condensed:
    """min l'Fl/2 - l'd over multipliers of all rows A of B and T, subject to Gl = e; slack c - Au = Fl - d - G'a.

    u = K+(f - A'l) + Ra, with a generalised inverse K+ of one sparse factorization.
    """

    def __init__(self, problem: ContactProblem):
        self.problem = problem
        self.rows = scipy.sparse.vstack([problem.constraint, problem.tangent]).tocsr()
        self.motions = rigid_motions(problem)
        pins = numpy.zeros(len(problem.load))  # stiffness of springs whose forces vanish in equilibrium
        if self.motions.shape[1] > 0:
            _, _, order = scipy.linalg.qr(self.motions.T, pivoting=True, mode="economic")
            pins[order[:self.motions.shape[1]]] = problem.stiffness.diagonal().mean()
        self.pinned = (problem.stiffness + scipy.sparse.diags(pins)).tocsc()
        self.factor = scipy.sparse.linalg.splu(self.pinned, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.1,
                                               options={"SymmetricMode": True})
        gaps = numpy.concatenate([problem.gap, problem.tangent_gap])
        self.d = self.rows @ self.inverse(problem.load) - gaps
        self.G = self.rows.dot(self.motions).T
        self.e = self.motions.T @ problem.load

    def inverse(self, force: numpy.ndarray) -> numpy.ndarray:
        """K+ f, with one step of refinement."""
        u = self.factor.solve(force)
        return u + self.factor.solve(force - self.pinned @ u)

    def product(self, multiplier: numpy.ndarray) -> numpy.ndarray:
        return self.rows @ self.inverse(self.rows.T @ multiplier)

    @functools.cached_property
    def F(self) -> numpy.ndarray:
        full = self.rows @ self.inverse(self.rows.T.toarray())
        return (full + full.T) / 2

    def require_solution(self) -> None:
        """Raises NoSolution if the loads work along a motion that contact does not hinder (exact, by a linear program)."""
        contacts, rows = self.problem.contacts, self.G.T[:len(self.problem.gap)]
        if self.motions.shape[1] == 0 or len(self.problem.friction_row):
            return
        scale = max(numpy.linalg.norm(self.e), 1e-300)
        found = scipy.optimize.linprog(-self.e / scale, rows[:contacts], numpy.zeros(contacts), rows[contacts:],
                                       numpy.zeros(len(rows) - contacts), bounds=(-1, 1))
        if -found.fun > 1e-7:
            raise NoSolution("the loads go on working along a motion that nothing hinders")

    def answer(self, multiplier: numpy.ndarray, motion: numpy.ndarray, work: int, unit: str) -> Answer:
        """u of the multipliers and rigid motions."""
        u = self.inverse(self.problem.load - self.rows.T @ multiplier) + self.motions @ motion
        own = len(self.problem.gap)
        return Answer(u, multiplier[:own], multiplier[own:], work, unit)

    def motion_of(self, multiplier: numpy.ndarray) -> numpy.ndarray:
        """a that closes the rows whose multipliers are not 0, and equations."""
        slack, own = self.F @ multiplier - self.d, len(self.problem.gap)
        closed = numpy.abs(multiplier) > 1e-9 * numpy.abs(multiplier).max(initial=0)
        closed[self.problem.contacts:own] = True
        tangents = (len(multiplier) - own) // max(len(self.problem.friction_row), 1)
        sizes = numpy.linalg.norm(multiplier[own:].reshape(-1, max(tangents, 1)), axis=1)
        closed[own:] = numpy.repeat(sizes < (1 - 1e-9) * self.problem.friction_bound, tangents)
        return numpy.linalg.lstsq(self.G.T[closed], slack[closed], rcond=1e-10)[0]


def _state(problem: ContactProblem, condensed: Condensed, x: numpy.ndarray, slack: numpy.ndarray) -> tuple[Any, Any]:
    """Rows that are closed, and of nodes with friction 0 where they are open or stick, else the sign of their slip."""
    stiff, own = numpy.maximum(condensed.F.diagonal(), 1e-300), len(problem.gap)
    closed = x[:own] - slack[:own] / stiff[:own] > 0
    closed[problem.contacts:] = True
    trial, bound = x[own:] - slack[own:] / stiff[own:], problem.friction_bound + problem.friction * x[problem.friction_row]
    return closed, numpy.where(numpy.abs(trial) > bound, numpy.sign(trial), 0).astype(int)


def _polished(condensed: Condensed, held: numpy.ndarray, expand: numpy.ndarray, fixed: numpy.ndarray, answer: Answer) -> Answer:
    """u and multipliers of one state from the whole system, with residuals in extended precision: K may be worse conditioned
    with its pins than with the contact. The answer as it is where that system is singular."""
    problem, n = condensed.problem, len(condensed.problem.load)
    size = numpy.concatenate([problem.stiffness.diagonal(), 1 / condensed.F.diagonal()[held]]) ** -0.5
    rows = condensed.rows[held]
    matrix = scipy.sparse.bmat([[problem.stiffness, condensed.rows.T @ scipy.sparse.csr_matrix(expand)], [rows, None]], format="csr")
    matrix = scipy.sparse.diags(size) @ matrix @ scipy.sparse.diags(size)
    right = size * numpy.concatenate([problem.load - condensed.rows.T @ fixed, numpy.concatenate([problem.gap, problem.tangent_gap])[held]])
    try:
        factor = scipy.sparse.linalg.splu(matrix.tocsc())
    except RuntimeError:
        return answer
    y, exact = numpy.zeros(len(right), dtype=numpy.longdouble), matrix.astype(numpy.longdouble)
    changes = []
    for _ in range(6):
        change = factor.solve((right - exact @ y).astype(float))
        y += change
        changes.append(numpy.linalg.norm(change))
    if not changes[-1] <= 1e-13 * changes[0]:
        return answer
    found = (size * y).astype(float)
    multiplier, own = expand @ found[n:] + fixed, len(problem.gap)
    return dataclasses.replace(answer, u=found[:n], multiplier=multiplier[:own], tangential=multiplier[own:])


def _newton_in_space(condensed: Condensed, polish: bool, steps: int) -> Answer:
    """Friction on discs: |t| <= g, and what slips has t = g n, n = q/|q|, q = t - slack/D (Alart, Curnier 1991), linearised."""
    problem, own, m = condensed.problem, len(condensed.problem.gap), len(condensed.d)
    size = numpy.concatenate([condensed.F.diagonal() ** -0.5, 1 / numpy.maximum(numpy.linalg.norm(condensed.G, axis=1), 1e-300)])
    pairs, z = numpy.arange(own, m).reshape(-1, 2), numpy.zeros(m + len(condensed.e))
    law = numpy.hstack([condensed.F, -condensed.G.T])  # slack = law z - d
    closed, slips, turns = numpy.ones(own, dtype=bool), numpy.zeros(len(pairs), dtype=bool), numpy.zeros((len(pairs), 2))
    for step in range(1, steps + 1):
        matrix = numpy.vstack([law, numpy.hstack([condensed.G, numpy.zeros(2 * condensed.e.shape)])])
        right, scale = numpy.concatenate([condensed.d, condensed.e]), size.copy()
        for i in [*numpy.flatnonzero(~closed), *pairs[slips].ravel()]:
            matrix[i], right[i], scale[i] = 0, 0, 1 / size[i]
            matrix[i, i] = 1
        for i in numpy.flatnonzero(slips):
            pair, n = pairs[i], turns[i]
            q = z[pair] - (law[pair] @ z - condensed.d[pair]) * (size[pair] ** 2).mean()
            bound = problem.friction_bound[i] + problem.friction[i] * max(z[problem.friction_row[i]], 0)
            across = bound / numpy.linalg.norm(q) * (numpy.eye(2) - numpy.outer(n, n))
            matrix[pair] -= across @ (matrix[pair] - law[pair] * (size[pair] ** 2).mean())
            matrix[pair, problem.friction_row[i]] -= problem.friction[i] * n
            right[pair] = problem.friction_bound[i] * n + across @ condensed.d[pair] * (size[pair] ** 2).mean()
        scaled, last, z = scale[:, None] * matrix * size, z, numpy.zeros(len(z))
        for _ in range(2):
            z = z + size * numpy.linalg.lstsq(scaled, scale * (right - matrix @ z), rcond=1e-13)[0]
        slack, before = law @ z - condensed.d, (closed, slips)
        closed = z[:own] - slack[:own] * size[:own] ** 2 > 0
        closed[problem.contacts:] = True
        q = z[pairs] - slack[pairs] * (size[pairs] ** 2).mean(axis=1)[:, None]
        bound = problem.friction_bound + problem.friction * numpy.maximum(z[problem.friction_row], 0)
        length = numpy.linalg.norm(q, axis=1)
        slips, turns = (length > bound) | (bound == 0), q / numpy.maximum(length, 1e-300)[:, None]
        settled = numpy.abs((z - last) / size).max() <= 1e-13 * numpy.abs(z / size).max()
        if settled and all((a == b).all() for a, b in zip(before, (closed, slips), strict=True)):
            break
    else:
        raise RuntimeError(f"Newton's method does not settle in {steps} steps")
    found = condensed.answer(z[:m], z[m:], step, "steps")
    if not polish:
        return found
    holds = numpy.concatenate([closed, numpy.repeat(~slips, 2)])
    held, fixed = numpy.flatnonzero(holds), numpy.zeros(m)
    expand = numpy.eye(m)[:, held]
    for i in numpy.flatnonzero(slips):
        expand[pairs[i]] = numpy.outer(problem.friction[i] * turns[i], expand[problem.friction_row[i]])
        fixed[pairs[i]] = problem.friction_bound[i] * turns[i]
    return _polished(condensed, held, expand, fixed, found)


def active_set(problem: ContactProblem, polish: bool = False, steps: int = 200) -> Answer:
    """A semismooth Newton method (Hintermueller, Ito, Kunisch 2003) with dense exact solves."""
    if problem.is_bounded:
        raise NotImplementedError("bounds")
    condensed = Condensed(problem)
    if len(problem.tangent_gap) != len(problem.friction_row):
        return _newton_in_space(condensed, polish, steps)
    condensed.require_solution()
    own, m, r = len(problem.gap), condensed.rows.shape[0], condensed.motions.shape[1]
    normal, is_coulomb = problem.friction_row, (problem.friction > 0)
    closed, slip, seen = numpy.ones(own, dtype=bool), numpy.zeros(m - own, dtype=int), set()
    for step in range(1, steps + 1):
        seen.add((closed.tobytes(), slip.tobytes()))
        # l = E y + l0: rows that hold have a multiplier y of their own, those that slip one from the normal force or the bound.
        stick = (slip == 0) & (closed[normal] | ~is_coulomb)
        held = numpy.flatnonzero(numpy.concatenate([closed, stick]))
        expand, fixed = numpy.zeros((m, len(held))), numpy.zeros(m)
        expand[held, range(len(held))] = 1
        for i in numpy.flatnonzero(~stick & (closed[normal] | ~is_coulomb)):
            expand[own + i] = slip[i] * problem.friction[i] * expand[normal[i]]
            fixed[own + i] = slip[i] * problem.friction_bound[i]
        matrix = numpy.zeros((len(held) + r, len(held) + r))
        matrix[:len(held), :len(held)], matrix[:len(held), len(held):] = condensed.F[held] @ expand, -condensed.G.T[held]
        matrix[len(held):, :len(held)] = condensed.G @ expand
        right = numpy.concatenate([(condensed.d - condensed.F @ fixed)[held], condensed.e - condensed.G @ fixed])
        scale = numpy.concatenate([condensed.F.diagonal()[held] ** -0.5, numpy.ones(r)])  # rows of a motion in units of forces
        if r:
            scale[len(held):] = 1 / numpy.maximum(numpy.linalg.norm((condensed.G @ expand) * scale[:len(held)], axis=1), 1e-300)
        y = scale * numpy.linalg.lstsq(scale[:, None] * matrix * scale, scale * right, rcond=1e-12)[0]
        x, motion = expand @ y[:len(held)] + fixed, y[len(held):]
        slack = condensed.F @ x - condensed.d - condensed.G.T @ motion
        then = _state(problem, condensed, x, slack)
        if (then[0] == closed).all() and (then[1] == slip).all():
            found = condensed.answer(x, motion, step, "steps")
            return _polished(condensed, held, expand, fixed, found) if polish else found
        if (then[0].tobytes(), then[1].tobytes()) in seen:  # it cycles: one change at a time
            both, old = numpy.concatenate(then), numpy.concatenate([closed, slip])
            first = numpy.flatnonzero(both != old)[0]
            both[:first], both[first + 1:] = old[:first], old[first + 1:]
            then = both[:own].astype(bool), both[own:].astype(int)
        closed, slip = then
    raise RuntimeError(f"the active set does not settle in {steps} steps")
