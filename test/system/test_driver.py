#!/usr/bin/python3
"""test_driver.py EPAFI SOURCE_DIR MPIRUN ARGUMENTS...: the program as its users meet it: exit codes, messages, files; on one
rank and on several, always within a time limit, so that a rank that waits for ever is a failure."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

PROGRAM, SOURCE, LAUNCH = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
SOLVED, NOT_CONVERGED, WRONG_INPUT, NOT_SOLVABLE = range(4)
LIMIT = 240  # seconds

REPORT = {
    "Epafi": ["Version"],
    "Problem": ["Primal Dimension", "Dual Dimension", "Equality Multipliers", "Inequality Multipliers", "Crosspoints",
                "Subdomains", "Floating Bodies", "Kernel Dimension", "Ranks"],
    "Algorithm": ["Name", "Reason"],
    "Iterations": ["Outer", "CG Steps", "Expansion Steps", "Proportioning Steps", "Hessian Multiplications",
                   "Preconditioner Applications"],
    "Accuracy": ["Relative Projected Gradient", "Feasibility", "Complementarity", "Energy", "Active Contact Nodes",
                 "Contact Force"],
    "Time": ["Assembly", "Setup", "Solve", "Recovery", "Output", "Total"],
    "Memory": ["Peak Bytes", "Factor Bytes"],
    "Status": ["Converged", "Reason"],
}


def scene(name):
    return str(SOURCE / "xml" / f"{name}.xml")


def epafi(*arguments, ranks=1):
    launch = [*LAUNCH, str(ranks)] if ranks > 1 else []
    return subprocess.run([*launch, PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=LIMIT,
                          check=False)


def said(run):
    """The lines the program itself wrote to the error stream; mpirun adds a few about the exit code."""
    return [line for line in run.stderr.splitlines() if line.startswith("epafi: ")]


def read_report(file):
    """{list: {parameter: value as text}}."""
    root = xml.etree.ElementTree.parse(file).getroot()
    return {part.get("name"): {p.get("name"): p.get("value") for p in part.findall("Parameter")}
            for part in root.findall("ParameterList")}


class Driver(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def expect(self, code, words, *arguments, ranks=1):
        """The program ends with `code` and one sentence that holds all `words`."""
        run = epafi(*arguments, ranks=ranks)
        self.assertEqual(run.returncode, code, f"{arguments} on {ranks} ranks: {run.stdout}{run.stderr}")
        sentences = said(run)
        self.assertEqual(len(sentences), 1, run.stderr)
        for word in words:
            self.assertIn(word, sentences[0])

    def changed(self, name, *replacements):
        """A copy of a scene with parts of its text replaced."""
        text = pathlib.Path(scene(name)).read_text(encoding="utf-8")
        for old, new in replacements:
            self.assertIn(old, text)
            text = text.replace(old, new)
        file = self.place / "changed.xml"
        file.write_text(text, encoding="utf-8")
        return file


def coarse(file):
    """What makes a scene with mesh files, or with many elements in space, small."""
    bodies = xml.etree.ElementTree.parse(file).getroot().find("ParameterList[@name='Bodies']")
    words = []
    for body in bodies:
        values = {parameter.get("name"): parameter.get("value") for parameter in body.findall("Parameter")}
        is_space = values.get("Physics") == "elasticity 3-D"
        if "Mesh" in values:
            words += ["--set", f"Bodies/{body.get('name')}/Mesh Size Factor={8 if is_space else 4}"]
        elif is_space:
            halved = ",".join(str(int(number) // 2) for number in values["Elements"].strip("{}").split(","))
            words += ["--set", f"Bodies/{body.get('name')}/Elements={{{halved}}}"]
    return words


class Solves(Driver):
    def test_every_scene_on_one_and_three_ranks(self):
        precise = ["--set", "Solver/Tolerance=1e-10", "--set", "Solver/Equilibrium Tolerance=1e-10"]
        for file in sorted((SOURCE / "xml").glob("*.xml")):
            energies = []
            for ranks in (1, 3):
                report = self.place / "report.xml"
                run = epafi(file, "--report", report, "--output", self.place / "out", *precise, *coarse(file), ranks=ranks)
                self.assertEqual(run.returncode, SOLVED, run.stdout + run.stderr)
                content = read_report(report)
                for part, names in REPORT.items():
                    for name in names:
                        self.assertIn(name, content[part], f"{file.name}: {part}")
                self.assertEqual(content["Status"]["Converged"], "true")
                self.assertEqual(content["Problem"]["Ranks"], str(ranks))
                self.assertLessEqual(float(content["Accuracy"]["Relative Projected Gradient"]), 1e-6)
                energies.append(float(content["Accuracy"]["Energy"]))
                for kind in ("h5", "xdmf"):
                    self.assertTrue((self.place / "out" / f"{file.stem}.{kind}").exists())
            self.assertAlmostEqual(energies[0], energies[1], delta=1e-9 * abs(energies[0]))

    def test_more_ranks_than_subdomains(self):
        self.assertEqual(epafi(scene("single_subdomain"), "--quiet", ranks=4).returncode, SOLVED)

    def test_quiet_says_nothing(self):
        run = epafi(scene("coercive"), "--quiet")
        self.assertEqual((run.returncode, run.stdout, run.stderr), (SOLVED, "", ""))

    def test_the_log_says_what_was_done_and_why(self):
        text = epafi(scene("semicoercive")).stdout
        for word in ("Active sets", "floating", "right", "preconditioner dirichlet", "CHOLMOD", "F explicit", "energy", "memory", "Converged"):
            self.assertIn(word, text)

    def test_printed_parameters_are_the_reference_page(self):
        page = (SOURCE / "docs" / "parameters.md").read_text(encoding="utf-8")
        self.assertEqual(epafi("--print-parameters", ranks=2).stdout, page)
        self.assertTrue(page.startswith("# Parameters\n"))
        self.assertTrue(page.endswith("|\n"))

    def test_a_new_load_by_set(self):
        run = epafi(scene("coercive"), "--quiet", "--set", "Bodies/right/Loads/x/Value=0.25")
        self.assertEqual((run.returncode, run.stderr), (SOLVED, ""))

    def test_help_is_ours_alone(self):
        for ranks in (1, 2):
            run = epafi("--help", ranks=ranks)
            self.assertEqual(run.returncode, SOLVED)
            self.assertTrue(run.stdout.startswith("Usage: epafi"), run.stdout)
            self.assertEqual(run.stdout.count("Usage:"), 1)
            self.assertLess(len(run.stdout.splitlines()), 30)  # a screen

    def test_units_do_not_matter(self):
        # Powers of two round nothing, so that every step is the same, up to the ends of what a scene may hold.
        names = ("left/Loads/upper strip", "right/Loads/lower strip")
        loads = {"left": -1.0, "right": -3.0}
        counts = set()
        for factor in (2.0**-96, 2.0**-30, 1.0, 2.0**30, 2.0**96):
            report = self.place / "report.xml"
            changes = [f"--set=Bodies/{name}/Value={loads[name.split('/')[0]] * factor}" for name in names]
            run = epafi(scene("coercive"), "--quiet", "--report", report, *changes)
            self.assertEqual(run.returncode, SOLVED, run.stderr)
            content = read_report(report)
            counts.add(content["Iterations"]["Hessian Multiplications"])
            self.assertAlmostEqual(float(content["Accuracy"]["Energy"]) / factor**2, -0.11914, delta=1e-4)
        self.assertEqual(len(counts), 1, counts)


class StopsBeforeTheTolerance(Driver):
    def test_exit_code_one_and_a_report_that_says_so(self):
        for ranks in (1, 3):
            report = self.place / "report.xml"
            run = epafi(scene("coercive"), "--set", "Solver/MPRGP/Maximum Multiplications=5", "--report", report,
                        ranks=ranks)
            self.assertEqual(run.returncode, NOT_CONVERGED)
            self.assertIn("MaxIterations", run.stdout)
            content = read_report(report)
            self.assertEqual(content["Status"]["Converged"], "false")
            self.assertGreater(float(content["Accuracy"]["Relative Projected Gradient"]), 1e-6)

    def test_a_tolerance_below_round_off_ends_with_a_reason(self):
        run = epafi(scene("coercive"), "--set", "Solver/Tolerance=1e-17")
        self.assertEqual(run.returncode, NOT_CONVERGED, run.stdout)
        self.assertIn("Stagnated", run.stdout)


class RefusesWrongInput(Driver):
    CASES = [
        (["Bodies/left/Elments", "did you mean"], "Bodies/left/Elments={4,4}"),
        (["Solver/Tolerance", "balanced", "small"], "Solver/Tolerance=small"),
        (["Bodies/left", "Rectangle"], "Bodies/left/Rectangle={1,0,0,1}"),
        (["Bodies/left", "Elements"], "Bodies/left/Elements={-4,4}"),
        (["Bodies/left", "Elements"], "Bodies/left/Elements={32}"),
        (["Conductivity", "-1"], "Bodies/left/Conductivity=-1"),
        (["Conductivity", "nan"], "Bodies/left/Conductivity=nan"),
        (["Value", "inf"], "Bodies/left/Loads/upper strip/Value=inf"),
        (["Edge", "north"], "Bodies/left/Supports/wall/Edge=north"),
        (["First Edge"], "Contact/interface/First Edge=inside"),
        (["First Body", "middle"], "Contact/interface/First Body=middle"),
        (["Coupling", '"auto", "nodes", "mortar"'], "Contact/interface/Coupling=glue"),
        (["Contact/interface"], "Contact/interface/First Edge=top"),
        (["Contact/interface", "left"], "Bodies/left/Supports/wall/Edge=right"),
        (["Grid"], "Decomposition/Grid={33,1}"),
        (["Parts"], "Decomposition/Parts=-1"),
        (["Cluster"], "Decomposition/Cluster=-2"),
        (["Method"], "Decomposition/Method=random"),
        (["Maximum Multiplications"], "Solver/MPRGP/Maximum Multiplications=0"),
        (["Tolerance"], "Solver/Tolerance=0"),
        (["Solver/Direct Solvers", "Tacho"], "Solver/Direct Solvers/Subdomains=Tacho"),
        (["="], "Solver/Tolerance"),
        (['parameter "Value" in list "Bodies/left/Loads/upper strip" is 1e-200', "choose other units."],
         "Bodies/left/Loads/upper strip/Value=1e-200"),
        (["Conductivity", "1e+31", "choose other units."], "Bodies/left/Conductivity=1e31"),
        (["Rectangle", "choose other units."], "Bodies/left/Rectangle={0,1e-40,0,1}"),
        (["do not coincide", "x = 1, y", "x = 1.00000001, y"], "Bodies/right/Rectangle={1.00000001,2,0,1}"),
        (['names the list "Bodies/lefd", which the scene does not have; did you mean "left"?'],
         "Bodies/lefd/Elements={32,32}"),
        (['"Output"', "unknown; allowed are"], "Output/File=x"),
        (["Expansion Step", "> 0 and < 2"], "Solver/MPRGP/Expansion Step=2"),
        (["Balance Reduction", "> 0 and < 1"], "Solver/SMALBE/Balance Reduction=1"),
        (['lacks its parameter "Rectangle"', "must be given"], "Bodies/third/Elements={1,1}"),
    ]

    def test_parameters(self):
        for words, change in self.CASES:
            with self.subTest(change):
                self.expect(WRONG_INPUT, words, scene("coercive"), "--set", change)

    def test_clusters_of_subdomains_that_are_too_small(self):
        for ranks in (1, 2):
            self.expect(WRONG_INPUT, ["is a cluster of its own", "larger"], scene("coercive"), "--set", "Decomposition/Grid={32,32}", "--set",
                        "Decomposition/Cluster=1", ranks=ranks)

    def test_a_suggestion_ends_the_sentence(self):
        for change in ("Contact/interface/First Body=lefft", "Bodies/left/Elments={4,4}", "Decomposition/Method=metsi",
                       "Bodies/lefd/Elements={4,4}"):
            run = epafi(scene("coercive"), "--set", change)
            self.assertTrue(run.stderr.endswith('"?\n'), run.stderr)

    def test_parameters_on_three_ranks(self):
        for words, change in self.CASES[::5]:
            with self.subTest(change):
                self.expect(WRONG_INPUT, words, scene("coercive"), "--set", change, ranks=3)

    def test_files(self):
        empty = self.place / "empty.xml"
        empty.write_text("", encoding="utf-8")
        for ranks in (1, 3):
            self.expect(WRONG_INPUT, ["nowhere.xml"], self.place / "nowhere.xml", ranks=ranks)
            self.expect(WRONG_INPUT, [str(self.place)], self.place, ranks=ranks)
            self.expect(WRONG_INPUT, ["empty.xml"], empty, ranks=ranks)
            self.expect(WRONG_INPUT, ["changed.xml", "line"],
                        self.changed("coercive", ("</ParameterList>\n</ParameterList>", "</ParameterList>")), ranks=ranks)

    def test_values_in_files(self):
        for words, old, new in [
                (["Value", "nan"], 'value="-1.0"', 'value="nan"'),
                (["Value", "abc"], 'value="-1.0"', 'value="abc"'),
                (["Elements", "double"], 'type="Array(int)" value="{32, 32}"', 'type="double" value="32"'),
                (["Conductivty", "Conductivity"], '<Parameter name="Elements"',
                 '<Parameter name="Conductivty" type="double" value="1"/><Parameter name="Elements"'),
                (["left"], '<ParameterList name="right">', '<ParameterList name="left">')]:
            with self.subTest(new):
                self.expect(WRONG_INPUT, words, self.changed("coercive", (old, new)))

    def test_options(self):
        self.expect(WRONG_INPUT, ["--ouput", "--output"], scene("coercive"), "--ouput", "x")
        self.expect(WRONG_INPUT, ["no scene"])
        self.expect(WRONG_INPUT, ["--report"], scene("coercive"), "--report")
        self.expect(WRONG_INPUT, ["two scenes"], scene("coercive"), scene("gap"), ranks=2)

    def test_places_that_cannot_be_written(self):
        blocked = self.place / "file"
        blocked.write_text("", encoding="utf-8")
        for ranks in (1, 3):
            for option in ("--output", "--report"):
                self.expect(WRONG_INPUT, [str(blocked)], scene("coercive"), option, blocked / "out", ranks=ranks)
            self.expect(WRONG_INPUT, [str(blocked)], scene("stacked_blocks"), "--frd", blocked / "out", ranks=ranks)
            self.expect(WRONG_INPUT, ["--frd", "membrane"], scene("coercive"), "--frd", self.place / "out.frd", ranks=ranks)
        self.assertEqual([file.name for file in self.place.iterdir()], ["file"])
        copy = self.changed("stacked_blocks")
        self.expect(WRONG_INPUT, ["overwrite"], copy, "--frd", copy)
        self.expect(WRONG_INPUT, ["--dat", "input decks"], copy, "--dat", self.place / "out.dat")


PLATE = """
Point(1) = {0, 0, 0, 0.5}; Point(2) = {2, 0, 0, 0.5}; Point(3) = {2, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Surface("part") = {1}; Physical Curve("foot") = {1}; Physical Curve("side") = {4};
"""
SLAB = """
Merge "slab.stl";
ClassifySurfaces{40*Pi/180, 1, 1, Pi};
CreateGeometry;
s() = Surface{:}; Surface Loop(1) = s(); Volume(1) = {1}; Physical Volume("part") = {1};
Mesh.MeshSizeMax = 0.7;
e = 1e-3;
f() = Surface In BoundingBox {-e, -e, -e, 1 + e, 1 + e, e}; Physical Surface("foot") = {f()};
l() = Surface In BoundingBox {-e, -e, -e, e, 1 + e, 0.5 + e}; Physical Surface("side") = {l()};
"""
ON_A_FLOOR = """<ParameterList name="Epafi">
  <ParameterList name="Bodies"><ParameterList name="part">
    <Parameter name="Physics" type="string" value="{physics}"/>
    <Parameter name="Mesh" type="string" value="part.geo"/>
    <Parameter name="Young's Modulus" type="double" value="1000"/>
    <Parameter name="Poisson's Ratio" type="double" value="0.3"/>
    <ParameterList name="Supports"><ParameterList name="side">
      <Parameter name="Surface" type="string" value="side"/>{held}
    </ParameterList></ParameterList>
    <ParameterList name="Loads"><ParameterList name="load">
      <Parameter name="Box" type="Array(double)" value="{box}"/>
      <Parameter name="Force" type="Array(double)" value="{force}"/>
    </ParameterList></ParameterList>
  </ParameterList></ParameterList>
  <ParameterList name="Obstacles"><ParameterList name="floor">
    <Parameter name="Kind" type="string" value="plane"/>
    <Parameter name="Point" type="Array(double)" value="{point}"/>
    <Parameter name="Normal" type="Array(double)" value="{normal}"/>
  </ParameterList></ParameterList>
  <ParameterList name="Contact"><ParameterList name="foot">
    <Parameter name="First Body" type="string" value="part"/>
    <Parameter name="First Surface" type="string" value="foot"/>
    <Parameter name="Obstacle" type="string" value="floor"/>
  </ParameterList></ParameterList>
</ParameterList>
"""


class OutlivesGmsh(Driver):
    """Geometries are programs of Gmsh's; what goes wrong in them ends Gmsh alone."""

    def setUp(self):
        super().setUp()
        self.own = self.place / "temporary"
        self.own.mkdir()
        before = os.environ.get("TMPDIR")
        os.environ["TMPDIR"] = str(self.own)
        self.addCleanup(lambda: os.environ.update(TMPDIR=before) if before else os.environ.pop("TMPDIR"))

    def on_a_floor(self, geometry, is_solid=False):
        (self.place / "part.geo").write_text(geometry, encoding="utf-8")
        words = {"physics": "elasticity 3-D", "box": "{0.5, 1, 0.5, 1, 0, 0.5}", "force": "{0, 0, -50}",
                 "point": "{0, 0, 0}", "normal": "{0, 0, 1}"} if is_solid else {
                     "physics": "plane strain", "box": "{1, 2, 0, 1}", "force": "{0, -8}", "point": "{0, 0}",
                     "normal": "{0, 1}"}
        words["held"] = "".join(f'<Parameter name="{axis}" type="double" value="0"/>'
                                for axis in ("XYZ" if is_solid else "X"))
        scene_file = self.place / "part.xml"
        scene_file.write_text(ON_A_FLOOR.format(**words), encoding="utf-8")
        return scene_file

    def test_mistakes_of_geometries_are_wrong_input_and_leave_no_files(self):
        for words, change in ((["part.geo", "Gmsh says"], ("{1, 2, 3, 4}", "{1, 2, 3}")),
                              (["part.geo", "of its own accord"], ("Physical Surface", "Mesh 2; Exit; Physical Surface"))):
            for ranks in (1, 2):
                self.expect(WRONG_INPUT, words, self.on_a_floor(PLATE.replace(*change)), ranks=ranks)
                self.assertEqual([path for path in self.own.iterdir() if path.match("epafi-??????")], [])

    def test_a_mesh_that_fails_on_the_way_to_a_target_leaves_the_last_one(self):
        mark, out, report = self.place / "mark", self.place / "out", self.place / "report.xml"
        once = f'If (FileExists("{mark}")) Exit; EndIf Printf("seen") > "{mark}";'
        for ranks in (1, 2):
            mark.unlink(missing_ok=True)
            run = epafi(self.on_a_floor(PLATE + once + "\n"), "--accuracy", "0.5 %", "--output", out, "--report", report,
                        ranks=ranks)
            self.assertEqual(run.returncode, NOT_CONVERGED, run.stdout + run.stderr)
            self.assertIn("the next mesh failed: Gmsh, at work on", read_report(report)["Status"]["Reason"])
            self.assertTrue((out / "part.h5").exists())

    def test_a_part_from_an_stl_file_is_refined_as_a_mesh_file_is(self):
        corners = [(x, y, z) for z in (0, 0.5) for y in (0, 1) for x in (0, 1)]
        faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
        with open(self.place / "slab.stl", "w", encoding="utf-8") as file:
            print("solid slab", file=file)
            for a, b, c, d in faces:
                for triangle in ((a, b, c), (a, c, d)):
                    print("facet normal 0 0 0\nouter loop", file=file)
                    for corner in triangle:
                        print("vertex", *corners[corner], file=file)
                    print("endloop\nendfacet", file=file)
            print("endsolid slab", file=file)
        run = epafi(self.on_a_floor(SLAB, is_solid=True), "--accuracy", "15 %", "--set", "Accuracy/Order=1",
                    "--set", "Accuracy/Maximum Levels=3", "--quiet", "--report", self.place / "report.xml")
        self.assertIn(run.returncode, (SOLVED, NOT_CONVERGED), run.stderr)
        levels = [part.find("Parameter[@name='Primal Dimension']").get("value") for part in
                  xml.etree.ElementTree.parse(self.place / "report.xml").getroot().find("ParameterList[@name='Levels']")]
        self.assertGreaterEqual(len(levels), 2) # Gmsh's versions mesh alike, but not the same
        self.assertLess(int(levels[-2]), int(levels[-1]))


class RefusesProblemsWithoutASolution(Driver):
    def test_a_floating_body_without_contact(self):
        text = pathlib.Path(scene("semicoercive")).read_text(encoding="utf-8")
        text = re.sub(r'  <ParameterList name="Contact">.*?\n  </ParameterList>\n', "", text, flags=re.S)
        file = self.place / "free.xml"
        file.write_text(text, encoding="utf-8")
        for ranks in (1, 3):
            self.expect(NOT_SOLVABLE, ["no solution", "'right'"], file, ranks=ranks)

    def test_a_load_that_pulls_the_body_away(self):
        for ranks in (1, 3):
            self.expect(NOT_SOLVABLE, ["no solution", "'right'"], scene("semicoercive"), "--set",
                        "Bodies/right/Loads/lower strip/Value=1", ranks=ranks)

    def test_a_load_without_resultant(self):
        for ranks in (1, 3):
            self.expect(NOT_SOLVABLE, ["not unique", "'right'"], scene("semicoercive"), "--set",
                        "Bodies/right/Loads/lower strip/Value=0", ranks=ranks)

    def test_supports_that_overlap(self):
        for ranks in (1, 3):
            self.expect(NOT_SOLVABLE, ["no solution", "'interface'", "overlap by 0.1 at (1, 0)"], scene("coercive"),
                        "--set", "Bodies/left/Supports/wall/Edge=bottom", "--set", "Bodies/left/Supports/wall/Value=0.1",
                        "--set", "Bodies/right/Supports/wall/Edge=bottom", ranks=ranks)

    def test_a_tiny_resultant_of_round_off_is_none(self):
        self.expect(NOT_SOLVABLE, ["not unique", "'right'"], scene("semicoercive"),
                    "--set", "Bodies/right/Loads/up/Value=0.3", "--set", "Bodies/right/Loads/up/Box={1,2,0,0.25}",
                    "--set", "Bodies/right/Loads/down/Value=-0.1", "--set", "Bodies/right/Loads/down/Box={1,2,0.25,1}",
                    "--set", "Bodies/right/Loads/lower strip/Value=0")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
