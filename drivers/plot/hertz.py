"""Errors of Hertz's contacts over the mesh size, from hertz.csv."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, NullLocator

from . import style, table

COLUMNS = ["scene", "block_factor", "h", "hertz_radius", "radius_error", "radius_by_area_error", "pressure_error"]
SERIES = {"radius_error": ("radius, from the pressure", style.BLUE, "o"),
          "pressure_error": ("largest pressure", style.VERMILLION, "s"),
          "radius_by_area_error": ("radius, from the closed nodes' area", style.GREEN, "^")}
LINES = ["-", "--", ":", "-."]  # by size of the block


def blocks(content):
    return sorted(set(content["block_factor"]))


def draw_slopes(axes, h, errors):
    """h above all errors, h² below the area's."""
    ends = numpy.array([h.min(), h.max()])
    for power, top in ((1, 1.6 * errors.max()), (2, 0.5 * errors[numpy.argmax(h)])):
        axes.plot(ends, top * (ends / ends[1])**power, color=style.GREY, linewidth=1.0, zorder=1)
        axes.annotate("~ h" if power == 1 else "~ h²", (ends[1], top), (4, 0), textcoords="offset points", va="center",
                      fontsize=10, color="#555555")


def draw(axes, content, sizes):
    relative = content["h"] / content["hertz_radius"]
    for column, (_, colour, marker) in SERIES.items():
        for block, line in zip(sizes, LINES):
            chosen = (content["block_factor"] == block) & (content[column] > 0)
            order = numpy.flatnonzero(chosen)[numpy.argsort(relative[chosen])]
            axes.plot(relative[order], 100 * content[column][order], color=colour, marker=marker, linestyle=line, linewidth=1.7,
                      markersize=6, markerfacecolor=colour if line == "-" else "white")
    draw_slopes(axes, relative, 100 * content["radius_by_area_error"])
    axes.set_xscale("log")
    axes.set_yscale("log")
    ticks = sorted(set(relative.round(4)))
    axes.set_xticks(ticks, [f"{tick:.3g}" for tick in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.margins(x=0.12)
    axes.set_xlabel("mesh size h / a [1]")


def figure(file, rows):
    numbers = {column: table.numbers(file, rows, column) for column in COLUMNS[1:]}
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    sizes = blocks(numbers)[:len(LINES)]
    picture, panels = pyplot.subplots(1, len(scenes), sharey=True, squeeze=False, figsize=(1.2 + 4.4 * len(scenes), 4.8),
                                      gridspec_kw=dict(wspace=0.08))
    for axes, scene in zip(panels[0], scenes):
        of_scene = numpy.array([row["scene"] == scene for row in rows])
        draw(axes, {column: values[of_scene] for column, values in numbers.items()}, sizes)
        axes.set_title(scene.replace("_", ": ").replace("hertz", "Hertz"))
    panels[0, 0].set_ylabel("error relative to Hertz's value [%]")
    handles = [Line2D([], [], color=colour, marker=marker, linewidth=1.7, markersize=6, label=label)
               for label, colour, marker in SERIES.values()]
    if len(sizes) > 1:
        handles += [Line2D([], [], color=style.BLACK, linestyle=line, linewidth=1.4,
                           label="block of the scene" if size == 1 else f"block {size:g} times as large")
                    for size, line in zip(sizes, LINES)]
    picture.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.0), ncol=min(3, len(handles)))
    return picture
