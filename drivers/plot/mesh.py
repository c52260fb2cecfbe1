"""The mesh, every element coloured by its estimated error: where it is fine, and where the error sits."""

import dataclasses

import matplotlib
import matplotlib.pyplot as pyplot
import numpy
from matplotlib.collections import LineCollection, PolyCollection

from . import render, space, style, subdomains
from .cells import outer_facets

MOST_ELEMENTS = 60000  # whose lines can be told apart


def can_draw(run):
    return all(body.error is not None for body in run.bodies) and norm_of(run) is not None


def norm_of(run):
    """Four decades below the largest; none if no element has an error."""
    largest = max(body.error.max() for body in run.bodies)
    return matplotlib.colors.LogNorm(1e-4 * largest, largest) if largest > 0 else None


def draw_plane(axes, run, norm):
    for body in run.bodies:
        axes.add_collection(PolyCollection(body.points[body.cells][:, :, :2], array=numpy.maximum(body.error, norm.vmin), norm=norm,
                                           cmap=style.STRESS, edgecolors="face", linewidths=0.2, zorder=1))
        inner, outer = subdomains.borders(dataclasses.replace(body, subdomain=body.element))
        if len(body.cells) <= MOST_ELEMENTS:
            axes.add_collection(LineCollection(inner, colors="black", linewidths=0.25, zorder=2))
        axes.add_collection(LineCollection(outer, colors="black", linewidths=0.8, zorder=2))
    axes.autoscale()
    axes.set_aspect("equal")
    axes.set_xlabel("x [length]")
    axes.set_ylabel("y [length]")


def draw_space(axes, run, norm):
    surfaces = []
    for body in run.bodies:
        polygons, cell = outer_facets(body.cell_type, body.cells)
        shades = style.STRESS(norm(numpy.maximum(body.error, norm.vmin)))[cell][:, :3]
        surfaces.append(space.Surface(body.points, polygons, numpy.repeat(shades[:, None, :], polygons.shape[1], axis=1)))
    view = render.View()
    space.triad(axes, space.paint(axes, surfaces, view), view, numpy.concatenate([body.points for body in run.bodies]))


def figure(run):
    norm = norm_of(run)
    picture, axes = pyplot.subplots(figsize=(9.2, 6.8))
    (draw_plane if run.is_plane() else draw_space)(axes, run, norm)
    bar = picture.colorbar(matplotlib.cm.ScalarMappable(norm, style.STRESS), ax=axes, shrink=0.72, pad=0.02, aspect=24)
    bar.set_label("estimated error of an element\nin the energy norm")
    bar.outline.set_visible(False)
    elements = sum(len(numpy.unique(body.element)) for body in run.bodies)
    axes.set_title(f"{elements} elements and their errors — {run.title}", pad=10)
    return picture
