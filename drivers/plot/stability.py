"""Hard cases: products over what makes them hard, and how each family ended, from stability.csv."""

import textwrap

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter

from . import style, table

COLUMNS = ["case", "parameter", "expected", "outcome", "ok", "hessian_multiplications", "family", "value", "variant"]

# Title, label of the abscissa, variants, and the cases with their labels; six lines at most.
PANELS = [
    ("Jumps, default", "conductivity or E of the other part", ["default"], {
        "jump between the bodies": "between bodies", "jumps along subdomain borders": "along borders",
        "jumps across subdomain borders": "across borders", "checkerboard inside subdomains": "checkerboard inside",
        "channels through borders and contact": "channels", "elastic squares, along borders": "elastic, along borders"}),
    ("Jumps, without preconditioner", "conductivity or E of the other part", ["plain"], {
        "jump between the bodies": "between bodies", "jumps along subdomain borders": "along borders",
        "jumps across subdomain borders": "across borders", "checkerboard inside subdomains": "checkerboard inside",
        "channels through borders and contact": "channels", "elastic squares, along borders": "elastic, along borders"}),
    ("Flat elements and bodies", "length to height", ["default", "plain"], {
        "flat elements": "elements", "flat bodies, subdomains and elements": "all",
        "flat subdomains": "subdomains", "flat elastic elements": "elastic elements",
        "flat elastic bodies and elements": "elastic, all"}),
    ("Large and many subdomains", "H/h, or 1/H", ["default", "plain"], {
        "H/h": "H/h", "1/H": "1/H", "1/H, floating": "1/H, floating"}),
    ("Hardly held bodies", "conductivity or E of the soft layer", ["default"], {
        "soft support, pressed": "pressed", "soft support, pulled off": "pulled off", "elastic, soft support": "elastic"}),
    ("Nearly incompressible", "1/(1 − 2ν)", ["default", "plain"], {
        "squares": "squares", "square on a floor": "square on a floor", "cubes": "cubes"}),
    ("Parameters of the algorithms", "Γ, ρ, M: value", ["default", "plain"], {
        "proportioning constant": "Γ", "proportioning constant, floating": "Γ, floating", "penalty, membranes": "ρ",
        "balance": "M"}),
]
OUTCOMES = [("solved", style.BLUE), ("refused, as it should be", style.SKY), ("stopped, and said so", style.ORANGE),
            ("not as expected", style.VERMILLION)]


def is_good(row):
    return row["ok"].strip() == "1"


def is_solved(row):
    return row["outcome"] == "solved"


def class_of(row):
    if not is_good(row):
        return "not as expected"
    if is_solved(row):
        return "solved"
    return "stopped, and said so" if row["outcome"] == "stopped" else "refused, as it should be"


def draw_line(axes, rows, colour, dashes):
    """Filled: solved. Hollow: stopped. Cross: not as expected."""
    rows = sorted((row for row in rows if row["value"].strip()), key=lambda row: float(row["value"]))
    if not rows:
        return
    x = numpy.array([float(row["value"]) for row in rows])
    y = numpy.maximum(1, numpy.array([float(row["hessian_multiplications"]) for row in rows]))
    axes.plot(x, y, color=colour, linewidth=1.6, linestyle=dashes)
    for mark, size, face, chosen in (("o", 5, colour, [is_good(row) and is_solved(row) for row in rows]),
                                     ("o", 6, "white", [is_good(row) and not is_solved(row) for row in rows]),
                                     ("X", 9, colour, [not is_good(row) for row in rows])):
        chosen = numpy.array(chosen)
        axes.plot(x[chosen], y[chosen], linestyle="none", marker=mark, markersize=size, markeredgecolor=colour,
                  markerfacecolor=face, markeredgewidth=1.3, zorder=3)


def draw_panel(axes, rows, title, label, variants, cases):
    handles = []
    for (name, words), colour in zip(cases.items(), style.SERIES):
        mine = [row for row in rows if row["case"] == name]
        for variant in variants:
            draw_line(axes, [row for row in mine if row["variant"] == variant], colour,
                      "-" if variant == "default" else (0, (2, 1.5)))
        if mine:
            handles.append(Line2D([], [], color=colour, linewidth=1.6, marker="o", markersize=5, label=words))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_title(title)
    axes.set_xlabel(label)
    bottom, top = axes.get_ylim()
    if top < 40 * bottom:  # too few decades for powers of ten alone
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_major_formatter(ScalarFormatter())
    axes.yaxis.set_minor_formatter(NullFormatter())
    if variants == ["plain"]:
        return  # the same lines as those of the panel before it
    axes.legend(handles=handles, fontsize=8.5, loc="best", handlelength=1.4, labelspacing=0.25, framealpha=0.75,
                frameon=True, edgecolor="none")


def draw_outcomes(axes, rows):
    families = list(dict.fromkeys(row["family"] for row in rows))
    left = numpy.zeros(len(families))
    for name, colour in OUTCOMES:
        counts = numpy.array([sum(class_of(row) == name for row in rows if row["family"] == family) for family in families])
        axes.barh(range(len(families)), counts, left=left, color=colour, height=0.7)
        left += counts
    for place, total in enumerate(left):
        axes.text(total + 1, place, f"{total:.0f}", va="center", fontsize=9)
    axes.set_yticks(range(len(families)), [textwrap.fill(family, 15) for family in families], fontsize=8.5, linespacing=0.9)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.margins(x=0.12)
    axes.set_title("How the cases ended")
    axes.set_xlabel("cases [number]")


def figure(file, rows):
    for column in ("value", "hessian_multiplications"):
        table.numbers(file, rows, column)  # complains of what is no number
    picture, panels = pyplot.subplots(2, 4, figsize=(18.5, 9.2), gridspec_kw=dict(wspace=0.24, hspace=0.36))
    flat = panels.ravel()
    place = flat[7].get_position()
    flat[7].set_position([place.x0 + 0.055, place.y0, place.width - 0.055, place.height])  # room for names
    for axes, (title, label, variants, cases) in zip(flat, PANELS):
        draw_panel(axes, rows, title, label, variants, cases)
    top = max(flat[0].get_ylim()[1], flat[1].get_ylim()[1])  # the two to be compared
    bottom = min(flat[0].get_ylim()[0], flat[1].get_ylim()[0])
    for axes in flat[:2]:
        axes.set_ylim(bottom, top)
    draw_outcomes(flat[7], rows)
    for axes in panels[:, 0]:
        axes.set_ylabel("products with F [number]")
    handles = [Line2D([], [], color=style.BLACK, label="default"),
               Line2D([], [], color=style.BLACK, linestyle=(0, (2, 1.5)), label="without preconditioner"),
               Line2D([], [], color=style.BLACK, marker="o", linestyle="none", markerfacecolor="white",
                      label="stopped, and said so"),
               Line2D([], [], color=style.BLACK, marker="X", markersize=9, linestyle="none", label="not as expected")]
    handles += [Patch(color=colour, label=name) for name, colour in OUTCOMES]
    picture.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0.045), ncol=8, columnspacing=1.4)
    picture.suptitle("Hard cases: products until solved, tolerance 1e-8", y=0.955, fontsize=15)
    return picture
