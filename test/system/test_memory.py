#!/usr/bin/python3
"""test_memory.py EPAFI MPIRUN [FLAG...] NUMBER_FLAG: what a rank holds of a scene whose mesh comes from a file falls as ranks
become more."""

import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import unittest

LIMIT = 300  # seconds
FALL = -0.85  # of the data of the rank with most, as a power of the number of ranks
LEAST_ON_8 = 1 / 6


def measured(program):
    """Runs it and writes the rank's peak to a file; on a rank of its own."""
    process = subprocess.run(program[1:], check=False)
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss  # kB
    pathlib.Path(program[0], os.environ.get("OMPI_COMM_WORLD_RANK", "0")).write_text(json.dumps(peak), encoding="ascii")
    return process.returncode


def block(n):
    """A cube of n³ bricks in Gmsh's format 2.2, whose lower and upper sides are surfaces."""
    def node(i, j, k):
        return 1 + i + (n + 1) * (j + (n + 1) * k)
    nodes = [f"{node(i, j, k)} {i / n} {j / n} {k / n}" for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)]
    across = [(0, 0), (1, 0), (1, 1), (0, 1)]
    bricks = [[node(i + a, j + b, k + c) for c in (0, 1) for a, b in across]
              for k in range(n) for j in range(n) for i in range(n)]
    elements = [f"5 2 1 1 {' '.join(map(str, brick))}" for brick in bricks]
    for tag, k in ((2, 0), (3, n)):
        elements += [f"3 2 {tag} {tag} {' '.join(str(node(i + a, j + b, k)) for a, b in across)}" for j in range(n) for i in range(n)]
    numbered = [f"{number} {element}" for number, element in enumerate(elements, start=1)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '3 1 "block"', '2 2 "bottom"', '2 3 "top"',
                      "$EndPhysicalNames", "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(numbered)), *numbered,
                      "$EndElements", ""])


def entry(name, kind, value):
    return f'<Parameter name="{name}" type="{kind}" value="{value}"/>'


def sublist(name, *inside):
    return f'<ParameterList name="{name}">{"".join(inside)}</ParameterList>'


def scene(mesh):
    """The cube pressed on a floor and pulled sideways and up at the top, so that it lifts a little."""
    body = sublist("block", entry("Mesh", "string", mesh), entry("Physics", "string", "elasticity 3-D"), entry("Order", "int", 1),
                   entry("Young's Modulus", "double", 200), entry("Poisson's Ratio", "double", 0.3),
                   sublist("Supports", sublist("top", entry("Surface", "string", "top"), entry("X", "double", 0.01),
                                               entry("Y", "double", 0), entry("Z", "double", -0.002))))
    floor = sublist("floor", entry("Kind", "string", "plane"), entry("Point", "Array(double)", "{0, 0, 0}"),
                    entry("Normal", "Array(double)", "{0, 0, 1}"))
    foot = sublist("foot", entry("First Body", "string", "block"), entry("First Surface", "string", "bottom"),
                   entry("Obstacle", "string", "floor"))
    return sublist("Epafi", sublist("Bodies", body), sublist("Obstacles", floor), sublist("Contact", foot),
                   sublist("Decomposition", entry("Parts", "int", 64)), sublist("Solver", entry("Tolerance", "double", 1e-4)))


class Memory(unittest.TestCase):
    def run_on(self, ranks, elements):
        """(peak of each rank in kB, energy)"""
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            (place / "block.msh").write_text(block(elements), encoding="ascii")
            (place / "scene.xml").write_text(scene("block.msh"), encoding="ascii")
            run = subprocess.run([*LAUNCHER, str(ranks), sys.executable, __file__, "--measured", folder, EPAFI, place / "scene.xml",
                                  "--quiet", "--report", place / "report.xml"],
                                 capture_output=True, text=True, timeout=LIMIT, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            energy = re.search(r'name="Energy"[^>]*value="([^"]*)"', (place / "report.xml").read_text(encoding="utf-8"))
            return [json.loads((place / str(rank)).read_text(encoding="ascii")) for rank in range(ranks)], float(energy[1])

    def test_data_of_the_rank_with_most_fall(self):
        libraries, _ = self.run_on(8, 4)
        alone, energy = self.run_on(1, 36)
        whole = alone[0] - libraries[0]
        for ranks in (2, 4, 8):
            peaks, same = self.run_on(ranks, 36)
            data = [peak - libraries[rank] for rank, peak in enumerate(peaks)]
            with self.subTest(ranks=ranks, data=data, whole=whole):
                self.assertLessEqual(max(data), whole * ranks**FALL)
                self.assertLessEqual(abs(same - energy), 1e-6 * abs(energy))
                if ranks == 8:
                    self.assertLessEqual(max(data), LEAST_ON_8 * whole)


if __name__ == "__main__":
    if sys.argv[1] == "--measured":
        sys.exit(measured(sys.argv[2:]))
    EPAFI, *LAUNCHER = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
