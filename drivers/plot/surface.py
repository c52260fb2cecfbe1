"""The deflection of all bodies as one surface."""

import matplotlib
import matplotlib.pyplot as pyplot
import numpy
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

from . import style

CELLS_A_SIDE = 56  # facets drawn in each direction of a body: enough to look smooth, few enough to be fast


def thinned(count, most):
    """At most `most` + 1 of the indices 0 ... count - 1, the ends among them."""
    return numpy.unique(numpy.linspace(0, count - 1, min(count, most + 1)).round().astype(int))


def facets(body):
    """Corners of the facets drawn, f x 4 x 3, the third coordinate being the deflection."""
    points = numpy.column_stack([body.points[:, :2], body.deflection()])
    shape = body.grid_shape()
    if shape is None:
        chosen = thinned(len(body.cells), 4 * CELLS_A_SIDE**2 - 1)
        corners = points[body.cells[chosen]]
        return corners if corners.shape[1] == 4 else numpy.concatenate([corners, corners[:, -1:]], axis=1)
    lattice = points.reshape(*shape, 3)[numpy.ix_(thinned(shape[0], CELLS_A_SIDE), thinned(shape[1], CELLS_A_SIDE))]
    return numpy.stack([lattice[:-1, :-1], lattice[:-1, 1:], lattice[1:, 1:], lattice[1:, :-1]], axis=2).reshape(-1, 4, 3)


def traces(run, pair):
    """The contact line on the surface of each body that touches it: list of n x 3."""
    result = []
    tolerance = 1e-7 * run.size()
    low, high = pair.points.min(axis=0) - tolerance, pair.points.max(axis=0) + tolerance
    for body in run.bodies:
        near = numpy.flatnonzero(((body.points >= low) & (body.points <= high)).all(axis=1))
        if len(near) != len(pair.points):
            continue
        direction = high - low
        order = near[numpy.argsort(body.points[near] @ direction)]
        back = numpy.argsort(numpy.argsort(pair.points @ direction))
        result.append(numpy.column_stack([pair.points[:, :2], body.deflection()[order][back]]))
    return result


def active_segments(trace, active):
    """Pieces of the line between neighbouring closed nodes; a closed node alone gives a point-like piece."""
    both = active[:-1] & active[1:]
    pieces = [trace[k:k + 2] for k in numpy.flatnonzero(both)]
    padded = numpy.concatenate([[False], active, [False]])
    lonely = numpy.flatnonzero(active & ~padded[:-2] & ~padded[2:])
    return pieces, trace[lonely]


def draw_contacts(axes, run):
    closed = False
    for pair in run.lines():
        for index, trace in enumerate(traces(run, pair)):
            axes.add_collection3d(Line3DCollection([trace], colors=style.BLACK, linewidths=1.2, zorder=3))
            if index > 0:
                continue
            pieces, lonely = active_segments(trace, pair.active)
            if pieces:
                axes.add_collection3d(Line3DCollection(pieces, colors=style.ACTIVE, linewidths=4.0, zorder=4,
                                                       capstyle="round"))
            if len(lonely):
                axes.scatter(*lonely.T, color=style.ACTIVE, s=14, depthshade=False, zorder=4)
            closed = closed or bool(pair.active.any())
    return closed


def frame(axes, corners):
    """Limits, proportions and labels."""
    low, high = corners.reshape(-1, 3).min(axis=0), corners.reshape(-1, 3).max(axis=0)
    extent = numpy.maximum(high - low, 1e-12 * max(1.0, float(numpy.abs(corners).max())))
    for bounds, start, end in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), low, low + extent):
        bounds(start, end)
    plane = extent[:2] / extent[:2].max()
    axes.set_box_aspect((*(1.7 * numpy.maximum(plane, 0.25)), 0.8), zoom=1.0)
    axes.set_xlabel("x [length]", labelpad=14)
    axes.set_ylabel("y [length]", labelpad=8)
    axes.set_zlabel("u [length]", labelpad=9)
    for axis, length in zip("xy", plane):
        axes.locator_params(axis=axis, nbins=3 if length < 0.45 else 5 if length < 0.8 else 8)
    axes.locator_params(axis="z", nbins=5)
    axes.view_init(elev=24, azim=-62)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.pane.set_facecolor("#FAFAFA")
        axis.pane.set_edgecolor("#CCCCCC")


def figure(run):
    corners = numpy.concatenate([facets(body) for body in run.bodies])
    heights = corners[:, :, 2].mean(axis=1)
    norm = matplotlib.colors.Normalize(corners[:, :, 2].min(), corners[:, :, 2].max())
    colours = matplotlib.cm.viridis(norm(heights))
    picture = pyplot.figure(figsize=(9.5, 6.2))
    axes = picture.add_subplot(projection="3d", computed_zorder=False)
    axes.add_collection3d(Poly3DCollection(corners, facecolors=colours, edgecolors=(0, 0, 0, 0.22), linewidths=0.25,
                                           zorder=1))
    closed = draw_contacts(axes, run)
    frame(axes, corners)
    bar = picture.colorbar(matplotlib.cm.ScalarMappable(norm, "viridis"), ax=axes, shrink=0.62, pad=0.13, aspect=22)
    bar.set_label("deflection u [length]")
    bar.outline.set_visible(False)
    names = ", ".join(body.name for body in run.bodies[:4]) + (", …" if len(run.bodies) > 4 else "")
    axes.set_title(f"Deflection of {names} — {run.title}", pad=0, y=0.98)
    handles = [Line2D([], [], color=style.BLACK, linewidth=1.2, label="contact line")] if run.lines() else []
    if closed:
        handles.append(Line2D([], [], color=style.ACTIVE, linewidth=4, label="contact closed"))
    if handles:
        axes.legend(handles=handles, loc="lower center", bbox_to_anchor=(0.5, -0.04), ncol=2)
    return picture
