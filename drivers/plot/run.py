"""Reads the HDF5 file of a run (its layout: src/output/FieldWriter.hpp)."""

import dataclasses

import h5py
import numpy

from .errors import PlotError


@dataclasses.dataclass
class Body:
    name: str
    points: numpy.ndarray  # n x 3
    cells: numpy.ndarray  # n_e x 4
    u: numpy.ndarray  # n x components
    subdomain: numpy.ndarray  # n_e
    crosspoints: numpy.ndarray  # m x 3

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
    bodies: list
    contacts: list
    history: History  # or None

    def size(self):
        """Extent of all bodies together."""
        points = numpy.concatenate([body.points for body in self.bodies])
        return numpy.ptp(points, axis=0).max()


def read_run(file):
    try:
        with h5py.File(file, "r") as content:
            bodies = [read_body(name, group) for name, group in content["bodies"].items()]
            contacts = [read_contact(name, group) for name, group in content.get("contact", {}).items()]
            run = Run(file.stem, bodies, contacts, read_history(content.get("history")))
    except (OSError, KeyError, ValueError, TypeError, AttributeError) as error:
        reason = str(error).strip("'\"")
        raise PlotError(f"'{file}' cannot be read as the HDF5 file of an Epafi run: {reason}.") from error
    if not run.bodies or any(len(body.cells) == 0 for body in run.bodies):
        raise PlotError(f"'{file}' holds a body without cells, or no body; there is nothing to draw.")
    return run


def read_body(name, group):
    points, cells, u = group["points"][:], group["cells"][:], group["u"][:]
    subdomain = group["subdomain"][:]
    if len(u) != len(points) or len(subdomain) != len(cells) or (cells.size and cells.max() >= len(points)):
        raise ValueError(f"the datasets of body {name} do not fit each other")
    crosspoints = group["crosspoints"][:] if "crosspoints" in group else numpy.zeros((0, 3))
    return Body(title(name, group), points, cells, u.reshape(len(points), -1), subdomain, crosspoints)


def read_contact(name, group):
    initial = group["initial_gap"][:] if "initial_gap" in group else None
    return Contact(title(name, group), name, group["points"][:], group["gap"][:], group["multiplier"][:],
                   group["active"][:] > 0.5, initial)


def read_history(group):
    if group is None:
        return None
    letters = numpy.array([chr(code) for code in group["step"][:]], dtype="U1")
    return History(group["outer"][:], letters, group["projected_gradient"][:], group["constraint_residual"][:],
                   group["hessian_multiplications"][:])


def title(name, group):
    given = group.attrs.get("name", name)
    return given.decode() if isinstance(given, bytes) else str(given)
