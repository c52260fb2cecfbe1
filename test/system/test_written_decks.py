#!/usr/bin/python3
"""test_written_decks.py EPAFI SOURCE_DIR MPIRUN ARGUMENTS...: decks as FreeCAD and PrePoMax write them, beside closed forms and,
where it is installed, ccx."""

import itertools
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

EPAFI, LAUNCH = sys.argv[1], sys.argv[3:]
TETRAHEDRA = [(0, 1, 3, 7), (0, 1, 7, 5), (0, 5, 7, 4), (0, 3, 2, 7), (0, 6, 4, 7), (0, 2, 6, 7)]  # of corners x + 2y + 4z
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
FACES = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]  # S1 ... S4


class Mesh:
    """Boxes of C3D10, each with nodes of its own."""

    def __init__(self):
        self.nodes, self.elements, self.bodies = {}, {}, {}

    def box(self, name, low, high, counts):
        known, first = {}, len(self.elements) + 1

        def node(place):
            return known.setdefault(place, len(self.nodes) + len(known) + 1)

        for cell in itertools.product(*map(range, counts)):
            corners = [tuple(2 * (cell[c] + (k >> c & 1)) for c in range(3)) for k in range(8)]
            for tetrahedron in TETRAHEDRA:
                ends = [corners[k] for k in tetrahedron]
                middles = [tuple((a + b) // 2 for a, b in zip(ends[i], ends[j])) for i, j in EDGES]
                self.elements[len(self.elements) + 1] = [node(place) for place in ends + middles]
        for place, number in known.items():
            self.nodes[number] = [a + (b - a) * k / (2 * n) for a, b, k, n in zip(low, high, place, counts)]
        self.bodies[name] = range(first, len(self.elements) + 1)

    def on(self, body, axis, value):
        """Nodes and faces in a plane."""
        faces = [(element, f + 1) for element in self.bodies[body] for f, corners in enumerate(FACES)
                 if all(abs(self.nodes[self.elements[element][k]][axis] - value) < 1e-9 for k in corners)]
        nodes = sorted({node for element in self.bodies[body] for node in self.elements[element]
                        if abs(self.nodes[node][axis] - value) < 1e-9})
        return nodes, faces

    def node_lines(self):
        return "".join(f"{number}, {x:.9g}, {y:.9g}, {z:.9g}\n" for number, (x, y, z) in sorted(self.nodes.items()))

    def element_lines(self, body):
        return "".join(f"{number}, {', '.join(map(str, self.elements[number]))}\n" for number in self.bodies[body])


def lines(entries):
    return "".join(f"{entry},\n" for entry in entries)


def face_lines(faces):
    return "".join(f"{element},S{face}\n" for element, face in faces)


def pressure_lines(faces, value):
    return "".join(f"{element},P{face},{value}\n" for element, face in faces)


def freecad(mesh, sets, constraints, material, step):
    """A deck in the order and with the comments of FreeCAD's writer."""
    body_sets = "".join(f"*ELSET,ELSET={body}\n" + lines(mesh.bodies[body]) for body in mesh.bodies)
    sections = "".join(f"*SOLID SECTION, ELSET={body}, MATERIAL=MechanicalMaterial\n" for body in mesh.bodies)
    elements = "".join(mesh.element_lines(body) for body in mesh.bodies)
    return (f"** Nodes\n*Node, NSET=Nall\n{mesh.node_lines()}\n\n\n** Volume elements\n*Element, TYPE=C3D10, ELSET=Evolumes\n"
            f"{elements}\n** Define element set Eall\n*ELSET, ELSET=Eall\nEvolumes\n\n\n"
            f"***********************************************************\n"
            f"** Element sets for materials and FEM element type (solid, shell, beam, fluid)\n{body_sets}\n{sets}\n"
            f"** Materials\n** see information about units at file end\n** FreeCAD material name: CalculiX-Steel\n"
            f"*MATERIAL, NAME=MechanicalMaterial\n{material}\n** Sections\n{sections}\n{constraints}\n"
            f"***********************************************************\n"
            f"** At least one step is needed to run an CalculiX analysis of FreeCAD\n{step}\n"
            f"** Outputs --> frd file\n*NODE FILE\nU, RF\n*EL FILE\nS, E\n*CONTACT FILE\nCDIS, CSTR\n"
            f"** outputs --> dat file\n** reaction forces for Constraint fixed\n*NODE PRINT, NSET=ConstraintFixed, TOTALS=ONLY\nRF\n"
            f"\n*OUTPUT, FREQUENCY=1\n***********************************************************\n*END STEP\n")


def prepomax(mesh, sets, constraints, step):
    """A deck in the order and with the headings of PrePoMax."""
    def heading(name):
        return f"************************************************************\n**\n** {name} ++++++++++++++++++\n**\n"

    elements = "".join(f"*Element, Type=C3D10, Elset={body}\n{mesh.element_lines(body)}" for body in mesh.bodies)
    sections = "".join(f"*Solid section, Elset={body}, Material=S235\n" for body in mesh.bodies)
    return (f"{heading('Heading')}*Heading\nHash: 4iFSbEkG, Date: 01.02.2024, Unit system: MM_TON_S_C\n"
            f"{heading('Nodes')}*Node\n{mesh.node_lines()}{heading('Elements')}{elements}{sets}"
            f"{heading('Materials')}*Material, Name=S235\n*Density\n7.8E-09\n*Elastic\n210000, 0\n"
            f"{heading('Sections')}{sections}{constraints}{heading('Steps')}{step}"
            f"**\n** Field outputs +++++\n**\n*Node file\nRF, U\n*El file\nS, E, NOE\n*Contact file\nCDIS, CSTR\n**\n*End step\n")


def displacements_in(text):
    block = text[text.rindex(" -4  DISP"):]
    return {int(line[3:13]): [float(line[13 + 12 * c:25 + 12 * c]) for c in range(3)]
            for line in block[:block.index("\n -3")].splitlines() if line.startswith(" -1")}


def length(vector):
    return sum(component ** 2 for component in vector) ** 0.5


class WrittenDecksTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def solve(self, text, ranks=1):
        """Displacements, and the report."""
        deck, frd, report, dat = (self.folder / name for name in ("model.inp", "epafi.frd", "report.xml", "epafi.dat"))
        deck.write_text(text, encoding="utf-8")
        command = [EPAFI, deck, "--quiet", "--frd", frd, "--report", report, "--dat", dat]
        done = subprocess.run([*(LAUNCH + [str(ranks)] if ranks > 1 else []), *command], capture_output=True, text=True,
                              timeout=240, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return displacements_in(frd.read_text(encoding="utf-8")), xml.etree.ElementTree.parse(report).getroot()

    def compare(self, text, found, tolerance):
        """With ccx' solution of the same deck for small displacements."""
        if shutil.which("ccx") is None:
            return
        (self.folder / "theirs.inp").write_text(re.sub(r",\s*NLGEOM", "", text, flags=re.I), encoding="utf-8")
        subprocess.run(["ccx", "theirs"], cwd=self.folder, capture_output=True, timeout=240, check=True)
        theirs = displacements_in((self.folder / "theirs.frd").read_text(encoding="latin-1"))
        self.assertEqual(found.keys(), theirs.keys())
        largest = max(map(length, theirs.values()))
        self.assertLessEqual(max(length([a - b for a, b in zip(found[node], theirs[node])]) for node in theirs),
                             tolerance * largest)

    def resultant(self, report, name):
        value = report.find(f"ParameterList[@name='Contact']/ParameterList[@name='{name}']/Parameter[@name='Resultant']")
        return [float(part) for part in value.get("value").strip("{}").split(",")]

    def blocks(self, gap=0.0, counts=(3, 3, 2)):
        mesh = Mesh()
        mesh.box("lower", (0, 0, 0), (10, 10, 5), (2, 2, 2))
        mesh.box("upper", (0, 0, 5 + gap), (10, 10, 10 + gap), counts)
        return mesh

    def sets(self, mesh, gap=0.0):
        """Fixed base, faces that meet, and the sides' planes of symmetry."""
        fixed, _ = mesh.on("lower", 2, 0)
        _, dependent = mesh.on("upper", 2, 5 + gap)
        _, independent = mesh.on("lower", 2, 5)
        sides = [sorted(mesh.on("lower", axis, 0)[0] + mesh.on("upper", axis, 0)[0]) for axis in (0, 1)]
        return (f"*NSET,NSET=ConstraintFixed\n{lines(fixed)}*NSET,NSET=SideX\n{lines(sides[0])}*NSET,NSET=SideY\n{lines(sides[1])}"
                f"*SURFACE, NAME=DEPContact, TYPE=ELEMENT\n{face_lines(dependent)}"
                f"*SURFACE, NAME=INDContact, TYPE=ELEMENT\n{face_lines(independent)}")

    HELD = "*BOUNDARY\nConstraintFixed,3\nSideX,1\nSideY,2\n"

    def test_freecad_contact_of_a_slope_presses_as_springs_do(self):
        mesh = self.blocks()
        _, top = mesh.on("upper", 2, 10)
        text = freecad(mesh, self.sets(mesh),
                       "*CONTACT PAIR, INTERACTION=INTContact, TYPE=SURFACE TO SURFACE\nDEPContact, INDContact\n"
                       "*SURFACE INTERACTION, NAME=INTContact\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n10000\n"
                       "*FRICTION\n0.3, 1000\n", "*ELASTIC\n210000, 0",
                       f"*STEP, INC=2000, NLGEOM\n*STATIC\n{self.HELD}*DLOAD\n{pressure_lines(top, 100.0)}")
        found, report = self.solve(text)
        # 100 MPa / 10000 MPa/mm between the blocks, and 100/210000 of 10 mm in them
        for node in mesh.on("upper", 2, 10)[0]:
            self.assertAlmostEqual(found[node][2], -0.01 - 10 * 100 / 210000, delta=1e-7)
        self.assertAlmostEqual(self.resultant(report, "DEPCONTACT - INDCONTACT")[2], 10000, delta=1e-3)
        self.compare(text, found, 2e-3)

    def test_prepomax_tied_contact_is_a_spring_in_both_senses(self):
        mesh = self.blocks()
        top_nodes, top = mesh.on("upper", 2, 10)
        step = ("*Step, Inc=100\n*Static\n*Output, Frequency=1\n*Boundary, op=New\nConstraintFixed, 1, 3, 0\n*Cload, op=New\n"
                "*Dload, op=New\n")
        text = prepomax(mesh, re.sub("NSET=", "Nset=", self.sets(mesh)),
                        "*Surface interaction, Name=Surface_interaction-1\n*Surface behavior, Pressure-overclosure=Tied\n10000\n"
                        "*Friction\n0.3, 2000\n"
                        "*Contact pair, Interaction=Surface_interaction-1, Type=Surface to surface\nDEPContact, INDContact\n",
                        f"{step}{pressure_lines(top, -100.0)}")
        found, _ = self.solve(text)
        for node in top_nodes:
            self.assertAlmostEqual(found[node][2], 0.01 + 10 * 100 / 210000, delta=1e-7)
        across = "".join(f"{node}, 1, {50 / len(top_nodes):.9g}\n" for node in top_nodes)
        text = text.replace("*Cload, op=New\n", f"*Cload, op=New\n{across}")
        found, _ = self.solve(text, ranks=2)
        self.compare(text, found, 3e-3)

    def test_freecad_tie_and_weight_are_those_of_one_body(self):
        mesh = self.blocks(counts=(2, 2, 2))
        text = freecad(mesh, self.sets(mesh), "*TIE, POSITION TOLERANCE=0.1, ADJUST=NO, NAME=TIEConstraintTie\nDEPContact, INDContact\n",
                       "*ELASTIC\n210000, 0.3\n*DENSITY\n7.9E-09", f"*STEP\n*STATIC\n{self.HELD}*DLOAD\nEall,GRAV,9810,0,0,-1\n")
        found, report = self.solve(text, ranks=2)
        weight = 7.9e-9 * 9810 * 1000
        holds = report.findall("ParameterList[@name='Support']//Parameter[@name='Force']")
        self.assertAlmostEqual(sum(float(force.get("value").strip("{}").split(",")[2]) for force in holds), weight, delta=1e-9 * weight)
        self.compare(text, found, 2e-2)

    def test_freecad_press_without_more_than_a_fixed_base_slides_nowhere(self):
        mesh = self.blocks()
        _, top = mesh.on("upper", 2, 10)
        text = freecad(mesh, self.sets(mesh),
                       "*CONTACT PAIR, INTERACTION=INTContact, TYPE=SURFACE TO SURFACE\nDEPContact, INDContact\n"
                       "*SURFACE INTERACTION, NAME=INTContact\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n*FRICTION\n0.5\n",
                       "*ELASTIC\n210000, 0.3",
                       "*STEP\n*STATIC\n*BOUNDARY\nConstraintFixed,1\nConstraintFixed,2\nConstraintFixed,3\n"
                       f"*DLOAD\n{pressure_lines(top, 100.0)}")
        found, report = self.solve(text)
        force = self.resultant(report, "DEPCONTACT - INDCONTACT")
        self.assertAlmostEqual(force[2], 10000, delta=1e-2)
        self.assertLess(max(abs(found[node][2]) for node in found), 0.006)

    def test_forces_and_moments_on_a_node_are_spread_over_its_surface_and_balance(self):
        mesh = Mesh()
        mesh.box("beam", (0, 0, 0), (40, 10, 8), (8, 2, 2))
        fixed, ends = mesh.on("beam", 0, 0)
        _, end = mesh.on("beam", 0, 40)
        node = len(mesh.nodes) + 1
        sets = (f"*NODE\n{node}, 50, 8, 1\n*NSET,NSET=ConstraintFixed\n{lines(fixed)}*SURFACE, NAME=End, TYPE=ELEMENT\n"
                f"{face_lines(end)}*SURFACE, NAME=Ground, TYPE=ELEMENT\n{face_lines(ends)}"
                f"*COUPLING, CONSTRAINT NAME=c, REF NODE={node}, SURFACE=End\n*DISTRIBUTING\n1,6\n")
        for loads in ({1: 500, 2: 100, 3: -50}, {4: 3000, 5: 2000, 6: -1000}):
            cards = "".join(f"{node},{component},{value}\n" for component, value in loads.items())
            text = freecad(mesh, sets, "", "*ELASTIC\n210000, 0.3",
                           f"*STEP\n*STATIC\n*BOUNDARY\nConstraintFixed,1,3\n*CLOAD\n{cards}"
                           "*SECTION PRINT, SURFACE=Ground, NAME=g\nSOF, SOM\n")
            found, _ = self.solve(text, ranks=2)
            printed = (self.folder / "epafi.dat").read_text(encoding="utf-8")
            force, moment = (
                [float(x) for x in printed[printed.index(words):].split("\n\n")[1].split()[:6]][first:first + 3]
                for words, first in (("total surface force (fx,fy,fz)", 0), ("total surface force (fx,fy,fz)", 3)))
            f, m = ([loads.get(first + c, 0) for c in range(3)] for first in (1, 4))
            r = [50, 8, 1]
            m = [m[c] + r[c - 2] * f[c - 1] - r[c - 1] * f[c - 2] for c in range(3)]
            for value, expected in zip(force + moment, f + m):
                self.assertAlmostEqual(value, -expected, delta=2e-6 * max(map(abs, f + m)))
            self.compare(text, found, 1e-2)

    def test_pairs_that_a_deck_leaves_out_are_found_between_its_bodies(self):
        mesh = self.blocks(0.004)
        _, top = mesh.on("upper", 2, 10.004)
        text = freecad(mesh, self.sets(mesh, 0.004), "", "*ELASTIC\n210000, 0",
                       f"*STEP\n*STATIC\n{self.HELD}*DLOAD\n{pressure_lines(top, 100.0)}")
        deck, scene, report = (self.folder / name for name in ("model.inp", "model.xml", "report.xml"))
        deck.write_text(text, encoding="utf-8")

        def run(*arguments):
            return subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=240, check=False)

        def pressed(done, name):
            self.assertEqual(done.returncode, 0, done.stderr)
            force = self.resultant(xml.etree.ElementTree.parse(report).getroot(), name)
            self.assertAlmostEqual(abs(force[2]), 10000, delta=1e-3)

        self.assertEqual(run(EPAFI, deck).returncode, 3)  # the upper block hangs in the air
        done = run(*LAUNCH, 2, EPAFI, deck, "--set", "Contact/Automatic/Kind=contact", "--report", report)
        self.assertIn("plane on plane, area 100, gap 0.004", done.stdout)
        pressed(done, "body 1 - body 2")
        # As XML to paste into what --export writes.
        pairs = run(EPAFI, deck, "--print-pairs").stdout
        self.assertIn('name="Second Surface" type="string" value="at ', pairs)
        self.assertEqual(run(EPAFI, deck, "--export", scene).returncode, 0)
        own = scene.read_text(encoding="utf-8")
        scene.write_text(own[:own.rindex("</ParameterList>")] + pairs + "</ParameterList>", encoding="utf-8")
        pressed(run(EPAFI, scene, "--report", report), "body 1 - body 2")
        listed = run(EPAFI, deck, "--list", "--set", "Contact/Automatic/Distance=1e-3")
        self.assertIn("1 pair of faces is 0.004 apart: a Distance of 0.0048 takes it in", listed.stdout)
        self.assertIn("body 1/at ", listed.stdout)
        wrong = run(EPAFI, deck, "--set", "Contact/Automatic/Distnace=1e-3")
        self.assertEqual((wrong.returncode, wrong.stderr.count("\n")), (2, 1), wrong.stderr)

    def test_prepomax_hard_contact_with_adjust_has_no_gap(self):
        gap = 0.05
        mesh = self.blocks(gap)
        _, top = mesh.on("upper", 2, 10 + gap)
        sets = re.sub("NSET=", "Nset=", self.sets(mesh, gap))
        text = prepomax(mesh, sets,
                        "*Surface interaction, Name=Surface_interaction-1\n*Surface behavior, Pressure-overclosure=Hard\n"
                        "*Contact pair, Interaction=Surface_interaction-1, Type=Surface to surface, Adjust=0.1\nDEPContact, INDContact\n",
                        f"*Step, Nlgeom, Inc=100\n*Static\n1, 1, 1E-05, 1E+30\n*Output, Frequency=1\n*Boundary, op=New\n"
                        f"ConstraintFixed, 3, 3, 0\nSideX, 1, 1, 0\nSideY, 2, 2, 0\n*Cload, op=New\n*Dload, op=New\n"
                        f"{pressure_lines(top, 100.0)}")
        found, report = self.solve(text)
        for node in mesh.on("upper", 2, 10 + gap)[0]:
            self.assertAlmostEqual(found[node][2], -10 * 100 / 210000, delta=1e-7)
        self.assertAlmostEqual(self.resultant(report, "DEPCONTACT - INDCONTACT")[2], 10000, delta=1e-3)

    def test_prepomax_steps_press_and_let_go(self):
        mesh = self.blocks()
        _, top = mesh.on("upper", 2, 10)
        step = ("*Step, Inc=100\n*Static, Direct\n1, 1\n*Output, Frequency=1\n*Boundary, op=New\nConstraintFixed, 3, 3, 0\n"
                "SideX, 1, 1, 0\nSideY, 2, 2, 0\n*Cload, op=New\n*Dload, op=New\n")
        text = prepomax(mesh, re.sub("NSET=", "Nset=", self.sets(mesh)),
                        "*Surface interaction, Name=Surface_interaction-1\n*Surface behavior, Pressure-overclosure=Linear\n100000\n"
                        "*Contact pair, Interaction=Surface_interaction-1, Type=Surface to surface\nDEPContact, INDContact\n",
                        f"{step}{pressure_lines(top, 100.0)}*Node file\nU\n*End step\n{step}{pressure_lines(top, 25.0)}")
        found, report = self.solve(text)
        for node in mesh.on("upper", 2, 10)[0]:
            self.assertAlmostEqual(found[node][2], -25 / 100000 - 10 * 25 / 210000, delta=1e-8)
        self.assertEqual(len(report.find("ParameterList[@name='Steps']")), 2)
        self.compare(text, found, 2e-3)

    def test_prepomax_bolt_is_tightened_and_then_locked(self):
        """Without ccx, which cuts off the elements with faces in the section alone, not those that touch it with an edge."""
        mesh = Mesh()
        mesh.box("bolt", (0, 0, 0), (4, 4, 20), (1, 1, 4))
        (bottom, _), (top, _) = mesh.on("bolt", 2, 0), mesh.on("bolt", 2, 20)
        section, faces = mesh.on("bolt", 2, 10)
        below = [(element, face) for element, face in faces
                 if min(mesh.nodes[node][2] for node in mesh.elements[element]) < 9]
        node = len(mesh.nodes) + 1
        sets = (f"*Node\n{node}, 2, 2, 10\n*Nset, Nset=Bottom\n{lines(bottom)}*Nset, Nset=Top\n{lines(top)}"
                f"*Surface, Name=Pre_tension_surface, Type=Element\n{face_lines(below)}")
        step = "*Step, Inc=100\n*Static\n1, 1, 1E-05, 1E+30\n*Output, Frequency=1\n*Boundary, op=New\n"
        held = "Bottom, 1, 3, 0\nTop, 3, 3, "
        text = prepomax(mesh, sets, f"*Pre-tension section, Surface=Pre_tension_surface, Node={node}\n0, 0, 1\n",
                        f"{step}{held}0\n*Cload, op=New\n{node}, 1, 4200\n*Dload, op=New\n*Node file\nU\n"
                        f"*Node print, Nset=Bottom, Totals=Only\nRF\n*End step\n"
                        f"{step}{held}0.01\n*Boundary, Fixed\n{node}, 1, 1\n*Cload, op=New\n*Dload, op=New\n")
        found, report = self.solve(text)
        # 4200 N stretch each half by 4200/(16 210000) of its 10 mm; locked it goes on as a whole, by 0.01 of 20 mm
        forces = report.findall(".//ParameterList[@name='Preload']//Parameter[@name='Force']")
        self.assertAlmostEqual(float(forces[-1].get("value")), 4200 + 16 * 210000 * 0.01 / 20, delta=1e-3)
        totals = re.findall(r"total force .* BOTTOM and time  (\S+)\n\n\s*\S+\s+\S+\s+(\S+)",
                            (self.folder / "epafi.dat").read_text(encoding="utf-8"))
        for (time, force), expected in zip(totals, [(1, -4200), (2, -5880)], strict=True):
            self.assertEqual(float(time), expected[0])
            self.assertAlmostEqual(float(force), expected[1], delta=1e-2)
        self.assertAlmostEqual(found[section[0]][2], 0.005 - 4200 * 10 / (16 * 210000), delta=1e-7)

    def test_prints_have_the_words_and_numbers_of_calculix(self):
        def printed(name):
            text = (self.folder / name).read_text(encoding="utf-8")
            sums = [re.search(words + r".*\n\n\s*(\S+)\s+(\S+)\s+(\S+)", text).groups()
                    for words in (r"total force \(fx,fy,fz\) for set CONSTRAINTFIXED and time ", r"total surface force \(fx,fy,fz\)")]
            block = text[text.index("displacements (vx,vy,vz) for set SIDEX and time "):].split("\n\n")[1]
            rows = [line.split() for line in block.splitlines()]
            return [float(x) for sum_ in sums for x in sum_], {int(node): [float(x) for x in u] for node, *u in rows}

        mesh = self.blocks()
        _, top = mesh.on("upper", 2, 10)
        text = freecad(mesh, self.sets(mesh),
                       "*CONTACT PAIR, INTERACTION=INTContact, TYPE=SURFACE TO SURFACE\nDEPContact, INDContact\n"
                       "*SURFACE INTERACTION, NAME=INTContact\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n10000\n",
                       "*ELASTIC\n210000, 0", f"*STEP\n*STATIC\n{self.HELD}*DLOAD\n{pressure_lines(top, 100.0)}"
                       "*NODE PRINT, NSET=SideX\nU\n*CONTACT PRINT, SLAVE=DEPContact, MASTER=INDContact, TOTALS=ONLY\nCF\n")
        found, _ = self.solve(text, ranks=2)
        sums, u = printed("epafi.dat")
        for value, expected in zip(sums, [0, 0, 10000, 0, 0, 10000]):
            self.assertAlmostEqual(value, expected, delta=1e-2)
        self.assertEqual(sorted(u), sorted(set(mesh.on("lower", 0, 0)[0] + mesh.on("upper", 0, 0)[0])))
        for node, vector in u.items():
            self.assertAlmostEqual(vector[2], found[node][2], delta=1e-7)
        self.compare(text, found, 2e-3)
        if shutil.which("ccx"):
            theirs, their_u = printed("theirs.dat")
            for value, expected in zip(sums, theirs):
                self.assertAlmostEqual(value, expected, delta=20)
            self.assertEqual(their_u.keys(), u.keys())

    def test_prints_of_elements_contacts_and_sections_are_those_of_a_pressed_block(self):
        def block(words, text):
            return text[text.index(words):].split("\n\n")[1].splitlines()

        mesh = self.blocks()
        _, top = mesh.on("upper", 2, 10)
        _, ends = mesh.on("lower", 2, 0)
        pressure, stiffness, young = 100.0, 1e4, 210000.0
        text = freecad(mesh, self.sets(mesh) + f"*SURFACE, NAME=Ground\n{face_lines(ends)}",
                       "*CONTACT PAIR, INTERACTION=INTContact, TYPE=SURFACE TO SURFACE\nDEPContact, INDContact\n"
                       f"*SURFACE INTERACTION, NAME=INTContact\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness}\n",
                       "*ELASTIC\n210000, 0", f"*STEP\n*STATIC\n{self.HELD}*DLOAD\n{pressure_lines(top, pressure)}"
                       "*CONTACT PRINT\nCDIS, CSTR\n*EL PRINT, ELSET=Eall\nS, E, ENER\n"
                       "*SECTION PRINT, SURFACE=Ground, NAME=g\nSOF, SOM\n"
                       "*SECTION PRINT, SURFACE=INDContact, NAME=h\nSOF\n"
                       "*NODE PRINT, NSET=SideX\nU\n")
        self.solve(text, ranks=2)
        printed = (self.folder / "epafi.dat").read_text(encoding="utf-8")
        for words, values in (("stresses (elem", [0, 0, -pressure, 0, 0, 0]),
                              ("strains (elem", [0, 0, -pressure / young, 0, 0, 0]),
                              ("internal energy density (elem", [pressure ** 2 / young / 2])):
            rows = block(words, printed)
            self.assertEqual(len(rows), 4 * len(mesh.elements))
            for row in rows:
                for value, expected in zip(row.split()[2:], values, strict=True):
                    self.assertAlmostEqual(float(value), expected, delta=1e-5 * max(abs(x) for x in values), msg=words)
        for words, values in (("relative contact displacement (slave node", [-pressure / stiffness, 0, 0]),
                              ("contact stress (slave node", [pressure, 0, 0])):
            rows = block(words, printed)
            self.assertGreater(len(rows), 8)
            for row in rows:
                for value, expected in zip(row.split()[1:], values, strict=True):
                    self.assertAlmostEqual(float(value), expected, delta=1e-4 * max(abs(x) for x in values), msg=words)
        for name, height, outwards in (("GROUND", 0, -1), ("INDCONTACT", None, 1)):
            statistics = printed[printed.index(f"statistics for surface set {name} "):].split("\n\n")
            force, centre, sizes = ([float(x) for x in statistics[k].split()] for k in (2, 4, 8))
            self.assertAlmostEqual(force[2], -outwards * pressure * 100, delta=1e-2)
            self.assertAlmostEqual(force[3], 5 * force[2], delta=0.1)
            self.assertAlmostEqual(force[4], -5 * force[2], delta=0.1)
            self.assertEqual(centre[:2] + centre[3:], [5, 5, 0, 0, outwards])
            if height is not None:
                self.assertEqual(centre[2], height)
            self.assertAlmostEqual(sizes[0], 100, delta=1e-4)
            self.assertAlmostEqual(sizes[1], -pressure * 100, delta=1e-2)

    def test_a_deck_that_names_faces_alone_is_refined_to_a_target(self):
        mesh = self.blocks()
        _, side = mesh.on("upper", 0, 0)
        foot, _ = mesh.on("lower", 2, 0)
        text = freecad(mesh, self.sets(mesh) + f"*NSET, NSET=Foot\n{lines(foot)}", "*TIE, NAME=t\nDEPContact, INDContact\n",
                       "*ELASTIC\n210000, 0.3",
                       f"*STEP\n*STATIC\n*BOUNDARY\nFoot, 1, 3\n*DLOAD\n{pressure_lines(side, 1.0)}")
        (self.folder / "model.inp").write_text(text, encoding="utf-8")
        found, works = [], []
        for target in (None, 0.05):
            command = [EPAFI, self.folder / "model.inp", "--quiet", "--report", self.folder / "report.xml",
                       "--frd", self.folder / "epafi.frd", *(["--accuracy", str(target)] if target else [])]
            subprocess.run(command, check=True, timeout=120)
            report = xml.etree.ElementTree.parse(self.folder / "report.xml")
            found.append(float(report.find(".//Parameter[@name='Relative Error']").get("value")))
            works.append(float(report.find(".//Parameter[@name='Load Work']").get("value")))
        self.assertGreater(found[0], 0.06)
        self.assertLessEqual(found[1], 0.05)
        # What the work grows by is the error's square, but at the corners the estimate of so coarse a mesh sees little.
        self.assertGreater(works[1], works[0])
        self.assertLessEqual(works[1] - works[0], (2 * found[0]) ** 2 * works[1])

    def test_a_target_is_that_of_all_load_steps_and_of_what_is_asked_for(self):
        mesh = self.blocks()
        top, _ = mesh.on("upper", 2, 10)
        foot, _ = mesh.on("lower", 2, 0)
        pair = ("*CONTACT PAIR, INTERACTION=rub, TYPE=SURFACE TO SURFACE\nDEPContact, INDContact\n*SURFACE INTERACTION, NAME=rub\n"
                "*FRICTION\n0.3, 1e9\n")

        def ended(moved, *options):
            steps = "*END STEP\n".join(f"*STEP\n*STATIC\n*BOUNDARY\nFoot, 1, 3\nTop, 1, 1, {x}\nTop, 2, 2\nTop, 3, 3, {z}\n"
                                       for x, z in moved)
            text = freecad(mesh, self.sets(mesh) + f"*NSET, NSET=Foot\n{lines(foot)}*NSET, NSET=Top\n{lines(top)}", pair,
                           "*ELASTIC\n210000, 0.3", steps)
            (self.folder / "model.inp").write_text(text, encoding="utf-8")
            done = subprocess.run([EPAFI, self.folder / "model.inp", "--report", self.folder / "report.xml", *options],
                                  capture_output=True, text=True, timeout=120, check=False)
            return done, xml.etree.ElementTree.parse(self.folder / "report.xml")

        def error(report):
            return float(report.find(".//Parameter[@name='Relative Error']").get("value"))

        aside, both = [(0.05, -0.02)], [(0.05, -0.02), (0, -0.2)]
        first, last = (error(ended(moved)[1]) for moved in (aside, both))
        self.assertGreater(first, 1.1 * last)
        done, _ = ended(both, "--accuracy", str((first + last) / 2))
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn(f"TargetMissed: the estimated error is {100 * first:.6g} % in the worst load step", done.stdout)
        self.assertEqual(ended(both, "--accuracy", str(1.01 * first))[0].returncode, 0)
        done, _ = ended(aside, "--dat", self.folder / "model.dat", "--accuracy", "0.99", "--set", "Accuracy/Quantity/Kind=force", "--set",
                        "Accuracy/Quantity/Contact=DEPCONTACT - INDCONTACT")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("TargetMissed: there is no error bar (there is friction", done.stdout)

    def test_what_cannot_be_solved_is_named_with_its_line(self):
        mesh = self.blocks()
        text = prepomax(mesh, re.sub("NSET=", "Nset=", self.sets(mesh)), "", "*Step\n*Frequency\n10\n")
        (self.folder / "modes.inp").write_text(text, encoding="utf-8")
        done = subprocess.run([EPAFI, self.folder / "modes.inp"], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 2)
        line = text[:text.index("*Frequency")].count("\n") + 1
        self.assertIn(f"modes.inp, line {line}: *FREQUENCY", done.stderr)

    def test_damaged_decks_get_a_sentence_with_the_line_or_an_answer(self):
        """What is damaged so that it still is a deck has an answer, or is a problem without one (code 3)."""
        mesh = self.blocks(counts=(1, 1, 1))
        _, top = mesh.on("upper", 2, 10)
        whole = freecad(mesh, self.sets(mesh),
                        "*CONTACT PAIR, INTERACTION=INTContact, TYPE=SURFACE TO SURFACE\nDEPContact, INDContact\n"
                        "*SURFACE INTERACTION, NAME=INTContact\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n10000\n",
                        "*ELASTIC\n210000, 0.3", f"*STEP\n*STATIC\n{self.HELD}*DLOAD\n{pressure_lines(top, 100.0)}").splitlines()
        cards = [i for i, line in enumerate(whole) if line.startswith("*") and not line.startswith("**")]
        damages = [lambda line: "", lambda line: line[:len(line) // 2], lambda line: line.replace("=", " "),
                   lambda line: line.replace("1", "x", 1), lambda line: line + ", 1e400", lambda line: line.replace(",", " "),
                   lambda line: line[::-1], lambda line: line + "\n" + line, lambda line: re.sub(r"\d+", "99999", line, count=1),
                   lambda line: line.replace("ontact", "tact")]
        refused = 0
        for case in range(100):
            place = min(cards[case * 7 % len(cards)] + (case % 3 == 2), len(whole) - 1)
            text = "\n".join([*whole[:place], damages[case % len(damages)](whole[place]), *whole[place + 1:]]) + "\n"
            (self.folder / "damaged.inp").write_text(text, encoding="utf-8")
            done = subprocess.run([EPAFI, self.folder / "damaged.inp", "--quiet"], capture_output=True, text=True, timeout=60,
                                  check=False)
            self.assertIn(done.returncode, (0, 2, 3), (case, whole[place], done.stderr))
            if done.returncode == 2:
                refused += 1
                self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
                self.assertRegex(done.stderr, r"damaged\.inp, line \d+: ", (case, whole[place]))
        self.assertGreater(refused, 30)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
