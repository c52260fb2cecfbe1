#!/usr/bin/python3
"""test_ranks.py XML, under mpirun: communicators, shares of fields, and errors on all ranks alike."""

import pathlib
import sys
import unittest

import numpy
from mpi4py import MPI

import epafi

SCENES, WORLD = pathlib.Path(sys.argv[1]), MPI.COMM_WORLD


class Ranks(unittest.TestCase):
    def test_shares_together_are_the_solution_on_one_rank(self):
        shared = epafi.solve(SCENES / "coercive.xml", set={"Solver/Tolerance": 1e-12}, comm=WORLD)
        alone = epafi.solve(SCENES / "coercive.xml", set={"Solver/Tolerance": 1e-12}, comm=MPI.COMM_SELF)
        self.assertAlmostEqual(shared.energy, alone.energy, delta=1e-12)
        for name, body in shared.bodies.items():
            whole = numpy.concatenate(WORLD.allgather(body.u))
            numpy.testing.assert_allclose(whole, alone.bodies[name].u, atol=1e-10)
            numpy.testing.assert_array_equal(numpy.concatenate(WORLD.allgather(body.cells)), alone.bodies[name].cells)

    def test_parts_of_the_ranks_solve_scenes_of_their_own(self):
        colour = min(WORLD.Get_rank(), 1)
        part = WORLD.Split(colour)
        result = epafi.solve(SCENES / ("semicoercive.xml" if colour else "coercive.xml"), comm=part)
        self.assertEqual(result.report["Problem"]["Ranks"], part.Get_size())
        energies = WORLD.allgather(result.energy)
        self.assertEqual(len(set(energies)), min(WORLD.Get_size(), 2))

    def test_errors_come_on_all_ranks(self):
        with self.assertRaises(epafi.InputError) as caught:
            epafi.solve("nothing.xml")
        self.assertEqual(len(set(WORLD.allgather(str(caught.exception)))), 1)

    def test_what_one_rank_raises_ends_the_run_on_all(self):
        def refuse(*_):
            raise RuntimeError("enough")
        with self.assertRaises(RuntimeError if WORLD.Get_rank() == 0 else KeyboardInterrupt):
            epafi.solve(SCENES / "punch.xml", set={"Bodies/block/Elements": [160, 160], "Bodies/punch/Elements": [40, 80]},
                        progress=refuse if WORLD.Get_rank() == 0 else False)

    def test_the_first_rank_draws(self):
        figure = epafi.solve(SCENES / "coercive.xml").plot()
        self.assertEqual(figure is None, WORLD.Get_rank() > 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
