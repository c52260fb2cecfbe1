"""Contact problems whose zone is given, by one linear solve: conditions in the zone are equations, the others are left out. And
primal-dual active sets, which find the zone by such solves."""

import numpy

import snesvi

# PETSc's defaults but for hypre, which is as in snesvi_scenes.py.
MULTIGRID = {"ksp_type": "cg", "ksp_norm_type": "unpreconditioned", "ksp_initial_guess_nonzero": True, "ksp_max_it": 500}
SOLVERS = {
    "cholmod": {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": "cholmod"},
    "hypre": {**MULTIGRID, "pc_type": "hypre", "pc_hypre_type": "boomeramg", "pc_hypre_boomeramg_strong_threshold": 0.7,
              "pc_hypre_boomeramg_P_max": 4, "pc_hypre_boomeramg_agg_nl": 1},
    "gamg": {**MULTIGRID, "pc_type": "gamg"},
}


class ZoneSolver:
    """Keeps what does not change with the zone: CHOLMOD's ordering and symbolic factorisation."""

    def __init__(self, PETSc, system, solver):
        self.PETSc, self.system = PETSc, system
        settings = PETSc.Options()
        for name, value in SOLVERS[solver].items():
            if not settings.hasName("zone_" + name):
                settings["zone_" + name] = value
        self.matrix = system.stiffness.duplicate()
        self.matrix.setOption(PETSc.Mat.Option.SPD, True)
        self.matrix.setOption(PETSc.Mat.Option.KEEP_NONZERO_PATTERN, True)
        self.matrix.setNearNullSpace(PETSc.NullSpace().create(vectors=system.modes, comm=system.stiffness.comm))
        self.ksp = PETSc.KSP().create(system.stiffness.comm)
        self.ksp.setOptionsPrefix("zone_")
        self.ksp.setFromOptions()
        self.places = system.pivots - system.stiffness.getOwnershipRange()[0]
        self.load, self.product = system.load.duplicate(), system.load.duplicate()

    def setup(self, held, z):
        """held: which conditions are equations; z gets their values."""
        system = self.system
        system.load.copy(self.load)
        system.stiffness.copy(self.matrix, structure=self.PETSc.Mat.Structure.SAME_NONZERO_PATTERN)
        z.getArray()[self.places[held]] = system.gap[held]
        self.matrix.zeroRowsColumns(system.pivots[held], 1.0, z, self.load)
        self.ksp.setOperators(self.matrix)
        self.ksp.setUp()

    def solve(self, held, z, tolerance):
        """From z to the solution, to a residual of tolerance |f|; steps of CG. \\raises NotSolved"""
        self.setup(held, z)
        return self.iterate(held, z, tolerance)

    def iterate(self, held, z, tolerance):
        """The solve behind a setup."""
        self.ksp.setTolerances(rtol=tolerance, atol=0.0)
        self.ksp.solve(self.load, z)
        if self.ksp.getConvergedReason() <= 0 or not numpy.isfinite(z.norm()):
            raise snesvi.NotSolved(f"a step's linear solver stopped with KSP's reason {self.ksp.getConvergedReason()}; its zone may "
                                   "not hold all bodies")
        z.getArray()[self.places[held]] = self.system.gap[held]
        return self.ksp.getIterationNumber()

    def forces(self, z):
        """Of the conditions."""
        self.system.stiffness.mult(z, self.product)
        return (self.system.load.getArray() - self.product.getArray())[self.places]


class ActiveSets:
    """On one mesh; closed: which conditions of contact are held, at first and in the end."""

    LIMIT = 100  # steps
    LOOSE = 1e-3  # tolerance of CG while the zone changes

    def __init__(self, PETSc, system, solver, tolerance, closed):
        self.system, self.tolerance, self.closed = system, tolerance, closed
        self.solver, self.is_direct = ZoneSolver(PETSc, system, solver), solver == "cholmod"
        self.z, self.steps, self.cg_steps = system.load.duplicate(), 0, 0
        self.comm = system.load.comm.tompi4py()

    def wrong(self):
        """Closed ones that pull and open ones that penetrate, by more than a thousandth of the tolerance of the largest value."""
        from mpi4py import MPI
        excess = numpy.where(self.closed, -self.solver.forces(self.z), self.z.getArray()[self.solver.places] - self.system.gap)
        result = numpy.zeros_like(self.closed)
        for side in (self.closed, ~self.closed):
            largest = self.comm.allreduce(float(numpy.abs(excess[side]).max(initial=0.0)), MPI.MAX)
            result |= side & ~self.system.tied & (excess > 1e-3 * self.tolerance * largest)
        return result

    def run(self):
        """\\raises NotSolved"""
        tolerance = self.tolerance if self.is_direct else self.LOOSE
        while self.steps < self.LIMIT:
            self.cg_steps += self.solver.solve(self.closed | self.system.tied, self.z, tolerance)
            self.steps += 1
            wrong = self.wrong()
            count = self.comm.allreduce(int(wrong.sum()))
            if count == 0 and tolerance == self.tolerance:
                return
            self.closed ^= wrong
            if count == 0:
                tolerance = self.tolerance
        raise snesvi.NotSolved(f"the zone has not settled after {self.LIMIT} steps: {count} conditions change")


def carried(coarse, fine):
    """Which conditions of a finer mesh begin closed: as the nearest one of the same body is in the end; all if there is none."""
    from scipy.spatial import cKDTree
    comm, system = coarse.comm, coarse.system
    bodies, places, closed = (numpy.concatenate(comm.allgather(values[~system.tied])) for values in
                              (system.bodies, system.places, coarse.closed))
    result = numpy.ones(len(fine.gap), dtype=bool)
    for body in numpy.unique(bodies):
        here = fine.bodies == body
        if here.any():
            result[here] = closed[bodies == body][cKDTree(places[bodies == body]).query(fine.places[here])[1]]
    return result
