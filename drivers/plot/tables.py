"""CG steps of tables.csv beside the paper's."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D

from . import style

COLUMNS = ["problem", "H_inverse", "H_over_h", "cg_iterations"]
MARKERS = "osD^vP"


def curve(rows, column):
    """(H_inverse, values) in ascending order, rows without a number left out."""
    points = sorted((float(row["H_inverse"]), float(row[column])) for row in rows if (row.get(column) or "").strip())
    return numpy.array(points).reshape(-1, 2).T


def draw_problem(axes, rows, ratios, has_paper):
    for k, ratio in enumerate(ratios):
        chosen = [row for row in rows if float(row["H_over_h"]) == ratio]
        colour, marker = style.SERIES[k % len(style.SERIES)], MARKERS[k % len(MARKERS)]
        axes.plot(*curve(chosen, "cg_iterations"), color=colour, marker=marker, linewidth=1.8, markersize=6.5)
        if has_paper:
            axes.plot(*curve(chosen, "paper_cg_iterations"), color=colour, marker=marker, linewidth=1.2, markersize=6.5,
                      linestyle="--", markerfacecolor="white")
    inverse = sorted({float(row["H_inverse"]) for row in rows})
    axes.set_xscale("log", base=2)
    axes.set_xticks(inverse, [f"{value:g}" for value in inverse])
    axes.minorticks_off()
    axes.margins(x=0.06)
    axes.set_xlabel("subdomains a side 1/H [number]")


def figure(rows):
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    ratios = sorted({float(row["H_over_h"]) for row in rows})
    has_paper = any((row.get("paper_cg_iterations") or "").strip() for row in rows)
    picture, panels = pyplot.subplots(1, len(problems), sharey=True, squeeze=False,
                                      figsize=(1.2 + 4.4 * len(problems), 4.8), gridspec_kw=dict(wspace=0.08))
    for axes, problem in zip(panels[0], problems):
        draw_problem(axes, [row for row in rows if row["problem"] == problem], ratios, has_paper)
        axes.set_title(problem)
    panels[0, 0].set_ylim(bottom=0)  # once all panels, which share the axis, have set its upper end
    panels[0, 0].set_ylabel("CG steps [number]")
    handles = [Line2D([], [], color=style.SERIES[k % len(style.SERIES)], marker=MARKERS[k % len(MARKERS)], linewidth=1.8,
                      label=f"H/h = {ratio:g}") for k, ratio in enumerate(ratios)]
    if has_paper:
        handles += [Line2D([], [], color=style.BLACK, linewidth=1.8, label="Epafi"),
                    Line2D([], [], color=style.BLACK, linewidth=1.2, linestyle="--", label="paper")]
    picture.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=min(len(handles), 5))
    heading = "CG steps, ours beside the paper's" if has_paper else "CG steps"
    picture.suptitle(heading, y=0.99, fontsize=14)
    return picture
