"""A part of a run: what lies in a box."""

import dataclasses

import numpy

from . import cells
from .errors import PlotError

BEYOND = 0.1  # of the box's size: cells in the plane that are kept around it, so that their rim is not seen


def of(run, box):
    """The bodies' cells in `box`, {x0, x1, y0, y1} with or without {z0, z1}, and the contacts' nodes on them. In space these
    are the cells whose middles it holds; in the plane the picture ends at the box, and cells reach beyond it.

    \\raises PlotError if no cell is in the box."""
    low, high = numpy.array(box[::2]), numpy.array(box[1::2])
    if run.is_plane():
        low, high = low[:2], high[:2]
        edge = BEYOND * (high - low).max()
        low, high = low - edge, high + edge
    bodies = [body for body in (part_of_body(body, low, high) for body in run.bodies) if body is not None]
    if not bodies:
        points = numpy.concatenate([body.points for body in run.bodies])
        extent = ", ".join(f"{name} {a:.4g} … {b:.4g}" for name, a, b in
                           zip("xyz", points.min(axis=0)[:len(low)], points.max(axis=0)[:len(low)]))
        raise PlotError(f"no cell of '{run.title}' lies in the box {', '.join(f'{x:g}' for x in box)}; "
                        f"the bodies fill {extent}.")
    return dataclasses.replace(run, bodies=bodies, contacts=[part_of_contact(pair, bodies) for pair in run.contacts])


def part_of_body(body, low, high):
    """None if nothing of the body is in the box."""
    middles = body.points[body.cells].mean(axis=1)[:, :len(low)]
    kept = ((middles >= low) & (middles <= high)).all(axis=1)
    if not kept.any():
        return None
    nodes, local = numpy.unique(body.cells[kept], return_inverse=True)
    return dataclasses.replace(body, points=body.points[nodes], cells=local.reshape(body.cells[kept].shape), u=body.u[nodes],
                               subdomain=body.subdomain[kept],
                               error=None if body.error is None else body.error[kept], element=body.element[kept],
                               von_mises=None if body.von_mises is None else body.von_mises[nodes])


def part_of_contact(pair, bodies):
    on_body = numpy.zeros(len(pair.points), bool)
    for body in bodies:
        if body.group == pair.first_body:
            on_body = cells.places(body.points, pair.points) >= 0
    part = pair.along(numpy.flatnonzero(on_body))
    if pair.cells is not None:
        number = numpy.cumsum(on_body) - 1
        part.cells = number[pair.cells[on_body[pair.cells].all(axis=1)]]
    return part
