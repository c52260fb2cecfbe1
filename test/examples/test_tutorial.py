#!/usr/bin/python3
"""test_tutorial.py EPAFI SOURCE_DIR: docs/tutorial.md says what is so. Its pieces of XML are xml/board.xml, and its commands
print what stands below them, numbers up to 2 %: those of round-off, times and memory may be others."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
PAGE = (SOURCE / "docs" / "tutorial.md").read_text(encoding="utf-8")
SCENE = SOURCE / "xml" / "board.xml"
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
RUN_TO_RUN = ("  accuracy", "  time", "  memory", "  mesh")  # round-off, which marks elements too, and the machine


def blocks():
    """Language and text of each block of the page, in order."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def commands_and_outputs():
    """Each command of the solver with all output that the page shows before the next one; pictures and the build are left
    out, and so is mpirun."""
    runs = []
    for language, text in blocks():
        if language == "sh":
            runs.append((text, []))
        elif language == "text":
            runs[-1][1].extend(text.splitlines())
    return [run for run in runs if run[1] and "epafi-plot" not in run[0]]


def agrees(shown, printed):
    """Whether a line of the page is that of the program: the same words and whole numbers, others within 2 %. Round-off may
    change how many products an iteration takes, and what it leaves."""
    if shown.startswith(RUN_TO_RUN):
        return printed.startswith(shown[:12])
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    slack = 4 if "products" in shown else 0
    pairs = zip(*(map(float, NUMBER.findall(line.split("of the mesh")[0])) for line in (shown, printed)))
    return all(abs(a - b) <= (slack if a.is_integer() and b.is_integer() else max(0.02 * abs(a), 5e-4)) for a, b in pairs)


class Tutorial(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.place = pathlib.Path(place.name)
        (self.place / "build" / "release" / "drivers").mkdir(parents=True)
        (self.place / "build" / "release" / "drivers" / "epafi").symlink_to(PROGRAM)
        shutil.copy(SCENE, self.place / "board.xml")

    def test_its_pieces_are_the_scene(self):
        pieces = [text for language, text in blocks() if language == "xml"]
        self.assertEqual("".join(pieces), SCENE.read_text(encoding="utf-8"))

    def test_its_commands_print_what_it_shows(self):
        runs = commands_and_outputs()
        self.assertGreaterEqual(len(runs), 9)
        for command, shown in runs:
            with self.subTest(command):
                ended = subprocess.run(["bash", "-c", command], cwd=self.place, text=True, timeout=120, check=False,
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env={**os.environ, "LC_ALL": "C.UTF-8"})
                printed = ended.stdout.splitlines()
                for line in shown:
                    while printed and not agrees(line, printed[0]):
                        printed.pop(0)
                    self.assertTrue(printed, f"the page shows, but the program does not print\n{line}\nin\n{ended.stdout}")
                    printed.pop(0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
