"""Elastic bodies in space: deformed surface, coloured by von Mises stress; subdomains, moved apart."""

import matplotlib
import matplotlib.pyplot as pyplot
import numpy
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from . import cells, deformation, render, style, subdomains

PIXELS = 1800  # of the longer side, about twice the dots of the picture: edges come out smooth
MOST_MESH_FACETS = 5000  # seen at once; above, the lines of the mesh would hide the colours
SHARP = numpy.cos(numpy.radians(32.0))  # edges between facets that turn by more are drawn
APART = 0.22  # share of their distance from the middle by which subdomains are moved


class Surface:
    """Polygons in space with a colour for each of their corners."""

    def __init__(self, points, polygons, colours):
        self.points, self.polygons, self.colours = points, polygons, colours
        self.normals = render.normals(points[polygons]) if len(polygons) else numpy.zeros((0, 3))

    def lines(self, view, with_mesh):
        """Sharp edges and outlines, and the other edges of the mesh if wished: two lists of n x 2 x 3."""
        ends, meeting = cells.edges(self.polygons)
        seen = self.normals @ view.eye > 0
        first, second = meeting[:, 0], meeting[:, 1]
        either = seen[first] | (seen[second] & (second >= 0))
        turn = (self.normals[first] * self.normals[second]).sum(axis=1)
        sharp = (second < 0) | (turn < SHARP) | (seen[first] != seen[second])
        places = self.points[ends]
        return places[either & sharp], places[either & ~sharp] if with_mesh else places[:0]


def coloured(body, points, norm):
    polygons = cells.outer_facets(body.cell_type, body.cells)[0]
    return Surface(points, polygons, style.STRESS(norm(body.von_mises))[polygons][:, :, :3])


def paint(axes, surfaces, view):
    """Draws surfaces with hidden parts removed; returns the picture, for lines on it."""
    projected = [view.project(surface.points) for surface in surfaces]
    every = numpy.concatenate([place[surface.polygons.ravel()] for place, surface in zip(projected, surfaces)])
    low, high = every[:, :2].min(axis=0), every[:, :2].max(axis=0)
    edge = 0.01 * (high - low).max()
    picture = render.Picture(low - edge, high + edge, PIXELS)
    for place, surface in zip(projected, surfaces):
        facing = numpy.flatnonzero(surface.normals @ view.eye > 0)
        polygons, owner, which = cells.triangles(surface.polygons[facing])
        owner = facing[owner]
        light = render.shade(surface.normals[owner])[:, None, None]
        picture.draw(place[polygons], surface.colours[owner[:, None], which] * light)
    axes.imshow(picture.pixels(), extent=picture.extent(), origin="lower", interpolation="antialiased", zorder=1)
    count = sum(int((surface.normals @ view.eye > 0).sum()) for surface in surfaces)
    tolerance = 0.004 * (high - low).max()
    for surface in surfaces:
        sharp, mesh = surface.lines(view, count <= MOST_MESH_FACETS)
        for lines, colour, width in ((mesh, (0, 0, 0, 0.20), 0.3), (sharp, (0, 0, 0, 0.85), 0.8)):
            seen = picture.visible(view.project(lines), tolerance)
            axes.add_collection(LineCollection(seen, colors=[colour], linewidths=width, zorder=2, capstyle="round"))
    axes.set_aspect("equal")
    axes.set_axis_off()
    return picture


def triad(axes, pixels, view, points):
    """Directions of the coordinates below the picture's left corner, and how large the bodies are; returns where a legend
    goes, below both."""
    left, right, bottom, top = pixels.extent()
    unit = 0.06 * max(right - left, top - bottom)
    origin = numpy.array([left + unit, bottom - 1.2 * unit])
    for name, direction in zip("xyz", unit * view.axes.T[:, :2]):
        axes.annotate("", origin + direction, origin, annotation_clip=False,
                      arrowprops=dict(arrowstyle="-|>", color=style.BLACK, lw=1.1, shrinkA=0, shrinkB=0, mutation_scale=9))
        axes.text(*(origin + 1.3 * direction), name, ha="center", va="center", fontsize=10)
    low, high = points.min(axis=0), points.max(axis=0)
    noise = 1e-9 * (high - low).max()
    low, high = (numpy.where(numpy.abs(ends) < noise, 0.0, ends) for ends in (low, high))
    sizes = ", ".join(f"{name} {a:.4g} … {b:.4g}" for name, a, b in zip("xyz", low, high))
    axes.text(origin[0] + 1.9 * unit, origin[1], f"{sizes} [length]", fontsize=10, color="#444444", va="center")
    return origin + unit * numpy.array([1.6, -0.3])


def draw_closed(axes, picture, run, view, factor):
    """The rim of the closed part of each contact, as far as it is seen; returns whether any is."""
    drawn = False
    for pair in run.contacts:
        points = deformation.contact_points(run, pair, factor)
        if points is None or pair.cells is None or pair.cells.shape[1] < 3:
            continue
        closed = pair.cells[pair.active[pair.cells].all(axis=1)]
        if not len(closed):
            continue
        ends, meeting = cells.edges(closed)
        rim = view.project(points[ends[meeting[:, 1] < 0]])
        seen = picture.visible(rim, 0.010 * run.size())
        axes.add_collection(LineCollection(seen, colors=style.ACTIVE, linewidths=2.2, zorder=3, capstyle="round"))
        drawn = drawn or len(seen) > 0
    return drawn


def figure(run):
    view, factor = render.View(), deformation.scale(run)
    norm = matplotlib.colors.Normalize(*deformation.stress_range(run))
    surfaces = [coloured(body, deformation.deformed(body, factor), norm) for body in run.bodies]
    picture, axes = pyplot.subplots(figsize=(9.2, 6.8))
    pixels = paint(axes, surfaces, view)
    closed = draw_closed(axes, pixels, run, view, factor)
    below = triad(axes, pixels, view, numpy.concatenate([body.points for body in run.bodies]))
    bar = picture.colorbar(matplotlib.cm.ScalarMappable(norm, style.STRESS), ax=axes, shrink=0.72, pad=0.02, aspect=24)
    bar.set_label("von Mises stress [force per area]")
    bar.outline.set_visible(False)
    axes.set_title(f"{deformation.names(run)}: {deformation.text(factor)} — {run.title}", pad=10)
    if closed:
        axes.legend(handles=[Line2D([], [], color=style.ACTIVE, linewidth=2.2, label="rim of the closed contact")],
                    loc="upper left", bbox_to_anchor=below, bbox_transform=axes.transData)
    return picture


def parts(run, colour):
    """The surface of each body's subdomains, moved away from the middle of all bodies."""
    palette = numpy.array([matplotlib.colors.to_rgb(shade) for shade in style.AREAS])
    middle = numpy.mean([body.points.mean(axis=0) for body in run.bodies], axis=0)
    surfaces = []
    for body in run.bodies:
        polygons, cell = cells.outer_facets(body.cell_type, body.cells, body.subdomain)
        owner = body.subdomain[cell]
        numbers, where = numpy.unique(body.subdomain, return_inverse=True)
        weight = numpy.bincount(where)
        centres = body.points[body.cells].mean(axis=1)
        centre = numpy.column_stack([numpy.bincount(where, centres[:, d]) / weight for d in range(3)])
        for k, number in enumerate(numbers):
            own = polygons[owner == number]
            nodes, local = numpy.unique(own, return_inverse=True)
            points = body.points[nodes] + APART * (centre[k] - middle)
            shades = numpy.broadcast_to(palette[colour[int(number)]], (*own.shape, 3))
            surfaces.append(Surface(points, local.reshape(own.shape), shades))
    return surfaces


def decomposition(run):
    view, colour = render.View(), subdomains.colouring(run)
    picture, axes = pyplot.subplots(figsize=(8.2, 6.8))
    pixels = paint(axes, parts(run, colour), view)
    triad(axes, pixels, view, numpy.concatenate([body.points for body in run.bodies]))
    crosspoints = sum(len(body.crosspoints) for body in run.bodies)
    count = len(colour)
    axes.set_title(f"{count} subdomain{'s' if count != 1 else ''}, moved apart; {crosspoints} crosspoints — {run.title}", pad=10)
    return picture
