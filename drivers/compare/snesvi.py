#!/usr/bin/python3
"""snesvi.py cholmod|hypre --size N: the model problem's contact problem by PETSc's SNESVI (reduced-space Newton) on the
undecomposed meshes, for `peers`. Prints its measurements as one line of JSON.

A bound needs the constraint in one unknown: on the contact line the jump w = u2 - u1 >= 0 is one (membranes.with_jump).

Exit codes: 0 solved, 1 not solved (the reason on stderr), 2 wrong usage, 3 a package is missing (its name on stderr).
"""

import argparse
import glob
import importlib
import json
import os
import resource
import sys
import time

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

# PETSc's defaults but for the tolerance of CG and the line search: 1e-2 a Newton step is cheaper in all than 1e-1, 1e-3
# or 1e-5, other smoothers, coarsenings and thresholds of hypre are no faster, and with so inexact steps the default line
# search may give up where full steps converge.
SOLVERS = {
    "cholmod": {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": "cholmod"},
    "hypre": {"ksp_type": "cg", "ksp_rtol": 1e-2, "pc_type": "hypre", "pc_hypre_type": "boomeramg",
              "snes_linesearch_type": "basic"},
}


class MissingPackage(Exception):
    """Its text is the name of the Debian package."""


class NotSolved(Exception):
    """Why not, as a sentence without its full stop."""


def parse(arguments):
    parser = argparse.ArgumentParser(prog="snesvi.py", description=__doc__.split("\n\n")[0])
    parser.add_argument("solver", choices=SOLVERS)
    parser.add_argument("--size", type=int, required=True, metavar="N", help="elements a side of a body, a multiple of 4")
    parser.add_argument("--problem", choices=["coercive", "semicoercive"], default="coercive")
    parser.add_argument("--tolerance", type=float, default=1e-6, metavar="T", help="reduction of the residual (1e-6)")
    parser.add_argument("--petsc-options", default="", metavar="TEXT", help="further options of PETSc")
    options = parser.parse_args(arguments)
    if options.size < 4 or options.size % 4 != 0:
        parser.error(f"argument --size: {options.size} is no multiple of 4; the loads end at quarters of a side")
    return options


def load_petsc(options):
    """petsc4py, also where Debian's alternatives do not point to it."""
    sys.path.extend(sorted(glob.glob("/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages")))
    try:
        import petsc4py
    except ImportError:
        raise MissingPackage("python3-petsc4py") from None
    petsc4py.init(["snesvi.py", *options.split()])
    from petsc4py import PETSc
    return PETSc


def module(name):
    """One of this folder's that needs packages. \\raises MissingPackage"""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MissingPackage("python3-" + error.name.split(".")[0]) from None


def newton(PETSc, defaults, stiffness, load, lower, upper, tolerance):
    """The solver, ready to run; all of PETSc's own setup is in its solve(). A bound that is None is infinite."""
    settings = PETSc.Options()
    for name, value in defaults.items():
        if not settings.hasName(name):
            settings[name] = value
    snes = PETSc.SNES().create(stiffness.comm)
    snes.setType("vinewtonrsls")

    def residual(_, z, result):
        stiffness.mult(z, result)
        result.axpy(-1.0, load)

    snes.setFunction(residual, load.duplicate())
    snes.setJacobian(lambda *_: None, stiffness)  # constant
    bounds = [load.duplicate() if bound is None else bound for bound in (lower, upper)]
    for bound, given, infinity in zip(bounds, (lower, upper), (PETSc.NINFINITY, PETSc.INFINITY)):
        if given is None:
            bound.set(infinity)
    snes.setVariableBounds(*bounds)
    # Of the loads, too, which are the residual of no displacement: what begins near the solution cannot lose as much again.
    snes.setTolerances(rtol=tolerance, atol=tolerance * load.norm(), stol=0.0, max_it=200)
    snes.setFromOptions()
    return snes


def reason_of(PETSc, code):
    names = {value: name for name, value in vars(PETSc.SNES.ConvergedReason).items() if isinstance(value, int)}
    return f"{names.get(code, 'unknown reason')} ({code})"


def measure(options):
    PETSc = load_petsc(options.petsc_options)
    start = time.perf_counter()
    system = module("membranes").with_jump(options.problem == "coercive", options.size)
    matrix = system.stiffness
    stiffness = PETSc.Mat().createAIJ(matrix.shape, csr=(matrix.indptr, matrix.indices, matrix.data), comm=PETSc.COMM_SELF)
    stiffness.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    stiffness.setOption(PETSc.Mat.Option.SPD, True)
    load = PETSc.Vec().createWithArray(system.load, comm=PETSc.COMM_SELF)
    lower = load.duplicate()
    lower.set(PETSc.NINFINITY)
    lower.getArray()[system.jumps] = 0.0
    assembled = time.perf_counter()

    z = load.duplicate()
    z.set(0.0)
    try:
        snes = newton(PETSc, SOLVERS[options.solver], stiffness, load, lower, None, options.tolerance)
        snes.solve(None, z)
    except PETSc.Error as error:
        raise NotSolved("PETSc says: " + str(error).splitlines()[-1].strip()) from error
    finished = time.perf_counter()
    if snes.getConvergedReason() <= 0:
        raise NotSolved(f"SNESVI stopped with {reason_of(PETSc, snes.getConvergedReason())} after "
                        f"{snes.getIterationNumber()} steps")
    product = load.duplicate()
    stiffness.mult(z, product)
    return {"unknowns": matrix.shape[0], "assembly_seconds": assembled - start,
            "solve_seconds": finished - assembled, "iterations": snes.getIterationNumber(),
            "linear_iterations": snes.getLinearSolveIterations(), "energy": 0.5 * product.dot(z) - load.dot(z),
            "peak_bytes": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss}


def printed(script, measure, options):
    """Prints measure(options), or why there is nothing; the exit code. On all ranks."""
    first = int(os.environ.get("OMPI_COMM_WORLD_RANK", "0")) == 0
    try:
        measurements = measure(options)
        if first:
            print(json.dumps(measurements))
    except MissingPackage as error:
        if not first:  # in silence: what two ranks say runs together, and the first that fails ends the others
            return 0
        print(error, file=sys.stderr)
        return 3
    except NotSolved as error:
        print(f"{script}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(printed("snesvi.py", measure, parse(sys.argv[1:])))
