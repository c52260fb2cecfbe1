"""Hertz's contact of a rigid cylinder or sphere with an elastic half-space, and what a run has found in its place.

Lengths, forces and pressures in the units of the scene. E* = E / (1 - nu^2), because the obstacle is rigid."""

import dataclasses
import math

import h5py
import numpy


@dataclasses.dataclass
class Contact:
    radius: float  # of the contact; of a cylinder the half-width
    pressure: float  # in its middle


def stiffness(young, poisson):
    """E*"""
    return young / (1 - poisson**2)


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
    mesh_size: float  # mean length of the surface's edges
    nodes: int
    closed: int


def measure(in_space, points, force, area, pressure, active, cells):
    """Hertz's p = p0 sqrt(1 - r^2 / a^2) has the mean of r^2, weighted by p, a^2 / 4 in the plane and 2 a^2 / 5 in space: all
    nodes count there, not only the rim's. `area` and `force` of a node, by thickness in the plane."""
    r2 = (points[:, :2 if in_space else 1]**2).sum(axis=1)
    moment = float((r2 * force).sum() / force.sum())
    closed_area = float(area[active].sum())
    corners = {6: 3, 9: 4}.get(cells.shape[1], cells.shape[1]) if in_space else 2  # of order 2 they come first
    ends = numpy.concatenate([cells[:, [k, (k + 1) % corners]] for k in range(corners if in_space else 1)])
    return Found(force=float(force.sum()),
                 radius=math.sqrt(moment * (5 / 2 if in_space else 4)),
                 radius_by_area=math.sqrt(4 * closed_area / math.pi) if in_space else closed_area,
                 pressure=float(pressure.max()),
                 mesh_size=float(numpy.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).mean()),
                 nodes=len(points), closed=int(active.sum()))


def read(file, in_space, thickness=1.0):
    """What the run in `file` has found; its only contact counts. \\raises OSError, KeyError if it holds no such thing"""
    with h5py.File(file, "r") as run:
        group = next(iter(run["contact"].values()))
        values = {name: group[name][:] for name in ("points", "force", "area", "pressure", "active", "cells")}
    return measure(in_space, values["points"], values["force"] / thickness, values["area"] / thickness,
                   values["pressure"], values["active"] > 0, values["cells"])
