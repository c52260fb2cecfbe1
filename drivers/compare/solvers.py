"""Starts the solvers of the membranes, each as a process of its own, and reads what they measured.

A run is a dictionary: unknowns, total_seconds, assembly_seconds, iterations, energy, peak_bytes (of the whole process), and
where they are known apart, setup_seconds and linear_iterations. What is counted:

  epafi     assembly, setup, solve and recovery of u; iterations are products with F
  snesvi_*  from the making of the SNES to its solution, assembly left out; iterations are Newton steps
  linear_*  factorisation or multigrid setup, and the solve, assembly left out; the contact zone is given
"""

import json
import os
import pathlib
import subprocess
import tempfile
import xml.etree.ElementTree

from reference import ROOT

# What peers and table.py ask of a family of problems, with programs, Case and run below: this one, or block_solvers.py.
TITLE = "membranes, 1/h"
MORTARS = ()  # solvers that take bodies meshed apart
LARGEST_RANKS = 1
LARGEST_ORDER = 1
DEFAULT_SIZE = 512
SIZES = "a multiple of 4 within 8 ... 4096"
NOTE = ("Times: epafi from assembly to u; its peers without their assembly, and linear_* is one linear solve with the contact "
        "zone given.")
NAMES = ("epafi", "snesvi_cholmod", "snesvi_hypre", "linear_cholmod", "linear_muelu")
COMPARE = pathlib.Path(__file__).resolve().parent
ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "OMP_THREAD_LIMIT": "1",
               "PYTHONDONTWRITEBYTECODE": "1"}
EXIT_WRONG_INPUT, EXIT_MISSING = 2, 3


def is_size(size):
    return 8 <= size <= 4096 and size % 4 == 0


class UsageError(Exception):
    """One sentence: what is wrong with the call, and what to do."""


class Trouble(Exception):
    """Why there are no numbers of a solver; status is failed or missing."""

    def __init__(self, status, reason):
        super().__init__(reason)
        self.status = status


class Case:
    """What is solved, and how."""

    def __init__(self, options, programs, known, _):
        self.problem, self.size, self.tolerance = options.problem, options.size, options.tolerance
        self.epafi_options, self.time_limit = options.epafi_options, options.time_limit
        self.programs = programs
        self.closed_nodes = known.closed_nodes if known else None

    def learn(self, name, run):
        """Where no reference says how large the contact zone is, Epafi does."""
        if name == "epafi" and self.closed_nodes is None:
            self.closed_nodes = run["closed_nodes"]

    def unknowns(self):
        """Free nodes of the undecomposed meshes."""
        return (self.size + 1) * (2 * self.size + (self.problem == "semicoercive"))


def programs(names):
    """What has to be built for these solvers."""
    return {"epafi" if name == "epafi" else "epafi-linear" for name in names if not name.startswith("snesvi")}


def find_programs(options, script):
    """The folder of epafi and what is built for its peers."""
    places = [options.programs] if options.programs else [script.absolute().parent.parent, ROOT / "build/release/drivers"]
    needed = options.family.programs(options.solvers)
    for place in places:
        if all(os.access(place / program, os.X_OK) and (place / program).is_file() for program in needed):
            return place.absolute()
    raise UsageError(f"{' and '.join(sorted(needed))} not found in {' or '.join(map(str, places))}; "
                     "call ./setup studies first, or name the folder by --programs")


def start(command, case, further=None):
    """The finished process; `further`: more of its environment."""
    with subprocess.Popen([str(word) for word in command], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, env={**os.environ, **ENVIRONMENT, **(further or {})}) as process:
        try:
            output, errors = process.communicate(timeout=case.time_limit)
        except subprocess.TimeoutExpired:
            process.terminate()  # mpirun ends its ranks then; it could not if it were killed
            process.communicate()
            raise Trouble("failed", f"took longer than {case.time_limit:g} s") from None
    return subprocess.CompletedProcess(command, process.returncode, output, errors)


def why(process):
    """The last line of a process that failed."""
    lines = [line.strip() for line in (process.stderr or process.stdout).splitlines() if line.strip()]
    code = f"signal {-process.returncode}" if process.returncode < 0 else f"exit code {process.returncode}"
    return f"{lines[-1]} ({code})" if lines else code


def run_epafi(case):
    grid = max(2, case.size // 16)
    changes = [f"Bodies/left/Elements={{{case.size},{case.size}}}", f"Bodies/right/Elements={{{case.size},{case.size}}}",
               f"Decomposition/Grid={{{grid},{grid}}}", f"Solver/Tolerance={case.tolerance:g}",
               f"Solver/Equilibrium Tolerance={case.tolerance:g}", *case.epafi_options]
    with tempfile.TemporaryDirectory() as place:
        report = pathlib.Path(place) / "report.xml"
        process = start([case.programs / "epafi", ROOT / "xml" / f"{case.problem}.xml", "--quiet", "--report", report,
                         *(f"--set={change}" for change in changes)], case)
        return {"unknowns": case.unknowns(), **reported(process, report)}


def reported(process, report):
    """The run of an epafi that has finished. \\raises UsageError, Trouble"""
    if process.returncode == EXIT_WRONG_INPUT:
        raise UsageError(process.stderr.strip())
    values = read_report(report) if report.exists() else {}
    if process.returncode != 0:
        raise Trouble("failed", values.get(("Status", "Reason")) or why(process))
    times = {part: float(values["Time", part]) for part in ("Assembly", "Setup", "Solve", "Recovery")}
    return {"total_seconds": sum(times.values()), "assembly_seconds": times["Assembly"],
            "setup_seconds": times["Setup"], "iterations": int(values["Iterations", "Hessian Multiplications"]),
            "energy": float(values["Accuracy", "Energy"]), "peak_bytes": int(float(values["Memory", "Peak Bytes"])),
            "closed_nodes": int(values["Accuracy", "Active Contact Nodes"])}


def read_report(file):
    """{(list, parameter): value as text}."""
    root = xml.etree.ElementTree.parse(file).getroot()
    return {(part.get("name"), entry.get("name")): entry.get("value")
            for part in root.findall("ParameterList") for entry in part.findall("Parameter")}


def run_snesvi(solver, case):
    return measured_snesvi(start([COMPARE / "snesvi.py", solver, "--size", case.size, "--problem", case.problem,
                                  "--tolerance", case.tolerance], case))


def measured_snesvi(process):
    """The run that a script of PETSc's printed. \\raises Trouble"""
    if process.returncode == EXIT_MISSING:
        package = process.stderr.split()[0]
        raise Trouble("missing", f"install the package {package}, or all of the peers by ./setup packages peers")
    return measured(process)


def run_linear(solver, case):
    if case.closed_nodes is None:
        raise Trouble("failed", f"the contact zone at 1/h = {case.size} is not known; let epafi run with it")
    return measured(start([case.programs / "epafi-linear", solver, "--size", case.size, "--closed", case.closed_nodes,
                           "--problem", case.problem], case))


def measured(process):
    """The run that a peer printed as its last line."""
    if process.returncode != 0:
        raise Trouble("failed", why(process))
    try:
        values = json.loads(process.stdout.splitlines()[-1])
        values["total_seconds"] = values.get("setup_seconds", 0.0) + values["solve_seconds"]
    except (IndexError, ValueError, KeyError, TypeError):
        raise Trouble("failed", "printed no measurements") from None
    return values


def run(name, case):
    """\\raises Trouble, UsageError"""
    if name == "epafi":
        return run_epafi(case)
    family, solver = name.split("_")
    return {"snesvi": run_snesvi, "linear": run_linear}[family](solver, case)
