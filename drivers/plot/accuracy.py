"""Errors beside what they take, from accuracy.csv: over time, over products with F, over the mesh size, and the digits of the
Time-Accuracy-Size view; estimated errors beside true ones from accuracy_effectivity.csv, and other programs from peers/*/peers.csv,
where these stand beside it."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from . import peers, style, table
from .errors import PlotError

COLUMNS = ["problem", "variant", "order", "elements", "tolerance", "unknowns", "seconds", "hessian_multiplications", "energy_error",
           "algebraic_error", "estimated_error", "on_pareto_front", "discretisation_error"]
NUMBERS = COLUMNS[5:]
TITLES = {"strings": "strings (closed form)", "coercive": "coercive membranes", "semicoercive": "semicoercive membranes",
          "blocks_plane": "elastic blocks, plane", "blocks_space": "elastic blocks, space"}
# Of the variants, those that a picture can show: label, colour, marker. The default is drawn last.
VARIANTS = {
    "snesvi_cholmod": ("SNESVI + CHOLMOD", style.BLACK, "X"),
    "snesvi_hypre": ("SNESVI + hypre", style.GREY, "X"),
    "plain": ("no preconditioner", style.GREY, "v"),
    "lumped": ("lumped", style.SKY, "^"),
    "implicit": ("implicit F", style.PURPLE, "<"),
    "tolerance_1e-10": ("tolerance 1e-10", style.BLUE, ">"),
    "tolerance_1e-4": ("tolerance 1e-4", style.ORANGE, "d"),
    "tolerance_1e-2": ("tolerance 1e-2", "#B8860B", "p"),
    "nested": ("nested, balanced", style.GREEN, "P"),
    "balanced": ("balanced", style.VERMILLION, "s"),
    "default": ("default (1e-6)", style.BLACK, "o"),
    "quadratic": ("order 2 (1e-6)", style.BLUE, "D"),
}
LADDERS = {
    "ladder_plain": ("no preconditioner", style.GREY, "v"),
    "ladder_lumped": ("lumped", style.SKY, "^"),
    "ladder_dirichlet": ("Dirichlet in face", style.BLACK, "o"),
    "ladder_single": ("in single precision", style.VERMILLION, "+"),
}
ERRORS = {
    "energy_error": ("energy norm", style.BLACK, "o", "-"),
    "estimated_discretisation_error": ("its estimate", style.VERMILLION, "s", "--"),
    "l2_error": ("L2 norm", style.BLUE, "^", "-"),
    "contact_zone_error": ("contact zone", style.GREEN, "D", ":"),
    "force_error": ("contact force", style.PURPLE, "v", ":"),
}
NO_ERROR = 1e-9  # what is left of round-off and of the reference's tolerance is no error of the mesh


def problems(rows):
    return list(dict.fromkeys(row["problem"] for row in rows))


def chosen(rows, problem, variant):
    found = [row for row in rows if row["problem"] == problem and row["variant"] == variant]
    return sorted(found, key=lambda row: float(row["elements"]))


def column(rows, name):
    return numpy.array([float(row.get(name) or "nan") for row in rows])


def panels_for(number, width=4.8, height=4.2):
    """Up to three beside each other; spare ones are hidden."""
    across = min(number, 3)
    down = -(-number // across)
    picture, panels = pyplot.subplots(down, across, squeeze=False, figsize=(0.6 + width * across, 0.4 + height * down),
                                      gridspec_kw=dict(wspace=0.26, hspace=0.38))
    for axes in panels.flat[number:]:
        axes.set_visible(False)
    return picture, list(panels.flat[:number])


def legend(picture, entries, columns=4, extra=()):
    """Under all panels."""
    handles = [Line2D([], [], color=colour, marker=marker, linestyle=line, linewidth=1.6, markersize=6.5, label=label)
               for label, colour, marker, line in entries]
    picture.legend(handles=[*handles, *extra], loc="upper center", bbox_to_anchor=(0.5, 0.03), ncol=columns)


def shown(rows, catalogue):
    present = {row["variant"] for row in rows}
    return {name: entry for name, entry in catalogue.items() if name in present}


def plain_decades(axis):
    """Ticks at decades alone."""
    axis.set_major_locator(LogLocator(subs=(1.0,), numticks=8))
    axis.set_minor_formatter(NullFormatter())


def few_decades(axis, label):
    """Ticks at 1, 2 and 5, or where that were many, at decades alone."""
    low, high = numpy.log10(axis.get_view_interval())
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high - low < 1.6 else (1.0,), numticks=12))
    axis.set_major_formatter(FuncFormatter(label))
    axis.set_minor_formatter(NullFormatter())


def percent(value, _):
    return f"{100 * value:g} %"


def seconds(value, _):
    return f"{value:g} s" if value >= 1 else f"{1e3 * value:g} ms"


def draw_front(axes, rows, x="seconds"):
    """The broad line under all curves: the fastest way to each error."""
    points = sorted((float(row[x]), float(row["energy_error"])) for row in rows if float(row["on_pareto_front"]) > 0)
    if points:
        axes.plot(*numpy.array(points).T, color="#F5D28A", linewidth=9, solid_capstyle="round", zorder=0.5,
                  solid_joinstyle="round", drawstyle="steps-post")


def label_work(axes):
    axes.set_xscale("log")
    axes.set_yscale("log")
    few_decades(axes.xaxis, seconds)
    few_decades(axes.yaxis, percent)
    axes.set_xlabel("time from scene to solution")


def work(rows, others):
    """Error over time, a curve a variant, a point a mesh; `others`: a panel of their own for rows of peers.py."""
    names = problems(rows)
    picture, panels = panels_for(len(names) + (1 if others else 0))
    catalogue = shown(rows, VARIANTS)
    for axes, problem in zip(panels, names):
        draw_front(axes, [row for row in rows if row["problem"] == problem])
        for variant, (_, colour, marker) in catalogue.items():
            found = chosen(rows, problem, variant)
            peer = variant.startswith("snesvi")
            axes.plot(column(found, "seconds"), column(found, "energy_error"), color=colour, marker=marker, linewidth=1.1,
                      markersize=6, linestyle=":" if peer else "-", markerfacecolor="none" if variant == "default" else colour,
                      markeredgewidth=1.6 if variant == "default" else 0.5)
        axes.set_title(TITLES.get(problem, problem))
        label_work(axes)
    if others:
        handles = [Line2D([], [], color=colour, marker=marker, linestyle=line, linewidth=1.1, markersize=5, label=label,
                          markerfacecolor=colour if line == "-" else "none")
                   for label, colour, marker, line in peers.draw(panels[-1], others)]
        panels[-1].legend(handles=handles, fontsize=6.5, loc="lower left", ncol=2)
        label_work(panels[-1])
        low, high = panels[-1].get_ylim()
        panels[-1].set_ylim(low / 6, high)  # room for the legend
        few_decades(panels[-1].yaxis, percent)
    for axes in panels[::3]:
        axes.set_ylabel("error in the energy norm, relative")
    legend(picture, [(label, colour, marker, ":" if name.startswith("snesvi") else "-")
                     for name, (label, colour, marker) in catalogue.items()],
           extra=[Line2D([], [], color="#F5D28A", linewidth=9, label="Pareto front")])
    picture.suptitle("Error over time: a curve a setting, a point a mesh", y=0.96 if len(panels) > 3 else 1.0, fontsize=14)
    return picture


def products(rows):
    """What a digit of the iteration takes on one mesh, whatever the machine."""
    names = [name for name in problems(rows) if any(row["variant"] in LADDERS and row["problem"] == name for row in rows)]
    picture, panels = panels_for(len(names))
    for axes, problem in zip(panels, names):
        for variant, (_, colour, marker) in LADDERS.items():
            found = sorted(chosen(rows, problem, variant), key=lambda row: float(row["hessian_multiplications"]))
            axes.plot(column(found, "hessian_multiplications"), column(found, "algebraic_error"), color=colour, marker=marker,
                      linewidth=1.5, markersize=7 if marker == "+" else 5.5)
        finest = max((row for row in rows if row["problem"] == problem), key=lambda row: float(row["elements"]))
        balanced = chosen(rows, problem, "balanced")[-1:]
        axes.plot(column(balanced, "hessian_multiplications"), column(balanced, "algebraic_error"), color=style.GREEN, marker="*",
                  markersize=15, linestyle="none", zorder=5)
        axes.axhline(float(finest["discretisation_error"]), color=style.ORANGE, linewidth=1.6, linestyle="--")
        axes.set_yscale("log")
        plain_decades(axes.yaxis)
        axes.set_xlim(left=0)
        axes.set_xlabel("products with F [number]")
        axes.set_title(f"{TITLES.get(problem, problem)}, {float(finest['elements']):g} elements a side", fontsize=11.5)
    for axes in panels[::3]:
        axes.set_ylabel("algebraic error, energy norm, relative [1]")
    legend(picture, [(label, colour, marker, "-") for label, colour, marker in LADDERS.values()], columns=3,
           extra=[Line2D([], [], color=style.GREEN, marker="*", markersize=14, linestyle="none", label="balanced stopping"),
                  Line2D([], [], color=style.ORANGE, linewidth=1.6, linestyle="--", label="error of the mesh")])
    picture.suptitle("Error of the iteration over products with F: tolerances 1e-1 ... 1e-10",
                     y=0.96 if len(panels) > 3 else 1.0, fontsize=14)
    return picture


def draw_slope(axes, size, top, power):
    ends = numpy.array([size.min(), size.max()])
    axes.plot(ends, top * (ends / ends[1])**power, color="#AAAAAA", linewidth=1.0, zorder=1)
    axes.annotate("~ h" if power == 1 else "~ h²", (ends[0], top * (ends[0] / ends[1])**power), (-4, 0),
                  textcoords="offset points", ha="right", va="center", fontsize=10, color="#555555")


def convergence(rows):
    """Errors over the mesh size, the iteration's being none."""
    names = problems(rows)
    picture, panels = panels_for(len(names))
    present = set()
    for axes, problem in zip(panels, names):
        found = chosen(rows, problem, "tolerance_1e-10")
        size = 1 / column(found, "elements")
        for name, (_, colour, marker, line) in ERRORS.items():
            values = column(found, name)
            values[~(values > NO_ERROR)] = numpy.nan
            if numpy.isfinite(values).any():
                present.add(name)
                axes.plot(size, values, color=colour, marker=marker, linestyle=line, linewidth=1.5, markersize=6,
                          markerfacecolor="none" if name == "estimated_discretisation_error" else colour)
        energy, l2 = column(found, "energy_error"), column(found, "l2_error")
        draw_slope(axes, size, 1.7 * energy[0], 1)
        draw_slope(axes, size, 0.55 * l2[0], 2)
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(size, [f"1/{1 / value:.0f}" for value in size])
        axes.xaxis.set_minor_locator(NullLocator())
        plain_decades(axes.yaxis)
        axes.margins(x=0.16)
        axes.set_xlabel("mesh size: one of so many elements a side")
        axes.set_title(TITLES.get(problem, problem))
    for axes in panels[::3]:
        axes.set_ylabel("relative error [1]")
    legend(picture, [entry for name, entry in ERRORS.items() if name in present], columns=5)
    picture.suptitle("Error over mesh size", y=0.96 if len(panels) > 3 else 1.0, fontsize=14)
    return picture


def spectrum(rows):
    """Digits of accuracy over digits of size, digits of efficacy and unknowns a second over time, one problem a line."""
    names = [name for name in ("coercive", "semicoercive", "blocks_space") if name in problems(rows)] or problems(rows)[:1]
    catalogue = {name: entry for name, entry in shown(rows, VARIANTS).items()
                 if name in ("plain", "default", "balanced", "nested", "snesvi_cholmod", "snesvi_hypre")}
    picture, panels = pyplot.subplots(len(names), 3, squeeze=False, figsize=(14.4, 0.4 + 4.0 * len(names)),
                                      gridspec_kw=dict(wspace=0.27, hspace=0.42))
    views = [("digits_of_size", "digits_of_accuracy", "digits of size log₁₀ N [1]", "digits of accuracy −log₁₀ e [1]"),
             ("seconds", "digits_of_efficacy", "time T", "digits of efficacy −log₁₀ eT [1]"),
             ("seconds", "unknowns_per_second", "time T", "unknowns a second N/T [1/s]")]
    for line, problem in zip(panels, names):
        for axes, (x, y, x_label, y_label) in zip(line, views):
            for variant, (_, colour, marker) in catalogue.items():
                found = chosen(rows, problem, variant)
                axes.plot(column(found, x), column(found, y), color=colour, marker=marker, linewidth=1.4, markersize=6,
                          linestyle=":" if variant.startswith("snesvi") else "-",
                          markerfacecolor="none" if variant == "default" else colour)
            if x == "seconds":
                axes.set_xscale("log")
                few_decades(axes.xaxis, seconds)
            if y == "unknowns_per_second":
                axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{1e-6 * value:g} M"))
                axes.set_ylim(bottom=0)
            axes.set_xlabel(x_label)
            axes.set_ylabel(y_label)
        line[1].set_title(TITLES.get(problem, problem), fontsize=13)
    legend(picture, [(label, colour, marker, ":" if name.startswith("snesvi") else "-")
                     for name, (label, colour, marker) in catalogue.items()], columns=6)
    return picture


def effectivity(rows):
    """Estimated over true error: a line a scene, a mark a mesh; between the dashed lines it is within a factor 2."""
    rows = [row for row in rows if float(row["discretisation_error"]) > NO_ERROR]
    names = list(dict.fromkeys(row["scene"] for row in rows))
    picture, axes = pyplot.subplots(figsize=(7.6, 0.9 + 0.36 * len(names)))
    for level, label, marker, face in ((0, "mesh of the scene", "o", "white"), (1, "refined once", "o", style.BLUE)):
        found = [row for row in rows if float(row["level"]) == level]
        axes.plot([float(row["effectivity"]) for row in found], [names.index(row["scene"]) for row in found], linestyle="none",
                  marker=marker, markersize=8, color=style.BLUE, markerfacecolor=face, markeredgewidth=1.6, label=label,
                  zorder=4 - level)
    axes.axvline(1, color=style.BLACK, linewidth=1.3)
    for bound in (0.5, 2):
        axes.axvline(bound, color=style.VERMILLION, linewidth=1.3, linestyle="--")
    axes.set_xscale("log")
    axes.set_xlim(0.4, 2.5)
    axes.set_xticks([0.5, 0.7, 1, 1.4, 2], ["0.5", "0.7", "1", "1.4", "2"])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.set_xlabel("estimated error / error of the mesh [1]")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1))
    return picture


EFFECTIVITY = ["scene", "level", "discretisation_error", "effectivity"]


def read_effectivity(file):
    """Its rows; none if there is no such file."""
    if not file.is_file():
        return []
    rows = table.read(file)
    if not table.has(rows, EFFECTIVITY):
        raise PlotError(f"'{file}' lacks one of the columns {', '.join(EFFECTIVITY)}; run the study anew.")
    for name in EFFECTIVITY[1:]:
        table.numbers(file, rows, name)
    return rows


def figures(file, rows):
    """Yields the end of each picture's name and the picture."""
    for name in NUMBERS:
        table.numbers(file, rows, name)  # complains of what is no number
    if not any(row["variant"] == "default" for row in rows):
        raise PlotError(f"'{file}' holds no row of the variant 'default'; run the study anew.")
    scenes = read_effectivity(file.with_name(f"{file.stem}_effectivity.csv"))
    on_meshes = [row for row in rows if row["variant"] not in LADDERS]
    yield "work", work(on_meshes, peers.read(file.parent / "peers"))
    if any(row["variant"] in LADDERS for row in rows):
        yield "products", products(rows)
    if any(row["variant"] == "tolerance_1e-10" for row in rows):
        yield "convergence", convergence(on_meshes)
    yield "spectrum", spectrum(on_meshes)
    if scenes:
        yield "effectivity", effectivity(scenes)
