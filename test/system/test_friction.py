#!/usr/bin/python3
"""test_friction.py EPAFI SOURCE_DIR MPIRUN ARGUMENTS...: scenes with friction beside closed forms, by the study that compares
them, and the fields of their load steps."""

import csv
import math
import pathlib
import re
import runpy
import subprocess
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree

import h5py
import numpy

EPAFI, SOURCE, LAUNCH = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
STUDY = SOURCE / "drivers/study/friction"
COMPLETE, FAILED, WRONG_USAGE = range(3)
study = types.SimpleNamespace(**runpy.run_path(str(STUDY), run_name="study"))


def run(*arguments):
    return subprocess.run([STUDY, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
                          check=False)

CUBE = """SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Physical Volume("cube") = {1};
Physical Surface("bottom") = {5};
Physical Surface("top") = {6};
Mesh.MeshSizeMin = 0.35;
Mesh.MeshSizeMax = 0.35;
"""
# A block of order 2 on a rigid floor, its top pressed down and pushed aside.
PUSHED = """<ParameterList name="Epafi">
  <ParameterList name="Bodies">
    <ParameterList name="block">
      <Parameter name="Physics" type="string" value="{physics}"/>
      {mesh}
      <Parameter name="Order" type="int" value="2"/>
      <Parameter name="Young's Modulus" type="double" value="1"/>
      <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
      <ParameterList name="Supports">
        <ParameterList name="push">
          <Parameter name="Surface" type="string" value="top"/>
          <Parameter name="X" type="double" value="0.005"/>{across}
          <Parameter name="{up}" type="double" value="-0.01"/>
        </ParameterList>
      </ParameterList>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Obstacles">
    <ParameterList name="plate">
      <Parameter name="Kind" type="string" value="plane"/>
      <Parameter name="Point" type="Array(double)" value="{origin}"/>
      <Parameter name="Normal" type="Array(double)" value="{normal}"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Contact">
    <ParameterList name="floor">
      <Parameter name="First Body" type="string" value="block"/>
      <Parameter name="First Surface" type="string" value="bottom"/>
      <Parameter name="Obstacle" type="string" value="plate"/>
      <Parameter name="Friction" type="double" value="0.2"/>
    </ParameterList>
  </ParameterList>
  <ParameterList name="Solver">
    <Parameter name="Tolerance" type="double" value="1e-10"/>
  </ParameterList>
</ParameterList>
"""


def pushed(mesh):
    """The scene on a grid in the plane, on one in space, or on tetrahedra."""
    grids = {"plane": ("Rectangle", "{0, 1, 0, 1}", "{6, 6}"), "space": ("Box", "{0, 1, 0, 1, 0, 1}", "{3, 3, 3}")}
    words = f'<Parameter name="Mesh" type="string" value="{mesh}"/>'
    if mesh in grids:
        kind, box, elements = grids[mesh]
        words = (f'<Parameter name="{kind}" type="Array(double)" value="{box}"/>'
                 f'<Parameter name="Elements" type="Array(int)" value="{elements}"/>')
    if mesh == "plane":
        return PUSHED.format(physics="plane strain", mesh=words, across="", up="Y", origin="{0, 0}", normal="{0, 1}")
    return PUSHED.format(physics="elasticity 3-D", mesh=words, across='<Parameter name="Y" type="double" value="0.002"/>',
                         up="Z", origin="{0, 0, 0}", normal="{0, 0, 1}")


STEPS = {"press it": 0.5, "aside": 1.0, "back": 0.3}


def in_steps(names):
    """The scene in the plane in some of STEPS."""
    steps = "".join(f'<ParameterList name="{name}"><Parameter name="Supports" type="string" value="block/push = {STEPS[name]}"/>'
                    '</ParameterList>' for name in names)
    return pushed("plane").replace('<ParameterList name="Solver">', f'<ParameterList name="Steps">{steps}</ParameterList>'
                                                                    '<ParameterList name="Solver">')


def fields_of(group):
    """All datasets of a run, or of one of its load steps, by their paths."""
    found = {}
    for part in ("bodies", "contact", "history"):
        group[part].visititems(lambda name, item, part=part: found.update({f"{part}/{name}": item[()]})
                               if isinstance(item, h5py.Dataset) else None)
    return found


class Friction(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def compared(self, part, factor=1.0):
        """Rows of the table, and by how much each of its lines is off."""
        options = types.SimpleNamespace(program=EPAFI, factor=factor)
        rows, lines = getattr(study, part)(options, self.place)
        return rows, {name.split(" [")[0]: abs(found / exact - 1) for name, found, exact in lines}

    def test_the_closed_form_of_cylinders_carries_its_forces_and_sticks_where_it_says(self):
        p, q, mu, n = 900.0, 100.0, 0.3, 20000
        form = study.Mindlin(p, q, mu, 50.0, 210000.0, 0.3)
        places = [(2 * (k + 0.5) / n - 1) * form.a for k in range(n)]
        self.assertAlmostEqual(sum(map(form.pressure, places)) * 2 * form.a / n / p, 1, places=5)
        self.assertAlmostEqual(sum(map(form.shear, places)) * 2 * form.a / n / q, 1, places=5)
        self.assertAlmostEqual(form.largest_shear(), mu * form.p0 * math.sqrt(q / (mu * p)), places=9)
        self.assertAlmostEqual(form.shear(1.01 * form.c), mu * form.pressure(1.01 * form.c), places=9)
        self.assertLess(form.shear(0.99 * form.c), 0.9 * mu * form.pressure(0.99 * form.c))

    def test_the_loop_of_a_strip_closes_and_has_the_area_that_friction_takes(self):
        n, u = 2000, 0.025
        way = [u * k / n for k in (*range(n), *range(n, -n, -1), *range(-n, n + 1))]
        forces = study.strip_loop(9e5, 10.0, -80.0, way)
        self.assertAlmostEqual(forces[n], forces[-1], places=9)
        area = sum((a + b) / 2 * (v - w) for a, b, w, v in zip(forces[n:], forces[n + 1:], way[n:], way[n + 1:]))
        self.assertAlmostEqual(area / (4 / 3 * study.strip_force(9e5, 10.0, u) * u), 1, places=4)

    def test_cylinders_stick_and_slip_as_cattaneo_and_mindlin_say(self):
        rows, off = self.compared("mindlin")
        for name, most in (("a", 2e-3), ("c", 3e-3), ("c/a", 2e-3), ("largest pressure", 1e-3), ("largest shear", 0.03),
                           ("sum of pressures", 2e-3), ("sum of shears", 2e-3)):
            self.assertLess(off[name], most, name)
        computed = [row for row in rows if row["source"] == "computed"]
        slips = [row for row in computed if row["shear"] > 0.999 * row["bound"] > 0]
        self.assertGreater(len(slips), 10)
        for row in computed:
            self.assertLess(row["shear"], row["bound"] * (1 + 1e-5) + 1e-6)
        coarser = self.compared("mindlin", 2.0)[1]
        for name in ("largest pressure", "largest shear"):
            self.assertLess(off[name], coarser[name], name)

    def test_a_clamped_strap_goes_through_the_loop_of_a_thin_strip(self):
        rows, off = self.compared("loop")
        for name, most in (("force when pressed", 1e-4), ("force when pulled first", 6e-3), ("half the loop's height", 3e-3),
                           ("closes with", 1e-4), ("work of a loop", 0.02)):
            self.assertLess(off[name], most, name)
        self.assertEqual(len([row for row in rows if row["source"] == "computed"]), 13)
        report = study.xml.etree.ElementTree.parse(self.place / "report.xml").getroot()
        self.assertAlmostEqual(float(study.listed(report, "Contact", "joint", "Force")), 50.0 * 100, delta=1e-3)

    def test_the_loop_of_a_bolted_joint_closes(self):
        """What is pulled to and fro past sliding finds the same forces in the second cycle."""
        rows, off = self.compared("joint", 2.0)
        self.assertEqual(len(rows), 25)
        for name, most in (("force pulled forth again", 1e-6), ("force pulled back again", 1e-6), ("work of a cycle", 1e-3),
                           ("work and the loop's area", 0.2)):
            self.assertLess(off[name], most, name)
        report = study.xml.etree.ElementTree.parse(self.place / "report.xml").getroot()
        slides = study.listed(report, "Steps", "back 2: -1", "Contact", "joint")
        self.assertEqual(float(study.listed(slides, "Stick Area")), 0)
        force, pressing = study.listed(slides, "Tangential Force").strip("{}").split(","), float(study.listed(slides, "Force"))
        self.assertAlmostEqual(abs(float(force[0])) / (0.15 * pressing), 1, places=2)
        turned = study.listed(report, "Steps", "back 2: 0.8", "Contact", "joint")
        self.assertGreater(float(study.listed(turned, "Stick Area")), 0)
        bolt = study.listed(report, "Steps", "bolt", "Preload", "bolt")
        self.assertEqual(float(study.listed(bolt, "Force")), 2500)

    def test_a_block_that_is_driven_back_slides_as_it_did_the_other_way(self):
        ended = subprocess.run([EPAFI, SOURCE / "xml/driven_block.xml", "--quiet", "--output", self.place, "--set",
                                "Bodies/block/Elements={40,20}", "--set", "Solver/Tolerance=1e-9"],
                               capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual((ended.returncode, ended.stderr), (COMPLETE, ""))
        with open(self.place / "steps.csv", newline="", encoding="utf-8") as stream:
            steps = {row["step"]: {name: float(row[name]) for name in row if name not in ("step", "contact")}
                     for row in csv.DictReader(stream)}
        self.assertEqual(list(steps)[-1], "left 0")
        right, left, press = steps["right 1"], steps["left 0"], steps["press"]
        for way, sign in ((right, 1), (left, -1)):
            self.assertEqual(way["stick_area"], 0)
            self.assertAlmostEqual(way["tangential_x"] / way["force"], 0.4 * sign, places=6)
            self.assertAlmostEqual(way["slip_area"] + way["open_area"], 40, places=9)
        self.assertAlmostEqual(left["force"] / right["force"], 1, places=6)
        self.assertLess(abs(press["tangential_x"]), 1e-9 * press["force"])
        self.assertGreater(press["stick_area"], 0)

    def test_one_contact_may_have_coulombs_law_and_another_one_given_bounds(self):
        tree = xml.etree.ElementTree.parse(SOURCE / "xml/driven_block.xml")
        lists = {entry.get("name"): entry for entry in tree.getroot()}
        tree.getroot().remove(lists["Steps"])
        lists["Obstacles"].append(xml.etree.ElementTree.fromstring(
            '<ParameterList name="wall"><Parameter name="Kind" type="string" value="plane"/><Parameter name="Point" '
            'type="Array(double)" value="{40, 0}"/><Parameter name="Normal" type="Array(double)" value="{-1, 0}"/></ParameterList>'))
        lists["Contact"].append(xml.etree.ElementTree.fromstring(
            '<ParameterList name="side"><Parameter name="First Body" type="string" value="block"/><Parameter name="First Surface" '
            'type="string" value="right"/><Parameter name="Obstacle" type="string" value="wall"/>'
            '<Parameter name="Friction Bound" type="double" value="0.002"/></ParameterList>'))
        tree.write(self.place / "both.xml")
        for ranks in (1, 2):
            ended = subprocess.run([*LAUNCH, str(ranks), EPAFI, self.place / "both.xml", "--quiet", "--output", self.place, "--set",
                                    "Bodies/block/Supports/drive/X=0", "--set", "Bodies/block/Elements={24,12}", "--set",
                                    "Solver/Tolerance=1e-10"], capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual((ended.returncode, ended.stderr), (COMPLETE, ""))
            with h5py.File(self.place / "both.h5") as file:
                side, foot = ({name: file[f"contact/{pair}/{name}"][:] for name in ("traction", "pressure", "friction_state")}
                              for pair in ("side", "foot"))
            slips = side["friction_state"] == 1
            self.assertGreater(slips.sum(), 10)
            length = numpy.linalg.norm(side["traction"], axis=1)
            self.assertLess(length.max(), 0.002 * (1 + 1e-9))
            self.assertLess(abs(length[slips] - 0.002).max(), 1e-9)
            slips = foot["friction_state"] == 1
            self.assertGreater(slips.sum(), 10)
            length = numpy.linalg.norm(foot["traction"], axis=1)
            self.assertLess((length - 0.4 * foot["pressure"]).max(), 1e-9)
            self.assertLess(abs(length - 0.4 * foot["pressure"])[slips].max(), 1e-6 * foot["pressure"].max())

    def test_slip_is_the_displacement_along_the_floor_and_traction_within_coulombs_law_at_each_node(self):
        (self.place / "cube.geo").write_text(CUBE, encoding="utf-8")
        for mesh in ("plane", "space", "cube.geo"):
            with self.subTest(mesh=mesh):
                (self.place / "pushed.xml").write_text(pushed(mesh), encoding="utf-8")
                ended = subprocess.run([EPAFI, self.place / "pushed.xml", "--quiet", "--output", self.place],
                                       capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual((ended.returncode, ended.stderr), (COMPLETE, ""))
                with h5py.File(self.place / "pushed.h5", "r") as file:
                    body, contact = file["bodies/block"], file["contact/floor"]
                    points, u = body["points"][:], body["u"][:]
                    places, slip, traction, pressure, state = (contact[name][:] for name in
                                                               ("points", "slip", "traction", "pressure", "friction_state"))
                nodes = [int(numpy.argmin(numpy.linalg.norm(points - place, axis=1))) for place in places]
                along = u.shape[1] - 1
                slips, size = state == 1, numpy.abs(slip).max()
                self.assertGreater(slips.sum(), 4)
                self.assertGreater(size, 1e-3)
                closed = state > 0
                off = numpy.abs(slip[closed][:, :along] - u[nodes][closed][:, :along]).max()
                self.assertLess(off, 1e-6 * size)
                length = numpy.linalg.norm(traction, axis=1)
                self.assertLess((length - 0.2 * pressure).max(), 1e-6 * pressure.max())

    def products(self, scene, *changes):
        ended = subprocess.run([EPAFI, SOURCE / "xml" / scene, "--quiet", "--report", self.place / "report.xml",
                                *(word for change in changes for word in ("--set", change))],
                               capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual((ended.returncode, ended.stderr), (COMPLETE, ""))
        report = xml.etree.ElementTree.parse(self.place / "report.xml")
        return int(report.find(".//ParameterList[@name='Iterations']/Parameter[@name='Hessian Multiplications']").get("value"))

    def test_planes_of_symmetry_cost_friction_nothing(self):
        """Facets' normals leave such planes; rows of friction along that error took products by the hundred."""
        coarse = ("Bodies/rail/Mesh Size Factor=2.5", "Bodies/wheel/Mesh Size Factor=2.5")
        without = self.products("wheel_on_rail.xml", *coarse)
        for law in ("Friction=0.3", "Friction Bound=1e6"):
            self.assertLess(self.products("wheel_on_rail.xml", *coarse, "Contact/touch/" + law), 2 * without, law)

    def test_a_pin_that_floats_sticks_at_first(self):
        """The forces that balance it are no sign of what slips: begun with these as slip it took 3892 products, now about 70."""
        found = self.products("lug.xml", "Bodies/lug/Order=1", "Bodies/pin/Order=1", "Accuracy/Coarser Start=10000000",
                              "Contact/bearing/Friction=0.3")
        self.assertLess(found, 200)

    def assert_one_grid_a_step(self, directory):
        (series,) = xml.etree.ElementTree.parse(directory / "pushed.xdmf").findall("./Domain/Grid")
        self.assertEqual(series.get("CollectionType"), "Temporal")
        self.assertEqual([(step.get("Name"), step.find("Time").get("Value")) for step in series],
                         [("press it", "1"), ("aside", "2"), ("back", "3")])
        meshes = {tuple(step.find(f"./Grid/{part}/DataItem").text for part in ("Topology", "Geometry")) for step in series}
        self.assertEqual(len(meshes), 1)
        self.assertIn("pushed.h5:/steps/aside/contact/floor/slip", [item.text for item in series[1].iter("DataItem")])
        with h5py.File(directory / "pushed.h5") as file:
            for item in series.iter("DataItem"):
                self.assertEqual(tuple(map(int, item.get("Dimensions").split())), file[item.text.split(":")[1]].shape, item.text)

    def assert_steps_of_one_mesh(self, file, shorter):
        """Blocks of all steps, the first two steps' as if the run had ended there."""
        text = file.read_text(encoding="utf-8")
        self.assertEqual(re.findall("^    1PNAME +(.+)$", text, re.MULTILINE), [name for name in STEPS for _ in range(5)])
        self.assertEqual(re.findall("^ -4  ([A-Z]+) ", text, re.MULTILINE), 3 * ["DISP", "STRESS", "TOSTRAIN", "FORC", "CONTACT"])
        self.assertEqual(text.count("    2C"), 1)
        self.assertTrue(text.endswith("\n -3\n 9999\n"))
        self.assertTrue(text.startswith(shorter.read_text(encoding="utf-8").removesuffix(" 9999\n")))

    def test_the_files_have_the_fields_of_every_load_step_as_if_the_run_had_ended_there(self):
        for ranks in (1, 2):
            def solved(number, ranks=ranks):
                directory = self.place / f"{ranks}_{number}"
                (self.place / "pushed.xml").write_text(in_steps(list(STEPS)[:number]), encoding="utf-8")
                ended = subprocess.run([*LAUNCH, str(ranks), EPAFI, self.place / "pushed.xml", "--quiet", "--output", directory,
                                        "--frd", directory / "pushed.frd"], capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual((ended.returncode, ended.stderr), (COMPLETE, ""))
                return directory
            directory = solved(3)
            self.assert_one_grid_a_step(directory)
            self.assert_steps_of_one_mesh(directory / "pushed.frd", solved(2) / "pushed.frd")
            with h5py.File(directory / "pushed.h5") as whole:
                steps = sorted(whole["steps"].values(), key=lambda step: step.attrs["number"])
                self.assertEqual([step.attrs["name"].decode() for step in steps], list(STEPS))
                for number, step in enumerate(steps, 1):
                    with h5py.File(solved(number) / "pushed.h5") as short, self.subTest(ranks=ranks, number=number):
                        self.assertEqual(step.attrs["energy"], short.attrs["energy"])
                        found, expected = fields_of(step), fields_of(short)
                        self.assertEqual(found.keys(), expected.keys())
                        for name, values in expected.items():
                            numpy.testing.assert_array_equal(found[name], values, name)
                u = [step["bodies/block/u"][:] for step in steps]
                self.assertGreater(min(abs(u[0] - u[1]).max(), abs(u[1] - u[2]).max()), 1e-3)

    def test_the_study_writes_tables_and_says_what_went_wrong(self):
        ended = run("--program", EPAFI, "--output", self.place, "--factor", 4)
        self.assertEqual((ended.returncode, ended.stderr), (COMPLETE, ""))
        for name, first in (("traction", "x"), ("loop", "displacement"), ("joint", "displacement")):
            with open(self.place / f"friction_{name}.csv", newline="", encoding="utf-8") as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual({row["source"] for row in rows} - {"closed form", "thin strip"}, {"computed"})
            self.assertTrue(all(math.isfinite(float(row[first])) for row in rows))
        ended = run("--program", "/bin/false", "--output", self.place)
        self.assertEqual(ended.returncode, FAILED)
        self.assertIn("cattaneo_mindlin ended with code 1", ended.stderr)
        self.assertEqual(run("--program", self.place).returncode, WRONG_USAGE)
        self.assertEqual(run("--program", EPAFI, "--factor", 0).returncode, WRONG_USAGE)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
