"""Any solver on any problem: `run(problem, solver)`, `table`, and what an answer is worth, `residuals`."""

import argparse
import dataclasses
import sys
import time
from collections.abc import Callable, Iterable, Mapping

import numpy

from ._epafi import InputError
from .condensed import Answer, ManySolutions, NoSolution
from .condensed import active_set as polished
from .peers import ALGORITHMS, SOLVERS, Absent, Unfit, active_set
from .problems import ContactProblem, load, names

NO_SOLUTION = "no solution"


def energy(problem: ContactProblem, u: numpy.ndarray) -> float:
    """u'Ku/2 - f'u, summed in extended precision."""
    exact = u.astype(numpy.longdouble)
    return float(exact @ (problem.stiffness.astype(numpy.longdouble) @ exact) / 2 - problem.load @ exact)


def reference(problem: ContactProblem) -> Answer | None:
    """By active sets and residuals in extended precision; None where there is no solution."""
    if problem.verdict == NO_SOLUTION:
        return None
    return active_set(problem) if problem.is_bounded else polished(problem, polish=True)


def residuals(problem: ContactProblem, answer: Answer) -> dict[str, float]:
    """The conditions of Karush, Kuhn and Tucker at an answer, recomputed, all relative; where unknowns have bounds what is left
    of the balance is their multiplier.

    balance          of forces, to the sum of their sizes, in the norm of the inverse of K's diagonal
    penetration      of contact, equations and bounds, to the largest displacement or gap
    tension          of multipliers of contact, to the largest
    complementarity  sum of |multiplier times slack| to the energy
    friction         t - its projection on the disc of t + slip, a slip in units of forces, to the largest multiplier
    """
    u, b = answer.u, problem.constraint
    forces = problem.stiffness @ u - problem.load + b.T @ answer.multiplier + problem.tangent.T @ answer.tangential
    sizes = abs(problem.stiffness) @ abs(u) + abs(problem.load) + abs(b).T @ abs(answer.multiplier)
    slack, contacts = problem.gap - b @ u, problem.contacts
    multiplier, open_by = answer.multiplier[:contacts], slack[:contacts]
    low, high = numpy.isfinite(problem.lower), numpy.isfinite(problem.upper)
    # a bound takes the force that would move the unknown through it
    at_low = low & (~high | (u - problem.lower < problem.upper - u)) & (forces > 0)
    at_high = high & ~at_low & (forces < 0)
    at_bound = at_low | at_high
    distance = numpy.where(at_low, u - problem.lower, numpy.where(at_high, problem.upper - u, 0))
    complementary = numpy.abs(multiplier * open_by).sum() + numpy.abs(forces * distance)[at_bound].sum()
    left, weight = numpy.where(at_bound, 0, forces), 1 / problem.stiffness.diagonal()
    length = max(numpy.abs(u).max(), numpy.abs(problem.gap).max(initial=0))
    through = [-open_by, numpy.abs(slack[contacts:]), (problem.lower - u)[low], (u - problem.upper)[high]]
    work = max(abs(problem.load @ u), u @ (problem.stiffness @ u))
    found = {"balance": numpy.sqrt((weight * left ** 2).sum() / (weight * sizes ** 2).sum()),
             "penetration": max(part.max(initial=0) for part in through) / length,
             "tension": -multiplier.min(initial=0) / max(numpy.abs(multiplier).max(initial=0), 1e-300),
             "complementarity": complementary / work}
    if len(problem.friction_row):
        found["friction"] = _friction(problem, answer)
    return {name: float(value) for name, value in found.items()}


def _friction(problem: ContactProblem, answer: Answer) -> float:
    tangents = problem.components - 1
    slip = (problem.tangent @ answer.u - problem.tangent_gap).reshape(-1, tangents)
    t = answer.tangential.reshape(-1, tangents)
    bound = problem.friction_bound + problem.friction * answer.multiplier[problem.friction_row]
    trial = t + slip * problem.stiffness.diagonal().mean()
    length = numpy.maximum(numpy.linalg.norm(trial, axis=1), 1e-300)
    projected = trial * numpy.minimum(1, numpy.maximum(bound, 0) / length)[:, None]
    return numpy.abs(t - projected).max() / numpy.abs(answer.multiplier).max()


def error(problem: ContactProblem, u: numpy.ndarray, exact: numpy.ndarray) -> float:
    """In the energy norm, relative; rigid motions do not count."""
    stiffness, apart = problem.stiffness.astype(numpy.longdouble), u.astype(numpy.longdouble) - exact  # large motions cancel
    return float(numpy.sqrt(max(apart @ (stiffness @ apart), 0) / (exact @ (stiffness @ exact))))


@dataclasses.dataclass
class Entry:
    """A solver on a problem."""

    problem: str
    solver: str
    outcome: str  #: "solved", "no solution", "many solutions", "absent: ...", "unfit: ..." or "failed: ..."
    work: int = 0
    unit: str = ""
    seconds: float = numpy.nan  #: all of it, factorizations too
    error: float = numpy.nan  #: in the energy norm beside the reference


def run(problem: ContactProblem, solver: Callable[[ContactProblem], Answer], name: str = "", exact: Answer | None = None,
        repeats: int = 1) -> Entry:
    """The best time of some. `exact`: the reference; None: it is computed."""
    entry, best, answer = Entry(problem.name, name or getattr(solver, "__name__", "solver"), "solved"), numpy.inf, None
    for _ in range(repeats):
        began = time.perf_counter()
        try:
            answer = solver(problem)
        except NoSolution:
            entry.outcome = NO_SOLUTION
        except ManySolutions:
            entry.outcome = "many solutions"
        except (Absent, Unfit) as reason:
            entry.outcome = f"{type(reason).__name__.lower()}: {reason}"
            return entry
        except Exception as reason:  # a solver may fail in any way
            entry.outcome = f"failed: {reason}"
            return entry
        best = min(best, time.perf_counter() - began)
    entry.seconds = best
    if answer is not None:
        entry.work, entry.unit = int(answer.work), answer.unit
        exact = reference(problem) if exact is None else exact
        entry.error = numpy.inf if exact is None else error(problem, answer.u, exact.u)
    return entry


def contest(problems: Iterable[ContactProblem], solvers: Mapping[str, Callable[[ContactProblem], Answer]] = SOLVERS,
            repeats: int = 1) -> list[Entry]:
    """All on all."""
    entries = []
    for problem in problems:
        exact = reference(problem)
        entries += [run(problem, solver, name, exact, repeats) for name, solver in solvers.items()]
    return entries


def table(entries: list[Entry]) -> str:
    """Markdown: a row a problem, a column a solver; seconds, work in brackets, error."""
    solvers, rows = list(dict.fromkeys(entry.solver for entry in entries)), list(dict.fromkeys(entry.problem for entry in entries))
    cells = {(entry.problem, entry.solver): _cell(entry) for entry in entries}
    lines = [["problem", *solvers], ["---"] * (1 + len(solvers)), *([row, *(cells[row, name] for name in solvers)] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _cell(entry: Entry) -> str:
    if entry.outcome == "solved":
        return f"{entry.seconds:.2g} ({entry.work}) {entry.error:.0e}".replace("0e+00", "0")
    kind, _, reason = entry.outcome.partition(": ")
    return {"unfit": "-", "absent": "absent", "failed": "fails"}.get(kind, kind)


def draw(entries: list[Entry], file: str) -> None:
    """Seconds of each solver on each problem; hollow where the error is larger than 1e-6."""
    from .plot import style
    rows, solvers = list(dict.fromkeys(entry.problem for entry in entries)), list(dict.fromkeys(entry.solver for entry in entries))
    figure, axes = style.pyplot.subplots(figsize=(9.5, 0.32 * len(rows) + 1.6), layout="constrained")
    looks = zip([*style.SERIES, style.BLACK, style.GREY, "#8C564B"], "osD^vP*X<", strict=True)
    for name, (colour, marker) in zip(solvers, looks, strict=False):
        own = [entry for entry in entries if entry.solver == name and numpy.isfinite(entry.seconds)]
        faces = ["none" if entry.error > 1e-6 else colour for entry in own]
        axes.scatter([entry.seconds for entry in own], [rows.index(entry.problem) for entry in own], s=46, marker=marker,
                     facecolors=faces, edgecolors=colour, label=name)
    axes.set(xscale="log", xlabel="seconds", yticks=range(len(rows)), yticklabels=rows)
    axes.invert_yaxis()
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(file, dpi=110)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m epafi.contest", description="Prints a table of solvers on problems.")
    parser.add_argument("problems", nargs="*", metavar="PROBLEM", help=f"of {', '.join(names())} (default: all)")
    parser.add_argument("--repeats", type=int, default=3, help="of which the best time counts (3)")
    parser.add_argument("--algorithms", action="store_true", help="Epafi's by name on the same operator, not Epafi and others")
    parser.add_argument("--picture", metavar="FILE", help="draws the times, too")
    options = parser.parse_args(arguments)
    try:
        entries = contest([load(name) for name in options.problems or names()], ALGORITHMS if options.algorithms else SOLVERS,
                          repeats=options.repeats)
    except InputError as wrong:
        print(f"epafi.contest: {wrong}", file=sys.stderr)
        return 2
    print(table(entries))
    for entry in entries:
        if entry.outcome.startswith(("failed", "absent")):
            print(f"{entry.problem}, {entry.solver}: {entry.outcome}", file=sys.stderr)
    if options.picture:
        draw(entries, options.picture)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
