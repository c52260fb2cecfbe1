"""Hertz's contact of two bodies with the curvatures and stiffnesses of cylinders or spheres, and what a run has found in its place.

Lengths, forces and pressures in the units of the scene. Of two elastic bodies 1 / E* = (1 - nu_1^2) / E_1 + (1 - nu_2^2) / E_2, and
1 / R = 1 / R_1 + 1 / R_2, with the radius of a hollow negative: `together`. A rigid flat or round body takes no part in the first."""

import dataclasses
import math

import h5py
import numpy


@dataclasses.dataclass
class Contact:
    radius: float  # of the contact; of a cylinder the half-width
    pressure: float  # in its middle


def stiffness(young, poisson):
    """E* of one elastic body"""
    return young / (1 - poisson**2)


def together(values):
    """Of two stiffnesses E* or radii."""
    return 1 / sum(1 / value for value in values)


def cylinder(load, radius, e_star):
    """`load`: force by length along the cylinder. a = sqrt(4 P R / (pi E*)), p0 = 2 P / (pi a)."""
    a = math.sqrt(4 * load * radius / (math.pi * e_star))
    return Contact(a, 2 * load / (math.pi * a))


def sphere(force, radius, e_star):
    """a = (3 F R / (4 E*))^(1/3), p0 = 3 F / (2 pi a^2)."""
    a = (3 * force * radius / (4 * e_star)) ** (1 / 3)
    return Contact(a, 3 * force / (2 * math.pi * a**2))


@dataclasses.dataclass
class Found:
    """Of the part that is modelled: one half of a cylinder's contact, from x = 0 on, or one quarter of a sphere's."""
    force: float
    radius: float  # from the pressure's second moment
    radius_by_area: float  # from the area of the closed nodes
    pressure: float  # largest one at a node
    variation: float  # of the pressure beside Hertz's, see below: 1 without wiggles
    mesh_size: float  # mean length of the surface's edges
    nodes: int
    closed: int


# Of facets by their nodes, in space or not: all pairs that follow each other on their edges.
CORNERS = {(False, 2): 2, (False, 3): 2, (True, 3): 3, (True, 4): 4, (True, 6): 3, (True, 9): 4}


def neighbours(in_space, cells):
    """Pairs of nodes along the facets' edges."""
    corners = CORNERS[in_space, cells.shape[1]]
    pairs = []
    for edge in range(corners if in_space else 1):
        ends = cells[:, edge], cells[:, (edge + 1) % corners]
        if cells.shape[1] == corners:
            pairs.append(ends)
        else:
            pairs += [(ends[0], cells[:, corners + edge]), (cells[:, corners + edge], ends[1])]
    return [numpy.concatenate(side) for side in zip(*pairs)]


def variation(values, pairs):
    """Sum of the differences along the edges."""
    return float(numpy.abs(values[pairs[0]] - values[pairs[1]]).sum())


def measure(in_space, points, force, area, pressure, active, cells):
    """Hertz's p = p0 sqrt(1 - r^2 / a^2) has the mean of r^2, weighted by p, a^2 / 4 in the plane and 2 a^2 / 5 in space: all
    nodes count there, not only the rim's. `area` and `force` of a node, by thickness in the plane. The variation is measured
    against Hertz's pressure of that radius and the same largest value."""
    r2 = (points[:, :2 if in_space else 1]**2).sum(axis=1)
    moment = float((r2 * force).sum() / force.sum())
    closed_area = float(area[active].sum())
    corners = CORNERS[in_space, cells.shape[1]]
    ends = numpy.concatenate([cells[:, [k, (k + 1) % corners]] for k in range(corners if in_space else 1)])
    radius = math.sqrt(moment * (5 / 2 if in_space else 4))
    pairs, exact = neighbours(in_space, cells), pressure.max() * numpy.sqrt(numpy.maximum(0, 1 - r2 / radius**2))
    return Found(force=float(force.sum()),
                 radius=radius,
                 radius_by_area=math.sqrt(4 * closed_area / math.pi) if in_space else closed_area,
                 pressure=float(pressure.max()),
                 variation=variation(pressure, pairs) / variation(exact, pairs),
                 mesh_size=float(numpy.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).mean()),
                 nodes=len(points), closed=int(active.sum()))


def read(file, in_space, thickness=1.0):
    """What the run in `file` has found; its only contact counts. \\raises OSError, KeyError if it holds no such thing"""
    with h5py.File(file, "r") as run:
        group = next(iter(run["contact"].values()))
        values = {name: group[name][:] for name in ("points", "force", "area", "pressure", "active", "cells")}
    return measure(in_space, values["points"], values["force"] / thickness, values["area"] / thickness,
                   values["pressure"], values["active"] > 0, values["cells"])
