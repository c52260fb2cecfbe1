#!/usr/bin/python3
"""snesvi_scenes.py cholmod|hypre|gamg FILE: a contact problem that epafi-export wrote, by PETSc's SNESVI (reduced-space
Newton), for `peers`. Begins with the solution with all contact closed: without contact bodies may float. On any number of
ranks, CHOLMOD on one. Prints its measurements as one line of JSON.

Exit codes: 0 solved, 1 not solved (the reason on stderr), 2 wrong usage, 3 a package is missing (its name on stderr).
"""

import argparse
import os
import resource
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

import snesvi  # noqa: E402

# The fastest of what was tried. hypre: strong thresholds 0.25 ... 0.9, interpolation from 4 neighbours or any number, HMIS with
# extended interpolation, 0 ... 2 levels of aggressive coarsening with 1 or 2 paths, nodal coarsening with and without
# interpolation of the rigid motions. GAMG: thresholds -1 ... 0.05, squared graphs on 0 ... 2 levels, 2 ... 4 smoothing steps,
# SOR (CG breaks down), interpolation kept between Newton steps. Both: 1e-1 ... 1e-3 for CG. On the reduced matrix as SNESVI
# hands it over hypre takes twice as many CG steps, and GAMG stops with an error when the active set changes.
MULTIGRID = {"ksp_type": "cg", "ksp_rtol": 1e-2, "snes_linesearch_type": "basic"}
SOLVERS = {
    "cholmod": {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": "cholmod"},
    "hypre": {**MULTIGRID, "multigrid_pc_type": "hypre", "multigrid_pc_hypre_type": "boomeramg",
              "multigrid_pc_hypre_boomeramg_strong_threshold": 0.7, "multigrid_pc_hypre_boomeramg_P_max": 4,
              "multigrid_pc_hypre_boomeramg_agg_nl": 1},
    "gamg": {**MULTIGRID, "multigrid_pc_type": "gamg"},
}


def parse(arguments):
    parser = argparse.ArgumentParser(prog="snesvi_scenes.py", description=__doc__.split("\n\n")[0])
    parser.add_argument("solver", choices=SOLVERS)
    parser.add_argument("file", help="what epafi-export wrote")
    parser.add_argument("--tolerance", type=float, default=1e-6, metavar="T", help="of the residual, below that at the start or the loads (1e-6)")
    parser.add_argument("--petsc-options", default="", metavar="TEXT", help="further options of PETSc")
    return parser.parse_args(arguments)


class Multigrid:
    """A preconditioner of PETSc's that sees all unknowns, three a node: those at their bounds have a row of the identity.
    The reduced matrix of SNESVI alone has neither blocks of nodes nor a near-null space any more."""

    def __init__(self, PETSc, snes, stiffness, modes):
        self.snes, self.stiffness = snes, stiffness
        self.whole = stiffness.duplicate()
        self.whole.setOption(PETSc.Mat.Option.SPD, True)
        self.whole.setOption(PETSc.Mat.Option.KEEP_NONZERO_PATTERN, True)
        self.whole.setNearNullSpace(PETSc.NullSpace().create(vectors=modes, comm=stiffness.comm))
        self.inner = PETSc.PC().create(stiffness.comm)
        self.inner.setOptionsPrefix("multigrid_")
        self.inner.setFromOptions()
        self.right, self.left = stiffness.createVecs()
        self.scatter, self.PETSc = None, PETSc

    def setUp(self, pc):
        inactive = self.snes.getVIInactiveSet()
        first, last = self.stiffness.getOwnershipRange()
        self.stiffness.copy(self.whole, structure=self.PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        self.whole.zeroRowsColumns(inactive.complement(first, last), diag=1.0)
        self.inner.setOperators(self.whole)
        self.inner.setUp()
        reduced = pc.getOperators()[0].createVecRight()
        self.scatter = self.PETSc.Scatter().create(self.right, inactive, reduced, None)
        self.right.set(0.0)

    def apply(self, _, residual, correction):
        forward, reverse = self.PETSc.ScatterMode.FORWARD, self.PETSc.ScatterMode.REVERSE
        self.scatter.scatter(residual, self.right, mode=reverse)
        self.inner.apply(self.right, self.left)
        self.scatter.scatter(self.left, correction, mode=forward)


def solve(PETSc, options, system):
    snes = snesvi.newton(PETSc, SOLVERS[options.solver], system.stiffness, system.load, system.lower, system.upper,
                         options.tolerance)
    if options.solver != "cholmod":
        preconditioner = snes.getKSP().getPC()
        preconditioner.setType(PETSc.PC.Type.PYTHON)
        preconditioner.setPythonContext(Multigrid(PETSc, snes, system.stiffness, system.modes))
    zone = snesvi.module("zones").ZoneSolver(PETSc, system, options.solver)
    z = system.load.duplicate()
    steps = zone.solve(system.gap == system.gap, z, 1e-2)
    snes.solve(None, z)
    return snes, z, steps + snes.getLinearSolveIterations()


def loaded(PETSc, solver, files):
    """The systems in the files. \\raises NotSolved"""
    if solver == "cholmod" and PETSc.COMM_WORLD.size > 1:
        raise snesvi.NotSolved("CHOLMOD works on one rank; give it threads by OPENBLAS_NUM_THREADS")
    try:
        return [snesvi.module("contact_bounds").load(PETSc, file) for file in files]
    except (OSError, ValueError) as error:
        raise snesvi.NotSolved(str(error)) from None


def measure(options):
    PETSc = snesvi.load_petsc(options.petsc_options)
    comm = PETSc.COMM_WORLD.tompi4py()
    start = time.perf_counter()
    try:
        system, = loaded(PETSc, options.solver, [options.file])
        comm.Barrier()
        assembled = time.perf_counter()
        snes, z, linear_iterations = solve(PETSc, options, system)
    except PETSc.Error as error:
        raise snesvi.NotSolved("PETSc says: " + str(error).splitlines()[-1].strip()) from error
    comm.Barrier()
    finished = time.perf_counter()
    if snes.getConvergedReason() <= 0:
        raise snesvi.NotSolved(f"SNESVI stopped with {snesvi.reason_of(PETSc, snes.getConvergedReason())} after "
                               f"{snes.getIterationNumber()} steps")
    return {"unknowns": system.unknowns, "assembly_seconds": assembled - start, "solve_seconds": finished - assembled,
            "iterations": snes.getIterationNumber(), "linear_iterations": linear_iterations,
            "energy": system.energy(z), "closed_nodes": system.closed_nodes(z),
            "peak_bytes": comm.allreduce(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)}


if __name__ == "__main__":
    sys.exit(snesvi.printed("snesvi_scenes.py", measure, parse(sys.argv[1:])))
