"""Runs to a target: errors over unknowns from targets.csv, the true ones beside the targets; and the meshes of one run from
meshes.csv."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.ticker import FuncFormatter, NullFormatter

from . import style, table

COLUMNS = ["scene", "order", "target", "unknowns", "seconds", "estimated_error", "true_error"]
MESHES = ["mesh", "order", "unknowns", "relative_error", "seconds"]
COLOURS = [style.BLUE, style.VERMILLION, style.GREEN, style.PURPLE, style.ORANGE, style.SKY, style.BLACK]
MARKERS = "osD^vP<>X*"


def percents(axes):
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def draw_power(axes, x, y, power, label):
    """A line of a slope below some points."""
    ends = numpy.array([x.min(), x.max()])
    values = 0.6 * y.min() * (ends / ends[1])**power
    axes.plot(ends, values, color=style.GREY, linewidth=1.0, zorder=1)
    axes.annotate(label, (ends[0], values[0]), (0, 5), textcoords="offset points", fontsize=9, color="#555555")


def figure(file, rows):
    numbers = {name: table.numbers(file, rows, name) for name in COLUMNS[1:]}
    series = list(dict.fromkeys((row["scene"], row["order"] if row["order"] == "1" else "2") for row in rows))
    picture, (left, right) = pyplot.subplots(1, 2, figsize=(12.5, 5.4), gridspec_kw=dict(wspace=0.2))
    for k, (scene, order) in enumerate(series):
        chosen = numpy.array([(row["scene"], row["order"]) == (scene, order) for row in rows])
        colour, marker = COLOURS[k % len(COLOURS)], MARKERS[(k // len(COLOURS) + k) % len(MARKERS)]
        label = scene.replace("_", " ") + (", order 1" if order == "1" else "")
        ascending = numpy.argsort(numbers["unknowns"][chosen])
        error = 100 * numbers["true_error"][chosen]
        left.plot(numbers["unknowns"][chosen][ascending], error[ascending], color=colour, marker=marker, linewidth=1.4,
                  markersize=5.5, label=label)
        right.plot(100 * numbers["target"][chosen], error, color=colour, marker=marker, linestyle="none", markersize=6)
    targets = 100 * numpy.array([numbers["target"].min(), numbers["target"].max()])
    right.plot(targets, targets, color=style.BLACK, linewidth=1.2)
    right.plot(targets, 1.1 * targets, color=style.GREY, linewidth=1.0, linestyle="--")
    right.annotate("a tenth above the target", (targets[0], 1.1 * targets[0]), (4, 12), textcoords="offset points", fontsize=9,
                   color="#555555")
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set_yscale("log")
        percents(axes)
        axes.set_ylabel("true error in the energy norm [%]")
    right.xaxis.set_minor_formatter(NullFormatter())
    right.set_xticks(sorted(set((100 * numbers["target"]).round(4))))
    right.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    left.set_xlabel("unknowns of the last mesh [1]")
    right.set_xlabel("target [%]")
    draw_power(left, numbers["unknowns"], 100 * numbers["true_error"], -2 / 3, "~ N^(-2/3)")
    picture.legend(loc="upper center", bbox_to_anchor=(0.5, 0.02), ncol=5, fontsize=9)
    return picture


def meshes(file, rows):
    unknowns, error = table.numbers(file, rows, "unknowns"), 100 * table.numbers(file, rows, "relative_error")
    seconds, order = table.numbers(file, rows, "seconds"), table.numbers(file, rows, "order")
    picture, axes = pyplot.subplots(figsize=(6.4, 4.6))
    axes.plot(unknowns, error, color=style.GREY, linewidth=1.2, zorder=1)
    for number, colour, marker in ((1, style.VERMILLION, "s"), (2, style.BLUE, "o")):
        if (order == number).any():
            axes.plot(unknowns[order == number], error[order == number], color=colour, marker=marker, linestyle="none",
                      markersize=8, label=f"order {number}")
    for x, y, second in zip(unknowns, error, seconds):
        axes.annotate(f"{second:.2g} s", (x, y), (7, 5), textcoords="offset points", fontsize=9)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.margins(0.15)
    percents(axes)
    axes.set_xlabel("unknowns [1]")
    axes.set_ylabel("estimated error in the energy norm [%]")
    axes.legend()
    return picture
