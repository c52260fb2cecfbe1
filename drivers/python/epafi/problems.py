"""An open set of contact problems in matrices, for any solver: `load("coercive")`, or all in files by
`python3 -m epafi.problems FOLDER`.
"""

import argparse
import dataclasses
import json
import os
import pathlib
import sys
from collections.abc import Mapping
from typing import Any

import numpy
import scipy.io
import scipy.sparse

from . import _epafi
from .scenes import given

SCENES = pathlib.Path(__file__).parent / "xml"
MATRICES = ("stiffness", "constraint", "tangent")


@dataclasses.dataclass(eq=False)
class ContactProblem:
    """min u'Ku/2 - f'u subject to Bu <= c (Bu = c from row `contacts` on) and lower <= u <= upper.

    With friction a node's tangential force t has |t| <= friction_bound + friction times its multiplier, and where its slip
    Tu - s is not 0, it is that large and along the slip. Ku + B'lambda + T't + nu = f, nu of the bounds.
    """

    name: str
    title: str
    units: str
    stiffness: scipy.sparse.csr_matrix  #: K, n x n, both triangles
    load: numpy.ndarray  #: f, n
    constraint: scipy.sparse.csr_matrix  #: B, m x n
    gap: numpy.ndarray  #: c, m
    contacts: int  #: rows with <=, with multipliers >= 0
    lower: numpy.ndarray  #: n
    upper: numpy.ndarray  #: n
    tangent: scipy.sparse.csr_matrix  #: T: rows of a node with friction follow each other, components - 1 of them
    tangent_gap: numpy.ndarray  #: s
    friction_row: numpy.ndarray  #: of each node with friction its row of B
    friction: numpy.ndarray  #: of each its coefficient (Coulomb)
    friction_bound: numpy.ndarray  #: of each a force (Tresca)
    components: int  #: unknowns a node
    bodies: list[str]
    body: numpy.ndarray  #: n: place in `bodies`
    node: numpy.ndarray  #: n: number in the body
    coordinates: numpy.ndarray  #: n x 3: of the unknown's node
    direction: numpy.ndarray  #: n x 3: in which the unknown displaces it; of membranes (1, 0, 0)
    verdict: str  #: "one solution", "many solutions" (of one energy) or "no solution"
    energy: float | None  #: u'Ku/2 - f'u of the solution
    found: str  #: how the energy is known

    @property
    def is_bounded(self) -> bool:
        return bool(numpy.isfinite(self.lower).any() or numpy.isfinite(self.upper).any())

    def __repr__(self) -> str:
        return (f"{self.name}: {self.title}; {len(self.load)} unknowns, {self.contacts} rows of contact, "
                f"{len(self.gap) - self.contacts} equations, {len(self.friction_row)} nodes with friction; {self.verdict}")


def of_scene(scene: str | os.PathLike | Mapping[str, Any], *, set: Mapping[str, Any] | None = None, name: str = "scene",
             title: str = "", units: str = "the scene's", verdict: str = "one solution", energy: float | None = None,
             found: str = "") -> ContactProblem:
    """A scene's problem undecomposed, without its load steps. On this rank alone."""
    parts = _epafi.system_of(*given(scene, set))
    parts.pop("energy_offset")
    for matrix in MATRICES:
        indptr, indices, data, shape = parts[matrix]
        parts[matrix] = scipy.sparse.csr_matrix((data, indices, indptr), shape=shape)
    size = len(parts["load"])
    return ContactProblem(name=name, title=title, units=units, lower=numpy.full(size, -numpy.inf), coordinates=parts.pop("place"),
                          upper=numpy.full(size, numpy.inf), verdict=verdict, energy=energy, found=found, **parts)


def of_grid(stiffness: Any, load: Any, lower: Any, upper: Any, coordinates: Any, **facts: Any) -> ContactProblem:
    """A problem with bounds alone, one unknown a node."""
    size, none = len(load), numpy.zeros(0)
    places = numpy.zeros((size, 3))
    places[:, :coordinates.shape[1]] = coordinates
    empty, numbers = scipy.sparse.csr_matrix((0, size)), numpy.zeros(0, dtype=numpy.int32)
    return ContactProblem(
        stiffness=scipy.sparse.csr_matrix(stiffness), load=load, constraint=empty, gap=none, contacts=0,
        lower=numpy.broadcast_to(lower, size).astype(float), upper=numpy.broadcast_to(upper, size).astype(float),
        tangent=empty, tangent_gap=none, friction_row=numbers, friction=none, friction_bound=none, components=1, bodies=["grid"],
        body=numpy.zeros(size, dtype=numpy.int32), node=numpy.arange(size, dtype=numpy.int32), coordinates=places,
        direction=numpy.tile([1.0, 0, 0], (size, 1)), **facts)


def names() -> list[str]:
    from .problem_list import PROBLEMS
    return list(PROBLEMS)


def load(name: str | os.PathLike) -> ContactProblem:
    """A problem of the set by its name, or of a file NAME.h5 that `write` has made."""
    from .problem_list import PROBLEMS
    if str(name).endswith(".h5"):
        return _read(name)
    if name not in PROBLEMS:
        raise _epafi.InputError(f"there is no problem '{name}'; there are {', '.join(PROBLEMS)}")
    make, facts = PROBLEMS[name]
    return make(name=name, **facts)


def write(problem: ContactProblem, folder: str | os.PathLike) -> None:
    """NAME.h5, in which a matrix is a group of indptr, indices and data, and the same as NAME.K.mtx, NAME.B.mtx, NAME.T.mtx (Matrix
    Market) with all the rest in NAME.json."""
    import h5py
    base, page = pathlib.Path(folder) / problem.name, {}
    base.parent.mkdir(parents=True, exist_ok=True)
    with h5py.File(f"{base}.h5", "w") as file:
        for key, value in vars(problem).items():
            if key in MATRICES:
                group = file.create_group(key)
                group.attrs["shape"] = value.shape
                for part in ("indptr", "indices", "data"):
                    group[part] = getattr(value, part)
                scipy.io.mmwrite(f"{base}.{'KBT'[MATRICES.index(key)]}.mtx", value, precision=17)
                continue
            page[key] = value.tolist() if isinstance(value, numpy.ndarray) else value
            if isinstance(value, numpy.ndarray):
                file[key] = value
            else:
                file.attrs[key] = numpy.nan if value is None else value
    for bound in ("lower", "upper"):  # JSON has no infinities
        page[bound] = [entry if numpy.isfinite(entry) else None for entry in page[bound]]
    pathlib.Path(f"{base}.json").write_text(json.dumps(page) + "\n", encoding="utf-8")


def _read(file: str | os.PathLike) -> ContactProblem:
    import h5py
    with h5py.File(file) as store:
        parts: dict[str, Any] = {key: value[()] for key, value in store.items() if key not in MATRICES}
        for key in MATRICES:
            group = store[key]
            parts[key] = scipy.sparse.csr_matrix(tuple(group[part][()] for part in ("data", "indices", "indptr")),
                                                 shape=tuple(group.attrs["shape"]))
        parts.update({key: value.item() if isinstance(value, numpy.generic) else value for key, value in store.attrs.items()})
    parts["bodies"] = [str(body) for body in parts["bodies"]]
    parts["energy"] = None if numpy.isnan(parts["energy"]) else parts["energy"]
    return ContactProblem(**parts)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m epafi.problems", description="Writes problems as HDF5 and Matrix Market.")
    parser.add_argument("folder")
    parser.add_argument("names", nargs="*", default=names(), metavar="NAME", help=f"of {', '.join(names())} (default: all)")
    options = parser.parse_args(arguments)
    try:
        for name in options.names:
            problem = load(name)
            write(problem, options.folder)
            print(problem)
    except _epafi.InputError as error:
        print(f"epafi.problems: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
