"""Extreme eigenvalues of F, plain and preconditioned, over size and number of subdomains, from spectra.csv."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter

from . import style, table

COLUMNS = ["problem", "cluster", "series", "value", "part", "preconditioner", "smallest_eigenvalue", "largest_eigenvalue"]
# Cluster (0 FETI-DP, 1 FETI, else hybrid) and part, with label, colour and marker.
SERIES = [
    (0, "all", "FETI-DP", style.BLUE, "o"),
    (0, "gluing", "gluing alone", style.GREEN, "s"),
    (0, "contact", "contact alone", style.VERMILLION, "^"),
    (1, "all", "FETI", style.PURPLE, "D"),
    (2, "all", "hybrid", style.ORANGE, "P"),
]
SMALLEST = (0, (2, 1.5))
# Slopes beside the plain eigenvalues: λ_max ~ (H/h)^p, 1/h.
SLOPES = {"H/h": [(1, "H/h"), (2, "(H/h)²")], "1/H": [(1, "1/H")]}


def draw_series(axes, rows, colour, marker):
    for column, dashes, face in (("largest_eigenvalue", "-", colour), ("smallest_eigenvalue", SMALLEST, "white")):
        points = numpy.array(sorted((float(row["value"]), float(row[column])) for row in rows)).T
        axes.plot(*points, color=colour, linestyle=dashes, linewidth=1.6, marker=marker, markersize=6, markerfacecolor=face,
                  markeredgewidth=1.2)


def draw_slopes(axes, rows, series):
    x = numpy.array([min(float(row["value"]) for row in rows), max(float(row["value"]) for row in rows)])
    top = max(float(row["largest_eigenvalue"]) for row in rows if float(row["value"]) == x[0])
    for power, label in SLOPES[series]:
        y = 1.5 * top * (x / x[0])**power
        axes.plot(x, y, color=style.GREY, linewidth=1.0, zorder=1)
        axes.annotate(label, (x[1], y[1]), (-4, 4), textcoords="offset points", ha="right", fontsize=9, color="#555555")


def draw_panel(axes, rows, series, is_plain):
    for cluster, part, _, colour, marker in SERIES:
        mine = [row for row in rows if min(int(row["cluster"]), 2) == cluster and row["part"] == part]
        if mine:
            draw_series(axes, mine, colour, marker)
    if is_plain:
        draw_slopes(axes, rows, series)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    values = sorted({float(row["value"]) for row in rows})
    axes.set_xticks(values, [f"{value:g}" for value in values])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    if not is_plain:
        axes.yaxis.set_minor_locator(FixedLocator([2, 3, 5]))
        axes.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.margins(x=0.08)


def legend(picture, rows):
    present = {(min(int(row["cluster"]), 2), row["part"]) for row in rows}
    handles = [Line2D([], [], color=colour, marker=marker, linewidth=1.6, markersize=6, label=label)
               for cluster, part, label, colour, marker in SERIES if (cluster, part) in present]
    handles += [Line2D([], [], color=style.BLACK, linewidth=1.6, marker="o", label="largest"),
                Line2D([], [], color=style.BLACK, linewidth=1.6, linestyle=SMALLEST, marker="o", markerfacecolor="white",
                       label="smallest, but 0")]
    picture.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.035), ncol=len(handles), columnspacing=1.6)


def figure(file, rows):
    for column in ("value", "cluster", "smallest_eigenvalue", "largest_eigenvalue"):
        table.numbers(file, rows, column)  # complains of what is no number
    columns = list(dict.fromkeys((row["problem"], row["series"]) for row in rows))
    kinds = list(dict.fromkeys(row["preconditioner"] for row in rows))
    picture, panels = pyplot.subplots(len(kinds), len(columns), sharex="col", sharey="row", squeeze=False,
                                      figsize=(1.4 + 3.2 * len(columns), 0.9 + 3.7 * len(kinds)),
                                      gridspec_kw=dict(wspace=0.08, hspace=0.1))
    for i, kind in enumerate(kinds):
        for k, (problem, series) in enumerate(columns):
            mine = [row for row in rows if (row["preconditioner"], row["problem"], row["series"]) == (kind, problem, series)]
            draw_panel(panels[i, k], mine, series, kind == "none")
            panels[0, k].set_title(problem)
            panels[-1, k].set_xlabel({"H/h": "H/h, 1/H = 4", "1/H": "1/H, H/h = 8"}.get(series, series))
        panels[i, 0].set_ylabel("eigenvalues of F [1]" if kind == "none" else "eigenvalues of MF [1]")
    legend(picture, rows)
    picture.suptitle("What MPRGP works on: extreme eigenvalues of F, or PFP", y=0.95, fontsize=14)
    return picture
