#!/usr/bin/python3
"""test_hertz.py EPAFI SOURCE_DIR: the study of Hertz's contacts: its closed forms, what it reads from runs, and a coarse ladder."""

import csv
import math
import pathlib
import runpy
import subprocess
import sys
import tempfile
import unittest

import numpy

EPAFI, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
STUDY = SOURCE / "drivers/study/hertz"
COMPLETE, FAILED, WRONG_USAGE = range(3)
LIMIT = 120  # seconds

sys.dont_write_bytecode = True
sys.path.insert(0, str(STUDY.parent))
import hertz_contact  # noqa: E402


def study(*arguments):
    return subprocess.run([STUDY, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=LIMIT)


class Hertz(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def table(self):
        with open(self.place / "hertz.csv", newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def test_the_closed_forms_carry_the_load_and_bend_the_surface_onto_the_obstacle(self):
        e_star, radius = hertz_contact.stiffness(210000.0, 0.3), 50.0
        line, point = hertz_contact.cylinder(906.0, radius, e_star), hertz_contact.sphere(768.0, radius, e_star)
        self.assertAlmostEqual(math.pi / 2 * line.radius * line.pressure, 906.0, places=9)  # the integral of p
        self.assertAlmostEqual(2 / 3 * math.pi * point.radius**2 * point.pressure, 768.0, places=9)
        self.assertAlmostEqual(2 * line.pressure / (e_star * line.radius), 1 / radius, places=12)  # curvatures
        self.assertAlmostEqual(math.pi * point.pressure / (2 * e_star * point.radius), 1 / radius, places=12)

    def test_two_bodies_are_softer_than_each_and_a_hollow_takes_curvature_away(self):
        self.assertAlmostEqual(hertz_contact.together([3.0, 6.0]), 2.0, places=12)
        self.assertAlmostEqual(hertz_contact.together([20.0, -22.0]), 220.0, places=9)

    def test_the_radius_of_hertzs_own_pressure_is_hertzs(self):
        for in_space in (False, True):
            a, p0, n = 0.5, 1000.0, 200
            x = numpy.linspace(0, 1, n + 1)
            share = numpy.full(n + 1, 1 / n)
            share[[0, -1]] /= 2
            if in_space:
                points = numpy.stack([*(axis.ravel() for axis in numpy.meshgrid(x, x)), numpy.zeros((n + 1)**2)], axis=1)
                area, r = numpy.outer(share, share).ravel(), numpy.linalg.norm(points, axis=1)
                corner = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
                cells = numpy.column_stack([corner, corner + 1, corner + n + 2, corner + n + 1])
            else:
                points, area, r = numpy.column_stack([x, 0 * x, 0 * x]), share, x
                cells = numpy.column_stack([numpy.arange(n), numpy.arange(1, n + 1)])
            pressure = p0 * numpy.sqrt(numpy.maximum(0, 1 - (r / a)**2))
            found = hertz_contact.measure(in_space, points, pressure * area, area, pressure, pressure > 0, cells)
            part = math.pi / 6 * a**2 * p0 if in_space else math.pi / 4 * a * p0
            self.assertAlmostEqual(found.force / part, 1, delta=2e-3)
            self.assertAlmostEqual(found.radius, a, delta=1e-3)
            self.assertAlmostEqual(found.radius_by_area, a, delta=1e-2)
            self.assertEqual((found.pressure, found.nodes, found.closed), (p0, len(points), int((r < a).sum())))
            self.assertAlmostEqual(found.mesh_size, 1 / n, places=12)
            self.assertAlmostEqual(found.variation, 1, delta=1e-2)
            wiggle = pressure * (1 + 0.05 * (-1)**numpy.arange(len(pressure)))
            self.assertGreater(hertz_contact.measure(in_space, points, pressure * area, area, wiggle, pressure > 0, cells).variation, 2)

    def test_edges_of_quadratic_facets_go_through_their_middles(self):
        pairs = hertz_contact.neighbours(True, numpy.array([[0, 1, 2, 3, 4, 5]]))
        self.assertEqual(set(zip(*map(list, pairs))), {(0, 3), (3, 1), (1, 4), (4, 2), (2, 5), (5, 0)})
        self.assertEqual([list(side) for side in hertz_contact.neighbours(False, numpy.array([[0, 1, 2]]))], [[0, 2], [2, 1]])

    def test_orders_are_those_of_the_values_without_their_limit(self):
        order = runpy.run_path(str(STUDY), run_name="study")["order"]
        for q in (1.0, 2.0, 3.5):
            h = [0.2, 0.12, 0.05]
            self.assertAlmostEqual(order(h, [7 - 3 * size**q for size in h]), q, places=4)
        self.assertIsNone(order([0.2, 0.1, 0.05], [1.0, 2.0, 1.5]))  # to and fro
        self.assertIsNone(order([0.1, 0.1, 0.05], [1.0, 2.0, 3.0]))

    def test_coarse_meshes_come_near_hertz_and_finer_ones_nearer(self):
        run = study("--program", EPAFI, "--output", self.place, "--scene", "hertz_cylinder", "--factors", "1,4", "--blocks", "1,2")
        self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""))
        rows = self.table()
        self.assertEqual([(float(row["block_factor"]), float(row["mesh_size_factor"])) for row in rows],
                         [(1, 4), (1, 1), (2, 4), (2, 1)])
        for coarse, fine in (rows[:2], rows[2:]):
            self.assertGreater(float(coarse["h"]), 2 * float(fine["h"]))
            for error in ("radius_error", "pressure_error", "radius_by_area_error"):
                self.assertLess(float(coarse[error]), 0.1, error)
                self.assertLess(float(fine[error]), 0.5 * float(coarse[error]), error)
            self.assertLess(float(fine["radius_error"]), 0.003)
            self.assertLess(float(fine["pressure_error"]), 0.006)
            self.assertLess(abs(float(fine["variation"]) - 1), 0.01)  # no wiggle
            self.assertAlmostEqual(float(fine["force"]), 453.0, delta=1e-3 * 453.0)  # of the block twice as large too
        self.assertGreater(int(rows[3]["unknowns"]), int(rows[1]["unknowns"]))
        self.assertIn(f"{100 * float(rows[1]['radius_error']):.2f} %", run.stdout)

    def test_the_sphere_is_measured_over_a_quarter(self):
        run = study("--program", EPAFI, "--output", self.place, "--scene", "hertz_sphere", "--factors", "1.4")
        self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""))
        (row,) = self.table()
        self.assertLess(float(row["radius_error"]), 0.01)
        self.assertLess(float(row["pressure_error"]), 0.02)
        self.assertLess(abs(float(row["variation"]) - 1), 0.03)
        self.assertAlmostEqual(float(row["force"]), 192.25, delta=0.2)

    def test_two_elastic_cylinders_meshed_apart_are_hertzs_whichever_has_the_multipliers(self):
        run = study("--program", EPAFI, "--output", self.place, "--scene", "cylinders", "--factors", "2")
        self.assertEqual((run.returncode, run.stderr), (COMPLETE, ""))
        rows = self.table()
        self.assertEqual([row["scene"] for row in rows], ["cylinders, multipliers first", "cylinders, multipliers second"])
        for row in rows:
            for error in ("radius_error", "pressure_error"):
                self.assertLess(float(row[error]), 0.005, error)
            self.assertLess(abs(float(row["variation"]) - 1), 0.01)
            self.assertAlmostEqual(float(row["force"]), 258.0, delta=0.05)
        self.assertNotEqual(*(row["contact_nodes"] for row in rows))
        self.assertAlmostEqual(float(rows[0]["radius"]), float(rows[1]["radius"]), delta=1e-3 * 0.5)

    def test_failed_runs_and_wrong_usage_are_said(self):
        run = study("--program", "/bin/false", "--output", self.place, "--scene", "hertz_sphere", "--factors", "4")
        self.assertEqual(run.returncode, FAILED)
        self.assertIn("hertz_sphere with mesh size factor 4 ended with code 1", run.stderr)
        run = study("--program", EPAFI, "--output", self.place, "--scene", "cylinders", "--factors", "4", "--blocks", "2")
        self.assertEqual(run.returncode, FAILED)
        self.assertIn("cylinders has no block", run.stderr)
        self.assertFalse((self.place / "hertz.csv").exists())
        for word, arguments in (("--factors", ["--factors", "0"]), ("--blocks", ["--blocks", "1,x"]), ("--scene", ["--scene", "x"]),
                                ("setup build", ["--program", self.place]), ("--time-limit", ["--time-limit", "0"])):
            run = study("--program", EPAFI, "--output", self.place, *arguments)
            self.assertEqual(run.returncode, WRONG_USAGE, run.stdout + run.stderr)
            self.assertIn(word, run.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
