"""Contact pressure on a surface, and what of it sticks: of a body in space, or of a membrane over an obstacle."""

import matplotlib.pyplot as pyplot
import numpy
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.tri import Triangulation

from . import cells, style

MARGIN = 0.35  # of the closed part's size is shown around it


def heaviest(pair):
    """The normal of the closed part, by pressure, else that of all nodes; not of length 1."""
    weights = numpy.where(pair.active, numpy.maximum(pair.pressure, 0.0), 0.0)
    return weights @ pair.normal if weights.any() else pair.normal.sum(axis=0)


class Flat:
    """As seen along the normal of what is closed; facets that face away are left out."""

    def __init__(self, pair):
        normal = heaviest(pair)
        length = numpy.linalg.norm(normal)
        normal = normal / length if length > 1e-6 else numpy.array([0.0, 0.0, 1.0])
        across = int(numpy.argmax(numpy.abs(normal)))
        kept = [d for d in range(3) if d != across]
        self.labels = [f"{'xyz'[d]} [length]" for d in kept]
        self.axes = numpy.eye(3)[kept]
        if abs(normal[across]) <= 0.999:
            first = numpy.eye(3)[kept[0]] - normal[kept[0]] * normal
            first /= numpy.linalg.norm(first)
            self.axes = numpy.array([first, numpy.cross(normal, first)])
            self.labels = ["along the surface [length]", "across [length]"]
        self.faces = pair.normal @ normal > 0

    def place(self, points):
        return points @ self.axes.T

    def shown(self, cells, place):
        """Of this side; of the other one, whose normals are not known, all."""
        whole = self.faces[cells].all(axis=1) if len(place) == len(self.faces) else numpy.ones(len(cells), bool)
        return cells[whole] if whole.any() else cells


class Unrolled:
    """A cylinder, cut open opposite of what is closed."""

    def __init__(self, pair, axis):
        middle = heaviest(pair)
        middle = middle - middle @ axis * axis
        if numpy.linalg.norm(middle) < 1e-6 * len(pair.normal):
            middle = pair.normal[0] - pair.normal[0] @ axis * axis
        first = middle / numpy.linalg.norm(middle)
        self.axes = numpy.array([first, numpy.cross(axis, first), axis])
        points, normals = pair.points @ self.axes[:2].T, pair.normal @ self.axes[:2].T
        # Where all normals meet: p - r n = c.
        ones, zeros = numpy.ones(len(points)), numpy.zeros(len(points))
        rows = numpy.concatenate([numpy.column_stack([ones, zeros, normals[:, 0]]),
                                  numpy.column_stack([zeros, ones, normals[:, 1]])])
        *self.centre, self.radius = numpy.linalg.lstsq(rows, points.T.reshape(-1), rcond=None)[0]
        self.labels = ["around [length]", "along the axis [length]"]

    def place(self, points):
        turned = points @ self.axes.T
        x, y = (turned[:, :2] - self.centre).T / self.radius
        return numpy.column_stack([abs(self.radius) * numpy.arctan2(y, x), turned[:, 2]])

    def shown(self, cells, place):
        """But those that the cut goes through."""
        return cells[numpy.ptp(place[cells][:, :, 0], axis=1) < numpy.pi * abs(self.radius)]


def view(pair):
    """Unrolled where normals turn about one axis, by more than 60 degrees to either side."""
    sizes, directions = numpy.linalg.eigh(pair.normal.T @ pair.normal / len(pair.normal))
    turns = numpy.linalg.norm(pair.normal.mean(axis=0)) < 0.8
    return Unrolled(pair, directions[:, 0]) if turns and sizes[0] < 1e-3 else Flat(pair)


def window(place, active):
    """Limits that show the closed part with a margin; everything if nothing is closed."""
    low, high = place.min(axis=0), place.max(axis=0)
    if active.any():
        inner = place[active]
        margin = MARGIN * max(float(numpy.ptp(inner, axis=0).max()), 0.1 * float((high - low).max()))
        low, high = numpy.maximum(low, inner.min(axis=0) - margin), numpy.minimum(high, inner.max(axis=0) + margin)
    edge = 0.015 * float((high - low).max())
    return low - edge, high + edge


def draw_points(axes, place, pair, _seen):
    """Where no facet of the surface is whole: the nodes alone."""
    return axes.scatter(*place.T, c=pair.pressure, cmap="YlOrRd", vmin=0, s=60, edgecolors=style.BLACK, linewidths=0.5)


def fan(place, facets, *values):
    """Quadrilaterals cut into four triangles about their middles, which favours no diagonal; the values there are means."""
    if facets.shape[1] == 3:
        return (Triangulation(*place.T, facets), *values)
    middle = len(place) + numpy.arange(len(facets))
    triangles = numpy.concatenate([numpy.column_stack([facets[:, k], facets[:, (k + 1) % 4], middle]) for k in range(4)])
    every = numpy.concatenate([place, place[facets].mean(axis=1)])
    return (Triangulation(*every.T, triangles), *(numpy.concatenate([value, value[facets].mean(axis=1)]) for value in values))


def sticking(pair):
    """Where friction holds, or nothing without."""
    return pair.friction_state == 2 if pair.friction_state is not None else numpy.zeros(len(pair.points), bool)


def draw_facets(axes, place, pair, seen):
    shown_cells = seen.shown(pair.cells, place)
    triangulation, shades, closed, sticks = fan(place, shown_cells, numpy.maximum(pair.pressure, 0.0), pair.active.astype(float),
                                                sticking(pair).astype(float))
    largest = float(pair.pressure.max())
    shown = axes.tripcolor(triangulation, shades, shading="gouraud",
                           cmap="YlOrRd", vmin=0, vmax=largest if largest > 0 else 1.0, rasterized=True)
    ends, meeting = cells.edges(shown_cells)
    axes.add_collection(LineCollection(place[ends], colors=[(0, 0, 0, 0.18 if len(ends) < 6000 else 0.05)], linewidths=0.3))
    axes.add_collection(LineCollection(place[ends[meeting[:, 1] < 0]], colors=style.BLACK, linewidths=1.0))
    if pair.facing is not None:
        points, facets = pair.facing
        others = seen.place(points)
        ends, _ = cells.edges(seen.shown(facets, others))
        axes.add_collection(LineCollection(others[ends], colors=style.GREEN, linewidths=0.4, alpha=0.7))
    if pair.active.any() and not pair.active.all():
        axes.tricontour(triangulation, closed, levels=[0.5], colors=[style.BLUE], linewidths=1.8)
    if sticking(pair).any() and not sticking(pair).all():
        axes.tricontour(triangulation, sticks, levels=[0.5], colors=[style.BLACK], linewidths=1.8, linestyles="--")
    return shown


def figure(run, pair):
    seen = view(pair)
    place = seen.place(pair.points)
    low, high = window(place, pair.active)
    ratio = float((high - low)[1] / (high - low)[0])
    picture, axes = pyplot.subplots(figsize=(8.4, float(numpy.clip(6.6 * ratio + 1.4, 3.4, 8.2))))
    axes.grid(False)
    draw = draw_facets if pair.is_surface() else draw_points
    shown = draw(axes, place, pair, seen)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")
    axes.set_xlabel(seen.labels[0])
    axes.set_ylabel(seen.labels[1])
    bar = picture.colorbar(shown, ax=axes, shrink=0.85, pad=0.03, aspect=26)
    bar.set_label("contact pressure [force per area]")
    bar.outline.set_visible(False)
    axes.set_title(f"{run.title}: contact {pair.name}\n{int(pair.active.sum())} of {len(pair.points)} nodes closed, "
                   f"force {pair.multiplier.sum():.4g}, largest pressure {pair.pressure.max():.4g}", fontsize=12)
    handles = []
    if draw is draw_facets and pair.active.any() and not pair.active.all():
        handles.append(Line2D([], [], color=style.BLUE, linewidth=1.8, label="boundary of the active set"))
    if draw is draw_facets and sticking(pair).any() and not sticking(pair).all():
        handles.append(Line2D([], [], color=style.BLACK, linewidth=1.8, linestyle="--", label="boundary of what sticks"))
    if draw is draw_facets and pair.facing is not None:
        handles.append(Line2D([], [], color=style.GREEN, linewidth=0.8, label="mesh of the other side"))
    if pair.friction_state is not None:
        axes.set_title(axes.get_title() + f"\n{int(sticking(pair).sum())} nodes stick, {int((pair.friction_state == 1).sum())} slip",
                       fontsize=12)
    if handles:
        axes.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, 0), bbox_transform=style.below(picture, axes),
                    ncols=len(handles))
    return picture
