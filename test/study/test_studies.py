#!/usr/bin/python3
"""test_studies.py EPAFI SOURCE_DIR MPIRUN ARGUMENTS...: the studies in their quick form: their tables, and what these must show."""

import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE, LAUNCH = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
STUDY = str(pathlib.Path(PROGRAM).with_name("epafi-study"))  # stands beside
SOLVED, WRONG_INPUT = 0, 2
LIMIT = 60  # seconds


class Studies(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)


class StudiesErrorBars(Studies):
    def test_the_study_of_error_bars_sets_them_beside_errors(self):
        command = [SOURCE / "drivers/study/error_bars", "--program", PROGRAM, "--output", self.place]
        run = subprocess.run([*command, "--scene", "coercive"], capture_output=True, text=True, check=False)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        with open(self.place / "error_bars.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertGreater(len(rows), 3)
        self.assertEqual({row["holds"] for row in rows}, {"1"})
        self.assertEqual(subprocess.run([*command, "--scene", "none"], capture_output=True, check=False).returncode, WRONG_INPUT)


class StudiesScaling(Studies):
    COLUMNS = ["problem", "H_inverse", "H_over_h", "ranks", "operator", "preconditioner", "hessian_multiplications",
               "assembly_seconds", "setup_seconds", "solve_seconds", "total_seconds", "peak_bytes", "apply_seconds",
               "apply_bytes", "stream_bytes_per_second"]

    def study(self, ranks=1):
        launch = [*LAUNCH, str(ranks)] if ranks > 1 else []
        return subprocess.run([*launch, STUDY, "scaling", "--quick", "--output", str(self.place)], capture_output=True,
                              text=True, timeout=2 * LIMIT, check=False)

    def rows(self):
        with open(self.place / "scaling.csv", newline="", encoding="utf-8") as table:
            reader = csv.DictReader(table)
            rows = list(reader)
        self.assertEqual(reader.fieldnames[:len(self.COLUMNS)], self.COLUMNS)
        return rows

    def test_the_quick_study_and_its_rows_of_other_numbers_of_ranks(self):
        run = self.study()
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""), run.stdout)
        for name in ("", "_blocks", "_costs", "_coarse", "_prediction"):
            self.assertGreater((self.place / f"scaling{name}.csv").stat().st_size, 50, name)
        for name in ("scaling.md", "scaling.png"):
            self.assertGreater((self.place / name).stat().st_size, 1000, name)
        alone = self.rows()
        self.assertEqual({(row["operator"], row["preconditioner"]) for row in alone},
                         {(form, kind) for form in ("implicit", "explicit", "shared") for kind in ("none", "lumped", "dirichlet")})
        for row in alone:
            numbers = {name: float(row[name]) for name in self.COLUMNS[6:]}
            self.assertTrue(all(value > 0 for value in numbers.values()), row)
        for problem in ("coercive", "semicoercive"):
            energies = [float(row["energy"]) for row in alone
                        if (row["problem"], row["H_inverse"], row["H_over_h"]) == (problem, "8", "8")]
            self.assertLess(max(energies) - min(energies), 1e-5 * abs(energies[0]), problem)

        run = self.study(ranks=2)
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""), run.stdout)
        both = self.rows()
        self.assertEqual([row for row in both if row["ranks"] == "1"], alone)
        several = [row for row in both if row["ranks"] == "2"]
        self.assertEqual({(row["problem"], row["H_inverse"], row["operator"], row["cluster"]) for row in several},
                         {("coercive", "8", "shared", "0"), ("coercive", "8", "explicit", "0"), ("coercive", "6", "shared", "0"),
                          ("coercive", "6", "explicit", "0"), ("coercive", "8", "shared", "1"), ("blocks", "4", "implicit", "0"),
                          ("blocks", "4", "implicit", "1")})
        for row in several:
            self.assertGreaterEqual(float(row["messages_per_apply"]), 1, row)
            # one sum of the coarse problem, twice as precise as its numbers; none where subdomains have none in common
            unknowns = float(row["coarse_unknowns"]) if row["cluster"] == "0" else 0
            self.assertEqual(float(row["reduction_bytes_per_apply"]), 16 * unknowns, row)

    def test_tables_of_others_are_not_overwritten(self):
        (self.place / "scaling.csv").write_text("problem,ranks\ncoercive,2\n")
        run = self.study()
        self.assertEqual(run.returncode, WRONG_INPUT)
        self.assertIn("scaling.csv", run.stderr)
        self.assertEqual((self.place / "scaling.csv").read_text(), "problem,ranks\ncoercive,2\n")


class StudiesQuadraticPrograms(Studies):
    COLUMNS = ["problem", "size", "method", "preconditioner", "start", "hessian_multiplications", "cg_steps",
               "expansion_steps", "proportioning_steps", "seconds", "relative_projected_gradient"]

    def study(self, *arguments):
        return subprocess.run([STUDY, *map(str, arguments)], capture_output=True, text=True, timeout=2 * LIMIT, check=False)

    def products(self, rows, problem, size, preconditioner, start):
        found = {int(row["hessian_multiplications"]) for row in rows
                 if (row["problem"], int(row["size"]), row["method"], row["preconditioner"], row["start"]) ==
                 (problem, size, "projected_cg", preconditioner, start)
                 and (float(row["proportioning_constant"]), float(row["expansion_step"])) == (1.0, 1.9)}
        self.assertEqual(len(found), 1, (problem, size, preconditioner, start))
        return found.pop()

    def test_the_quick_study(self):
        run = self.study("qp", "--quick", "--output", self.place)
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""), run.stdout)
        for name in ("qp.csv", "qp.md", "qp.png", "qp_traffic.csv"):
            self.assertGreater((self.place / name).stat().st_size, 50, name)
        with open(self.place / "qp.csv", newline="", encoding="utf-8") as table:
            reader = csv.DictReader(table)
            rows = list(reader)
        self.assertEqual(reader.fieldnames[:len(self.COLUMNS)], self.COLUMNS)
        for row in rows:
            if row["status"] == "Converged":
                self.assertLessEqual(float(row["relative_projected_gradient"]), 1.001e-6, row)
            steps = sum(int(row[f"{kind}_steps"]) for kind in ("cg", "expansion", "proportioning"))
            self.assertLessEqual(steps, int(row["hessian_multiplications"]), row)
        self.assertLessEqual(self.products(rows, "journal_bearing", 100, "none", "zero"), 444)  # PERMON 3.18
        self.assertLessEqual(self.products(rows, "journal_bearing", 100, "multigrid", "zero"), 70)
        for problem in ("journal_bearing", "obstacle", "torsion"):
            nested = [self.products(rows, problem, size, "face_multigrid", "nested") for size in (50, 100)]
            self.assertLessEqual(nested[1], 30, problem)
            self.assertLessEqual(nested[1], 1.5 * nested[0], f"{problem}: the count hardly grows with the mesh")

    def test_the_quick_study_of_heterogeneity(self):
        run = self.study("heterogeneity", "--quick", "--output", self.place)
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""), run.stdout)
        self.assertGreater((self.place / "heterogeneity.png").stat().st_size, 5000)
        with open(self.place / "heterogeneity.csv", newline="", encoding="utf-8") as table:
            rows = {(row["bodies"], row["pattern"], row["cut"], float(row["jump"]), row["adaptive"]): row
                    for row in csv.DictReader(table)}
        for (bodies, pattern, cut, jump, use), row in rows.items():
            self.assertEqual(row["converged"], "1", row)
            if (jump, use) != (1e6, "auto"):
                continue
            products, without, at_first = (int(rows[bodies, pattern, cut, *key]["hessian_multiplications"])
                                           for key in ((1e6, "auto"), (1e6, "no"), (1, "auto")))
            if pattern in ("stripes", "checkerboard"):  # there is nothing to constrain
                self.assertLessEqual(products, 1.1 * without, row)  # corrections for contact may come for nothing
                self.assertEqual(row["constraints"], "0", row)
                continue
            self.assertLessEqual(products, 0.5 * without, row)
            self.assertGreater(int(row["constraints"]), 0, row)
            if pattern == "inclusions":
                self.assertLessEqual(products, 2 * at_first, row)
            if cut == "grid":
                self.assertLess(float(row["condition"]), 50, row)

    def test_the_quick_study_of_spectra(self):
        run = self.study("spectra", "--quick", "--output", self.place)
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""), run.stdout)
        self.assertGreater((self.place / "spectra.png").stat().st_size, 5000)
        with open(self.place / "spectra.csv", newline="", encoding="utf-8") as table:
            rows = {(row["problem"], row["cluster"], row["series"], row["value"], row["part"], row["preconditioner"]): row
                    for row in csv.DictReader(table)}
        for (problem, cluster, series, value, part, kind), row in rows.items():
            smallest, largest = float(row["smallest_eigenvalue"]), float(row["largest_eigenvalue"])
            self.assertLessEqual(smallest, largest, row)
            whole = rows[problem, cluster, series, value, "all", kind]
            if kind == "none":  # Cauchy's interlacing
                self.assertLessEqual(0.98 * float(whole["smallest_eigenvalue"]), smallest, row)
                self.assertLessEqual(0.98 * largest, float(whole["largest_eigenvalue"]), row)
            else:
                plain = rows[problem, cluster, series, value, part, "none"]
                self.assertLess(largest / smallest, float(plain["largest_eigenvalue"]) / float(plain["smallest_eigenvalue"]), row)
        self.assertEqual({key[4] for key in rows if key[1] == "0"}, {"all", "gluing", "contact"})

    def test_unknown_studies(self):
        for words, arguments in ((["tabels", "qp", "tables"], ["tabels"]), (["no study"], [])):
            run = self.study(*arguments)
            self.assertEqual(run.returncode, WRONG_INPUT)
            for word in words:
                self.assertIn(word, run.stderr)


class StudiesStability(Studies):
    COLUMNS = ["case", "parameter", "expected", "outcome", "ok", "hessian_multiplications"]
    FAMILIES = {"jumps", "shapes", "floating", "contact", "incompressible", "units", "choices", "penalty", "ranks", "known failures",
                "quadratic programs", "input", "meshes that do not match", "friction"}

    def study(self, *prefix):
        return subprocess.run([*prefix, STUDY, "stability", "--quick", "--output", str(self.place)], capture_output=True,
                              text=True, timeout=2 * LIMIT, check=False)

    def rows(self):
        with open(self.place / "stability.csv", newline="", encoding="utf-8") as table:
            reader = csv.DictReader(table)
            rows = list(reader)
        self.assertEqual(reader.fieldnames[:len(self.COLUMNS)], self.COLUMNS)
        return rows

    def test_the_quick_study_ends_as_expected_and_its_answers_are_confirmed(self):
        run = self.study()
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""), run.stdout)
        for name in ("stability.csv", "stability.md", "stability.png"):
            self.assertGreater((self.place / name).stat().st_size, 1000, name)
        rows = self.rows()
        self.assertEqual({row["family"] for row in rows}, self.FAMILIES)
        self.assertEqual({row["ranks"] for row in rows}, {"1"})
        for row in rows:
            self.assertEqual(row["ok"], "1", row)
            if row["outcome"] != "solved":
                self.assertNotEqual(row["reason"], "", row)
            elif row["balance"]:
                for residual, limit in (("balance", 1e-2), ("penetration", 1e-5), ("complementarity", 1e-6)):
                    self.assertLessEqual(float(row[residual]), limit, row)

    def test_more_ranks_bring_the_cases_that_ask_for_them(self):
        run = self.study(*LAUNCH, "2")
        self.assertEqual(run.returncode, SOLVED, run.stdout + run.stderr)
        self.assertEqual({row["ranks"] for row in self.rows()}, {"1", "2"})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
