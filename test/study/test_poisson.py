#!/usr/bin/python3
"""test_poisson.py POISSON: the side-by-side runs of linear solvers from outside."""

import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

POISSON = sys.argv[1]
COMPLETE, FAILED, WRONG_USAGE = range(3)
LIMIT = 120  # seconds
SOLVERS = ["fetidp", "fetidp_separate", "bddc", "bddc_separate", "muelu", "frosch", "cholmod"]


class Poisson(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def poisson(self, *arguments):
        return subprocess.run([POISSON, "--output", self.place, *map(str, arguments)], capture_output=True, text=True,
                              timeout=LIMIT, check=False)

    def table(self):
        with open(self.place / "poisson.csv", newline="", encoding="utf-8") as stream:
            return {(row["solver"], int(row["ranks"])): row for row in csv.DictReader(stream)}

    def test_every_solver_finds_the_exact_discrete_solution(self):
        run = self.poisson("--size", 32, "--subdomains", 4, "--ranks", "1,2", "--repeats", 1)
        self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""), run.stdout)
        rows = self.table()
        self.assertEqual(list(rows), [(name, 1) for name in SOLVERS] + [(name, 2) for name in SOLVERS[:-1]])
        for (name, ranks), row in rows.items():
            with self.subTest(solver=name, ranks=ranks):
                self.assertEqual((row["status"], row["unknowns"], row["subdomains"]), ("ok", "961", "16"))
                self.assertLessEqual(float(row["relative_residual"]), 2e-8)
                self.assertLessEqual(float(row["error"]), 1e-7)
                self.assertGreater(int(row["peak_bytes"]), 1_000_000)
                total = float(row["setup_seconds"]) + float(row["solve_seconds"])
                self.assertAlmostEqual(float(row["total_seconds"]), total, delta=1e-9)
                ratio = float(row["total_seconds"]) / float(rows["fetidp", ranks]["total_seconds"])
                self.assertAlmostEqual(float(row["ratio"]), ratio, delta=1e-9 * ratio)
        # Neither sharing nor the number of ranks changes what is computed.
        for name in ("fetidp", "bddc"):
            steps = {rows[kind, ranks]["iterations"] for kind in (name, f"{name}_separate") for ranks in (1, 2)}
            self.assertEqual(len(steps), 1, name)

    def test_a_wrong_call_is_told_what_is_allowed(self):
        for arguments, words in ((("--solvers", "hypre"), "the solvers are fetidp"), (("--size", 2), "outside 4 ... 4096"),
                                 (("--ranks", "0"), "numbers of ranks"), (("--programs", self.place), "epafi-poisson not found")):
            with self.subTest(words=words):
                run = self.poisson(*arguments)
                self.assertEqual(run.returncode, WRONG_USAGE)
                self.assertIn(words, run.stderr)

    def test_the_program_refuses_what_it_cannot_solve(self):
        program = pathlib.Path(POISSON).absolute().parent.parent / "epafi-poisson"
        for arguments, words in ((["cholmod"], "--size must be given"), (["--size", "8"], "no solver is named"),
                                 (["cholmod", "--size", "8", "--subdomains", "9"], "allowed are the integers 1 ... 8"),
                                 (["none.xml", "--size", "8"], "none.xml")):
            with self.subTest(words=words):
                run = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=LIMIT, check=False)
                self.assertIn(run.returncode, (1, 2))
                self.assertIn(words, run.stderr)
                self.assertEqual(run.stdout, "")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
