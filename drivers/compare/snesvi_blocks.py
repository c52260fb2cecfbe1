#!/usr/bin/python3
"""snesvi_blocks.py cholmod|hypre|gamg FILE: a contact problem that epafi-export wrote, by PETSc's SNESVI (reduced-space
Newton), for `peers`. On any number of ranks, CHOLMOD on one. Prints its measurements as one line of JSON.

Exit codes: 0 solved, 1 not solved (the reason on stderr), 2 wrong usage, 3 a package is missing (its name on stderr).
"""

import argparse
import json
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
    parser = argparse.ArgumentParser(prog="snesvi_blocks.py", description=__doc__.split("\n\n")[0])
    parser.add_argument("solver", choices=SOLVERS)
    parser.add_argument("file", help="what epafi-export wrote")
    parser.add_argument("--tolerance", type=float, default=1e-6, metavar="T", help="reduction of the residual (1e-6)")
    parser.add_argument("--petsc-options", default="", metavar="TEXT", help="further options of PETSc")
    options = parser.parse_args(arguments)
    if not os.path.isfile(options.file):
        parser.error(f"there is no file '{options.file}'; epafi-export makes it")
    return options


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
    snes = snesvi.newton(PETSc, SOLVERS[options.solver], system.stiffness, system.load, None, system.upper,
                         options.tolerance)
    if options.solver != "cholmod":
        preconditioner = snes.getKSP().getPC()
        preconditioner.setType(PETSc.PC.Type.PYTHON)
        preconditioner.setPythonContext(Multigrid(PETSc, snes, system.stiffness, system.modes))
    z = system.load.duplicate()
    z.set(0.0)
    snes.solve(None, z)
    return snes, z


def measure(options):
    PETSc = snesvi.load_petsc(options.petsc_options)
    try:
        import contact_bounds
    except ImportError as error:
        raise snesvi.MissingPackage("python3-" + error.name.split(".")[0]) from None
    comm = PETSc.COMM_WORLD.tompi4py()
    start = time.perf_counter()
    try:
        if options.solver == "cholmod" and comm.size > 1:
            raise snesvi.NotSolved("CHOLMOD works on one rank; give it threads by OPENBLAS_NUM_THREADS")
        system = contact_bounds.load(PETSc, options.file)
        comm.Barrier()
        assembled = time.perf_counter()
        snes, z = solve(PETSc, options, system)
    except PETSc.Error as error:
        raise snesvi.NotSolved("PETSc says: " + str(error).splitlines()[-1].strip()) from error
    comm.Barrier()
    finished = time.perf_counter()
    if snes.getConvergedReason() <= 0:
        raise snesvi.NotSolved(f"SNESVI stopped with {snesvi.reason_of(PETSc, snes.getConvergedReason())} after "
                               f"{snes.getIterationNumber()} steps")
    return {"unknowns": z.getSize(), "assembly_seconds": assembled - start, "solve_seconds": finished - assembled,
            "iterations": snes.getIterationNumber(), "linear_iterations": snes.getLinearSolveIterations(),
            "energy": system.energy(z), "closed_nodes": system.closed_nodes(z),
            "peak_bytes": comm.allreduce(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)}


def main(arguments):
    options = parse(arguments)
    first = int(os.environ.get("OMPI_COMM_WORLD_RANK", "0")) == 0
    try:
        measurements = measure(options)
        if first:
            print(json.dumps(measurements))
    except snesvi.MissingPackage as error:
        if not first:  # in silence: what two ranks say runs together, and the first that fails ends the others
            return 0
        print(error, file=sys.stderr)
        return 3
    except snesvi.NotSolved as error:
        print(f"snesvi_blocks.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
