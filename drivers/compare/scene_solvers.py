"""Epafi and its peers on scenes of xml/ that hold contact of elastic bodies and no tied joints: each run a process (or one a rank)
of its own. A run is a dictionary as in solvers.py. What is counted, meshing and assembly left out of all:

  epafi            setup, start from a coarser mesh, solve, recovery of u and error estimate; iterations are products with F,
                   unknowns those of all subdomains
  active_sets_*    active sets with exact linear solves, started on coarser meshes, which count; iterations are linear solves
  snesvi_*         from the making of the SNES to its solution, begun with all contact closed; iterations are Newton steps
  linear_*         one linear solve with the contact zone given, as active sets have found it
"""

import pathlib
import tempfile
import xml.etree.ElementTree

import solvers
from block_solvers import EPAFI_TOLERANCE, LARGEST_RANKS, launcher
from solvers import Trouble

TITLE = "elements of the scene's size over"
MORTARS = ()
LARGEST_ORDER = 2
DEFAULT_SIZE = 1
SIZES = "within 1 ... 8"
NOTE = ("Times without meshing and assembly, Epafi's cutting into subdomains among them; linear_* is one linear solve with the "
        "contact zone given.")
LINEAR = ("cholmod", "gamg")
NAMES = ("epafi", *(f"active_sets_{name}" for name in LINEAR), "snesvi_cholmod", *(f"linear_{name}" for name in LINEAR))
SCENES = ("bracket", "hertz_sphere", "lug", "stacked_blocks", "three_cubes", "wheel_on_rail")
COARSER = (2, 4)  # times the size of elements, of order 1


def is_size(size):
    return 1 <= size <= 8


def programs(names):
    """What has to be built for these solvers."""
    return {"epafi" if name == "epafi" else "epafi-export" for name in names}


def bodies_of(scene):
    """(name, {parameter: value as text}) of each."""
    root = xml.etree.ElementTree.parse(scene).getroot()
    for body in root.find("ParameterList[@name='Bodies']").findall("ParameterList"):
        yield body.get("name"), {entry.get("name"): entry.get("value") for entry in body.findall("Parameter")}


class Case:
    """What is solved, and how."""

    def __init__(self, options, folder_of_programs, _, folder):
        self.size, self.order, self.ranks, self.time_limit = options.size, options.order, options.ranks, options.time_limit
        self.tolerance, self.epafi_options, self.programs = options.tolerance, options.epafi_options, folder_of_programs
        self.scene, self.folder = solvers.ROOT / "xml" / f"{options.problem}.xml", pathlib.Path(folder)
        self.zone = self.folder / "zone.npy"

    def learn(self, name, run):
        """The zone is in its file."""

    def settings(self, coarser=1, order=None):
        """--set options of a mesh whose elements are so many times larger than asked for."""
        for name, parameters in bodies_of(self.scene):
            place = f"--set=Bodies/{name}"
            yield f"{place}/Order={order or self.order}"
            if "Elements" in parameters:
                counts = (int(count) for count in parameters["Elements"].strip("{}").split(","))
                yield f"{place}/Elements={{{','.join(str(max(1, round(n * self.size / coarser))) for n in counts)}}}"
            else:
                yield f"{place}/Mesh Size Factor={float(parameters.get('Mesh Size Factor', 1)) * coarser / self.size:g}"

    def exported(self):
        """Files of the systems, the finest first: of order 1 on the same mesh, too, and on coarser ones. \\raises Trouble"""
        meshes = [(1, self.order), *([(1, 1)] if self.order > 1 else []), *((factor, 1) for factor in COARSER)]
        files = [self.folder / f"system_{factor}_{order}.petsc" for factor, order in meshes]
        for file, (factor, order) in zip(files, meshes):
            if not file.exists():
                process = solvers.start([self.programs / "epafi-export", self.scene, file, *self.settings(factor, order)], self)
                if process.returncode != 0:
                    raise Trouble("failed", solvers.why(process))
        return files


def run_epafi(case):
    changes = [*(f"Solver/{name}Tolerance={EPAFI_TOLERANCE * case.tolerance:g}" for name in ("", "Equilibrium ")),
               *case.epafi_options]
    with tempfile.TemporaryDirectory() as place:
        report = pathlib.Path(place) / "report.xml"
        process = solvers.start([*launcher(case.ranks), case.programs / "epafi", case.scene, "--quiet", "--report", report,
                                 *case.settings(), *(f"--set={change}" for change in changes)], case)
        run, values = solvers.reported(process, report), solvers.read_report(report)
    counted = ("Setup", "Start", "Solve", "Recovery", "Error Estimate")
    return {**run, "unknowns": int(values["Problem", "Primal Dimension"]),
            "total_seconds": sum(float(values.get(("Time", part), 0)) for part in counted)}


def run_peer(family, solver, case):
    files = case.exported()
    ranks = 1 if solver == "cholmod" else case.ranks
    threads = {"OPENBLAS_NUM_THREADS": str(case.ranks // ranks)}
    if family == "snesvi":
        words = ["snesvi_scenes.py", solver, files[0]]
    elif family == "active_sets":
        words = ["active_sets.py", solver, *files, "--zone", case.zone]
    elif case.zone.exists():
        words = ["active_sets.py", solver, files[0], "--zone", case.zone, "--given"]
    else:
        raise Trouble("failed", "the contact zone is not known; let active_sets_cholmod or active_sets_gamg run with it")
    return solvers.measured_snesvi(solvers.start(
        [*launcher(ranks), solvers.COMPARE / words[0], *words[1:], "--tolerance", case.tolerance], case, threads))


def run(name, case):
    """\\raises Trouble, UsageError"""
    if name == "epafi":
        return run_epafi(case)
    return run_peer(*name.rsplit("_", 1), case)
