#!/usr/bin/python3
"""test_memory.py EPAFI MPIRUN [FLAG...] NUMBER_FLAG: what a rank holds of a scene whose mesh comes from a file falls as ranks
become more. In space factors are most of it, in the plane meshes.

test_memory.py --squares N DIR [FILE]: writes the membranes with 4 N² triangles, DIR/scene.xml and FILE, scene.msh or "scene_*.msh".
"""

import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import unittest

import numpy

LIMIT = 300  # seconds
FALL = -0.85  # of the data of the rank with most, as a power of the number of ranks
LEAST_ON_8, LEAST_OF_MESHES_ON_8 = 1 / 6, 1 / 5  # 1/3.6 if each rank had the mesh whole


def measured(program):
    """Runs it and writes the rank's peak to a file; on a rank of its own."""
    process = subprocess.run(program[1:], check=False)
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss  # kB
    pathlib.Path(program[0], os.environ.get("OMPI_COMM_WORLD_RANK", "0")).write_text(json.dumps(peak), encoding="ascii")
    return process.returncode


def gmsh(groups, nodes, elements):
    """A file in format 2.2. groups: (dimension, name) from tag 1 on; elements: (type, tag, nodes from 0)."""
    names = [f'{dimension} {tag} "{name}"' for tag, (dimension, name) in enumerate(groups, start=1)]
    points = [f"{number} {' '.join(map(str, point))}" for number, point in enumerate(nodes, start=1)]
    cells = [f"{number} {kind} 2 {tag} {tag} {' '.join(str(1 + node) for node in corners)}"
             for number, (kind, tag, corners) in enumerate(elements, start=1)]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames",
                      "$Nodes", str(len(points)), *points, "$EndNodes", "$Elements", str(len(cells)), *cells, "$EndElements", ""])


def block(n, file):
    """A cube of n³ bricks whose lower and upper sides are surfaces."""
    def node(i, j, k):
        return i + (n + 1) * (j + (n + 1) * k)
    across = [(0, 0), (1, 0), (1, 1), (0, 1)]
    bricks = [(5, 1, [node(i + a, j + b, k + c) for c in (0, 1) for a, b in across])
              for k in range(n) for j in range(n) for i in range(n)]
    sides = [(3, tag, [node(i + a, j + b, k) for a, b in across]) for tag, k in ((2, 0), (3, n)) for j in range(n) for i in range(n)]
    points = [(i / n, j / n, k / n) for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)]
    file.write_text(gmsh([(3, "block"), (2, "bottom"), (2, "top")], points, bricks + sides), encoding="ascii")


def squares(n, file):
    """Two unit squares side by side, of 2 n² triangles each and with nodes of their own, in binary; their left and right edges are
    surfaces. Where the file's name has a *, eight files, each with some rows of both."""
    if "*" not in file.name:
        rows_of_squares(n, range(n), file)
        return
    for part in range(8):
        rows_of_squares(n, range(part * n // 8, (part + 1) * n // 8), file.with_name(file.name.replace("*", str(part + 1))))


def rows_of_squares(n, rows, file):
    j, i = numpy.divmod(numpy.arange(rows.start * (n + 1), (rows.stop + 1) * (n + 1)), n + 1)
    nodes, numbers, elements = [], [], []
    for square in (0, 1):
        nodes.append(numpy.column_stack([square + i / n, j / n, 0 * i]))
        first = 1 + square * (n + 1)**2
        numbers.append(first + i + (n + 1) * j)
        a = numbers[-1][(i < n) & (j < rows.stop)]
        corners = numpy.vstack([numpy.column_stack([a, a + 1, a + n + 2]), numpy.column_stack([a, a + n + 2, a + n + 1])])
        elements.append((2, 1 + square, corners))
        for edge in (0, 1):
            a = first + edge * n + (n + 1) * numpy.array(rows)
            elements.append((1, 3 + 2 * square + edge, numpy.column_stack([a, a + n + 1])))
    names = ['2 1 "left"', '2 2 "right"', '1 3 "start of left"', '1 4 "end of left"', '1 5 "start of right"', '1 6 "end of right"']
    points = numpy.empty(2 * len(i), [("number", "<i4"), ("point", "<f8", 3)])
    points["number"], points["point"] = numpy.concatenate(numbers), numpy.vstack(nodes)
    with open(file, "wb") as stream:
        stream.write(b"$MeshFormat\n2.2 1 8\n\x01\0\0\0\n$EndMeshFormat\n")
        stream.write("\n".join(["$PhysicalNames", "6", *names, "$EndPhysicalNames", "$Nodes", str(len(points)), ""]).encode())
        points.tofile(stream)
        number = sum(len(corners) for _, _, corners in elements)
        stream.write(f"\n$EndNodes\n$Elements\n{number}\n".encode())
        for kind, tag, corners in elements:
            numpy.array([kind, len(corners), 2], "<i4").tofile(stream)
            tags = numpy.arange(number - len(corners) + 1, number + 1)
            number -= len(corners)
            numpy.column_stack([tags, numpy.full((len(corners), 2), tag), corners]).astype("<i4").tofile(stream)
        stream.write(b"\n$EndElements\n")


def entry(name, kind, value):
    return f'<Parameter name="{name}" type="{kind}" value="{value}"/>'


def sublist(name, *inside):
    return f'<ParameterList name="{name}">{"".join(inside)}</ParameterList>'


def on_floor(mesh):
    """The cube pressed on a floor and pulled sideways at the top."""
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


def membranes(mesh):
    """The paper's coercive membranes."""
    def body(name, held, low, high, value):
        strip = sublist("strip", entry("Box", "Array(double)", f"{{0, 2, {low}, {high}}}"), entry("Value", "double", value))
        return sublist(name, entry("Mesh", "string", mesh), entry("Group", "string", name), entry("Physics", "string", "membrane"),
                       entry("Order", "int", 1), sublist("Loads", strip),
                       sublist("Supports", sublist("wall", entry("Surface", "string", f"{held} of {name}"))))
    joint = sublist("joint", entry("First Body", "string", "left"), entry("First Surface", "string", "end of left"),
                    entry("Second Body", "string", "right"), entry("Second Surface", "string", "start of right"))
    return sublist("Epafi", sublist("Bodies", body("left", "start", 0.75, 1, -1), body("right", "end", 0, 0.25, -3)),
                   sublist("Contact", joint))


class Memory(unittest.TestCase):
    def run_on(self, ranks, mesh, n, scene, file="scene.msh"):
        """(peak of each rank in kB, energy)"""
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            mesh(n, place / file)
            (place / "scene.xml").write_text(scene(file), encoding="ascii")
            run = subprocess.run([*LAUNCHER, str(ranks), sys.executable, __file__, "--measured", folder, EPAFI, place / "scene.xml",
                                  "--quiet", "--report", place / "report.xml"],
                                 capture_output=True, text=True, timeout=LIMIT, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            energy = re.search(r'name="Energy"[^>]*value="([^"]*)"', (place / "report.xml").read_text(encoding="utf-8"))
            return [json.loads((place / str(rank)).read_text(encoding="ascii")) for rank in range(ranks)], float(energy[1])

    def test_data_of_the_rank_with_most_fall(self):
        libraries, _ = self.run_on(8, block, 4, on_floor)
        alone, energy = self.run_on(1, block, 36, on_floor)
        whole = alone[0] - libraries[0]
        for ranks in (2, 4, 8):
            peaks, same = self.run_on(ranks, block, 36, on_floor)
            data = [peak - libraries[rank] for rank, peak in enumerate(peaks)]
            print(f"{ranks} ranks: data of each {data} kB, of one rank {whole} kB", flush=True)
            with self.subTest(ranks=ranks, data=data, whole=whole):
                self.assertLessEqual(max(data), whole * ranks**FALL)
                self.assertLessEqual(abs(same - energy), 1e-6 * abs(energy))
                if ranks == 8:
                    self.assertLessEqual(max(data), LEAST_ON_8 * whole)

    def test_no_rank_but_the_first_has_the_mesh(self):
        libraries, _ = self.run_on(8, squares, 8, membranes)
        (whole,), energy = self.run_on(1, squares, 400, membranes)
        peaks, same = self.run_on(8, squares, 400, membranes)
        data = [peak - libraries[rank] for rank, peak in enumerate(peaks)]
        print(f"membranes, 8 ranks: data of each {data} kB, of one rank {whole - libraries[0]} kB", flush=True)
        self.assertLessEqual(max(data[1:]), LEAST_OF_MESHES_ON_8 * (whole - libraries[0]), (data, whole))
        self.assertLessEqual(abs(same - energy), 1e-6 * abs(energy))
        peaks, same = self.run_on(8, squares, 400, membranes, "scene_*.msh")
        data = [peak - libraries[rank] for rank, peak in enumerate(peaks)]
        print(f"from eight files: {data} kB", flush=True)
        self.assertLessEqual(max(data), LEAST_OF_MESHES_ON_8 * (whole - libraries[0]), (data, whole)) # the first, too
        self.assertLessEqual(abs(same - energy), 1e-6 * abs(energy))


if __name__ == "__main__":
    if sys.argv[1] == "--measured":
        sys.exit(measured(sys.argv[2:]))
    if sys.argv[1] == "--squares":
        PLACE = pathlib.Path(sys.argv[3])
        PLACE.mkdir(parents=True, exist_ok=True)
        FILE = sys.argv[4] if len(sys.argv) > 4 else "scene.msh"
        squares(int(sys.argv[2]), PLACE / FILE)
        (PLACE / "scene.xml").write_text(membranes(FILE), encoding="ascii")
        sys.exit()
    EPAFI, *LAUNCHER = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
