"""Products with F and condition numbers over the jump of the stiffness, without and with adaptive constraints, from
heterogeneity.csv."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from . import style, table

COLUMNS = ["bodies", "pattern", "cut", "jump", "adaptive", "hessian_multiplications", "condition", "converged"]
# Pattern and cut, with label, colour and marker.
SERIES = {
    ("stripes", "grid"): ("stripes", style.BLUE, "o"),
    ("checkerboard", "grid"): ("checkerboard", style.SKY, "s"),
    ("inclusions", "grid"): ("inclusions", style.PURPLE, "D"),
    ("channels", "grid"): ("channels", style.VERMILLION, "^"),
    ("crossing", "grid"): ("crossing channels", style.ORANGE, "P"),
    ("channels", "METIS"): ("channels, cut by METIS", style.GREEN, "v"),
    ("columns", "grid"): ("columns", style.VERMILLION, "X"),
}
WITHOUT = (0, (2, 1.5))
ROWS = [("hessian_multiplications", "products with F [number]"), ("condition", "condition number κ")]


def curve(rows, column):
    """(jump, values) in ascending order."""
    return numpy.array(sorted((float(row["jump"]), float(row[column])) for row in rows)).reshape(-1, 2).T


def draw_series(axes, rows, column, colour, marker):
    """Dashed and hollow without, where that is not the same as with; a grey ring around what did not converge."""
    chosen = {use: [row for row in rows if row["adaptive"] == use] for use in ("no", "auto")}
    for use, dashes, face in (("no", WITHOUT, "white"), ("auto", "-", colour)):
        jump, values = curve(chosen[use], column)
        if use == "no" and numpy.array_equal(values, curve(chosen["auto"], column)[1]):
            continue
        axes.plot(jump, values, color=colour, linestyle=dashes, linewidth=1.7, marker=marker, markersize=6.5,
                  markerfacecolor=face, markeredgecolor=colour, markeredgewidth=1.3, zorder=3 if use == "auto" else 2)
        stopped = numpy.array([row["converged"].strip() != "1" for row in
                               sorted(chosen[use], key=lambda row: float(row["jump"]))], dtype=bool)
        axes.plot(jump[stopped], values[stopped], linestyle="none", marker="o", markersize=13, markerfacecolor="none",
                  markeredgecolor=style.GREY, markeredgewidth=1.5)


def power(value, _=None):
    exponent = round(numpy.log10(value))
    return "1" if exponent == 0 else f"$10^{exponent}$"


def draw_panel(axes, rows, column):
    for (pattern, cut), (_, colour, marker) in SERIES.items():
        mine = [row for row in rows if (row["pattern"], row["cut"]) == (pattern, cut)]
        if mine:
            draw_series(axes, mine, column, colour, marker)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.xaxis.set_major_locator(FixedLocator(sorted({float(row["jump"]) for row in rows})))
    axes.xaxis.set_major_formatter(FuncFormatter(power))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.minorticks_off()
    axes.margins(x=0.07)


def legend(picture, rows):
    present = {(row["pattern"], row["cut"]) for row in rows}
    handles = [Line2D([], [], color=colour, marker=marker, linewidth=1.7, markersize=6.5, label=label)
               for key, (label, colour, marker) in SERIES.items() if key in present]
    handles += [Line2D([], [], color=style.BLACK, linewidth=1.7, label="with adaptive constraints"),
                Line2D([], [], color=style.BLACK, linewidth=1.7, linestyle=WITHOUT, marker="o", markersize=6.5,
                       markerfacecolor="white", label="without (where it differs)")]
    if any(row["converged"].strip() != "1" for row in rows):
        handles.append(Line2D([], [], color=style.GREY, marker="o", markersize=13, markerfacecolor="none",
                              linestyle="none", label="stopped early"))
    picture.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.045), ncol=5, columnspacing=1.8)


def figure(file, rows):
    for column in ("jump", "hessian_multiplications", "condition"):
        table.numbers(file, rows, column)  # complains of what is no number
    kinds = list(dict.fromkeys(row["bodies"] for row in rows))
    picture, panels = pyplot.subplots(2, len(kinds), sharex=True, sharey="row", squeeze=False,
                                      figsize=(1.4 + 3.1 * len(kinds), 7.8), gridspec_kw=dict(wspace=0.08, hspace=0.1))
    for column, kind in enumerate(kinds):
        mine = [row for row in rows if row["bodies"] == kind]
        for axes, (quantity, _) in zip(panels[:, column], ROWS):
            draw_panel(axes, mine, quantity)
        panels[0, column].set_title(kind)
        panels[1, column].set_xlabel("jump of the stiffness")
    for axes, (_, label) in zip(panels[:, 0], ROWS):
        axes.set_ylabel(label)
    legend(picture, rows)
    picture.suptitle("Jumps of the stiffness: products until solved, and the condition number", y=0.965, fontsize=15)
    return picture
