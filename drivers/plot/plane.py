"""Elastic bodies in the plane: deformed shape, coloured by von Mises stress."""

import matplotlib
import matplotlib.pyplot as pyplot
import numpy
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.tri import Triangulation

from . import cells, deformation, style

MOST_MESH_CELLS = 2500  # of all bodies: above, the lines of the mesh would hide the colours


def proportions(low, high):
    """Width and height of a figure whose axes have these limits, at equal scales."""
    extent = numpy.maximum(high - low, 0.02 * (high - low).max())
    width = 8.6
    return width, float(numpy.clip(0.74 * width * extent[1] / extent[0] + 1.3, 3.2, 8.4))


def boundary(body):
    """Edges that one cell alone has, n x 2."""
    return cells.outer_facets(body.cell_type, body.cells)[0]


def draw_closed(axes, run, factor):
    """The closed part of each contact on its first body; returns whether there is any."""
    drawn = False
    for pair in run.contacts:
        points = deformation.contact_points(run, pair, factor)
        if points is None or pair.cells is None:
            continue
        closed = pair.cells[pair.active[pair.cells].all(axis=1)]
        if pair.cells.shape[1] == 2 and len(closed):
            axes.add_collection(LineCollection(points[closed][:, :, :2], colors=style.ACTIVE, linewidths=3.2, zorder=5,
                                               capstyle="round"))
        lonely = numpy.setdiff1d(numpy.flatnonzero(pair.active), closed)
        axes.plot(*points[lonely, :2].T, color=style.ACTIVE, marker="o", markersize=4, linestyle="none", zorder=5)
        drawn = drawn or bool(pair.active.any())
    return drawn


def figure(run, box=None):
    """Of what lies in `box`, {x0, x1, y0, y1, …}, if there is one."""
    factor = deformation.scale(run)
    places = [deformation.deformed(body, factor) for body in run.bodies]
    every = numpy.concatenate(places)
    low, high = every[:, :2].min(axis=0), every[:, :2].max(axis=0)
    if box is not None:
        low, high = numpy.array(box[:4:2]), numpy.array(box[1:4:2])
    picture, axes = pyplot.subplots(figsize=proportions(low, high))
    axes.grid(False)
    norm = matplotlib.colors.Normalize(*deformation.stress_range(run))
    few = sum(len(body.cells) for body in run.bodies) <= MOST_MESH_CELLS
    for body, place in zip(run.bodies, places):
        x, y = place[:, 0], place[:, 1]
        triangles = cells.triangles(body.cells)[0]
        axes.tripcolor(Triangulation(x, y, triangles), body.von_mises, shading="gouraud", cmap=style.STRESS, norm=norm,
                       rasterized=True, zorder=1)
        if few:
            lines = cells.edges(body.cells)[0]
            axes.add_collection(LineCollection(place[lines][:, :, :2], colors=(0, 0, 0, 0.22), linewidths=0.3, zorder=2))
        outline = boundary(body)
        axes.add_collection(LineCollection(body.points[outline][:, :, :2], colors=style.GREY, linewidths=0.7,
                                           linestyles=(0, (4, 3)), zorder=3))
        axes.add_collection(LineCollection(place[outline][:, :, :2], colors=style.BLACK, linewidths=1.1, zorder=4,
                                           capstyle="round"))
    closed = draw_closed(axes, run, factor)
    axes.set_aspect("equal")
    axes.use_sticky_edges = False
    axes.margins(0.02)
    axes.autoscale_view()
    if box is not None:
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
    axes.set_xlabel("x [length]")
    axes.set_ylabel("y [length]")
    bar = picture.colorbar(matplotlib.cm.ScalarMappable(norm, style.STRESS), ax=axes, shrink=0.85, pad=0.03, aspect=26)
    bar.set_label("von Mises stress\n[force per area]")
    bar.outline.set_visible(False)
    axes.set_title(f"{deformation.names(run)}: {deformation.text(factor)} — {run.title}", pad=10)
    handles = [Line2D([], [], color=style.GREY, linewidth=0.9, linestyle=(0, (4, 3)), label="undeformed")]
    if closed:
        handles.append(Line2D([], [], color=style.ACTIVE, linewidth=3.2, label="contact closed"))
    axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=style.below(picture, axes),
                ncol=len(handles))
    return picture
