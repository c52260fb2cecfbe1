#!/usr/bin/python3
"""test_scenes.py EPAFI XML: scenes solved by `import epafi` beside the same by the program."""

import importlib.util
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xml.etree.ElementTree

import numpy

import epafi

PROGRAM, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
SEAM = epafi.Scene(
    bodies={"shelf": epafi.Body(rectangle=[0, 1, 0, 1], elements=(16, 16), supports={"wall": epafi.Support(edge="left")}),
            "cloth": epafi.Body(rectangle=numpy.array([1, 2, 0, 1]), elements=[16, 16],
                                loads={"weight": epafi.Load(value=-1)})},
    contact={"seam": epafi.Pair(first_body="shelf", first_edge="right", second_body="cloth", second_edge="left")})

LONG = {"Bodies/block/Elements": [160, 160], "Bodies/punch/Elements": [40, 80], "Solver/Tolerance": 1e-11}  # some seconds


def python(code, *arguments, **options):
    return subprocess.Popen([sys.executable, "-c", code, *arguments], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            **options)


class Scenes(unittest.TestCase):
    def test_numbers_are_those_of_the_program(self):
        for name, more in (("coercive", []), ("punch", []), ("clamped_strap", []), ("bracket", ["--accuracy", "10%"])):
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                file, report = SCENES / f"{name}.xml", pathlib.Path(folder) / "report.xml"
                subprocess.run([PROGRAM, file, "--quiet", "--report", report, *more], check=True)
                result = epafi.solve(file, accuracy="10%" if more else None)
                for entry in xml.etree.ElementTree.parse(report).getroot().find("*[@name='Accuracy']"):
                    key, value = entry.get("name"), entry.get("value")
                    if entry.get("type") == "double" and key in ("Energy", "Contact Force", "Strain Energy", "Load Work",
                                                                 "Relative Error"):
                        self.assertLessEqual(abs(result.report["Accuracy"][key] - float(value)), 1e-12 * abs(float(value)))

    def test_files_dictionaries_and_objects_are_one_scene(self):
        objects = epafi.solve(SEAM)
        plain = epafi.solve({"Bodies": {"shelf": {"Rectangle": [0.0, 1, 0, 1], "Elements": [16, 16],
                                                  "Supports": {"wall": {"Edge": "left"}}},
                                        "cloth": {"Rectangle": [1, 2, 0, 1], "Elements": [16, 16],
                                                  "Loads": {"weight": {"Value": -1}}}},
                             "Contact": {"seam": {"First Body": "shelf", "First Edge": "right", "Second Body": "cloth",
                                                  "Second Edge": "left"}}})
        with tempfile.NamedTemporaryFile("w", suffix=".xml") as file:
            file.write(epafi.to_xml(SEAM))
            file.flush()
            written = epafi.solve(file.name)
        self.assertEqual(objects.energy, plain.energy)
        self.assertEqual(objects.energy, written.energy)

    def test_every_number_of_the_schema_passes_through_xml(self):
        values = {"Solver": {"Tolerance": 1e-300, "MPRGP": {"Maximum Iterations": 7}}, "title": 'a < "b" & c'}
        self.assertIn('type="double" value="1e-300"', epafi.to_xml(values))
        self.assertIn("a &lt; ", epafi.to_xml(values))
        self.assertEqual(epafi.to_xml({"bodies": {"b": epafi.Body(youngs_modulus=2)}}),
                         epafi.to_xml({"Bodies": {"b": {"Young's Modulus": 2.0}}}))

    def test_fields_have_the_shapes_and_sums_that_they_say(self):
        result = epafi.solve(SEAM)
        cloth, seam = result.bodies["cloth"], result.contacts["seam"]
        self.assertEqual(cloth.points.shape, (33 * 33, 3))
        self.assertEqual(cloth.u.shape, (33 * 33, 1))
        self.assertEqual(cloth.cells.shape, (256, 9))
        self.assertEqual(cloth.subdomain.shape, cloth.error.shape)
        self.assertIsNone(cloth.von_mises)
        self.assertAlmostEqual(seam.force.sum(), 1, delta=1e-6)  # the weight of the cloth
        self.assertEqual(seam.active.dtype, bool)
        self.assertTrue((seam.active == (seam.multiplier > 0)).all())
        self.assertEqual(len(result.history["projected_gradient"]), len(result.history["hessian_multiplications"]))

    def test_load_steps_have_fields_of_their_own(self):
        result = epafi.solve(SCENES / "clamped_strap.xml")
        self.assertEqual(list(result.steps), list(result.report["Steps"]))
        first, last = (list(result.steps.values())[k] for k in (0, -1))
        self.assertIs(last.bodies, result.bodies)
        strap = next(iter(result.bodies))
        self.assertGreater(numpy.abs(last.bodies[strap].u - first.bodies[strap].u).max(), 0)
        contact = next(iter(result.contacts.values()))
        self.assertEqual(contact.traction.shape, contact.slip.shape)
        self.assertEqual(len(contact.friction_state), len(contact.gap))

    def test_errors_are_of_three_kinds_with_the_sentences_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            loose = {**SEAM, "contact": {}}
            for scene, kind in ((SEAM | {"Titel": "x"}, epafi.InputError), (loose, epafi.SolvabilityError)):
                file = pathlib.Path(folder) / "scene"
                file.write_text(epafi.to_xml(scene))
                run = subprocess.run([PROGRAM, "scene"], cwd=folder, text=True, capture_output=True)
                with self.assertRaises(kind) as caught:
                    epafi.solve(scene)
                self.assertEqual(run.stderr.strip(), f"epafi: {caught.exception}")
                self.assertEqual(run.returncode, 2 if kind is epafi.InputError else 3)
        self.assertTrue(issubclass(epafi.InputError, ValueError))
        few = {"Solver/MPRGP/Maximum Multiplications": 8}
        with self.assertRaises(epafi.NotConverged) as caught:
            epafi.solve(SCENES / "coercive.xml", set=few)
        self.assertEqual(caught.exception.result.status, "MaxIterations")
        self.assertEqual(str(caught.exception), caught.exception.result.reason)
        self.assertFalse(epafi.solve(SCENES / "coercive.xml", set=few, check=False).converged)

    def test_other_threads_go_on(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count, daemon=True)
        thread.start()
        epafi.solve(SCENES / "punch.xml", set=LONG)
        done.set()
        thread.join()
        self.assertGreater(counted[0], 20)

    def test_threads_that_solve_take_turns(self):
        code = """
import sys, threading, epafi
def solve():
    energies.extend(epafi.solve(sys.argv[1], set={"Bodies/left/Elements": [8, 8]}).energy for _ in range(5))
energies, threads = [], [threading.Thread(target=solve) for _ in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(len(energies), len(set(energies)))"""
        run = subprocess.run([sys.executable, "-c", code, SCENES / "coercive.xml"], capture_output=True, text=True, timeout=300)
        self.assertEqual(run.stdout, "20 1\n", run.stderr)

    def test_a_solve_may_call_for_another(self):
        a = numpy.array([[2.0, -1.0], [-1.0, 2.0]])
        result = epafi.solve_qp(lambda x: epafi.solve_qp(numpy.eye(2), a @ x, tolerance=1e-14).x, [1, 1], upper=0.5, tolerance=1e-8)
        numpy.testing.assert_allclose(result.x, 0.5)

    def test_the_interrupt_key_ends_a_run_and_python_goes_on(self):
        code = """
import json, sys, epafi
def progress(what, *numbers):
    print(what, flush=True)
try:
    epafi.solve(sys.argv[1], set=json.loads(sys.argv[3]), progress=progress)
except KeyboardInterrupt:
    print("interrupted", epafi.solve(sys.argv[2]).status)
"""
        process = python(code, SCENES / "punch.xml", SCENES / "coercive.xml", json.dumps(LONG))
        self.assertTrue(process.stdout.readline())
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=120)
        self.assertEqual((output.splitlines()[-1], errors), ("interrupted Converged", ""))

    def test_what_progress_raises_ends_the_run(self):
        def refuse(*_):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            epafi.solve(SCENES / "punch.xml", set=LONG, progress=refuse)

    def test_without_mpi4py_one_process_is_enough(self):
        code = """
import sys, json
sys.modules["mpi4py"] = None
import epafi
print(json.dumps(epafi.solve(sys.argv[1]).energy))
"""
        output, errors = python(code, SCENES / "coercive.xml").communicate()
        self.assertEqual(errors, "")
        self.assertEqual(json.loads(output), epafi.solve(SCENES / "coercive.xml").energy)

    @unittest.skipUnless(importlib.util.find_spec("pyvista"), "PyVista is not installed")
    def test_pyvista_shows_bodies_as_they_are_displaced(self):
        for scene, colour in (("punch", "von_mises"), ("coercive", "u")):
            result = epafi.solve(SCENES / f"{scene}.xml")
            plain, shown = result.to_meshio(), next(iter(result.plot("3-D").meshes))
            self.assertEqual((shown.n_points, shown.active_scalars_name), (len(plain.points), colour))
            moved = numpy.linalg.norm(shown.points - plain.points, axis=1).max()
            self.assertAlmostEqual(moved / numpy.linalg.norm(numpy.ptp(plain.points, axis=0)), 0.1, delta=1e-6)

    def test_pictures_files_and_other_forms(self):
        result = epafi.solve(SCENES / "punch.xml")
        for what in ("shape", "decomposition", "mesh", *result.contacts):
            self.assertTrue(result.plot(what).axes)
        with self.assertRaisesRegex(ValueError, "there is no picture 'shap'"):
            result.plot("shap")
        with tempfile.TemporaryDirectory() as folder:
            self.assertTrue(result.write(folder).is_file())
            self.assertEqual(sorted(os.listdir(folder)), ["history.csv", "punch.h5", "punch.xdmf", "report.xml"])
        mesh = result.to_meshio()
        self.assertEqual(len(mesh.points), sum(len(body.points) for body in result.bodies.values()))
        self.assertEqual(mesh.point_data["displacement"].shape, mesh.points.shape)
        self.assertIn("<td>", result._repr_html_())
        self.assertIn("Converged", str(result))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
