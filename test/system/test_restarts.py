#!/usr/bin/python3
"""test_restarts.py EPAFI SOURCE_DIR EPAFI_WITH_FAULTS FAULTY_RANKS MPIRUN ARGUMENTS...: load steps that an earlier run has done are
not done again, and what comes after them is what one run finds."""

import csv
import os
import re
import shutil
import signal
import unittest
import xml.etree.ElementTree

import h5py
import numpy

from running import PROGRAM, SOLVED, FAILED, WITH_FAULTS, WRONG_INPUT, Run, run, scene


def body(name, box, elements, supports):
    return f"""<ParameterList name="{name}">
  <Parameter name="Physics" type="string" value="elasticity 3-D"/>
  <Parameter name="Box" type="Array(double)" value="{{{box}}}"/>
  <Parameter name="Elements" type="Array(int)" value="{{{elements}}}"/>
  <Parameter name="Order" type="int" value="1"/>
  <Parameter name="Young's Modulus" type="double" value="200"/>
  <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
  <ParameterList name="Supports">{supports}</ParameterList>
</ParameterList>"""


def support(name, surface, **components):
    values = "".join(f'<Parameter name="{axis}" type="double" value="{value}"/>' for axis, value in components.items())
    return f'<ParameterList name="{name}"><Parameter name="Surface" type="string" value="{surface}"/>{values}</ParameterList>'


def strings(name, **words):
    return f'<ParameterList name="{name}">' + "".join(
        f'<Parameter name="{key.replace("_", " ")}" type="{"double" if isinstance(value, float) else "string"}" value="{value}"/>'
        for key, value in words.items()) + "</ParameterList>"


ROLLERS = support("x", "left", X=0) + support("y", "front", Y=0)
PLANE = ('<ParameterList name="{}"><Parameter name="Kind" type="string" value="plane"/><Parameter name="Point" '
         'type="Array(double)" value="{{{}}}"/><Parameter name="Normal" type="Array(double)" value="{{{}}}"/></ParameterList>')
# A bolt that is tightened and then locked, and beside it a block that is pressed on a floor and pushed, held where it is, and
# pulled back, when the stop that it has met on its way is gone.
STEPS = {"tighten": dict(Supports="block/push = 0.5"),
         "lock": dict(Preload="bolt = locked", Supports="upper/wall = 1, block/push = 1"),
         "hold": dict(Supports="block/push = fixed", Contacts="stop = off"),
         "aside": dict(Supports="block/push = 0.3, upper/wall = 3"),
         "back": dict(Supports="block/push = -0.2", Friction="floor = 0.1")}


def bolt_and_block(steps):
    bodies = (body("lower", "0, 0.5, 0, 1, 0, 1.5", "2, 2, 3", ROLLERS + support("foot", "bottom", Z=0)) +
              body("upper", "0, 0.5, 0, 1, 1.5, 4", "2, 2, 4", ROLLERS + support("wall", "top", Z=0.001)) +
              body("block", "2, 3, 0, 1, 0, 1", "4, 4, 4", support("push", "top", X=0.004, Y=0.002, Z=-0.01)))
    contacts = (strings("bolt", First_Body="lower", First_Surface="top", Second_Body="upper", Second_Surface="bottom",
                        Kind="tied", Preload="force 3") +
                strings("floor", First_Body="block", First_Surface="bottom", Obstacle="floor", Friction=0.2) +
                strings("stop", First_Body="block", First_Surface="right", Obstacle="stop"))
    return ('<ParameterList name="Epafi"><ParameterList name="Bodies">' + bodies + '</ParameterList><ParameterList name="Obstacles">' +
            PLANE.format("floor", "0, 0, 0", "0, 0, 1") + PLANE.format("stop", "3.0045, 0, 0", "-1, 0, 0") +
            '</ParameterList><ParameterList name="Contact">' + contacts + '</ParameterList><ParameterList name="Decomposition">'
            '<Parameter name="Grid" type="Array(int)" value="{2, 1, 1}"/></ParameterList><ParameterList name="Steps">' +
            "".join(strings(name, **STEPS[name]) for name in steps) + '</ParameterList><ParameterList name="Solver">'
            '<Parameter name="Tolerance" type="double" value="1e-12"/>'
            '<Parameter name="Equilibrium Tolerance" type="double" value="1e-12"/></ParameterList></ParameterList>')


def numbers_of(directory):
    """All numbers that the report has of load steps, by their paths, but for counts and what balances to round-off."""
    found = {}

    def enter(item, path):
        for part in item:
            name = f"{path}/{part.get('name')}"
            if part.tag == "ParameterList":
                enter(part, name)
            elif part.get("type") in ("double", "Array(double)") and "Imbalance" not in name and "Feedback" not in name and (
                    "Penetration" not in name):
                found[name] = numpy.array([float(word) for word in part.get("value").strip("{}").split(",")])
    (steps,) = xml.etree.ElementTree.parse(directory / "report.xml").findall("./ParameterList[@name='Steps']")
    enter(steps, "")
    return found


def history_of(directory):
    with open(directory / "history.csv", newline="", encoding="utf-8") as stream:
        return [(row["iteration"], row["step"], row["hessian_multiplications"]) for row in csv.DictReader(stream)]


class Restarts(Run):
    def solved(self, file, directory, *arguments, ranks=1):
        ended = run(PROGRAM, file, "--output", directory, *arguments, ranks=ranks)
        self.assertEqual((ended.returncode, ended.stderr), (SOLVED, ""), ended.stdout)
        return ended.stdout

    def bolted(self, *steps):
        """The scene with these steps, in a file of its name."""
        file = self.place / f"{len(steps)}" / "bolted.xml"
        file.parent.mkdir(exist_ok=True)
        file.write_text(bolt_and_block(steps or STEPS), encoding="utf-8")
        return file

    def pushed(self, base, *steps):
        """A block that slides to and fro on one with so many elements: on its nodes, or on mortars."""
        moves = {"press": 0.2, "right": 1.0, "left": -0.5}
        bodies = (body("base", "0, 1, 0, 1, -1, 0", base, support("foot", "bottom", X=0, Y=0, Z=0)) +
                  body("block", "0, 1, 0, 1, 0, 1", "4, 4, 2", support("push", "top", X=0.01, Y=0.004) + support("weight", "top", Z=-0.01)))
        file = self.place / f"pushed{base[0]}{len(steps)}" / "pushed.xml"
        file.parent.mkdir(exist_ok=True)
        file.write_text('<ParameterList name="Epafi"><ParameterList name="Bodies">' + bodies +
                        '</ParameterList><ParameterList name="Contact">' + strings(
                            "joint", First_Body="block", First_Surface="bottom", Second_Body="base", Second_Surface="top",
                            Friction=0.1) + '</ParameterList><ParameterList name="Steps">' +
                        "".join(strings(step, Supports=f"block/push = {moves[step]}") for step in steps) +
                        '</ParameterList></ParameterList>', encoding="utf-8")
        return file

    def assert_same(self, directory, whole, digits=1e-10):
        """With fewer digits a node at the rim of what sticks may stick or slip: areas are of whole nodes."""
        found, expected = ({name: values for name, values in numbers_of(run).items() if digits <= 1e-10 or "Area" not in name}
                           for run in (directory, whole))
        self.assertEqual(list(found), list(expected))
        largest = {}

        def kind(name):
            return "Moment" if "Moment" in name else name.split("/")[-1]  # some of these are differences
        for name, values in expected.items():
            largest[kind(name)] = max(largest.get(kind(name), 0), numpy.abs(values).max())
        for name, values in expected.items():
            self.assertLessEqual(numpy.abs(found[name] - values).max(), digits * largest[kind(name)], name)
        (file,) = whole.glob("*.h5")
        with h5py.File(directory / file.name) as fields, h5py.File(file) as known:
            self.assertEqual({step.attrs["name"] for step in fields["steps"].values()},
                             {step.attrs["name"] for step in known["steps"].values()})
            for step in known["steps"]:
                for name in known[f"steps/{step}/bodies"]:
                    u = known[f"steps/{step}/bodies/{name}/u"][:]
                    self.assertLessEqual(numpy.abs(fields[f"steps/{step}/bodies/{name}/u"][:] - u).max(), digits * numpy.abs(u).max())
            numpy.testing.assert_array_equal(fields["bodies"].keys(), known["bodies"].keys())
            series = xml.etree.ElementTree.parse((directory / file.name).with_suffix(".xdmf"))
            self.assertEqual([time.get("Value") for time in series.iter("Time")],
                             [str(k + 1) for k in range(len(known["steps"]))])
            for item in series.iter("DataItem"):
                self.assertIn(item.text.split(":")[1], fields)

    def test_after_any_step_what_follows_is_what_one_run_finds(self):
        """Where rows stay and where they change, on other numbers of ranks, in the same directory and in another one."""
        whole = self.place / "whole"
        self.solved(self.bolted(), whole)
        names = list(STEPS)
        for done, ranks in ((1, (1, 1)), (2, (1, 1)), (3, (3, 2)), (4, (2, 3)), (2, (1, 3))):
            with self.subTest(done=done, ranks=ranks):
                first = self.place / f"first{done}{ranks[1]}"
                self.killed_after(done, first, ranks[0])
                again = first if ranks[1] == 1 else self.place / f"again{done}{ranks[1]}"
                said = self.solved(self.bolted(), again, "--restart", first / "checkpoint.epafi", ranks=ranks[1])
                self.assertIn(f"restart     after step {names[done - 1]}, {done} of 5", said)
                self.assertEqual(re.findall("^  step +([a-z ]+):", said, re.MULTILINE), names[done:4])
                self.assert_same(again, whole)
                if ranks == (1, 1):
                    self.assertEqual(history_of(again), history_of(whole))

    def killed_after(self, number, directory, ranks):
        """A run that is killed when it has solved the step behind so many, before any file is of that one (seven files a step)."""
        ended = run(WITH_FAULTS, self.bolted(), "--output", directory, ranks=ranks,
                    env={**os.environ, "EPAFI_TEST_KILL": f"0:{7 * number + 1}"})
        self.assertNotEqual(ended.returncode, SOLVED)
        self.assertEqual(ended.stdout.count("\n  step        "), number, ended.stdout)

    def test_steps_may_be_added_to_those_that_are_done(self):
        """A run of the first steps alone does not know which supports the next one would hold."""
        whole, first = self.place / "whole", self.place / "first"
        self.solved(scene("clamped_strap"), whole, "--set", "Solver/Tolerance=1e-10")
        tree = xml.etree.ElementTree.parse(scene("clamped_strap"))
        (steps,) = tree.findall("./ParameterList[@name='Steps']")
        for step in list(steps)[6:]:
            steps.remove(step)
        tree.write(self.place / "clamped_strap.xml")
        for ranks in ((1, 1), (2, 3)):
            with self.subTest(ranks=ranks):
                self.solved(self.place / "clamped_strap.xml", first, "--set", "Solver/Tolerance=1e-10", ranks=ranks[0])
                again = self.place / f"again{ranks[1]}"
                self.solved(scene("clamped_strap"), again, "--set", "Solver/Tolerance=1e-10", "--restart",
                            first / "checkpoint.epafi", ranks=ranks[1])
                self.assert_same(again, whole)
        self.solved(self.bolted("tighten", "lock"), first)
        self.expect(run(PROGRAM, self.bolted(), "--restart", first / "checkpoint.epafi"), WRONG_INPUT, 'support "block/push"',
                    'after step "lock"')

    def test_stopped_within_a_step_it_goes_on_with_that_one(self):
        whole, first, again = (self.place / name for name in ("whole", "first", "again"))
        slow = ["--set", "Bodies/strap/Elements={400,16}", "--set", "Solver/Tolerance=1e-10"]
        process = self.start(PROGRAM, scene("clamped_strap"), *slow, "--output", first, ranks=2)
        self.reach(process, "  step        ", 3)
        process.send_signal(signal.SIGUSR1)
        ended = self.finish(process)
        self.assertEqual(ended.returncode, FAILED, ended.stdout + ended.stderr)
        number = ended.stdout.count("\n  step        ")
        said = self.solved(scene("clamped_strap"), again, *slow, "--restart", first / "checkpoint.epafi")
        self.assertIn(f", {number} of 13", said)
        self.solved(scene("clamped_strap"), whole, *slow)
        self.assert_same(again, whole, 1e-6)  # from other starts, to a tolerance of 1e-10

    def test_fields_that_are_not_there_any_more_are_named(self):
        first, again, moved = (self.place / name for name in ("first", "again", "moved"))
        self.solved(self.bolted("tighten"), first)
        moved.mkdir()
        shutil.copy(first / "checkpoint.epafi", moved)
        ended = run(PROGRAM, self.bolted("tighten", "lock"), "--output", again, "--restart", moved / "checkpoint.epafi", ranks=2)
        self.expect(ended, FAILED, 'fields of step "tighten" are not in the files', "bolted.h5")
        with h5py.File(again / "bolted.h5") as fields:
            self.assertEqual([step.attrs["number"] for step in fields["steps"].values()], [2])

    def test_slip_in_files_for_calculix_is_counted_from_the_first_step_on(self):
        """CSLIP at the end, on the floor and between blocks meshed alike or apart."""
        def slips(file):
            text = file.read_text(encoding="utf-8")
            rows = [line for line in text[text.rindex(" -4  CONTACT"):].splitlines() if line.startswith(" -1")]
            return numpy.array([[float(row[13 + 12 * k:25 + 12 * k]) for k in range(6)] for row in rows])

        for base in ("4, 4, 2", "3, 5, 2"):
            with self.subTest(base=base):
                whole, first, again = (self.place / f"{name}{base[0]}" for name in ("whole", "first", "again"))
                files = {run: run.with_suffix(".frd") for run in (whole, again)}
                self.solved(self.pushed(base, "press", "right", "left"), whole, "--frd", files[whole])
                self.solved(self.pushed(base, "press", "right"), first, ranks=2)
                self.solved(self.pushed(base, "press", "right", "left"), again, "--frd", files[again], "--restart",
                            first / "checkpoint.epafi")
                known, found = slips(files[whole]), slips(files[again])
                self.assertGreater(numpy.abs(known[:, 1:3]).max(), 5e-4)
                numpy.testing.assert_allclose(found, known, rtol=1e-5, atol=1e-7)

    def test_another_mesh_is_refused_where_rows_change_too(self):
        """The scene has the same words: only the file that it names, or one that this merges, has others."""
        (self.place / "blocks").mkdir()
        geometry = self.place / "blocks" / "block.geo"
        surfaces = {"bottom": 5, "top": 6, "right": 2}
        geometry.write_text('Merge "size.geo";\nSetFactory("OpenCASCADE");\nBox(1) = {2, 0, 0, 1, 1, 1};\n' + "".join(
            f'Physical Surface("{name}") = {{{number}}};\n' for name, number in surfaces.items()) +
            'Physical Volume("block") = {1};\nMeshSize{ PointsOf{ Volume{1}; } } = size;\n', encoding="utf-8")
        for names in (("tighten",), ("tighten", "lock")):
            file = self.bolted(*names)
            text = file.read_text(encoding="utf-8")
            block = text.index('name="block"')
            text = text[:block] + re.sub('<Parameter name="Box".*?/>\n *<Parameter name="Elements".*?/>', (
                f'<Parameter name="Mesh" type="string" value="{geometry}"/><Parameter name="Group" type="string" value="block"/>'),
                text[block:], count=1)
            text = re.sub('<ParameterList name="Decomposition">.*?</ParameterList>', "", text)
            file.write_text(text, encoding="utf-8")
        size, first = self.place / "blocks" / "size.geo", self.place / "first"
        size.write_text("size = 0.4;\n", encoding="utf-8")
        self.solved(self.place / "1" / "bolted.xml", first)
        again = [PROGRAM, self.place / "2" / "bolted.xml", "--restart", first / "checkpoint.epafi"]
        self.assertEqual(run(*again, ranks=2).returncode, SOLVED)
        size.write_text("size = 0.3;\n", encoding="utf-8")
        for ranks in (1, 2):
            self.expect(run(*again, ranks=ranks), WRONG_INPUT, 'body "block" has another mesh')

    def test_other_scenes_and_other_steps_are_refused(self):
        first = self.place / "first"
        self.solved(self.bolted("tighten", "lock"), first)
        scenes = {"none": re.sub('<ParameterList name="Steps">.*</ParameterList>(?=<ParameterList name="Solver">)', "",
                                 self.bolted().read_text())}
        scenes["other"] = self.bolted().read_text().replace('value="200"', 'value="201"', 1)
        for name, text in scenes.items():
            (self.place / f"{name}.xml").write_text(text, encoding="utf-8")
        for ranks in (1, 3):
            for file, words in ((self.place / "none.xml", ["between load steps", "has none"]),
                                (self.place / "other.xml", ["another scene"]),
                                (self.bolted("tighten", "lock"), ["all 2 load steps"]),
                                (self.bolted("tighten"), ['step "lock" as number 2', "no more"])):
                with self.subTest(file=file, ranks=ranks):
                    ended = run(PROGRAM, file, "--restart", first / "checkpoint.epafi", ranks=ranks)
                    self.expect(ended, WRONG_INPUT, *words)
            ended = run(PROGRAM, self.bolted(), "--set", "Steps/tighten/Supports=block/push = 0.6", "--restart",
                        first / "checkpoint.epafi", ranks=ranks)
            self.expect(ended, WRONG_INPUT, 'step "tighten" with other words')


if __name__ == "__main__":
    unittest.main(argv=[__file__])
