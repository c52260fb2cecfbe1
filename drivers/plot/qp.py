"""Products with the Hessian over the size, by method, preconditioner and start, from qp.csv."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D

from . import style, table

COLUMNS = ["problem", "size", "method", "preconditioner", "start", "hessian_multiplications"]
# method, preconditioner, start: the rows that tell the story, from many products to few.
SERIES = {
    ("fixed_step", "none", "zero"): ("fixed expansion steps", style.GREY, "v"),
    ("projected_cg", "none", "zero"): ("projected CG", style.BLUE, "o"),
    ("projected_cg", "none", "nested"): ("projected CG, nested start", style.SKY, "D"),
    ("projected_cg", "multigrid", "zero"): ("multigrid in face", style.ORANGE, "s"),
    ("projected_cg", "multigrid", "nested"): ("multigrid in face, nested start", style.PURPLE, "P"),
    ("projected_cg", "face_multigrid", "nested"): ("multigrid of the face, nested start", style.VERMILLION, "^"),
}
# Rows of a scan of parameters have other values than these.
DEFAULTS = {"proportioning_constant": 1.0, "expansion_step": 1.9}


def is_default(row):
    return all(float(row.get(column) or value) == value for column, value in DEFAULTS.items())


def converged(row):
    return row.get("status", "Converged") == "Converged"


def draw_series(axes, rows, colour, marker):
    rows = sorted(rows, key=lambda row: float(row["size"]))
    size = numpy.array([float(row["size"]) for row in rows])
    products = numpy.array([float(row["hessian_multiplications"]) for row in rows])
    axes.plot(size, products, color=colour, linewidth=1.8)
    for good, face, size_of_marker, layer in ((True, colour, 6.5, 3), (False, "white", 9, 4)):
        chosen = numpy.array([converged(row) == good for row in rows])
        axes.plot(size[chosen], products[chosen], linestyle="none", marker=marker, markersize=size_of_marker, zorder=layer,
                  markeredgecolor=colour, markerfacecolor=face, markeredgewidth=1.4)


def draw_reference(axes, rows):
    """PERMON's counts, where the table has them."""
    points = sorted((float(row["size"]), float(row["permon_multiplications"])) for row in rows
                    if (row.get("permon_multiplications") or "").strip())
    if points:
        axes.plot(*numpy.array(points).T, color=style.BLACK, linestyle="--", linewidth=1.3, marker="x", markersize=6.5)
    return bool(points)


def draw_problem(axes, rows):
    """Returns whether there was a reference to draw."""
    for key, (_, colour, marker) in SERIES.items():
        chosen = [row for row in rows if (row["method"], row["preconditioner"], row["start"]) == key]
        if chosen:
            draw_series(axes, chosen, colour, marker)
    axes.set_xscale("log")
    axes.set_yscale("log")
    sizes = sorted({float(row["size"]) for row in rows})
    axes.set_xticks(sizes, [f"{size:g}²" for size in sizes])
    axes.xaxis.set_minor_locator(pyplot.NullLocator())
    axes.margins(x=0.08)
    axes.set_xlabel("unknowns [number]")
    return draw_reference(axes, rows)


def figure(file, rows):
    for column in ("size", "hessian_multiplications"):
        table.numbers(file, rows, column)  # complains of what is no number
    rows = [row for row in rows if is_default(row)]
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    picture, panels = pyplot.subplots(1, len(problems), sharey=True, squeeze=False,
                                      figsize=(1.2 + 4.0 * len(problems), 5.2), gridspec_kw=dict(wspace=0.08))
    has_reference = False
    for axes, problem in zip(panels[0], problems):
        has_reference |= draw_problem(axes, [row for row in rows if row["problem"] == problem])
        axes.set_title(problem.replace("_", " "))
    panels[0, 0].set_ylabel("products with the Hessian [number]")
    present = {(row["method"], row["preconditioner"], row["start"]) for row in rows}
    handles = [Line2D([], [], color=colour, marker=marker, linewidth=1.8, markersize=6.5, label=label)
               for key, (label, colour, marker) in SERIES.items() if key in present]
    if has_reference:
        handles.insert(0, Line2D([], [], color=style.BLACK, linestyle="--", marker="x", linewidth=1.3, label="PERMON 3.18"))
    if not all(converged(row) for row in rows):
        handles.append(Line2D([], [], color=style.BLACK, marker="o", linestyle="none", markerfacecolor="white",
                              label="stopped early"))
    picture.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.02), ncol=3)
    picture.suptitle("Products with the Hessian, tolerance 1e-6", y=0.99, fontsize=14)
    return picture
