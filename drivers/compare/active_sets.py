#!/usr/bin/python3
"""active_sets.py cholmod|gamg FILE [COARSER...]: a contact problem that epafi-export wrote, by primal-dual active sets, for
`peers`. Each step solves the linear problem whose zone is held, and changes all conditions with a wrong sign at once. Begins on
the last file, with contact closed; each finer mesh begins with the state of the coarser one's nearest node. With --given the
zone is read from the file of --zone, and one linear solve is all that counts. Takes whatever contact_bounds.py takes: contact
by nodes and by mortars, tied joints, floating bodies. On any number of ranks, CHOLMOD on one. Prints its measurements as one
line of JSON.

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
import snesvi_scenes  # noqa: E402


def parse(arguments):
    parser = argparse.ArgumentParser(prog="active_sets.py", description=__doc__.split("\n\n")[0])
    parser.add_argument("solver", choices=("cholmod", "gamg"))
    parser.add_argument("files", nargs="+", metavar="FILE", help="what epafi-export wrote, the coarser meshes behind")
    parser.add_argument("--zone", required=True, metavar="FILE", help="where the zone is written, or with --given read")
    parser.add_argument("--given", action="store_true", help="solve once, with the zone of --zone")
    parser.add_argument("--tolerance", type=float, default=1e-6, metavar="T", help="of the residual (1e-6)")
    parser.add_argument("--petsc-options", default="", metavar="TEXT", help="further options of PETSc")
    return parser.parse_args(arguments)


def find_zone(PETSc, options, systems):
    """On one mesh after the other, from the coarsest on; a coarse mesh that fails helps nobody. \\raises NotSolved"""
    zones, sets, mesh_steps, cg_steps = snesvi.module("zones"), None, [], 0
    for system in reversed(systems):
        closed = system.gap == system.gap if sets is None else zones.carried(sets, system)
        sets = zones.ActiveSets(PETSc, system, options.solver, options.tolerance, closed)
        try:
            sets.run()
        except snesvi.NotSolved:
            if system is systems[0]:
                raise
            sets.closed[:] = True
        mesh_steps.append(sets.steps)
        cg_steps += sets.cg_steps
    return sets.z, sets.closed, mesh_steps, cg_steps


def solve_once(PETSc, options, system):
    """With the zone that is given; the second's begin of the solve itself is returned, too."""
    import numpy
    solver, z = snesvi.module("zones").ZoneSolver(PETSc, system, options.solver), system.load.duplicate()
    closed = numpy.isin(system.pivots, numpy.load(options.zone))
    solver.setup(closed | system.tied, z)
    set_up = time.perf_counter()
    return z, closed, solver.iterate(closed | system.tied, z, options.tolerance), set_up


def measure(options):
    PETSc = snesvi.load_petsc(options.petsc_options)
    import numpy
    comm, start = PETSc.COMM_WORLD.tompi4py(), time.perf_counter()
    try:
        systems = snesvi_scenes.loaded(PETSc, options.solver, options.files[:1] if options.given else options.files)
        comm.Barrier()
        assembled = set_up = time.perf_counter()
        if options.given:
            z, closed, cg_steps, set_up = solve_once(PETSc, options, systems[0])
            steps = [1]
        else:
            z, closed, steps, cg_steps = find_zone(PETSc, options, systems)
    except PETSc.Error as error:
        raise snesvi.NotSolved("PETSc says: " + str(error).splitlines()[-1].strip()) from error
    comm.Barrier()
    finished, system = time.perf_counter(), systems[0]
    if not options.given:
        zone = comm.gather(system.pivots[closed & ~system.tied])
        if comm.rank == 0:
            with open(options.zone, "wb") as stream:
                numpy.save(stream, numpy.concatenate(zone))
    return {"unknowns": system.unknowns, "assembly_seconds": assembled - start, "setup_seconds": set_up - assembled,
            "solve_seconds": finished - set_up, "iterations": sum(steps), "mesh_steps": steps, "linear_iterations": cg_steps,
            "energy": system.energy(z), "closed_nodes": comm.allreduce(int((closed & ~system.tied).sum())),
            "peak_bytes": comm.allreduce(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)}


if __name__ == "__main__":
    sys.exit(snesvi.printed("active_sets.py", measure, parse(sys.argv[1:])))
