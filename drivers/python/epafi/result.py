"""What a solve has come to: numpy's arrays, and the report in plain numbers."""

import dataclasses
import html
import os
import pathlib
import tempfile
from typing import Any

import numpy

from ._epafi import Error

MESHIO = {"triangle": "triangle", "quadrilateral": "quad", "tetrahedron": "tetra", "hexahedron": "hexahedron",
          "quadratic triangle": "triangle6", "quadratic quadrilateral": "quad9", "quadratic tetrahedron": "tetra10",
          "quadratic hexahedron": "hexahedron27", "serendipity quadrilateral": "quad8",
          "serendipity hexahedron": "hexahedron20"}


class NotConverged(Error):
    """Less was reached than asked; `result` is what was."""

    def __init__(self, result: Any):
        super().__init__(result.reason)
        self.result = result


class Fields:
    """Arrays with names."""

    def __repr__(self) -> str:
        own = ", ".join(f"{key} {getattr(value, 'shape', value)}" for key, value in vars(self).items() if value is not None)
        return f"{type(self).__name__}({own})"


@dataclasses.dataclass(eq=False, repr=False)
class BodyFields(Fields):
    """A body of n nodes and m cells; on several ranks this rank's share of both, in order.

    Lengths and forces in the scene's units; nodes appear once, cells name them from 0 in VTK's order.
    """

    physics: str
    cell_type: str
    points: numpy.ndarray  #: n x 3
    u: numpy.ndarray  #: n x components: displacement, of membranes deflection
    cells: numpy.ndarray  #: m x nodes of a cell
    subdomain: numpy.ndarray  #: m, numbered over all bodies
    von_mises: numpy.ndarray | None  #: n: stress at nodes; None of membranes
    error: numpy.ndarray | None  #: m: estimated error in the energy norm; None if not estimated


@dataclasses.dataclass(eq=False, repr=False)
class ContactFields(Fields):
    """A contact of n nodes of the first body's surface and m facets between them; on several ranks this rank's share."""

    cell_type: str
    points: numpy.ndarray  #: n x 3
    normal: numpy.ndarray  #: n x 3, of length 1, towards the other side; of membranes along z
    cells: numpy.ndarray  #: m x nodes of a facet
    area: numpy.ndarray  #: n: share of the surface
    initial_gap: numpy.ndarray  #: n: distance before loading
    gap: numpy.ndarray  #: n: what remains open
    multiplier: numpy.ndarray  #: n: force of each row, >= 0
    force: numpy.ndarray  #: n: force on each node
    pressure: numpy.ndarray  #: n: mean pressure around each node
    active: numpy.ndarray  #: n, bool: closed
    traction: numpy.ndarray | None = None  #: n x 3: friction's, on the second side
    slip: numpy.ndarray | None = None  #: n x 3: of the first side on the second
    friction_state: numpy.ndarray | None = None  #: n: 0 open, 1 slips, 2 sticks


@dataclasses.dataclass(eq=False, repr=False)
class TieFields(Fields):
    """A tied joint of n nodes."""

    points: numpy.ndarray  #: n x 3
    traction: numpy.ndarray  #: n x 3: force per area on the other side


@dataclasses.dataclass(eq=False, repr=False)
class Stage:
    """A solution: bodies, contacts and ties by their names, and its report."""

    name: str  #: of the load step
    bodies: dict[str, BodyFields]
    contacts: dict[str, ContactFields]
    ties: dict[str, TieFields]
    report: dict[str, Any]


def _stage(fields: dict[str, Any]) -> Stage:
    kinds: dict[str, Any] = {"bodies": BodyFields, "contacts": ContactFields, "ties": TieFields}
    parts: dict[str, Any] = {key: {name: kinds[key](**own) for name, own in value.items()} if key in kinds else value
                             for key, value in fields.items()}
    return Stage(**parts)


class Result:
    """A solved scene.

    bodies, contacts, ties  fields by name (BodyFields, ContactFields, TieFields), of the last load step
    steps                   the same of every load step (Stage), by name; empty where the scene has none
    report                  every number of `report.xml`, as nested dictionaries
    history                 numbers of every step of the iteration, an array each
    """

    def __init__(self, run: Any, name: str, comm: Any = None):
        self._run, self.name, self.comm = run, name, comm
        stages = [_stage(fields) for fields in run.take_stages()]
        self.bodies, self.contacts, self.ties = stages[-1].bodies, stages[-1].contacts, stages[-1].ties
        self.steps: dict[str, Stage] = {stage.name: stage for stage in stages if stage.name}
        self.report: dict[str, Any] = run.report
        self.history: dict[str, numpy.ndarray] = run.history()
        self.converged: bool = run.converged
        self.status: str = run.status
        self.reason: str = run.reason
        self.summary: str = run.summary

    @property
    def energy(self) -> float:
        """½uᵀKu − fᵀu."""
        return self.report["Accuracy"]["Energy"]

    @property
    def error(self) -> float | None:
        """The estimated error relative to the solution, in the energy norm; None if it was not estimated."""
        return self.report["Accuracy"].get("Relative Error")

    def __str__(self) -> str:
        return self.summary

    def __repr__(self) -> str:
        return f"<epafi.Result {self.name!r}: {self.status}, energy {self.energy:.9g}>"

    def _repr_html_(self) -> str:
        rows = [("status", f"{self.status}: {self.reason}"), ("energy", f"{self.energy:.9g}")]
        if self.error is not None:
            rows.append(("estimated error", f"{100 * self.error:.2g} % of the energy norm"))
        for name, contact in self.report.get("Contact", {}).items():
            rows.append((f"contact {name}", f"force {contact['Force']:.6g}, {contact['Active Nodes']} of "
                                            f"{contact['Candidates']} nodes closed"))
        cells = "".join(f"<tr><th>{html.escape(label)}</th><td>{html.escape(text)}</td></tr>" for label, text in rows)
        return f"<table>{cells}</table>"

    def write(self, directory: str | os.PathLike) -> pathlib.Path:
        """Writes NAME.h5, NAME.xdmf (for ParaView), report.xml and history.csv, of the last load step; returns the first.

        Collective.
        """
        return pathlib.Path(self._run.write(os.fspath(directory), self.name))

    def plot(self, what: str = "shape") -> Any:
        """matplotlib's figure: "shape", "decomposition", "mesh", "convergence", or a contact's name; "3-D" is PyVista's Plotter of
        this rank's arrays, to turn by hand (`.show()`) or to save (`.screenshot(file)`).

        Collective; returns None on other ranks than the first, but for "3-D". Needs h5py, on several ranks mpi4py.
        """
        if what == "3-D":
            return self._plotter()
        from .plot import contact, convergence, mesh, plane, pressure, space, subdomains, surface
        from .plot.run import read_run
        with tempfile.TemporaryDirectory(prefix="epafi-") as own:
            directory = own if self.comm is None else self.comm.bcast(own)
            file = self.write(directory)
            run = read_run(file) if self.comm is None or self.comm.Get_rank() == 0 else None
            if self.comm is not None:
                self.comm.Barrier()
        if run is None:
            return None
        in_space = not run.is_plane()
        if what == "shape":
            return (space if in_space else plane).figure(run) if run.is_elastic() else surface.figure(run)
        if what == "decomposition":
            return space.decomposition(run) if in_space else subdomains.figure(run)
        if what == "mesh":
            return mesh.figure(run)
        if what == "convergence":
            return convergence.figure(run.history, run.title)
        for pair in run.contacts:
            if pair.name == what:
                return pressure.figure(run, pair) if in_space else contact.figure(run, pair)
        there = ", ".join(["shape", "decomposition", "mesh", "convergence", "3-D", *self.contacts])
        raise ValueError(f"there is no picture {what!r}; there are {there}")

    def _plotter(self) -> Any:
        """Bodies as they are displaced, enlarged such that a tenth of their size is the most, coloured by von Mises's stress or the
        deflection."""
        import pyvista
        mesh = pyvista.from_meshio(self.to_meshio())
        if "u" in mesh.point_data:
            mesh["displacement"] = numpy.outer(mesh["u"], [0, 0, 1])
        largest = numpy.linalg.norm(mesh["displacement"], axis=1).max()
        factor = mesh.length / 10 / largest if largest > 0 else 0
        plotter = pyvista.Plotter()
        plotter.add_mesh(mesh.warp_by_vector("displacement", factor=factor), scalars="u" if "u" in mesh.point_data else "von_mises",
                         show_edges=True)
        return plotter

    def to_meshio(self) -> Any:
        """meshio's Mesh of all bodies of this rank's arrays, with `displacement` (or `u`), `von_mises` and `body`."""
        import meshio
        start, points, cells, body = 0, [], [], []
        data: dict[str, Any] = {}
        for number, own in enumerate(self.bodies.values()):
            points.append(own.points)
            cells.append((MESHIO[own.cell_type], own.cells + start))
            body.append(numpy.full(len(own.cells), number))
            start += len(own.points)
            field = {"u": own.u[:, 0]} if own.u.shape[1] == 1 else {
                "displacement": numpy.pad(own.u, ((0, 0), (0, 3 - own.u.shape[1])))}
            if own.von_mises is not None:
                field["von_mises"] = own.von_mises
            for key, values in field.items():
                data.setdefault(key, []).append(values)
        return meshio.Mesh(numpy.concatenate(points), cells, cell_data={"body": body},
                           point_data={key: numpy.concatenate(values) for key, values in data.items()})
