#!/usr/bin/python3
"""test_problems.py: the open set of contact problems, its references, and the runner."""

import contextlib
import dataclasses
import functools
import io
import json
import pathlib
import sys
import tempfile
import unittest

import numpy
import scipy.io

import epafi
from epafi import contest, peers, problems
from epafi.condensed import ManySolutions, NoSolution

load = functools.cache(problems.load)


@functools.cache
def reference(name):
    return contest.reference(load(name))


class Problems(unittest.TestCase):
    def test_every_reference_fulfils_the_conditions_of_its_problem(self):
        self.assertGreaterEqual(len(problems.names()), 12)
        for name in problems.names():
            problem = load(name)
            if problem.verdict == "no solution":
                continue
            with self.subTest(name):
                self.assertLess(max(contest.residuals(problem, reference(name)).values()), 1e-11)
                self.assertAlmostEqual(contest.energy(problem, reference(name).u) / problem.energy, 1, delta=1e-10)
                self.assertLessEqual(len(problem.load), 20000)
                self.assertLess(abs(problem.stiffness - problem.stiffness.T).max(), 1e-14 * abs(problem.stiffness).max())

    def test_a_second_solver_agrees_to_ten_digits(self):
        for name in problems.names():
            problem = load(name)
            if problem.verdict == "no solution":
                continue
            is_qp = problem.is_bounded or problem.verdict == "many solutions"
            second = peers.SOLVERS["solve_qp, MPRGP" if is_qp else "FETI-DP, active set"](problem)
            with self.subTest(name):
                self.assertAlmostEqual(contest.energy(problem, second.u) / problem.energy, 1, delta=1e-10)
                self.assertLess(contest.error(problem, second.u, reference(name).u), 1e-8)
                self.assertLess(max(contest.residuals(problem, second).values()), 1e-7)

    def test_no_algorithm_by_name_takes_fewer_products_than_the_default_but_for_one(self):
        for name in ("obstacle", "coercive", "semicoercive", "regions", "channels", "two_blocks", "nafems_roller", "tresca_block",
                     "sheared_block", "sheared_cube"):
            entries = contest.contest([load(name)], peers.ALGORITHMS)
            solved = {entry.solver: entry for entry in entries if entry.outcome == "solved"}
            with self.subTest(name):
                self.assertEqual(len(solved) + sum(entry.outcome.startswith("unfit") for entry in entries), len(entries))
                self.assertGreaterEqual(len(solved), 4)
                self.assertLess(max(entry.error for entry in solved.values()), 1e-7)
                self.assertLessEqual(solved["default"].work, min(entry.work for entry in solved.values()) + 1)
        self.assertGreater(solved["fixed point"].work, solved["default"].work)  # of the cube, Coulomb's law in space

    def test_the_problem_without_solution_is_recognised(self):
        problem = load("lifted")
        for name in ("FETI-DP, MPRGP", "FETI-DP, active set", "solve_qp, MPRGP", "solve_qp, active set", "SciPy active set"):
            with self.subTest(name), self.assertRaises(NoSolution):
                peers.SOLVERS[name](problem)
        self.assertEqual(contest.run(problem, peers.active_set).outcome, "no solution")

    def test_what_is_not_unique_is_recognised_or_right_in_energy(self):
        with self.assertRaises(ManySolutions):
            peers.fetidp(load("may_slide"), "MPRGP")
        self.assertLess(contest.run(load("may_slide"), peers.active_set).error, 1e-10)

    def test_residuals_see_what_is_wrong(self):
        narrow = dataclasses.replace(load("coercive"), gap=load("coercive").gap - 0.01)
        for name, part, wrong in (("coercive", "balance", dict(u=1.001)), ("coercive", "tension", dict(multiplier=-1)),
                                  ("coercive", "penetration", {}), ("obstacle", "penetration", dict(u=0.9)),
                                  ("obstacle", "complementarity", dict(u=1.1)), ("sheared_block", "friction", dict(tangential=0.9))):
            problem, answer = narrow if not wrong else load(name), reference(name)
            changed = dataclasses.replace(answer, **{key: factor * getattr(answer, key) for key, factor in wrong.items()})
            with self.subTest(name, part=part):
                self.assertGreater(contest.residuals(problem, changed)[part], 1e-6)

    def test_files_hold_the_whole_problem(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(problems.main([folder, "sheared_block", "string", "lifted"]), 0)
            for name in ("sheared_block", "string", "lifted"):
                problem, read = load(name), problems.load(f"{folder}/{name}.h5")
                page = json.loads((pathlib.Path(folder) / f"{name}.json").read_text(encoding="utf-8"))
                for key, value in vars(problem).items():
                    if key in problems.MATRICES:
                        matrix = scipy.io.mmread(f"{folder}/{name}.{'KBT'[problems.MATRICES.index(key)]}.mtx")
                        self.assertEqual(abs(getattr(read, key) - value).sum(), 0)
                        self.assertEqual(abs(matrix - value).sum(), 0)
                        continue
                    numpy.testing.assert_array_equal(getattr(read, key), value, err_msg=key)
                    if key not in ("lower", "upper"):
                        numpy.testing.assert_array_equal(page[key], value, err_msg=key)
                self.assertEqual(page["lower"], [None if low == -numpy.inf else low for low in problem.lower])

    def test_a_scene_is_what_the_program_solves(self):
        solved = epafi.solve(problems.SCENES / "coercive.xml", set={"Solver/Tolerance": 1e-12})
        self.assertAlmostEqual(solved.energy, load("coercive").energy, delta=1e-10)
        finer = problems.of_scene(problems.SCENES / "coercive.xml", set={"Bodies/left/Elements": [64, 32]})
        self.assertEqual(len(finer.load), len(load("coercive").load) + 32 * 33)
        with self.assertRaisesRegex(epafi.InputError, "there is no problem 'coercve'; there are string"):
            problems.load("coercve")

    def test_any_function_can_be_put_into_the_runner(self):
        def lazy(problem):
            return dataclasses.replace(reference("coercive"), u=0 * problem.load, work=1, unit="products")

        def broken(_):
            raise ZeroDivisionError("no pivot")
        entries = contest.contest([load("coercive"), load("lifted")], {"lazy": lazy, "broken": broken, "ours": peers.active_set})
        self.assertEqual([entry.outcome for entry in entries],
                         ["solved", "failed: no pivot", "solved", "solved", "failed: no pivot", "no solution"])
        self.assertAlmostEqual(entries[0].error, 1)
        self.assertLess(entries[2].error, 1e-12)
        self.assertEqual(entries[3].error, numpy.inf)
        self.assertIn("| coercive |", contest.table(entries))
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(contest.main(["sheared_block", "--repeats", "1", "--picture", f"{folder}/a.png"]), 0)
            self.assertGreater((pathlib.Path(folder) / "a.png").stat().st_size, 5000)
        self.assertIn("FETI-DP, MPRGP", out.getvalue())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
