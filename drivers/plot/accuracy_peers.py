"""True error over the seconds of everything, a panel a scene, from refinement.csv or accuracy_peers.csv."""

import matplotlib.pyplot as pyplot
from matplotlib.ticker import FuncFormatter

from . import style, table

COLUMNS = ["problem", "solver", "order", "refinement", "unknowns", "seconds", "energy_error"]
# Label, colour, marker; local refinement has full lines, even refinement dashed ones, order 1 hollow markers.
SOLVERS = {"epafi": ("Epafi", style.BLUE, "o"), "snesvi_cholmod": ("SNESVI + CHOLMOD", style.BLACK, "X"),
           "calculix": ("CalculiX", style.GREEN, "^"), "dealii": ("deal.II", style.VERMILLION, "s")}


def curves(rows):
    """{(solver, refinement, order or '' of Epafi's local runs, which choose it): points}."""
    result = {}
    for row in rows:
        chosen = row["solver"] == "epafi" and row["refinement"] == "local"
        key = row["solver"], row["refinement"], "" if chosen else row["order"]
        result.setdefault(key, []).append((float(row["seconds"]), 100 * float(row["energy_error"])))
    return result


def figure(file, rows):
    for name in ("seconds", "energy_error"):
        table.numbers(file, rows, name)
    rows = [row for row in rows if row["solver"] in SOLVERS]
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    picture, panels = pyplot.subplots(1, len(problems), figsize=(2 + 5.2 * len(problems), 5), squeeze=False)
    for axes, problem in zip(panels[0], problems):
        for (solver, refinement, order), points in curves(row for row in rows if row["problem"] == problem).items():
            name, colour, marker = SOLVERS[solver]
            points.sort(key=lambda point: -point[1])
            axes.plot(*zip(*points), color=colour, marker=marker, linewidth=1.4, markersize=6,
                      linestyle="-" if refinement == "local" else "--", markerfacecolor="none" if order == "1" else colour,
                      label=f"{name}, {refinement}" + (f", order {order}" if order else ""))
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.set_title(problem.replace("_", " "))
        axes.set_xlabel("seconds of all meshes [s]")
        axes.set_ylabel("true error in the energy norm [%]")
    entries = {label: line for axes in panels[0] for line, label in zip(*axes.get_legend_handles_labels())}
    panels[0][-1].legend(entries.values(), entries.keys(), loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=9)
    picture.tight_layout()
    return picture
