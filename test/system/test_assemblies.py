#!/usr/bin/python3
"""test_assemblies.py EPAFI SOURCE_DIR MPIRUN ARGUMENTS...: STEP files, completed by a few lines, from the file to an answer."""

import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

EPAFI, SOURCE, LAUNCH = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
SOLVED, FAILED, WRONG_INPUT, NOT_SOLVABLE = range(4)
LIMIT = 240  # seconds
LINES = 12  # of XML, at most

BLOCKS = """<ParameterList name="Blocks">
  <ParameterList name="Assembly">
    <Parameter name="Material" type="string" value="steel"/>
    <ParameterList name="Supports">
      <Parameter name="lower block/plane -z" type="string" value="fixed"/>
      <Parameter name="upper block/plane +z" type="string" value="xy"/>
    </ParameterList>
    <ParameterList name="Pressures">
      <Parameter name="upper block/plane +z" type="double" value="5"/>
    </ParameterList>
  </ParameterList>
</ParameterList>"""
PIN = """<ParameterList name="Pin in a lug">
  <ParameterList name="Assembly">
    <Parameter name="Material" type="string" value="steel"/>
    <ParameterList name="Supports">
      <Parameter name="lug/plane -z" type="string" value="fixed"/>
      <Parameter name="pin/plane" type="string" value="xy"/>
    </ParameterList>
    <ParameterList name="Forces">
      <Parameter name="pin/plane" type="Array(double)" value="{0, 0, 10000}"/>
    </ParameterList>
  </ParameterList>
</ParameterList>"""
SHRINK_FIT = """<ParameterList name="Shrink fit">
  <ParameterList name="Assembly">
    <Parameter name="Material" type="string" value="steel"/>
    <ParameterList name="Supports">
      <Parameter name="ring/cylinder r=40" type="string" value="around"/>
      <Parameter name="ring/plane -z" type="string" value="z"/>
      <Parameter name="shaft/plane -z" type="string" value="z around z"/>
    </ParameterList>
  </ParameterList>
</ParameterList>"""

BALL = """<ParameterList name="Ball in a socket">
  <ParameterList name="Assembly">
    <Parameter name="Material" type="string" value="steel"/>
    <ParameterList name="Supports">
      <Parameter name="base/plane -z" type="string" value="fixed"/>
      <Parameter name="lid/plane +x" type="string" value="x"/> <Parameter name="lid/plane +y" type="string" value="y"/>
      <Parameter name="ball/sphere" type="string" value="around z"/> <Parameter name="ball/point 0 0 -6" type="string" value="xy"/>
    </ParameterList>
    <ParameterList name="Pressures"><Parameter name="lid/plane +z" type="double" value="0.3125"/></ParameterList>
  </ParameterList>
</ParameterList>"""


def step(name):
    return SOURCE / "test/assembly" / f"{name}.step"


def run(*arguments, ranks=1):
    launch = [*LAUNCH, str(ranks)] if ranks > 1 else []
    return subprocess.run([*launch, EPAFI, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=LIMIT, check=False)


class Assemblies(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def write(self, text):
        self.assertLessEqual(len(text.splitlines()), LINES)
        file = self.place / "scene.xml"
        file.write_text(text, encoding="utf-8")
        return file

    def contact(self, name, text, pair, ranks=1, *options):
        """What the report says of a pair, as numbers."""
        report = self.place / "report.xml"
        done = run(step(name), self.write(text), "--report", report, *options, ranks=ranks)
        self.assertEqual(done.returncode, SOLVED, done.stdout + done.stderr)
        entries = xml.etree.ElementTree.parse(report).findall(
            f"ParameterList[@name='Contact']/ParameterList[@name='{pair}']/Parameter")
        values = {entry.get("name"): entry.get("value") for entry in entries if entry.get("type") != "string"}
        return {key: [float(part) for part in value.strip("{}").split(",")] for key, value in values.items()}

    def test_blocks_carry_what_presses_them_whatever_the_unit_of_the_file(self):
        for name, ranks in (("blocks", 1), ("blocks_inch", 2)):
            found = self.contact(name, BLOCKS, "upper block - lower block", ranks)
            self.assertAlmostEqual(found["Resultant"][2], 2000, delta=2000 * 1e-8)
            self.assertAlmostEqual(found["Contact Area"][0], 400, delta=1e-3)
            notes = xml.etree.ElementTree.parse(self.place / "report.xml").find(".//Parameter[@name='Notes']").get("value")
            self.assertIn("upper block - lower block: plane on plane, area 400, gap 0", notes)

    def test_a_pin_with_clearance_carries_its_force(self):
        found = self.contact("pin_in_lug", PIN, "lug - pin", 2)
        x, y, z = found["Resultant"]
        self.assertAlmostEqual(abs(z), 10000, delta=0.5)  # facets lack some of the ends
        self.assertLess(max(abs(x), abs(y)), 5)  # the guide takes it
        self.assertLess(found["Force Imbalance"][0], 1e-8 * 10000)

    def test_a_pin_that_nothing_guides_is_held_against_turning_and_sliding_if_asked(self):
        free = re.sub(".*pin/plane.*xy.*\\n", "", PIN)
        refused = run(step("pin_in_lug"), self.write(free))
        self.assertEqual(refused.returncode, NOT_SOLVABLE, refused.stdout + refused.stderr)
        for ranks in (1, 2):
            found = self.contact("pin_in_lug", free, "lug - pin", ranks, "--set", "Free Motions=hold")
            self.assertAlmostEqual(abs(found["Resultant"][2]), 10000, delta=0.5)
            holds = xml.etree.ElementTree.parse(self.place / "report.xml").findall("ParameterList[@name='Holds']/ParameterList")
            self.assertEqual([hold.get("name").partition(" can ")[2][:25] for hold in holds], ["slide along y", "turn about the axis throu"])
            for force in (hold.find("Parameter[@name='Force']") for hold in holds):
                self.assertLess(max(abs(float(part)) for part in force.get("value").strip("{}").split(",")), 1)

    def test_a_shrink_fit_has_lames_pressure(self):
        found = self.contact("shrink_fit", SHRINK_FIT, "ring - shaft")
        k = (40**2 + 19.98**2) / (40**2 - 19.98**2)
        expected = 0.02 * 210000 / (20 * (1 - 0.3) + 19.98 * (k + 0.3))
        self.assertAlmostEqual(found["Force"][0] / (2 * math.pi * 19.98 * 20), expected, delta=0.005 * expected)

    def test_a_ball_that_is_held_against_turning_carries_what_presses_its_lid(self):
        for pair in ("ball - lid", "base - ball"):
            found = self.contact("ball_socket", BALL, pair)
            self.assertAlmostEqual(abs(found["Resultant"][2]), 500, delta=500 * 1e-6)

    def test_pairs_that_are_printed_can_be_pasted(self):
        printed = run(step("blocks"), "--print-pairs")
        self.assertEqual(printed.returncode, SOLVED, printed.stderr)
        text = BLOCKS.replace("\n", "").replace("</ParameterList></ParameterList>", "</ParameterList>", 0)
        pasted = text[:text.rindex("</ParameterList>")] + printed.stdout.replace("\n", "") + "</ParameterList>"
        found = self.contact("blocks", pasted.replace("name=\"upper block - lower block\"", "name=\"joint\""), "joint")
        self.assertAlmostEqual(found["Force"][0], 2000, delta=1e-3)

    def test_the_whole_scene_can_be_written_and_solved(self):
        exported = self.place / "whole.xml"
        done = run(step("blocks"), self.write(BLOCKS), "--export", exported)
        self.assertEqual(done.returncode, SOLVED, done.stderr)
        solved = run(exported)
        self.assertEqual(solved.returncode, SOLVED, solved.stdout + solved.stderr)
        self.assertIn("force 2000", solved.stdout)

    def test_a_picture_shows_the_faces_by_their_numbers(self):
        picture = self.place / "bracket.svg"
        done = run(step("bracket"), "--show", picture, "--list")
        self.assertIn("face 1 ", done.stdout)
        self.assertEqual(done.returncode, SOLVED, done.stderr)
        root = xml.etree.ElementTree.parse(picture).getroot()
        space = "{http://www.w3.org/2000/svg}"
        titles = {title.text for title in root.iter(f"{space}title")}
        numbers = [text.text for text in root.iter(f"{space}text") if text.get("class") is None]
        names = [text.text for text in root.iter(f"{space}text") if text.get("class") == "body"]
        self.assertIn("bracket/face 3, face 3", titles)
        self.assertEqual(len(names), 6)
        self.assertGreaterEqual(len(set(numbers)), 20)  # of 37; others are inside, or hidden by what they touch
        self.assertTrue({f", face {number}" for number in numbers} <= {title[title.rindex(","):] for title in titles})
        plain = self.place / "strap.svg"
        done = run(SOURCE / "xml/bearing.xml", "--show", plain)
        self.assertEqual(done.returncode, SOLVED, done.stderr)
        self.assertIn("<title>", plain.read_text(encoding="utf-8"))
        wrong = run(step("bracket"), "--show", self.place / "bracket.png")
        self.assertEqual((wrong.returncode, wrong.stderr.count("\n")), (WRONG_INPUT, 1))

    def test_lists_name_faces_and_errors_are_sentences(self):
        listed = run(step("bracket"), "--list")
        self.assertEqual(listed.returncode, SOLVED, listed.stderr)
        for words in ("bracket/cylinder r=5.5 z y=-14", "nut M10:2/plane +z", "file: mm", "4 pairs of faces are 0.5 mm apart"):
            self.assertIn(words, listed.stdout)
        wrong = run(step("blocks"), self.write(BLOCKS.replace("plane +z", "plane up", 1)))
        self.assertEqual(wrong.returncode, WRONG_INPUT)
        self.assertIn('no face "upper block/plane up"; there are plane -x (face 7, area 400', wrong.stderr)
        self.assertEqual(run(step("blocks")).returncode, WRONG_INPUT)  # no material
        self.assertIn("is a membrane", run(SOURCE / "xml/coercive.xml", "--list").stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
