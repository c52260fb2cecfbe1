#!/usr/bin/python3
"""test_peers.py PEERS SOURCE_DIR: the side-by-side runs from outside. Needs no PETSc: where it would be called, the test
stands for a machine that lacks it."""

import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PEERS, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
COMPLETE, FAILED, WRONG_USAGE = range(3)
LIMIT = 120  # seconds
COLUMNS = ["problem", "unknowns", "solver", "total_seconds", "iterations", "energy", "peak_bytes"]
OURS = "epafi,linear_cholmod,linear_muelu"


def reference_energy(problem, size):
    with open(SOURCE / "test/reference/membranes.csv", newline="", encoding="utf-8") as table:
        found = [row for row in csv.DictReader(table)
                 if (row["problem"], row["elements_per_unit_side"]) == (problem, str(size))]
    return float(found[0]["energy"])


class Peers(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def peers(self, *arguments, **environment):
        return subprocess.run([PEERS, "--output", self.place / "out", *map(str, arguments)], capture_output=True, text=True,
                              timeout=LIMIT, check=False, env={**os.environ, **environment})

    def table(self):
        with open(self.place / "out" / "peers.csv", newline="", encoding="utf-8") as stream:
            reader = csv.DictReader(stream)
            rows = {row["solver"]: row for row in reader}
        self.assertEqual(reader.fieldnames[:len(COLUMNS)], COLUMNS)
        return rows

    def test_every_energy_is_the_reference_and_every_ratio_that_of_the_times(self):
        for problem in ("coercive", "semicoercive"):
            run = self.peers("--problem", problem, "--size", 16, "--solvers", OURS, "--repeats", 1)
            self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""), run.stdout)
            rows = self.table()
            self.assertEqual(",".join(rows), OURS)
            energy = reference_energy(problem, 16)
            for name, row in rows.items():
                self.assertEqual((row["problem"], row["status"]), (problem, "ok"))
                self.assertLessEqual(abs(float(row["energy"]) - energy), 1e-6 * abs(energy), name)
                ratio = float(row["total_seconds"]) / float(rows["epafi"]["total_seconds"])
                self.assertAlmostEqual(float(row["ratio"]), ratio, delta=1e-9 * ratio)
                self.assertGreaterEqual(int(row["iterations"]), 1)
                self.assertGreater(int(row["peak_bytes"]), 1_000_000)
                self.assertIn(f"{ratio:.2f}", run.stdout)
            self.assertEqual(int(rows["epafi"]["unknowns"]), 17 * 32 + (17 if problem == "semicoercive" else 0))

    def test_the_median_lies_between_least_and_greatest(self):
        self.peers("--size", 8, "--solvers", "epafi,linear_cholmod", "--repeats", 3)
        for row in self.table().values():
            self.assertEqual(row["repeats"], "3")
            self.assertLessEqual(float(row["minimum"]), float(row["total_seconds"]))
            self.assertLessEqual(float(row["total_seconds"]), float(row["maximum"]))

    def test_a_size_without_reference_is_compared_with_epafi(self):
        run = self.peers("--size", 12, "--solvers", OURS, "--repeats", 1, "--tolerance", 1e-9)
        self.assertEqual(run.returncode, COMPLETE, run.stdout)
        self.assertIn("compared with epafi's", run.stdout)
        for name, row in self.table().items():
            self.assertLess(float(row["energy_error"]), 1e-8, name)

    def test_a_missing_package_is_named(self):
        (self.place / "petsc4py.py").write_text("raise ImportError('not here')\n", encoding="utf-8")
        run = self.peers("--size", 8, "--solvers", "epafi,snesvi_cholmod", "--repeats", 1, PYTHONPATH=str(self.place))
        self.assertEqual(run.returncode, COMPLETE, run.stdout + run.stderr)
        self.assertIn("python3-petsc4py", run.stdout)
        self.assertEqual(self.table()["snesvi_cholmod"]["status"], "missing")

    def test_a_solver_that_fails_says_why(self):
        run = self.peers("--size", 16, "--solvers", OURS, "--repeats", 2, "--epafi-options",
                         "'Solver/MPRGP/Maximum Multiplications=3'")
        self.assertEqual(run.returncode, FAILED, run.stdout)
        rows = self.table()
        self.assertEqual((rows["epafi"]["status"], rows["epafi"]["total_seconds"]), ("failed", ""))
        self.assertIn("limit of operator products", rows["epafi"]["reason"])
        self.assertIn("epafi failed", run.stdout)
        self.assertEqual((rows["linear_muelu"]["status"], rows["linear_muelu"]["ratio"]), ("ok", ""))

    def test_a_wrong_energy_is_pointed_out(self):
        run = self.peers("--size", 16, "--solvers", "epafi,linear_cholmod", "--repeats", 1, "--epafi-options",
                         "Bodies/left/Conductivity=1.001")
        self.assertEqual(run.returncode, FAILED, run.stdout)
        self.assertEqual({name: row["status"] for name, row in self.table().items()},
                         {"epafi": "inaccurate", "linear_cholmod": "ok"})
        self.assertIn("the energy is off", run.stdout)

    def test_wrong_usage(self):
        for word, arguments in (("abaqus", ["--solvers", "epafi,abaqus"]), ("--size", ["--size", "18"]),
                                ("--repeats", ["--repeats", "0"]), ("--tolerance", ["--tolerance", "0"]),
                                ("Grd", ["--size", "8", "--solvers", "epafi", "--epafi-options", "Decomposition/Grd={2,2}"]),
                                ("setup build", ["--programs", str(self.place)])):
            run = self.peers(*arguments)
            self.assertEqual(run.returncode, WRONG_USAGE, run.stdout + run.stderr)
            self.assertIn(word, run.stderr)
            self.assertFalse((self.place / "out" / "peers.csv").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
