"""By how much displacements are drawn larger than they are, and where the bodies then lie."""

import numpy

from . import cells

VISIBLE = 0.02  # displacements of this share of the bodies' size are seen as they are
WANTED = 0.05  # share that smaller ones are enlarged to
OVERLAP = 0.001  # share of the size by which enlargement may let closed contacts cross


def scale(run):
    """1, 2 or 5 times a power of ten; 1 where displacements are visible as they are, or nothing moves."""
    size = run.size()
    largest = max(float(numpy.linalg.norm(body.u, axis=1).max()) for body in run.bodies)
    if largest >= VISIBLE * size or largest == 0:
        return 1.0
    wanted = WANTED * size / largest
    for pair in run.contacts:  # enlarged, a body goes as much too far as the gap that it closes
        if pair.initial_gap is not None and pair.active.any():
            closed = float(pair.initial_gap[pair.active].max())
            wanted = min(wanted, 1 + OVERLAP * size / closed) if closed > 0 else wanted
    power = 10.0 ** numpy.floor(numpy.log10(max(wanted, 1.0)))
    return float(max(step * power for step in (1, 2, 5) if step * power <= max(wanted, 1.0)))


def text(factor):
    return "displacements as they are" if factor == 1 else f"displacements {factor:,.0f} times enlarged".replace(",", " ")


def deformed(body, factor):
    return body.points + factor * body.displacement()


def contact_points(run, pair, factor):
    """Where the contact's nodes lie after the deformation of the first body; None if that body is not found."""
    for body in run.bodies:
        if body.group == pair.first_body:
            place = cells.places(body.points, pair.points)
            if (place >= 0).all():
                return deformed(body, factor)[place]
    return None


def names(run):
    return ", ".join(body.name for body in run.bodies[:4]) + (", …" if len(run.bodies) > 4 else "")


def stress_range(run):
    """0 and the largest von Mises stress, for the colours."""
    largest = max(float(body.von_mises.max()) for body in run.bodies)
    return 0.0, largest if largest > 0 else 1.0
