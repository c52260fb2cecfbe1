"""Scenes of xml/ for CalculiX (package calculix-ccx): punch, three_cubes and bracket with elements of order 1 or 2, without friction. The
program's whole run counts; the mesh and the input file are made before it.

Contact is TYPE=SURFACE TO SURFACE with a linear stiffness, not the mortars of calculix.py: those leave out each node of the slave that
is held, be it along the surface, and the systems turn singular. The stiffness is about the greatest with which a scene's contact zone
settles; what it yields is 1e-6 of the punch's energy, 1e-5 of three_cubes' and 1e-4 of the bracket's, whose error of 4 % seems to be 3.9 %.

The punch is one layer of hexahedra, of thickness 1 and held across it. A rigid floor is one fixed element, the master. Bodies that float
need no springs: contact begins closed. All loads are nodal forces, so that their work is known. The bracket's mesh is Epafi's own: Gmsh's
library makes it from the same file with the same settings.
"""

import ctypes
import ctypes.util
import pathlib
import tempfile

import calculix
from calculix import CUBE, SHAPES, Block, Failed
from reference import ROOT

STEEL, ALUMINIUM = (210000.0, 0.3), (70000.0, 0.33)  # Young's modulus, Poisson's ratio
STIFFNESS = {"punch": 1e10, "three_cubes": 1e8, "bracket": 1e6}  # of contact, MPa/mm
SQUARE = ([1 / 4] * 4, [-1 / 12] * 4 + [1 / 3] * 4)  # shares of a face's corners and edges, by order
TETRAHEDRON = (0, 1, 2, 3, 4, 5, 6, 7, 9, 8)  # CalculiX's order of Gmsh's nodes


class Deck:
    """An input file as it grows, and the forces of its loads, {(node, axis from 1): force}."""

    def __init__(self, order):
        self.order, self.nodes, self.elements, self.forces = order, {}, 0, {}
        self.bodies, self.held, self.contact = [], [], []

    def add(self, name, points, elements, kind, material):
        """A body of {node: point} and lists of nodes; the number of its first element."""
        first = self.elements + 1
        self.nodes |= points
        self.elements += len(elements)
        self.bodies += [f"*ELEMENT, TYPE={kind}, ELSET={name}", *calculix.element_lines(elements, first), f"*MATERIAL, NAME={name}",
                        "*ELASTIC", f"{material[0]}, {material[1]}", f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"]
        return first

    def block(self, name, cubes, box, material, order=None):
        """A body of hexahedra with surfaces NAME0, below, and NAME1, above."""
        order = order or self.order
        kind = SHAPES["hexahedra"]
        block = Block(cubes, order, kind, box, 1 + max(self.nodes, default=0))
        first = self.add(name, block.points(), block.elements, kind.names[order - 1], material)
        for height in (0, 1):
            self.surface(f"{name}{height}", [(first + element, face) for element, face in block.side(height)])
        return block

    def floor(self, low, high):
        """A fixed block of one element below z = 0 and the surface floor1."""
        block = self.block("floor", (1, 1, 1), ((*low, min(low)), (*high, 0.0)), STEEL, order=1)
        for axis in (1, 2, 3):
            self.hold(block.points(), axis)

    def surface(self, name, faces):
        self.contact += [f"*SURFACE, NAME={name}, TYPE=ELEMENT", *(f"{element}, S{face}" for element, face in faces)]

    def pair(self, slave, master):
        self.contact += ["*CONTACT PAIR, INTERACTION=HARD, TYPE=SURFACE TO SURFACE", f"{slave}, {master}"]

    def hold(self, nodes, axis):
        self.held += [f"{node}, {axis}" for node in sorted(nodes)]

    def load(self, nodes, shares, force):
        """A force {x, y, z} handed to nodes by shares."""
        for node, share in zip(nodes, shares):
            for axis, component in enumerate(force, start=1):
                if component:
                    self.forces[node, axis] = self.forces.get((node, axis), 0.0) + share * component

    def text(self, stiffness):
        lines = ["*NODE, NSET=NALL", *calculix.node_lines(self.nodes), *self.bodies, "*SURFACE INTERACTION, NAME=HARD",
                 "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{stiffness:g}", *self.contact, "*BOUNDARY", *self.held,
                 "*STEP", "*STATIC", "1.0, 1.0", "*CLOAD",
                 *(f"{node}, {axis}, {force:.12g}" for (node, axis), force in self.forces.items()),
                 "*NODE PRINT, NSET=NALL", "U", "*END STEP", ""]
        return "\n".join(lines)


def punch(meshes, order):
    deck = Deck(order)
    (nx, nz), (mx, mz) = meshes["block"], meshes["punch"]
    block = deck.block("block", (nx, 1, nz), ((0.0, 0.0, -20.0), (20.0, 1.0, 0.0)), ALUMINIUM)
    stamp = deck.block("punch", (mx, 1, mz), ((0.0, 0.0, 0.0), (5.0, 1.0, 10.0)), STEEL)
    deck.hold(block.at_zero(0) + stamp.at_zero(0), 1)
    deck.hold(deck.nodes, 2)
    deck.hold(block.at_zero(2), 3)
    upper = [corner for corner, (_, _, c) in enumerate(CUBE) if c == 1]
    upper += [len(CUBE) + edge for edge, ends in enumerate(SHAPES["hexahedra"].edges) if set(ends) <= set(upper)] if order == 2 else []
    for element, _ in stamp.side(1):
        deck.load([stamp.elements[element][k] for k in upper], SQUARE[order - 1], (0.0, 0.0, -200.0 * 5.0 / mx))
    deck.pair("punch0", "block1")
    return deck


def three_cubes(meshes, order):
    n = meshes["upper"][0]
    if n % 4:
        raise Failed(f"the loads' boxes end inside of elements: {n} along an edge are no multiple of 4")
    deck = Deck(order)
    deck.floor((-1.0, -1.0), (11.0, 11.0))
    for name, below, bottom, material in (("lower", "floor", 0.0, STEEL), ("middle", "lower", 10.0, (70000.0, 0.3)),
                                          ("upper", "middle", 20.0, STEEL)):
        block = deck.block(name, meshes[name], ((0.0, 0.0, bottom), (10.0, 10.0, bottom + 10.0)), material)
        for axis in (0, 1):
            deck.hold(block.at_zero(axis), axis + 1)
        deck.pair(f"{name}0", f"{below}1")
    for density, inside in ((-80.0, lambda i, j, k: 2 * max(i, j) < n <= 2 * k), (300.0, lambda i, j, k: 4 * min(i, j, k) >= 3 * n)):
        for element in block.chosen(inside):
            deck.load(block.elements[element], block.shape.shares[order - 1], (0.0, 0.0, density * block.volume()))
    return deck


def bracket(meshes, order):
    points, elements, facets = gmsh(ROOT / "xml/meshes/bracket.geo", meshes["bracket"], order)
    deck, kind = Deck(order), SHAPES["tetrahedra"]
    deck.add("bracket", points, elements, kind.names[order - 1], STEEL)
    faces = {frozenset(nodes[corner] for corner in corners): (element, face) for element, nodes in enumerate(elements, start=1)
             for face, corners in enumerate(kind.faces, start=1)}
    deck.surface("foot", [faces[frozenset(nodes[:3])] for nodes in facets["bottom"]])
    deck.floor((-10.0, -40.0), (90.0, 40.0))
    for axis in (1, 2):
        deck.hold({node for nodes in facets["holes"] for node in nodes}, axis)
    for surface, traction in (("washers", (0.0, 0.0, -26.2)), ("eye", (5.0, 0.0, 5.0))):
        for nodes in facets[surface]:
            deck.load(nodes, areas([points[node] for node in nodes]), traction)
    deck.pair("foot", "floor1")
    return deck


# Barycentric coordinates of the points where polynomials of degree 5 are integrated, and their weights.
DUNAVANT = [((1 / 3,) * 3, 0.225)]
for _inner, _weight in ((0.059715871789770, 0.132394152788506), (0.797426985353087, 0.125939180544827)):
    DUNAVANT += [(tuple(_inner if k == corner else (1 - _inner) / 2 for k in range(3)), _weight) for corner in range(3)]


def areas(points):
    """Integrals of the shape functions over a triangle of 3 nodes, or of 6 and curved."""
    result = [0.0] * len(points)
    for (a, b, c), weight in DUNAVANT:
        if len(points) == 3:
            values, by_a, by_b = (a, b, c), (1, 0, -1), (0, 1, -1)
        else:
            values = (a * (2 * a - 1), b * (2 * b - 1), c * (2 * c - 1), 4 * a * b, 4 * b * c, 4 * c * a)
            by_a = (4 * a - 1, 0, 1 - 4 * c, 4 * b, -4 * b, 4 * (c - a))  # c = 1 - a - b
            by_b = (0, 4 * b - 1, 1 - 4 * c, 4 * a, 4 * (c - b), -4 * a)
        u, v = ([sum(slope * point[axis] for slope, point in zip(slopes, points)) for axis in range(3)] for slopes in (by_a, by_b))
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        size = weight * sum(x * x for x in normal)**0.5 / 2
        result = [area + size * value for area, value in zip(result, values)]
    return result


def gmsh(file, factor, order):
    """Points {node: point}, tetrahedra and {surface: triangles} of a geometry with Mesh.MeshSizeFactor. \\raises Failed"""
    name = ctypes.util.find_library("gmsh")
    if name is None:
        raise Failed("Gmsh's library is not there; install the package libgmsh-dev, or all of the build's by ./setup packages build")
    library = ctypes.CDLL(name)
    library.gmshInitialize(0, None, 0, None, None)  # Gmsh 4.9 and later have one argument more before the last
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "mesh.msh"
        error = ctypes.c_int()
        for function, *arguments in (("OptionSetNumber", b"General.Terminal", ctypes.c_double(0)),
                                     ("OptionSetNumber", b"Mesh.MeshSizeFactor", ctypes.c_double(factor)), ("Open", bytes(file)),
                                     ("ModelMeshGenerate", 3), ("ModelMeshSetOrder", order),
                                     ("OptionSetNumber", b"Mesh.MshFileVersion", ctypes.c_double(2.2)), ("Write", bytes(mesh))):
            getattr(library, f"gmsh{function}")(*arguments, ctypes.byref(error))
            if error.value:
                raise Failed(f"Gmsh's {function} fails with {file.name}")
        library.gmshFinalize(None)
        return read_msh(mesh.read_text(encoding="ascii"))


def read_msh(text):
    """As gmsh says, of a file of version 2.2 in which only what belongs to a physical group is saved."""
    sections = {part.split("\n", 1)[0]: part.splitlines()[2:] for part in text.split("$") if not part.startswith("End")}
    names = {number: name.strip('"') for _, number, name in (line.split() for line in sections["PhysicalNames"])}
    points = {int(node): tuple(map(float, point)) for node, *point in (line.split() for line in sections["Nodes"])}
    tetrahedra, facets = [], {name: [] for name in names.values()}
    for line in sections["Elements"]:
        _, kind, tags, group, *words = line.split()
        nodes = [int(word) for word in words[int(tags) - 1:]]
        if kind in ("4", "11"):
            tetrahedra.append([nodes[k] for k in TETRAHEDRON[:len(nodes)]])
        elif kind in ("2", "9"):
            facets[names[group]].append(nodes)
    return points, tetrahedra, facets


SCENES = {"punch": punch, "three_cubes": three_cubes, "bracket": bracket}


def solve(program, problem, meshes, order, repeats, time_limit):
    """Runs as of calculix.measured, all of one mesh: {body: its elements along the axes, or the factor of its sizes}. \\raises Failed"""
    deck = SCENES[problem](meshes, order)
    text = deck.text(STIFFNESS[problem])
    runs = [calculix.measured(program, text, deck.forces, 1, time_limit) for _ in range(repeats)]
    return [{"unknowns": 3 * len(deck.nodes), **run} for run in runs]
