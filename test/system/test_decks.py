#!/usr/bin/python3
"""test_decks.py EPAFI SOURCE_DIR MPIRUN ARGUMENTS...: the decks of CalculiX' own suite (Debian's package calculix-ccx-test)
beside what CalculiX says of them: the suite's own references, or, without NLGEOM, a run of ccx."""

import csv
import gzip
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

EPAFI, SOURCE, LAUNCH = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
SUITE = pathlib.Path("/usr/share/doc/calculix-ccx-test/examples/test")


def table():
    with open(SOURCE / "test/system/decks.csv", encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def text_of(name):
    """Of a file of the suite; Debian packs the larger ones."""
    if (SUITE / name).is_file():
        return (SUITE / name).read_text(encoding="latin-1")
    with gzip.open(SUITE / f"{name}.gz", "rt", encoding="latin-1") as file:
        return file.read()


def deck(name):
    return text_of(f"{name}.inp")


def displacements_in_dat(text):
    """{node: u} of the last time that is printed, as far as blocks have it."""
    fields, time = {}, None
    for block in re.split(r"\n(?= displacements)", "\n" + text):
        head = re.match(r" displacements \(vx,vy,vz\) for set \S+ and time +(\S+)", block)
        if not head:
            continue
        time = float(head.group(1))
        for line in block.splitlines()[1:]:
            words = line.split()
            if len(words) == 4 and words[0].isdigit():
                fields.setdefault(time, {})[int(words[0])] = [float(word) for word in words[1:]]
            elif words:
                break
    return fields[max(fields)]


def displacements_in_frd(text):
    """{node: u} of the last results."""
    block = text[text.rindex(" -4  DISP"):]
    return {int(line[3:13]): [float(line[13 + 12 * c:25 + 12 * c]) for c in range(3)]
            for line in block[:block.index("\n -3")].splitlines() if line.startswith(" -1")}


def stresses_in_dat(text):
    """{(element, point): stress} of the last time that is printed."""
    fields = {}
    for time, block in re.findall(r"\n stresses \(elem, integ\.pnt\..* and time +(\S+)\n\n((?: .*\n)*)", text):
        rows = (line.split() for line in block.splitlines())
        fields.setdefault(float(time), {}).update({(int(row[0]), int(row[1])): [float(x) for x in row[2:]] for row in rows})
    return fields[max(fields)] if fields else {}


def reference(name, kind, folder):
    if kind == "ref":
        return displacements_in_dat(text_of(f"{name}.dat.ref"))
    text = deck(name)
    if kind == "linear":
        text = re.sub(r",\s*NLGEOM(=YES)?", "", text, flags=re.I)
    plane = ", OUTPUT=2D" if re.search("TYPE *= *CAX", text, re.I) else ""
    text = re.sub(r"\*NODE FILE.*", f"*NODE FILE{plane}\nU", text, flags=re.I)
    if not re.search(r"\*NODE FILE", text, re.I):
        text = re.sub(r"(\*END STEP)", rf"*NODE FILE{plane}\nU\n\1", text, flags=re.I)
    (folder / f"{name}.inp").write_text(text, encoding="latin-1")
    subprocess.run(["ccx", name], cwd=folder, capture_output=True, timeout=120, check=True)
    return displacements_in_frd((folder / f"{name}.frd").read_text(encoding="latin-1"))


def length(vector):
    return math.sqrt(sum(component ** 2 for component in vector))


class DecksTest(unittest.TestCase):
    def setUp(self):
        if not SUITE.is_dir():
            self.skipTest("the package calculix-ccx-test is not installed")
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def solve(self, name, ranks=1):
        (self.folder / f"{name}.inp").write_text(deck(name), encoding="latin-1")
        command = [EPAFI, self.folder / f"{name}.inp", "--frd", self.folder / f"epafi_{name}.frd", "--dat",
                   self.folder / f"epafi_{name}.dat"]
        if ranks > 1:
            command = [*LAUNCH, str(ranks), *command]
        done = subprocess.run(command, capture_output=True, text=True, timeout=240, check=False)
        self.assertEqual(done.returncode, 0, f"{name}: {done.stderr}")
        return displacements_in_frd((self.folder / f"epafi_{name}.frd").read_text(encoding="utf-8"))

    def compare(self, name, found, expected, tolerance):
        largest = max(length(u) for u in expected.values())
        self.assertGreater(largest, 0)
        last = max(int(number) for number in re.findall(r"^\s*(\d+)\s*,\s*[-+.\d]", deck(name), flags=re.M))
        expected = {node: u for node, u in expected.items() if node <= last}  # those behind are copies in bolts
        common = found.keys() & expected.keys()
        # A deck may have nodes without elements or print some alone; copies of shared nodes stand behind all others.
        own = {node for node in found if node <= max(expected)}
        self.assertTrue(common and common in (own, expected.keys()), name)
        worst = max(common, key=lambda node: length([a - b for a, b in zip(found[node], expected[node])]))
        apart = length([a - b for a, b in zip(found[worst], expected[worst])]) / largest
        self.assertLessEqual(apart, tolerance, f"{name}: node {worst} is at {found[worst]}, not {expected[worst]}")

    def test_displacements_are_those_of_calculix(self):
        compared = 0
        for row in table():
            with self.subTest(row["deck"]):
                if row["reference"] != "ref" and shutil.which("ccx") is None:
                    continue
                self.compare(row["deck"], self.solve(row["deck"]),
                             reference(row["deck"], row["reference"], self.folder), float(row["tolerance"]))
                compared += 1
        self.assertGreaterEqual(compared, 20)

    def test_stresses_at_integration_points_are_those_of_calculix(self):
        compared = 0
        for row in table():
            if row["reference"] != "ref" or float(row["tolerance"]) > 1e-5:
                continue
            expected = stresses_in_dat(text_of(f"{row['deck']}.dat.ref"))
            if not expected or re.search("TYPE *= *C(PE|PS|AX)", deck(row["deck"]), re.I):
                continue
            with self.subTest(row["deck"]):
                self.solve(row["deck"], 1 + compared % 2)
                found = stresses_in_dat((self.folder / f"epafi_{row['deck']}.dat").read_text(encoding="utf-8"))
                self.assertEqual(found.keys(), expected.keys())
                largest = max(abs(x) for stress in expected.values() for x in stress)
                for place, stress in expected.items():
                    for x, y in zip(found[place], stress, strict=True):
                        self.assertAlmostEqual(x, y, delta=1e-5 * largest, msg=f"{place}")
                compared += 1
        self.assertGreaterEqual(compared, 20)

    def test_contacts_are_printed_step_by_step_as_calculix_has_them(self):
        if shutil.which("ccx") is None:
            self.skipTest("ccx is not installed")
        text = re.sub(r",\s*NLGEOM(=YES)?", "", deck("friction2"), flags=re.I)
        text = re.sub(r"(\*END STEP)", r"*CONTACT PRINT\nCDIS,CSTR\n*CONTACT FILE\nCDIS,CSTR\n\1", text, flags=re.I)
        (self.folder / "theirs.inp").write_text(text, encoding="latin-1")
        (self.folder / "ours.inp").write_text(text, encoding="latin-1")
        subprocess.run(["ccx", "theirs"], cwd=self.folder, capture_output=True, timeout=120, check=True)
        subprocess.run([*LAUNCH, "2", EPAFI, self.folder / "ours.inp", "--quiet", "--dat", self.folder / "ours.dat",
                        "--frd", self.folder / "ours.frd"],
                       check=True, timeout=120)

        def printed(name, words):
            blocks = {}
            pattern = rf"\n {words} \(slave node,\S+ for all contact elements and time +(\S+)\n\n((?: .*\n)*)"
            for time, block in re.findall(pattern, (self.folder / name).read_text(encoding="utf-8")):
                rows = (line.split() for line in block.splitlines())
                blocks[float(time)] = {int(row[0]): [float(x) for x in row[1:]] for row in rows}
            return blocks

        for words in ("relative contact displacement", "contact stress"):
            theirs, ours = printed("theirs.dat", words), printed("ours.dat", words)
            self.assertEqual(len(ours), 4)
            for time, nodes in ours.items():
                self.assertEqual(nodes.keys(), theirs[time].keys())
                for node, values in nodes.items():
                    expected = theirs[time][node]
                    along = max(abs(x) for row in theirs[time].values() for x in row[1:])
                    self.assertAlmostEqual(values[0], expected[0], delta=0.08 * abs(expected[0]))  # a tail of tension there
                    for x, y in zip(values[1:], expected[1:], strict=True):
                        self.assertAlmostEqual(x, y, delta=2e-3 * along, msg=f"{words} at {time} of {node}")

        def slips(name):
            text = (self.folder / name).read_text(encoding="utf-8")
            block = text[text.rindex(" -4  CONTACT"):]
            return {int(line[3:13]): [float(line[25:37]), float(line[37:49])]
                    for line in block[:block.index("\n -3")].splitlines() if line.startswith(" -1")}

        theirs, ours = slips("theirs.frd"), slips("ours.frd")
        self.assertTrue(ours)
        for node, slip in ours.items():  # in the last step, after sliding to and fro
            for x, y in zip(slip, theirs[node], strict=True):
                self.assertAlmostEqual(x, y, delta=2e-3)

    def test_a_target_is_judged_on_the_mesh_of_the_deck(self):
        (self.folder / "beam10p.inp").write_text(deck("beam10p"), encoding="latin-1")
        for share, code in ((0.2, 0), (0.02, 1)):
            done = subprocess.run([EPAFI, self.folder / "beam10p.inp", "--accuracy", str(share)], capture_output=True,
                                  text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            found = re.search(r"estimated error ([\d.]+) %", done.stdout)
            self.assertEqual(float(found.group(1)) > 100 * share, code == 1)
            self.assertEqual("TargetMissed: the estimated error is" in done.stdout, code == 1)
        self.assertIn("finer meshes would not have the nodes", done.stdout)

    def test_two_ranks_find_the_same(self):
        for row in table()[::6]:
            with self.subTest(row["deck"]):
                self.compare(row["deck"], self.solve(row["deck"], 2), self.solve(row["deck"]), 2e-5)

    def test_an_exported_deck_is_the_same_scene(self):
        for name in ("beamp", "disk2"):
            (self.folder / f"{name}.inp").write_text(deck(name), encoding="latin-1")
            subprocess.run([EPAFI, self.folder / f"{name}.inp", "--export", self.folder / f"{name}.xml"], check=True,
                           timeout=60)
            frd = self.folder / "exported.frd"
            subprocess.run([EPAFI, self.folder / f"{name}.xml", "--quiet", "--frd", frd], check=True, timeout=60)
            by_place = sorted(displacements_in_frd(frd.read_text(encoding="utf-8")).values())
            self.assertEqual(by_place, sorted(self.solve(name).values()))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
