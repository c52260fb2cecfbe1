"""The two blocks for CalculiX (package calculix-ccx): hexahedra of order 1 (C3D8) or 2 (C3D20), or six tetrahedra in the place of each
(C3D4, C3D10), mortar contact without friction, the multipliers on the lower block's side or the upper's. C3D8 is Epafi's element, and so
are the energies; C3D20 has no nodes inside. Contact of the kind HARD yields: a linear law that is stiff does not."""

import itertools
import math
import os
import pathlib
import re
import subprocess
import tempfile
import time

# As in held_blocks.xml and floating_blocks.xml.
YOUNG, POISSON, WEIGHT = 210000.0, 0.3, 20.0
LIFT = {"held_blocks": 20.0, "floating_blocks": 15.0}
EDGE = 10.0


class Failed(Exception):
    """Why there is no energy."""


# Corners of a cube's elements on the unit cube, edges between corners, faces of corners; loads: shares of corners and edges at order 2.
CUBE = [(a, b, c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]


def path(axes):
    """A tetrahedron from (0, 0, 0) to (1, 1, 1) along three axes, with a positive volume."""
    corners = [(0, 0, 0)]
    for axis in axes:
        corners.append(tuple(x + (k == axis) for k, x in enumerate(corners[-1])))
    return corners if axes in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else [corners[k] for k in (0, 2, 1, 3)]


class Shape:
    """Of the elements in a cube: names by order, corners, edges, faces, and the shares of an even load."""

    def __init__(self, names, cells, edges, faces, shares):
        self.names, self.cells, self.edges, self.faces, self.shares = names, cells, edges, faces, shares


SHAPES = {
    "hexahedra": Shape(("C3D8", "C3D20"), [CUBE],
                       [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
                       [(0, 1, 2, 3), (4, 5, 6, 7)],
                       ([1 / 8] * 8, [-1 / 8] * 8 + [1 / 6] * 12)),
    "tetrahedra": Shape(("C3D4", "C3D10"), [path(axes) for axes in itertools.permutations(range(3))],
                        [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
                        [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
                        ([1 / 4] * 4, [-1 / 20] * 4 + [1 / 5] * 6))}


class Block:
    """Nodes and elements of a box between two corners, of so many cubes along each axis."""

    def __init__(self, cubes, order, shape, box, first):
        self.cubes, self.order, self.shape, self.box, self.first = cubes, order, shape, box, first
        self.number = {}
        self.elements = [self.element(cell, *place) for place in self.places() for cell in shape.cells]

    def places(self):
        """Of the cubes, in the order of their elements."""
        nx, ny, nz = self.cubes
        return ((i, j, k) for k in range(nz) for j in range(ny) for i in range(nx))

    def node(self, *place):
        """Of a place on the grid of half cubes (of order 1: of cubes)."""
        return self.number.setdefault(place, self.first + len(self.number))

    def element(self, cell, i, j, k):
        s = self.order
        corners = [(i + a, j + b, k + c) for a, b, c in cell]
        nodes = [self.node(*(s * x for x in corner)) for corner in corners]
        if s == 2:
            nodes += [self.node(*(p + q for p, q in zip(corners[a], corners[b]))) for a, b in self.shape.edges]
        return nodes

    def points(self):
        """{node: its coordinates}."""
        return {node: tuple(low + x * (high - low) / (n * self.order) for x, n, low, high in zip(place, self.cubes, *self.box))
                for place, node in self.number.items()}

    def volume(self):
        """Of an element."""
        return math.prod((high - low) / n for n, low, high in zip(self.cubes, *self.box)) / len(self.shape.cells)

    def chosen(self, inside):
        """Numbers of the elements in the cubes whose place fulfils a condition, from 0 in this block."""
        each = len(self.shape.cells)
        return [each * cube + cell for cube, place in enumerate(self.places()) if inside(*place) for cell in range(each)]

    def side(self, height):
        """Pairs (element, number of its face from 1) at the lower (0) or upper (1) side."""
        cubes = self.chosen(lambda i, j, k: k == height * (self.cubes[2] - 1))
        return [(element, face) for element in cubes for face, corners in enumerate(self.shape.faces, start=1)
                if all(self.shape.cells[element % len(self.shape.cells)][corner][2] == height for corner in corners)]

    def at_zero(self, axis):
        """Nodes on the side where an axis, from 0, begins."""
        return [node for place, node in self.number.items() if place[axis] == 0]


def node_lines(points):
    return [f"{node}, " + ", ".join(f"{x:.12g}" for x in point) for node, point in points.items()]  # of a number 20 characters are read


def element_lines(elements, first):
    """A line of numbers has 16 at most, and ends with a comma where it goes on."""
    lines = []
    for number, nodes in enumerate(elements, start=first):
        words = [str(number), *map(str, nodes)]
        lines.append(", ".join(words[:11]) + ("," if len(words) > 11 else ""))
        if len(words) > 11:
            lines.append(", ".join(words[11:]))
    return lines


def listed(numbers, across=12):
    numbers = [str(number) for number in numbers]
    return "\n".join(", ".join(numbers[k:k + across]) for k in range(0, len(numbers), across))


def deck(problem, n, order, shape="hexahedra", n_lower=None, slave="lower"):
    """CalculiX's input file, and the forces of its loads, with n cubes along an edge of the blocks, of the lower one n_lower if given;
    slave: the block with the multipliers."""
    kind = SHAPES[shape]
    lower = Block((n_lower or n,) * 3, order, kind, ((0.0,) * 3, (EDGE,) * 3), 1)
    upper = Block((n,) * 3, order, kind, ((0.0, 0.0, EDGE), (EDGE, EDGE, 2 * EDGE)), 1 + len(lower.number))
    count = len(lower.elements)
    lines = ["*NODE, NSET=NALL", *node_lines(lower.points() | upper.points()),
             f"*ELEMENT, TYPE={kind.names[order - 1]}, ELSET=EALL", *element_lines(lower.elements + upper.elements, 1)]
    half = n // 2
    for name, inside in (("RIGHT", lambda i, j, k: i >= half), ("BACK", lambda i, j, k: j >= half)):
        lines += [f"*ELSET, ELSET={name}", listed(1 + count + e for e in upper.chosen(inside))]
    sides = ("SLAVE", "MASTER") if slave == "lower" else ("MASTER", "SLAVE")
    for name, block, start, height in zip(sides, (lower, upper), (1, 1 + count), (1, 0)):
        lines += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{start + e}, S{face}" for e, face in block.side(height))]
    for name, block, axis in (("FLOOR", lower, 2), ("WALL", upper, 0), ("FRONT", upper, 1)):
        lines += [f"*NSET, NSET={name}", listed(block.at_zero(axis))]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", "1.0",
              "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL", "*SURFACE INTERACTION, NAME=HARD",
              "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", "1e12", "*CONTACT PAIR, INTERACTION=HARD, TYPE=MORTAR", "SLAVE, MASTER",
              "*BOUNDARY", "FLOOR, 1, 3, 0.0"]
    lines += ["WALL, 1, 3, 0.0"] if problem == "held_blocks" else ["WALL, 1, 1, 0.0", "FRONT, 2, 2, 0.0"]
    lines += ["*STEP", "*STATIC", "1.0, 1.0", "*DLOAD", f"RIGHT, GRAV, {WEIGHT}, 0.0, 0.0, -1.0",
              f"BACK, GRAV, {LIFT[problem]}, 0.0, 0.0, 1.0",
              "*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
    return "\n".join(lines), loads(upper, half, LIFT[problem])


def loads(block, half, lift):
    """Forces on the nodes, {(node, axis from 1): force}: vertical ones."""
    forces = {(node, 3): 0.0 for node in block.number.values()}
    for density, inside in ((-WEIGHT, lambda i, j, k: i >= half), (lift, lambda i, j, k: j >= half)):
        for element in block.chosen(inside):
            for node, share in zip(block.elements[element], block.shape.shares[block.order - 1]):
                forces[node, 3] += density * block.volume() * share
    return forces


def energy_of(results, forces):
    """-1/2 f'u from CalculiX's last printed displacements: the least potential energy, with that of its contact, which yields a
    little."""
    work = 0.0
    for line in results.rsplit("displacements", 1)[-1].splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            work += sum(forces.get((int(words[0]), axis), 0.0) * float(words[axis]) for axis in (1, 2, 3))
    return -work / 2


def solve(program, problem, sizes, order, shape, slave, threads, time_limit):
    """A run as in solvers.py. \\raises Failed"""
    text, forces = deck(problem, sizes["upper"], order, shape, sizes["lower"], slave)
    return {"unknowns": 3 * (text.split("*ELEMENT")[0].count("\n") - 1), **measured(program, text, forces, threads, time_limit)}


def measured(program, text, forces, threads, time_limit):
    """What a run of an input file measures: the whole program counts, input and output included. \\raises Failed"""
    with tempfile.TemporaryDirectory() as place:
        (pathlib.Path(place) / "model.inp").write_text(text, encoding="ascii")
        start = time.perf_counter()
        with subprocess.Popen([program, "model"], cwd=place, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, env={**os.environ, "OMP_NUM_THREADS": str(threads)}) as process:
            try:
                output, _ = process.communicate(timeout=time_limit)
            except subprocess.TimeoutExpired:
                process.kill()
                raise Failed(f"took longer than {time_limit:g} s") from None
        seconds = time.perf_counter() - start
        results = pathlib.Path(place) / "model.dat"
        energy = energy_of(results.read_text(encoding="ascii"), forces) if results.exists() else 0
        if energy == 0 or process.returncode != 0:
            raise Failed(next((line.strip() for line in output.splitlines() if "*ERROR" in line), "it says nothing of displacements"))
    return {"total_seconds": seconds, "energy": energy, "peak_bytes": 0,
            "iterations": len(re.findall(r"^ iteration\s+\d+", output, re.MULTILINE))}
