"""Epafi and its peers on the two blocks: each run a process (or one a rank) of its own. A run is a dictionary as in
solvers.py. What is counted:

  epafi, epafi_separate   assembly, setup, solve and recovery of u; iterations are products with F. _separate does not share
                          the factors of subdomains that are alike
  snesvi_*                from the making of the SNES to its solution; assembly, reading the file and the change of variables
                          are left out; iterations are Newton steps
  calculix*               the whole program, with elements of its own: hexahedra, _tetrahedra (calculix.py)
"""

import pathlib
import shutil
import tempfile

import calculix
import solvers
from solvers import Trouble

TITLE = "n"
LARGEST_RANKS = 64
DEFAULT_SIZE = 37
SIZES = "within 4 ... 128"
NOTE = "Times: epafi from assembly to u; its peers without their assembly and without changing variables."
NAMES = ("epafi", "epafi_separate", "snesvi_cholmod", "snesvi_hypre", "snesvi_gamg", "calculix", "calculix_tetrahedra")
MORTARS = ("epafi", "epafi_separate", "calculix", "calculix_tetrahedra")  # take blocks meshed apart
LARGEST_ORDER = 2
EPAFI_TOLERANCE = 0.1  # of the peers': see Case


def is_size(size):
    return 4 <= size <= 128


def programs(names):
    """What has to be built for these solvers."""
    return {"epafi" if name.startswith("epafi") else "epafi-export" for name in names if not name.startswith("calculix")}


def launcher(ranks):
    """What stands before a program that runs on so many ranks."""
    return ["mpirun", "--quiet", "--oversubscribe", "-n", ranks] if ranks > 1 else []


class Case:
    """What is solved, and how.

    Newton's last step takes the residual far below the tolerance; Epafi stops at it. For energies that agree to 1e-6 Epafi is
    asked for a tenth."""

    def __init__(self, options, folder_of_programs, _, folder):
        self.problem, self.size, self.ranks, self.time_limit = options.problem, options.size, options.ranks, options.time_limit
        self.tolerance, self.epafi_options, self.programs = options.tolerance, options.epafi_options, folder_of_programs
        self.order, self.multipliers = options.order, options.multipliers
        self.sizes = {"lower": options.size if options.lower_size is None else options.lower_size, "upper": options.size}
        self.grids = {body: max(2, round(size * options.order / 4.5)) for body, size in self.sizes.items()}
        self.scene, self.file = solvers.COMPARE / f"{options.problem}.xml", pathlib.Path(folder) / "system.petsc"

    def learn(self, name, run):
        """Nothing that others would have to know."""

    def unknowns(self):
        """Free displacements of the undecomposed meshes."""
        lower, upper = (self.order * size for size in self.sizes.values())
        plane = (upper + 1)**2 if self.problem == "floating_blocks" else 0
        return sum(3 * n * (n + 1)**2 for n in (lower, upper)) + plane

    def elements(self):
        """--set options of the mesh."""
        return [f"--set=Bodies/{body}/{change}" for body, size in self.sizes.items()
                for change in (f"Elements={{{size},{size},{size}}}", f"Order={self.order}")]

    def cut(self):
        """Settings of the subdomains: one grid, or, of blocks meshed apart, each block's own."""
        lists = {"": self.grids["upper"]} if len(set(self.sizes.values())) == 1 else {
            f"Bodies/{body}/": grid for body, grid in self.grids.items()}
        return [f"{place}Decomposition/Grid={{{grid},{grid},{grid}}}" for place, grid in lists.items()]

    def coupling(self):
        """Settings of the contact: blocks alike are coupled by pairs of nodes if nothing else is asked for."""
        if self.multipliers == "upper":
            return ["Contact/joint/Coupling=mortar", "Contact/joint/Multipliers=second"]
        return ["Contact/joint/Multipliers=first"]


def export(case):
    """Writes the system that the peers read. \\raises Trouble"""
    if not case.file.exists():
        process = solvers.start([case.programs / "epafi-export", case.scene, case.file, *case.elements()], case)
        if process.returncode != 0:
            raise Trouble("failed", solvers.why(process))


def run_epafi(case, further):
    settings = [*case.cut(), *case.coupling(),
                *(f"Solver/{name}Tolerance={EPAFI_TOLERANCE * case.tolerance:g}" for name in ("", "Equilibrium ")),
                *further, *case.epafi_options]
    with tempfile.TemporaryDirectory() as place:
        report = pathlib.Path(place) / "report.xml"
        process = solvers.start([*launcher(case.ranks), case.programs / "epafi", case.scene, "--quiet", "--report", report,
                                 *case.elements(), *(f"--set={setting}" for setting in settings)], case)
        return {"unknowns": case.unknowns(), **solvers.reported(process, report)}


def run_snesvi(solver, case):
    export(case)
    ranks = 1 if solver == "cholmod" else case.ranks
    threads = {"OPENBLAS_NUM_THREADS": str(case.ranks // ranks)}
    return solvers.measured_snesvi(solvers.start(
        [*launcher(ranks), solvers.COMPARE / "snesvi_scenes.py", solver, case.file, "--tolerance", case.tolerance], case,
        threads))


def run_calculix(case, shape):
    program = shutil.which("ccx")
    if program is None:
        raise Trouble("missing", "install the package calculix-ccx, or all of the peers by ./setup packages peers")
    try:
        return calculix.solve(program, case.problem, case.sizes, case.order, shape, case.multipliers, case.ranks,
                              case.time_limit)
    except calculix.Failed as error:
        raise Trouble("failed", str(error)) from None


def run(name, case):
    """\\raises Trouble, UsageError"""
    if name.startswith("calculix"):
        return run_calculix(case, "tetrahedra" if name == "calculix_tetrahedra" else "hexahedra")
    if name == "epafi":
        return run_epafi(case, [])
    if name == "epafi_separate":
        return run_epafi(case, ["Solver/Direct Solvers/Share Identical Subdomains=no"])
    return run_snesvi(name.removeprefix("snesvi_"), case)
