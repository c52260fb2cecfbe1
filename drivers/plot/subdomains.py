"""How the bodies are cut: subdomains, crosspoints, contact line."""

import matplotlib
import matplotlib.pyplot as pyplot
import numpy
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import style

MOST_NUMBERS = 40  # subdomains that still get their number written on them


def neighbours(run):
    """Pairs of subdomains that share a point, also across bodies, as two arrays."""
    size = run.size()
    places = numpy.concatenate([body.points[body.cells.ravel()] for body in run.bodies])
    owners = numpy.concatenate([numpy.repeat(body.subdomain, body.cells.shape[1]) for body in run.bodies]).astype(numpy.int64)
    rounded = numpy.round((places - places.min(axis=0)) / size * 1e6).astype(numpy.int64)
    place = (rounded[:, 0] * 1_000_003 + rounded[:, 1]) * 1_000_003 + rounded[:, 2]
    key = numpy.unique(numpy.column_stack([place, owners]).view([("place", "i8"), ("owner", "i8")]).ravel())
    pairs = []
    for distance in range(1, 12):  # more than 12 subdomains at a point do not occur in a sensible cut
        same = key["place"][distance:] == key["place"][:-distance]
        if not same.any():
            break
        pairs.append(numpy.column_stack([key["owner"][:-distance][same], key["owner"][distance:][same]]))
    return numpy.unique(numpy.concatenate(pairs), axis=0) if pairs else numpy.zeros((0, 2), int)


def colouring(run):
    """A colour number for each subdomain, different from its neighbours', colours used about equally often."""
    adjacent = {int(s): set() for body in run.bodies for s in numpy.unique(body.subdomain)}
    for a, b in neighbours(run):
        adjacent[int(a)].add(int(b))
        adjacent[int(b)].add(int(a))
    colour, used = {}, [0] * len(style.AREAS)
    for s in sorted(adjacent):
        taken = {colour[t] for t in adjacent[s] if t in colour}
        free = [c for c in range(len(used)) if c not in taken] or list(range(len(used)))
        colour[s] = min(free, key=lambda c: (used[c], c))
        used[colour[s]] += 1
    return colour


def borders(body):
    """Edges between subdomains and edges on the boundary of the body, each n x 2 x 2."""
    corners = body.cells.shape[1]
    ends = numpy.concatenate([body.cells[:, [k, (k + 1) % corners]] for k in range(corners)])
    owner = numpy.tile(body.subdomain, corners)
    ends = numpy.sort(ends, axis=1)
    order = numpy.argsort(ends[:, 0].astype(numpy.int64) * len(body.points) + ends[:, 1], kind="stable")
    ends, owner = ends[order], owner[order]
    twin = (ends[:-1] == ends[1:]).all(axis=1)
    between = numpy.flatnonzero(twin & (owner[:-1] != owner[1:]))
    alone = ~(numpy.concatenate([[False], twin]) | numpy.concatenate([twin, [False]]))
    return body.points[ends[between]][:, :, :2], body.points[ends[alone]][:, :, :2]


def draw_cells(axes, body, colour):
    numbers, where = numpy.unique(body.subdomain, return_inverse=True)
    shades = numpy.array([colour[int(s)] for s in numbers])[where]
    palette = matplotlib.colors.ListedColormap(style.AREAS)
    shape = body.grid_shape()
    if shape is None:
        axes.add_collection(PolyCollection(body.points[body.cells][:, :, :2], array=shades, cmap=palette,
                                           clim=(-0.5, len(style.AREAS) - 0.5), edgecolors="face", linewidths=0.4,
                                           rasterized=True))
        return
    x, y = body.points[:, 0].reshape(shape), body.points[:, 1].reshape(shape)
    axes.pcolormesh(x, y, shades.reshape(shape[0] - 1, shape[1] - 1), cmap=palette, vmin=-0.5,
                    vmax=len(style.AREAS) - 0.5, rasterized=True)


def draw_edges(axes, edges, colour, width):
    """All edges as one path: stroked at once, they show no seams where they meet."""
    gaps = numpy.full((len(edges), 1, 2), numpy.nan)
    path = numpy.concatenate([edges, gaps], axis=1).reshape(-1, 2)
    axes.plot(path[:, 0], path[:, 1], color=colour, linewidth=width, zorder=3, solid_capstyle="butt")


def draw_numbers(axes, body, size):
    middles = body.points[body.cells][:, :, :2].mean(axis=1)
    for s in numpy.unique(body.subdomain):
        inside = middles[body.subdomain == s]
        nearest = inside[numpy.argmin(((inside - inside.mean(axis=0))**2).sum(axis=1))]
        centre = inside.mean(axis=0) if numpy.ptp(inside, axis=0).prod() > 0 else nearest
        axes.text(*centre, str(s), ha="center", va="center", fontsize=size, color="#333333", zorder=6)


def figure(run):
    colour = colouring(run)
    count = len(colour)
    picture, axes = pyplot.subplots(figsize=(9.5, 5.6))
    axes.grid(False)
    for body in run.bodies:
        draw_cells(axes, body, colour)
        between, boundary = borders(body)
        draw_edges(axes, between, "#444444", 0.9)
        draw_edges(axes, boundary, style.BLACK, 1.4)
        if count <= MOST_NUMBERS:
            draw_numbers(axes, body, 11 if count <= 16 else 8.5)
    crosspoints = numpy.concatenate([body.crosspoints for body in run.bodies])
    dots = float(numpy.clip(900 / max(len(crosspoints), 1), 5, 42))
    axes.scatter(crosspoints[:, 0], crosspoints[:, 1], s=dots, color=style.BLACK, zorder=5, linewidths=0, clip_on=False)
    for pair in run.lines():
        for curve in pair.curves():
            axes.plot(*pair.points[curve, :2].T, color=style.VERMILLION, linewidth=3.4, zorder=4, solid_capstyle="butt")
    axes.set_aspect("equal")
    axes.use_sticky_edges = False
    axes.margins(0.02)
    axes.autoscale_view()
    axes.set_xlabel("x [length]")
    axes.set_ylabel("y [length]")
    axes.set_title(f"{count} subdomain{'s' if count != 1 else ''}, {len(crosspoints)} crosspoints — {run.title}")
    legend(picture, axes, run, len(crosspoints))
    return picture


def legend(picture, axes, run, crosspoints):
    handles = [Patch(facecolor=style.AREAS[0], edgecolor="#444444", label="subdomain")]
    if crosspoints:
        handles.append(Line2D([], [], color=style.BLACK, marker="o", markersize=5, linestyle="none", label="crosspoint"))
    if run.lines():
        handles.append(Line2D([], [], color=style.VERMILLION, linewidth=3.4, label="contact line"))
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=style.below(picture, axes),
                ncol=len(handles))
