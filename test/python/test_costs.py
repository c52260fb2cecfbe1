#!/usr/bin/python3
"""test_costs.py XML: memory over a thousand solves, and, with EPAFI_TIMES=1 on a quiet machine, time beside the library's own."""

import os
import pathlib
import resource
import sys
import time
import unittest

import numpy

import epafi
from test_matrices import on_side, solid, summed

SCENES = pathlib.Path(sys.argv[1])
quiet = unittest.skipUnless(os.environ.get("EPAFI_TIMES"), "times, on a quiet machine")


def resident():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


class Costs(unittest.TestCase):
    def test_memory_stays_flat_over_a_thousand_solves(self):
        small = {"Bodies/left/Elements": [8, 8], "Bodies/right/Elements": [8, 8]}
        sizes = []
        for k in range(1000):
            epafi.solve(SCENES / "coercive.xml", set=small)
            if k % 100 == 99:
                sizes.append(resident())
        self.assertLess(sizes[-1] - sizes[1], 0.02 * sizes[1], sizes)

    def test_memory_stays_flat_over_a_thousand_problems_and_programs(self):
        places, _, unknowns, matrices = solid([12, 12], [0.0, 0.0], [1.0, 1.0])
        bottom = numpy.flatnonzero(places[:, 1] == 0)
        loads = numpy.outer(on_side(places, [12, 12], 1.0)[1], [0.1, -1.0]).ravel()
        rows, rhs = numpy.zeros((13, len(loads))), numpy.ones(13)
        rows[range(13), 2 * bottom + 1] = -1
        sizes = []
        for k in range(1000):
            problem = epafi.Problem(2)
            problem.add_elements(unknowns, matrices, places, parts=2)
            problem.set_contact(rows, 0, friction=0.5)
            problem.solve(loads), problem.solve(0.5 * loads)
            epafi.solve_qp(lambda x: 2 * x, rhs, upper=0.3)
            if k % 100 == 99:
                sizes.append(resident())
        self.assertLess(sizes[-1] - sizes[1], 0.02 * sizes[1], sizes)

    @quiet
    def test_python_takes_a_twentieth_of_the_time_at_most(self):
        elements = {"Bodies/block/Elements": [96, 96]}
        shares = []
        for _ in range(5):
            began = time.perf_counter()
            result = epafi.solve(SCENES / "punch.xml", set=elements)
            shares.append((time.perf_counter() - began) / result.report["Time"]["Total"] - 1)
        self.assertLess(sorted(shares)[2], 0.05, shares)

    @quiet
    def test_python_takes_a_twentieth_beside_matrices_of_ones_own(self):
        """Of 100 000 unknowns, two blocks meshed apart with friction; matrices are made before."""
        bodies = []
        for number, count in enumerate(([250, 100], [225, 110])):
            places, cells, unknowns, matrices = solid(count, [0.0, number], [1.0, number + 1.0])
            stiffness, held = summed(unknowns, matrices, 2 * len(places)), 2 * numpy.flatnonzero(places[:, 1] == 0)
            bodies.append((stiffness, places, dict.fromkeys([*held, *(held + 1)], 0.0), on_side(places, count, 1.0)[0], cells))
        loads = [numpy.zeros(body[1].shape) for body in bodies]
        loads[1][bodies[1][1][:, 1] == 2] = [0.001, -0.01]
        shares = []
        for _ in range(5):
            problem = None  # the last one's factors are freed before the clock starts
            began, problem = time.perf_counter(), epafi.Problem(2)
            numbers = [problem.add_body(stiffness, places, held=held) for stiffness, places, held, _, _ in bodies]
            joint = problem.joint(*((own, facets, cells) for own, (_, _, _, facets, cells) in zip(numbers, bodies)))
            problem.set_contact(joint.rows, joint.gaps, friction=0.3)
            solution = problem.solve(numpy.concatenate(loads).ravel())
            shares.append((time.perf_counter() - began) / solution.seconds - 1)
        self.assertGreater(problem.unknowns, 100000)
        self.assertLess(min(shares), 0.05, shares)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
