"""Iterations, time, products with F beside the memory's speed, and predicted ranks, from scaling.csv and, where it stands
beside it, scaling_prediction.csv."""

import matplotlib.pyplot as pyplot
import numpy

from . import style, table
from .errors import PlotError

COLUMNS = ["problem", "H_inverse", "H_over_h", "ranks", "operator", "preconditioner", "hessian_multiplications",
           "assembly_seconds", "setup_seconds", "solve_seconds", "apply_seconds", "apply_bytes", "stream_bytes_per_second"]
PREDICTION = ["problem", "method", "ranks", "subdomains_a_rank", "local_seconds", "neighbour_seconds", "reduction_seconds",
              "coarse_sum_seconds", "coarse_solve_seconds", "efficiency"]
MARKERS = "osD^vP"
LINES = {"coercive": "-", "semicoercive": "--"}
METHODS = {"feti-dp": style.BLUE, "feti-1": style.ORANGE, "hybrid": style.GREEN, "hybrid-spread": style.VERMILLION}
PROBLEMS = {"coercive": ("membranes", "-"), "blocks": ("blocks in space", "--")}
OPERATORS = {"implicit": style.VERMILLION, "explicit": style.BLUE, "shared": style.GREEN}
PHASES = [("assembly", style.GREY), ("setup", style.ORANGE), ("solve", style.BLUE)]
PARTS = [("local work", ("local_seconds",), style.AREAS[0]),
         ("messages to neighbours", ("neighbour_seconds",), style.AREAS[2]),
         ("scalar products", ("reduction_seconds",), style.AREAS[4]),
         ("coarse problem: sum", ("coarse_sum_seconds",), style.AREAS[1]),
         ("coarse problem: solve", ("coarse_solve_seconds",), style.AREAS[3])]


def chosen(rows, **wanted):
    """Rows with these entries, numbers compared as numbers; of one rank, with the Dirichlet preconditioner in double
    precision, unless asked otherwise."""
    wanted = dict(dict(ranks=1, preconditioner="dirichlet", precision="double"), **wanted)
    return [row for row in rows if all(
        float(row[name]) == value if isinstance(value, (int, float)) else row.get(name, value) == value
        for name, value in wanted.items())]


def curve(rows, x, y):
    """Points in the order of x, those without a number left out."""
    points = sorted((float(row[x]), float(row[y])) for row in rows if (row.get(y) or "").strip())
    return numpy.array(points).reshape(-1, 2).T


def values(rows, name):
    return sorted({float(row[name]) for row in rows})


def ticks(axes, numbers):
    axes.set_xscale("log", base=2)
    axes.set_xticks(numbers, [f"{value:g}" for value in numbers])
    axes.minorticks_off()
    axes.margins(x=0.06)


def longest_series(rows, fixed, varied):
    """The value of `fixed` with the most values of `varied`."""
    return max(values(rows, fixed), key=lambda value: len(values(chosen(rows, **{fixed: value}), varied)), default=None)


def draw_iterations(axes, rows, fixed, varied, series):
    for k, value in enumerate(series):
        for problem, line in LINES.items():
            points = curve(chosen(rows, problem=problem, operator="shared", **{fixed: value}), varied,
                           "hessian_multiplications")
            axes.plot(*points, color=style.SERIES[k], marker=MARKERS[k], linestyle=line, linewidth=1.8, markersize=6,
                      label=f"{problem}, {'H/h' if fixed == 'H_over_h' else '1/H'} = {value:g}")
    ticks(axes, values([row for value in series for row in chosen(rows, operator="shared", **{fixed: value})], varied))
    axes.set_ylim(bottom=0)
    axes.set_ylim(top=1.25 * axes.get_ylim()[1])  # room for the legend
    axes.set_ylabel("products with F [number]")
    axes.set_xlabel("subdomains a side 1/H [number]" if varied == "H_inverse" else "elements a side of a subdomain H/h [number]")
    axes.legend(loc="upper left", ncol=len(series))


def draw_time(axes, rows, inverse):
    """Bars of phases over H/h, one for each form of F."""
    ratios = values([row for name in OPERATORS for row in chosen(rows, problem="coercive", operator=name, H_inverse=inverse)
                     if name == "implicit"], "H_over_h")
    for i, ratio in enumerate(ratios):
        for j, name in enumerate(OPERATORS):
            found = chosen(rows, problem="coercive", operator=name, H_inverse=inverse, H_over_h=ratio)
            if not found:
                continue
            unknowns = float(found[0].get("unknowns") or "nan")
            base = 0.0
            for phase, colour in PHASES:
                height = 1e6 * float(found[0][f"{phase}_seconds"]) / unknowns
                axes.bar(i + (j - 1) * 0.27, height, 0.24, bottom=base, color=colour, label=phase if i + j == 0 else None)
                base += height
            axes.text(i + (j - 1) * 0.27, base, f" {name}", rotation=90, ha="center", va="bottom", fontsize=8.5)
    axes.set_xticks(range(len(ratios)), [f"{ratio:g}" for ratio in ratios])
    axes.grid(axis="x", visible=False)
    axes.margins(y=0.22)
    axes.set_xlabel("elements a side of a subdomain H/h [number]")
    axes.set_ylabel("time an unknown [µs]")
    axes.legend(loc="upper left")


def draw_bandwidth(axes, rows, inverse):
    stream = 0.0
    for k, (name, colour) in enumerate(OPERATORS.items()):
        found = chosen(rows, problem="coercive", operator=name, H_inverse=inverse)
        ratio, rate = numpy.array(sorted((float(row["H_over_h"]), float(row["apply_bytes"]) / float(row["apply_seconds"]))
                                         for row in found)).reshape(-1, 2).T
        axes.plot(ratio, 1e-9 * rate, color=colour, marker=MARKERS[k], linewidth=1.8, markersize=6, label=name)
        stream = max([stream] + [float(row["stream_bytes_per_second"]) for row in found])
    axes.axhline(1e-9 * stream, color=style.BLACK, linestyle="--", linewidth=1.3, label="triad, from memory")
    ticks(axes, values(chosen(rows, problem="coercive", H_inverse=inverse), "H_over_h"))
    axes.set_ylim(0, 1.3 * axes.get_ylim()[1])
    axes.set_xlabel("elements a side of a subdomain H/h [number]")
    axes.set_ylabel("read by a product with F [GB/s]")
    axes.legend(loc="upper left", ncol=2)


def on_ranks(rows):
    """Rows of several ranks, and those of one rank with the same sizes."""
    def key(row):
        return row["problem"], row["operator"], float(row["H_over_h"]), float(row["H_inverse"])
    several = {key(row) for row in rows if float(row["ranks"]) > 1}
    found = [row for row in rows if key(row) in several
             and (row["preconditioner"], row.get("precision", "double")) == ("dirichlet", "double")]
    return sorted(found, key=lambda row: (*key(row), float(row["ranks"])))


def draw_ranks(axes, rows):
    """Bars of phases, each rank's time counted, so that bars of perfect scaling are equally high."""
    for i, row in enumerate(rows):
        base = 0.0
        for phase, colour in PHASES:
            height = 1e6 * float(row["ranks"]) * float(row[f"{phase}_seconds"]) / float(row.get("unknowns") or "nan")
            axes.bar(i, height, 0.6, bottom=base, color=colour, label=phase if i == 0 else None)
            base += height
    axes.set_xticks(range(len(rows)), [f"{float(row['ranks']):g} rank{'s' if float(row['ranks']) > 1 else ''}\n"
                                       f"1/H = {float(row['H_inverse']):g}\n{row['operator']}" for row in rows])
    axes.grid(axis="x", visible=False)
    axes.margins(y=0.3)
    axes.set_ylabel("ranks × time an unknown [µs]")
    axes.set_title("Several ranks")
    axes.legend(loc="upper left", ncol=3)


def duration(seconds):
    for unit, name in ((1, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= unit:
            digits = max(0, 1 - int(numpy.floor(numpy.log10(seconds / unit))))
            return f"{seconds / unit:.{digits}f} {name}"
    return f"{1e9 * seconds:.0f} ns"


def draw_parts(axes, rows):
    """Of an iteration of membranes by FETI-DP."""
    rows = sorted((row for row in rows if (row["problem"], row["method"]) == ("coercive", "feti-dp")), key=lambda row: float(row["ranks"]))
    ranks = numpy.array([float(row["ranks"]) for row in rows])
    total = sum(numpy.array([float(row[column]) for row in rows]) for _, columns, _ in PARTS for column in columns)
    base = numpy.zeros_like(ranks)
    for label, columns, colour in PARTS:
        part = sum(numpy.array([float(row[column]) for row in rows]) for column in columns) / total
        axes.fill_between(ranks, 100 * base, 100 * (base + part), color=colour, linewidth=0, label=label)
        base += part
    for x, seconds in zip(ranks, total):
        text = duration(seconds)
        side = dict(ha="left" if x == ranks[0] else "right" if x == ranks[-1] else "center")
        axes.text(x, 101, text, va="bottom", fontsize=8.5, color=style.BLACK, **side)
    axes.set_xscale("log")
    axes.set_xlim(ranks[0], ranks[-1])
    axes.set_ylim(0, 100)
    axes.set_xlabel("ranks [number]")
    axes.set_ylabel("share of an iteration [%]")


def draw_efficiency(axes, rows):
    for method, colour in METHODS.items():
        for problem, (name, line) in PROBLEMS.items():
            points = curve([row for row in rows if (row["problem"], row["method"]) == (problem, method)], "ranks", "efficiency")
            axes.plot(*points, color=colour, linestyle=line, marker="o", linewidth=1.8, markersize=5, label=f"{method}, {name}")
    axes.set_xscale("log")
    axes.set_ylim(0, 1.02)
    axes.set_xlabel("ranks [number]")
    axes.set_ylabel("local work by all time [1]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncol=2)


def draw_one_rank(panels, rows, inverse, ratios):
    draw_iterations(panels[0, 0], rows, "H_over_h", "H_inverse", ratios)
    panels[0, 0].set_title("More subdomains")
    draw_iterations(panels[0, 1], rows, "H_inverse", "H_over_h", [inverse])
    panels[0, 1].set_title("Larger subdomains")
    draw_time(panels[1, 0], rows, inverse)
    panels[1, 0].set_title(f"Time by form of F, coercive, 1/H = {inverse:g}")
    draw_bandwidth(panels[1, 1], rows, inverse)
    panels[1, 1].set_title("Products with F beside the memory")


def draw_predictions(panels, file):
    """With many subdomains a rank; above the parts the time of an iteration."""
    rows = table.read(file)
    number = values(rows, "subdomains_a_rank")[-1]
    rows = [row for row in rows if float(row["subdomains_a_rank"]) == number]
    draw_parts(panels[0], rows)
    panels[0].set_title(f"Predicted iteration by FETI-DP, {number:g} subdomains a rank", pad=20)
    panels[0].legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncol=2)
    draw_efficiency(panels[1], rows)
    panels[1].set_title("Predicted efficiency by method", pad=20)


def figure(file, rows):
    for column in ("H_inverse", "H_over_h", "ranks", "hessian_multiplications", "apply_seconds", "apply_bytes"):
        table.numbers(file, rows, column)  # complains of what is no number
    rows = [row for row in rows if row["problem"] in LINES and float(row.get("cluster") or 0) == 0]  # FETI-DP of membranes
    shared = chosen(rows, operator="shared")
    inverse = longest_series(shared, "H_inverse", "H_over_h")
    ratios = [value for value in values(shared, "H_over_h")
              if len(values(chosen(shared, H_over_h=value), "H_inverse")) > 2]
    prediction = file.with_name("scaling_prediction.csv")
    has_series, several = bool(ratios), on_ranks(rows)
    has_prediction = has_series and prediction.is_file() and table.has(table.read(prediction), PREDICTION)
    heights = [1] * (2 * has_series + has_prediction) + [0.8] * bool(several)
    if not heights:
        raise PlotError(f"'{file}' holds no series to draw; run the study anew.")
    picture = pyplot.figure(figsize=(12, 0.4 + 4.8 * sum(heights)))
    places = picture.add_gridspec(len(heights), 2, height_ratios=heights, hspace=0.68, wspace=0.2)
    if has_series:
        panels = numpy.array([[picture.add_subplot(places[i, j]) for j in (0, 1)] for i in range(2 + has_prediction)])
        draw_one_rank(panels, rows, inverse, ratios)
        if has_prediction:
            draw_predictions(panels[2], prediction)
    if several:
        draw_ranks(picture.add_subplot(places[-1, :]), several)
    return picture
