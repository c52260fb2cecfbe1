"""Reads the HDF5 file of a run (its layout: src/output/FieldWriter.hpp)."""

import dataclasses

import h5py
import numpy

from .cells import chain, is_plane, linear
from .errors import PlotError


@dataclasses.dataclass
class Body:
    name: str
    points: numpy.ndarray  # n x 3
    cells: numpy.ndarray  # n_e x 4
    u: numpy.ndarray  # n x components
    subdomain: numpy.ndarray  # n_e
    crosspoints: numpy.ndarray  # m x 3
    cell_type: str = "quadrilateral"
    von_mises: numpy.ndarray = None  # n, of elastic bodies
    group: str = ""
    error: numpy.ndarray = None  # n_e: estimated, of the element that a cell is a part of
    element: numpy.ndarray = None  # n_e: which one that is

    def displacement(self):
        """n x 3; of elastic bodies."""
        return numpy.column_stack([self.u, numpy.zeros((len(self.u), 3 - self.u.shape[1]))])

    def deflection(self):
        """What is drawn upwards: u itself for membranes, its length for vector fields."""
        return self.u[:, 0] if self.u.shape[1] == 1 else numpy.linalg.norm(self.u, axis=1)

    def grid_shape(self):
        """(rows, columns) if nodes and cells lie row by row on a rectangular grid, else None."""
        y = self.points[:, 1]
        columns = int(numpy.argmax(y != y[0])) if numpy.any(y != y[0]) else 0
        if columns < 2 or len(y) % columns != 0 or len(self.cells) != (columns - 1) * (len(y) // columns - 1):
            return None
        lattice = self.points.reshape(-1, columns, 3)
        size = numpy.ptp(self.points, axis=0).max()
        same_x = numpy.allclose(lattice[:, :, 0], lattice[0, :, 0], atol=1e-9 * size)
        same_y = numpy.allclose(lattice[:, :, 1].T, lattice[:, 0, 1], atol=1e-9 * size)
        first = numpy.arange(len(y)).reshape(-1, columns)[:-1, :-1].ravel()
        return lattice.shape[:2] if same_x and same_y and numpy.array_equal(self.cells[:, 0], first) else None


@dataclasses.dataclass
class Contact:
    name: str
    group: str
    points: numpy.ndarray
    gap: numpy.ndarray
    multiplier: numpy.ndarray
    active: numpy.ndarray  # bool
    initial_gap: numpy.ndarray  # or None
    pressure: numpy.ndarray = None
    normal: numpy.ndarray = None  # n x 3
    cells: numpy.ndarray = None  # m x 1, 2, 3 or 4, rows
    first_body: str = ""  # name of its group
    facing: tuple = None  # points and facets of the other surface, if it is meshed apart
    traction: numpy.ndarray = None  # n x 3, of friction on the second side
    friction_state: numpy.ndarray = None  # 0 open, 1 slips, 2 sticks

    def is_surface(self):
        """Of a body in space, or of a membrane over an obstacle."""
        return self.cells is not None and self.cells.shape[1] > 2

    def curves(self):
        """Rows in their order along the contact line, in the plane; several lists if the line has gaps."""
        if self.cells is not None and self.cells.shape[1] == 2:
            return chain(self.cells, len(self.points))
        return [numpy.arange(len(self.points))]

    def along(self, curve):
        """The contact of the nodes `curve` alone."""
        def chosen(values):
            return None if values is None else values[curve]
        return dataclasses.replace(self, points=self.points[curve], gap=self.gap[curve], multiplier=self.multiplier[curve],
                                   active=self.active[curve], initial_gap=chosen(self.initial_gap),
                                   pressure=chosen(self.pressure), normal=chosen(self.normal), cells=None,
                                   traction=chosen(self.traction), friction_state=chosen(self.friction_state))

    def shear(self):
        """Component of the traction along the line in its order."""
        if len(self.points) < 2:
            return numpy.linalg.norm(self.traction, axis=1)
        way = numpy.gradient(self.points, axis=0)
        return (self.traction * way).sum(axis=1) / numpy.linalg.norm(way, axis=1)

    def arclength(self):
        steps = numpy.linalg.norm(numpy.diff(self.points, axis=0), axis=1)
        return numpy.concatenate([[0.0], numpy.cumsum(steps)])


@dataclasses.dataclass
class History:
    outer: numpy.ndarray
    step: numpy.ndarray  # letters s, c, e, p
    projected_gradient: numpy.ndarray
    constraint_residual: numpy.ndarray
    hessian_multiplications: numpy.ndarray


@dataclasses.dataclass
class Run:
    title: str
    stem: str  # what names of pictures begin with
    bodies: list
    contacts: list
    history: History  # or None

    def is_elastic(self):
        return all(body.von_mises is not None for body in self.bodies)

    def lines(self):
        """Contacts along lines."""
        return [pair for pair in self.contacts if not pair.is_surface()]

    def is_plane(self):
        return all(is_plane(body.cell_type) for body in self.bodies)

    def size(self):
        """Extent of all bodies together."""
        points = numpy.concatenate([body.points for body in self.bodies])
        return numpy.ptp(points, axis=0).max()


def read_run(file, step=None):
    """The run as it is at the end of a load step, which its name or number says; without one as it is at its end."""
    try:
        with h5py.File(file, "r") as whole:
            content, suffix = (whole, "") if step is None else of_step(file, whole, step)
            bodies = [read_body(name, group) for name, group in content["bodies"].items()]
            contacts = [read_contact(name, group) for name, group in content.get("contact", {}).items()]
            run = Run(file.stem if step is None else f"{file.stem},\nstep {title('', content)}", file.stem + suffix, bodies,
                      contacts, read_history(content.get("history")))
    except (OSError, KeyError, ValueError, TypeError, AttributeError) as error:
        reason = str(error).strip("'\"")
        raise PlotError(f"'{file}' cannot be read as the HDF5 file of an Epafi run: {reason}.") from error
    if not run.bodies or any(len(body.cells) == 0 for body in run.bodies):
        raise PlotError(f"'{file}' holds a body without cells, or no body; there is nothing to draw.")
    return run


def of_step(file, content, step):
    """The group of a load step, which is laid out as the file is, and what tells its pictures from those of other steps."""
    groups = sorted(content.get("steps", {}).values(), key=lambda group: group.attrs["number"])
    names, numbers = [title("", group) for group in groups], [str(group.attrs["number"]) for group in groups]
    for labels in (names, numbers):
        if step in labels:
            group = groups[labels.index(step)]
            return group, "_" + group.name.split("/")[-1]
    there = ", ".join(f"{number} '{name}'" for number, name in zip(numbers, names))
    raise PlotError(f"'{file}' has no load step '{step}'; " + (f"its steps are {there}." if there else "it has no load steps."))


def read_body(name, group):
    points, cells, u = group["points"][:], group["cells"][:], group["u"][:]
    subdomain = group["subdomain"][:]
    if len(u) != len(points) or len(subdomain) != len(cells) or (cells.size and cells.max() >= len(points)):
        raise ValueError(f"the datasets of body {name} do not fit each other")
    crosspoints = group["crosspoints"][:] if "crosspoints" in group else numpy.zeros((0, 3))
    cell_type = text(group.attrs.get("cell_type", "quadrilateral"))
    corners = {"triangle": 3, "quadrilateral": 4, "tetrahedron": 4, "hexahedron": 8, "quadratic triangle": 6,
               "quadratic quadrilateral": 9, "quadratic tetrahedron": 10, "quadratic hexahedron": 27,
               "serendipity quadrilateral": 8, "serendipity hexahedron": 20, "prism": 6, "pyramid": 5, "quadratic prism": 15,
               "quadratic pyramid": 13}
    if cells.ndim != 2 or cells.shape[1] != corners[cell_type]:
        raise ValueError(f"the cells of body {name} are no {cell_type}s")
    von_mises = group["von_mises"][:] if "von_mises" in group else None
    if von_mises is not None and len(von_mises) != len(points):
        raise ValueError(f"the datasets of body {name} do not fit each other")
    error = group["error"][:] if "error" in group else None
    if error is not None and len(error) != len(cells):
        raise ValueError(f"the datasets of body {name} do not fit each other")
    cell_type, cells, whole = linear(cell_type, cells)
    return Body(title(name, group), points, cells, u.reshape(len(points), -1), subdomain[whole], crosspoints, cell_type,
                von_mises, name, None if error is None else error[whole], whole)


def read_contact(name, group):
    initial = group["initial_gap"][:] if "initial_gap" in group else None
    later = {key: group[key][:] if key in group else None for key in ("pressure", "normal", "cells", "traction", "friction_state")}
    if later["cells"] is not None:
        later["cells"] = linear(text(group.attrs.get("cell_type", "")), later["cells"])[1]
    return Contact(title(name, group), name, group["points"][:], group["gap"][:], group["multiplier"][:],
                   group["active"][:] > 0.5, initial, **later, first_body=text(group.attrs.get("first_body", "")),
                   facing=(group["facing/points"][:], group["facing/cells"][:]) if "facing" in group else None)


def read_history(group):
    if group is None:
        return None
    letters = numpy.array([chr(code) for code in group["step"][:]], dtype="U1")
    return History(group["outer"][:], letters, group["projected_gradient"][:], group["constraint_residual"][:],
                   group["hessian_multiplications"][:])


def title(name, group):
    return text(group.attrs.get("name", name))


def text(given):
    return given.decode() if isinstance(given, bytes) else str(given)
