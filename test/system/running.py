"""What the tests that watch the program fail, stop and be killed have in common: runs of it, moments in them, and whether the
files that are left are complete and belong together."""

import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

import h5py
import numpy

PROGRAM, SOURCE, WITH_FAULTS, FAULTY_RANKS = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4]
LAUNCH = sys.argv[5:]
SOLVED, FAILED, WRONG_INPUT, NOT_SOLVABLE = range(4)
LIMIT = 240  # seconds after which a run hangs, on a machine as busy as may be

# An iteration that takes long: no preconditioner, F by sparse solves with the whole factor.
SLOW = ["--set", "Solver/Preconditioner/Type=none", "--set", "Solver/Dual Operator/Mode=implicit",
        "--set", "Solver/Direct Solvers/Subdomains=KLU2",
        "--set", "Solver/Tolerance=1e-10", "--set", "Solver/Equilibrium Tolerance=1e-10"]


def scene(name):
    return str(SOURCE / "xml" / f"{name}.xml")


def elements(count, *bodies):
    return [word for body in bodies for word in ("--set", f"Bodies/{body}/Elements={{{count},{count}}}")]


def on_ranks(ranks, *command):
    return [*(LAUNCH + [str(ranks)] if ranks > 1 else []), *map(str, command)]


def run(*command, ranks=1, **options):
    return subprocess.run(on_ranks(ranks, *command), capture_output=True, text=True, timeout=LIMIT, check=False, **options)


def said(text):
    """The lines the program itself wrote to the error stream; mpirun adds some about the exit code."""
    return [line for line in text.splitlines() if line.startswith("epafi: ")]


def report_of(directory):
    """{list: {parameter: value as text}}, and the number of lists in Levels."""
    root = xml.etree.ElementTree.parse(pathlib.Path(directory) / "report.xml").getroot()
    report = {part.get("name"): {p.get("name"): p.get("value") for p in part.findall("Parameter")}
              for part in root.findall("ParameterList")}
    report["Levels"] = len(root.findall("ParameterList[@name='Levels']/ParameterList"))
    return report


def fields_of(file):
    """u of all bodies."""
    with h5py.File(file) as fields:
        return numpy.concatenate([body["u"][:].ravel() for body in fields["bodies"].values()])


def wait_for(condition, what, seconds=LIMIT):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited in vain for {what}")
        time.sleep(0.001)


def ranks_of(launcher):
    """Process numbers of the ranks that a mpirun has started, from release 5 on by a launcher of its own."""
    started = sorted(int(number) for children in pathlib.Path(f"/proc/{launcher}/task").glob("*/children")
                     for number in children.read_text().split())
    return [rank for number in started for rank in
            (ranks_of(number) if pathlib.Path(f"/proc/{number}/exe").resolve().name.startswith("prte") else [number])]


def has(process, kind, number):
    """Whether a signal is in one of a process's sets of them: SigBlk, blocked; ShdPnd, waiting."""
    sets = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return bool(int(re.search(rf"^{kind}:\s*([0-9a-f]+)$", sets, re.M)[1], 16) >> number - 1 & 1)


class Run(unittest.TestCase):
    """A test of runs in a directory of its own."""

    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)

    def start(self, *command, ranks=1):
        """A run whose output is in files, which can be looked at while it goes on."""
        place = tempfile.mkdtemp(dir=self.place)
        with open(f"{place}/stdout", "w", encoding="utf-8") as out, open(f"{place}/stderr", "w", encoding="utf-8") as err:
            process = subprocess.Popen(on_ranks(ranks, *command), stdout=out, stderr=err)
        process.printed = lambda stream="stdout": pathlib.Path(place, stream).read_text(encoding="utf-8")
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def reach(self, process, line, number=1):
        """Waits until a run has printed so many lines that begin so."""
        wait_for(lambda: ("\n" + process.printed()).count("\n" + line) >= number or process.poll() is not None, line)
        self.assertIsNone(process.poll(), "ended early: " + process.printed() + process.printed("stderr"))

    def finish(self, process):
        process.wait(LIMIT)
        return subprocess.CompletedProcess(process.args, process.returncode, process.printed(), process.printed("stderr"))

    def expect(self, ended, code, *words):
        """One sentence of ours that holds all words, and the code."""
        self.assertEqual(ended.returncode, code, ended.stdout + ended.stderr)
        sentences = said(ended.stderr)
        self.assertEqual(len(sentences), 1, ended.stderr)
        for word in words:
            self.assertIn(word, sentences[0])

    def assert_complete(self, directory, name):
        """What is there under its final name is complete. Returns the names."""
        names = set()
        for file in directory.iterdir():
            if file.name.startswith(".") and ".partial" in file.name:
                continue
            names.add(file.name)
            if file.suffix == ".h5":
                self.assertTrue(numpy.isfinite(fields_of(file)).all())
            elif file.suffix in (".xml", ".xdmf"):
                xml.etree.ElementTree.parse(file)
            elif file.suffix == ".csv":
                self.assertTrue(file.read_text().endswith("\n"))
            else:
                self.assertEqual(file.name, "checkpoint.epafi")
                self.assert_checkpoint(file, name)
        return names

    def assert_checkpoint(self, file, name, known=set()):
        """It is read, its checksum looked at. It may fit no mesh of the run that does that."""
        content = file.read_bytes()
        if content in known:
            return
        ended = run(PROGRAM, scene(name), "--quiet", "--restart", file, "--accuracy", "99%")
        self.assertEqual(ended.returncode, SOLVED, ended.stderr)
        known.add(content)

    def assert_one_mesh(self, directory, name):
        """All that is there under its final name is complete and of the mesh that the report tells of, unless that says that others
        were just being put in place. Returns the report, if there is one."""
        names = self.assert_complete(directory, name)
        fields = directory / f"{name}.h5"
        if f"{name}.xdmf" in names:
            with h5py.File(fields) as file:
                for item in xml.etree.ElementTree.parse(directory / f"{name}.xdmf").iter("DataItem"):
                    self.assertEqual(tuple(map(int, item.get("Dimensions").split())), file[item.text.split(":")[1]].shape, item.text)
        if "report.xml" not in names:  # none was complete
            self.assertLessEqual(names, {"checkpoint.epafi"})
            return None
        report = report_of(directory)
        if "are being put in place" in report["Status"]["Reason"]:
            return report
        self.assertEqual(names, {f"{name}.h5", f"{name}.xdmf", "history.csv", "meshes.csv", "report.xml", "checkpoint.epafi"})
        with h5py.File(fields) as file:
            self.assertAlmostEqual(file.attrs["energy"] / float(report["Accuracy"]["Energy"]), 1, delta=1e-14)
            steps = len(file["history/iteration"])
        self.assertEqual(len((directory / "history.csv").read_text().splitlines()), 1 + steps)
        with (directory / "meshes.csv").open() as table:
            rows = list(csv.DictReader(table))
        self.assertEqual(len(rows), report["Levels"])
        self.assertEqual(rows[-1]["unknowns"], report["Problem"]["Primal Dimension"])
        return report
