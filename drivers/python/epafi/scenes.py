"""Scenes from Python."""

import os
import pathlib
import sys
from collections.abc import Callable, Mapping
from typing import Any

from . import _epafi, parameters
from .progress import shown
from .result import NotConverged, Result


def to_xml(scene: Mapping[str, Any]) -> str:
    """The scene as the text of a file for the program `epafi`."""
    return parameters.xml(scene, parameters.SCHEMA, "Epafi")


def world() -> Any:
    """mpi4py's communicator of all ranks; None where there is no mpi4py."""
    return sys.modules["mpi4py.MPI"].COMM_WORLD if "mpi4py.MPI" in sys.modules else None


def address(comm: Any) -> int:
    """Of the MPI handle of mpi4py's communicator, for C++; 0 for None."""
    return 0 if comm is None else sys.modules["mpi4py.MPI"]._addressof(comm)


def given(scene: str | os.PathLike | Mapping[str, Any], set: Mapping[str, Any] | None) -> tuple[str, str, list[str]]:
    """Its text, empty where it is in a file; the file's name; and what is changed, as the program's --set has it."""
    texts = [f"{path}={parameters._spelled(value, None)[1]}" for path, value in (set or {}).items()]
    return (to_xml(scene), "scene", texts) if isinstance(scene, Mapping) else ("", os.fspath(scene), texts)


def solve(scene: str | os.PathLike | Mapping[str, Any], accuracy: float | str | None = None, *,
          set: Mapping[str, Any] | None = None, comm: Any = None, progress: bool | Callable | None = None,
          check: bool = True) -> Result:
    """Solves a scene. Collective over `comm`.

    scene     a scene file (.xml), an input deck (.inp), a dictionary laid out as a scene file is, or `epafi.Scene`; meshes
              lie relative to the file, of dictionaries to the current directory. Lengths, forces and moduli are in one
              system of units of yours, results in the same.
    accuracy  the relative error in the energy norm to refine to: 0.02 or "2 %"; None: on the scene's own mesh
    set       parameters by their paths, in place of the scene's: {"Solver/Tolerance": 1e-10}
    comm      mpi4py's communicator, None: that of all ranks; without mpirun that is one
    progress  True, False, None: on a terminal or in a notebook; or what is called as
              progress(what, iteration, projected_gradient, products) a few times a second
    check     whether to raise NotConverged, which has the result, where less was reached than asked; else ask
              `result.converged`

    Raises InputError, SolvabilityError, NotConverged or Error with one sentence on all ranks; an interrupt (Ctrl-C) ends
    the iteration on all of them. Other threads of Python go on meanwhile.
    """
    comm = world() if comm is None else comm
    assignments = dict(set or {})
    if accuracy is not None:
        if accuracy in (0, "0", "0%", "0 %"):
            raise _epafi.InputError(f"accuracy is {accuracy!r}, but no mesh is without error; ask for 0.01 say")
        assignments["Accuracy/Target"] = accuracy
    text, file, texts = given(scene, assignments)
    with shown(progress, comm) as tell:
        run = _epafi.solve_scene(text, file, texts, address(comm), tell)
    result = Result(run, pathlib.Path(file).stem, comm)
    if check and not result.converged:
        raise NotConverged(result)
    return result
