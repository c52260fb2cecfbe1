"""The two blocks for CalculiX (package calculix-ccx): hexahedra of order 1 (C3D8) or 2 (C3D20), mortar contact without friction,
the lower block's side with the multipliers. Its elements are not Epafi's: energies agree as meshes become finer, not on one mesh."""

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


class Block:
    """Nodes and elements of a cube of n elements a side whose lower side is at `bottom`."""

    def __init__(self, n, order, bottom, first):
        self.n, self.order, self.bottom, self.first = n, order, bottom, first
        self.number = {}
        self.elements = [self.element(i, j, k) for k in range(n) for j in range(n) for i in range(n)]

    def node(self, *place):
        """Of a place on the grid of half elements (of order 1: of elements)."""
        return self.number.setdefault(place, self.first + len(self.number))

    def element(self, i, j, k):
        s = self.order
        corners = [(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        nodes = [self.node(*(s * x for x in corner)) for corner in corners]
        if s == 2:
            edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
            nodes += [self.node(*(p + q for p, q in zip(corners[a], corners[b]))) for a, b in edges]
        return nodes

    def point(self, place):
        h = EDGE / (self.n * self.order)
        return place[0] * h, place[1] * h, self.bottom + place[2] * h

    def chosen(self, inside):
        """Numbers of the elements whose place fulfils a condition, from 0 in this block."""
        n = self.n
        return [i + n * (j + n * k) for k in range(n) for j in range(n) for i in range(n) if inside(i, j, k)]


def listed(numbers, across=12):
    numbers = [str(number) for number in numbers]
    return "\n".join(", ".join(numbers[k:k + across]) for k in range(0, len(numbers), across))


def deck(problem, n, order):
    """CalculiX's input file."""
    lower = Block(n, order, 0.0, 1)
    upper = Block(n, order, EDGE, 1 + len(lower.number))
    count = n**3
    lines = ["*NODE, NSET=NALL"]
    for block in (lower, upper):
        lines += [f"{node}, {x!r}, {y!r}, {z!r}" for place, node in block.number.items() for x, y, z in [block.point(place)]]
    lines.append(f"*ELEMENT, TYPE={'C3D20' if order == 2 else 'C3D8'}, ELSET=EALL")
    for start, block in ((1, lower), (1 + count, upper)):
        for k, nodes in enumerate(block.elements):
            words = [str(start + k), *map(str, nodes)]
            lines.append(", ".join(words[:11]) + ("," if len(words) > 11 else ""))
            if len(words) > 11:
                lines.append(", ".join(words[11:]))
    half = n // 2
    for name, block, start, inside in (("TOP", lower, 1, lambda i, j, k: k == n - 1), ("BOTTOM", upper, 1 + count, lambda i, j, k: k == 0),
                                       ("RIGHT", upper, 1 + count, lambda i, j, k: i >= half),
                                       ("BACK", upper, 1 + count, lambda i, j, k: j >= half)):
        lines += [f"*ELSET, ELSET={name}", listed(start + e for e in block.chosen(inside))]
    lines += ["*SURFACE, NAME=SLAVE, TYPE=ELEMENT", "TOP, S2", "*SURFACE, NAME=MASTER, TYPE=ELEMENT", "BOTTOM, S1"]
    for name, block, axis in (("FLOOR", lower, 2), ("WALL", upper, 0), ("FRONT", upper, 1)):
        lines += [f"*NSET, NSET={name}", listed(node for place, node in block.number.items() if place[axis] == 0)]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}", "*DENSITY", "1.0",
              "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL", "*SURFACE INTERACTION, NAME=HARD",
              "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD", "*CONTACT PAIR, INTERACTION=HARD, TYPE=MORTAR", "SLAVE, MASTER",
              "*BOUNDARY", "FLOOR, 1, 3, 0.0"]
    lines += ["WALL, 1, 3, 0.0"] if problem == "held_blocks" else ["WALL, 1, 1, 0.0", "FRONT, 2, 2, 0.0"]
    lines += ["*STEP", "*STATIC", "1.0, 1.0", "*DLOAD", f"RIGHT, GRAV, {WEIGHT}, 0.0, 0.0, -1.0",
              f"BACK, GRAV, {LIFT[problem]}, 0.0, 0.0, 1.0",
              "*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
    return "\n".join(lines), loads(upper, half, LIFT[problem])


def loads(block, half, lift):
    """Vertical forces on the nodes, {node: force}: of an element's load corners have 1/8, of order 2 -1/8 and edges 1/6."""
    volume = (EDGE / block.n)**3
    shares = [1 / 8] * 8 if block.order == 1 else [-1 / 8] * 8 + [1 / 6] * 12
    forces = dict.fromkeys(range(block.first, block.first + len(block.number)), 0.0)
    for density, inside in ((-WEIGHT, lambda i, j, k: i >= half), (lift, lambda i, j, k: j >= half)):
        for element in block.chosen(inside):
            for node, share in zip(block.elements[element], shares):
                forces[node] += density * volume * share
    return forces


def energy_of(results, forces):
    """-1/2 f'u from CalculiX's printed displacements: the least potential energy, with that of its contact, which yields a little."""
    work = 0.0
    for line in results.splitlines():
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            work += forces.get(int(words[0]), 0.0) * float(words[3])
    return -work / 2


def solve(program, problem, n, order, threads, time_limit):
    """A run as in solvers.py: the whole program counts, input and output included. \\raises Failed"""
    with tempfile.TemporaryDirectory() as place:
        text, forces = deck(problem, n, order)
        (pathlib.Path(place) / "blocks.inp").write_text(text, encoding="ascii")
        start = time.perf_counter()
        with subprocess.Popen([program, "blocks"], cwd=place, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True, env={**os.environ, "OMP_NUM_THREADS": str(threads)}) as process:
            try:
                output, _ = process.communicate(timeout=time_limit)
            except subprocess.TimeoutExpired:
                process.kill()
                raise Failed(f"took longer than {time_limit:g} s") from None
        seconds = time.perf_counter() - start
        results = pathlib.Path(place) / "blocks.dat"
        energy = energy_of(results.read_text(encoding="ascii"), forces) if results.exists() else 0
        if energy == 0 or process.returncode != 0:
            raise Failed(next((line.strip() for line in output.splitlines() if "*ERROR" in line), "it says nothing of displacements"))
    return {"unknowns": 6 * len(forces), "total_seconds": seconds, "energy": energy, "peak_bytes": 0,
            "iterations": len(re.findall(r"^ iteration\s+\d+", output, re.MULTILINE))}
