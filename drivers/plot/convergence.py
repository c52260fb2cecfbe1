"""How the iteration converged."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from . import style, table
from .run import History

COLUMNS = ["outer", "step", "projected_gradient", "constraint_residual", "hessian_multiplications"]
KINDS = {"s": ("start", "D", 4.5), "c": ("conjugate gradient", "o", 4.0), "e": ("expansion", "^", 6.5),
         "p": ("proportioning", "s", 5.5)}


def history_of_table(file, rows):
    letters = numpy.array([row["step"] for row in rows], dtype="U1")
    number = {name: table.numbers(file, rows, name) for name in COLUMNS if name != "step"}
    return History(number["outer"].astype(int), letters, number["projected_gradient"], number["constraint_residual"],
                   number["hessian_multiplications"])


def drawable(values):
    return numpy.isfinite(values) & (values > 0)


def can_draw(history):
    return history is not None and len(history.step) > 0 and bool(drawable(history.projected_gradient).any())


def draw_series(axes, history, values, colour):
    good = drawable(values)
    x = history.hessian_multiplications
    axes.plot(x[good], values[good], color=colour, linewidth=1.1, alpha=0.75, zorder=2)
    for letter, (_, marker, size) in KINDS.items():
        chosen = good & (history.step == letter)
        if len(x) > 250 and letter == "c":
            size = 2.0  # so many that larger ones would hide the line
        filled = colour if letter in "c" else "white"
        axes.plot(x[chosen], values[chosen], linestyle="none", marker=marker, markersize=size, zorder=3 + (letter != "c"),
                  markeredgecolor=colour, markerfacecolor=filled, markeredgewidth=1.3)


def mark_outer(axes, history):
    """A line where each outer iteration begins, numbers above as far as there is room."""
    begins = numpy.flatnonzero(numpy.diff(history.outer)) + 1
    if len(begins) == 0:
        return
    begins = numpy.concatenate([[0], begins])
    x, number = history.hessian_multiplications[begins], history.outer[begins]
    for place in x:
        axes.axvline(place, color=style.GREY, linewidth=0.7, linestyle=(0, (2, 3)), zorder=1)
    room = max(history.hessian_multiplications.max() - history.hessian_multiplications.min(), 1) / 38
    last, ticks, labels = -numpy.inf, [], []
    for place, k in zip(x, number):
        if place - last >= room:
            ticks.append(place)
            labels.append(str(int(k)))
            last = place
    above = axes.secondary_xaxis("top")
    above.set_xticks(ticks, labels, fontsize=9, color="#555555")
    above.tick_params(length=0, pad=1)
    above.spines["top"].set_visible(False)
    above.set_xlabel("outer iteration", fontsize=10, color="#555555", labelpad=4)


def is_round_off(history):
    """Steps whose constraint holds to round-off: on a common axis they would press everything else together."""
    gradients = history.projected_gradient[drawable(history.projected_gradient)]
    return (history.constraint_residual >= 0) & (history.constraint_residual < 1e-4 * gradients.min())


def draw_equilibrium(axes, history):
    """The constraint's residual; an arrow at the lower edge where it is round-off. Returns the legend's handles."""
    if not drawable(history.constraint_residual).any():
        return []
    round_off = is_round_off(history)
    draw_series(axes, history, numpy.where(round_off, numpy.nan, history.constraint_residual), style.VERMILLION)
    handles = [Line2D([], [], color=style.VERMILLION, linewidth=2, label="equilibrium ‖Gλ‖")]
    if round_off.any():
        look = dict(linestyle="none", marker="v", markersize=7, color=style.VERMILLION)
        axes.plot(history.hessian_multiplications[round_off], numpy.full(round_off.sum(), 0.03),
                  transform=axes.get_xaxis_transform(), zorder=4, **look)
        handles.append(Line2D([], [], label="equilibrium to round-off", **look))
    return handles


def figure(history, title):
    picture, axes = pyplot.subplots(figsize=(9.0, 5.4))
    handles = [Line2D([], [], color=style.BLUE, linewidth=2, label="projected gradient ‖gᴾ‖")]
    draw_series(axes, history, history.projected_gradient, style.BLUE)
    handles += draw_equilibrium(axes, history)
    axes.set_yscale("log")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=10))
    axes.set_xlabel("products with the Hessian [number]")
    axes.set_ylabel("relative residual [1]")
    mark_outer(axes, history)
    counts = {letter: int((history.step == letter).sum()) for letter in KINDS}
    for letter, (name, marker, size) in KINDS.items():
        if counts[letter]:
            handles.append(Line2D([], [], linestyle="none", marker=marker, markersize=size, color=style.BLACK,
                                  markerfacecolor=style.BLACK if letter == "c" else "white",
                                  label=f"{name} ({counts[letter]})"))
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncol=3)
    axes.set_title(f"Convergence — {title}", pad=10)
    return picture
