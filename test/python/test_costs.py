#!/usr/bin/python3
"""test_costs.py XML: memory over a thousand solves, and time beside the library's own."""

import pathlib
import resource
import sys
import time
import unittest

import epafi

SCENES = pathlib.Path(sys.argv[1])


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

    def test_python_takes_a_twentieth_of_the_time_at_most(self):
        elements = {"Bodies/block/Elements": [96, 96]}
        shares = []
        for _ in range(5):
            began = time.perf_counter()
            result = epafi.solve(SCENES / "punch.xml", set=elements)
            shares.append((time.perf_counter() - began) / result.report["Time"]["Total"] - 1)
        self.assertLess(sorted(shares)[2], 0.05, shares)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
