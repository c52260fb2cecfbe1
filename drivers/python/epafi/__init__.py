"""Epafi from Python: contact problems by FETI-DP and quadratic programming.

    import epafi
    result = epafi.solve("xml/punch.xml", accuracy=0.02)
    print(result)
    result.bodies["block"].u          # numpy, n x components

MPI starts with the import, by mpi4py where that is installed; one process needs no mpirun.
"""

import importlib
from typing import TYPE_CHECKING, Any

from . import _epafi

if TYPE_CHECKING:
    from . import contest, peers, problems  # noqa: F401

_epafi.prepare()
try:
    import mpi4py.MPI  # noqa: F401  starts MPI and ends it
except ImportError:
    pass
_epafi.begin()

from ._epafi import Error, InputError, SolvabilityError  # noqa: E402
from .matrices import Joint, Problem, Solution  # noqa: E402
from .parameters import (Accuracy, Body, Decomposition, Equation, Load, Obstacle, Pair, Region, Scene, Solver,  # noqa: E402
                         Step, Support)
from .qp import QpResult, solve_qp  # noqa: E402
from .result import BodyFields, ContactFields, NotConverged, Result, Stage, TieFields  # noqa: E402
from .scenes import solve, to_xml  # noqa: E402

__version__ = _epafi.version


def __getattr__(name: str) -> Any:
    """epafi.problems, .peers and .contest, which need SciPy, when they are asked for."""
    if name in ("contest", "peers", "problems"):
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module 'epafi' has no attribute '{name}'")


for _error in (Error, InputError, SolvabilityError):
    _error.__module__ = "epafi"
Error.__doc__ = "What Epafi says of anything that went wrong: one sentence."
InputError.__doc__ = "The input is wrong: where, the value found, and what is allowed."
SolvabilityError.__doc__ = "The problem has no solution, or more than one: which body, and why."

__all__ = ["Accuracy", "Body", "BodyFields", "ContactFields", "Decomposition", "Equation", "Error", "InputError", "Joint", "Load",
           "NotConverged", "Obstacle", "Pair", "Problem", "QpResult", "Region", "Result", "Scene", "Solution",
           "SolvabilityError", "Solver", "Stage", "Step", "Support", "TieFields", "solve", "solve_qp", "to_xml"]
