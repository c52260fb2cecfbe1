"""Which problems there are (problems.py), and what is known of them."""

from functools import partial
from typing import Any

import numpy
import scipy.sparse

from .problems import SCENES, ContactProblem, of_grid, of_scene


def _string(n: int, **facts: Any) -> ContactProblem:
    """-u'' = -1 over a floor, times h squared."""
    x = numpy.arange(1, n + 1) / (n + 1)
    stiffness = scipy.sparse.diags([-1, 2, -1], [-1, 0, 1], shape=(n, n)) * float(n + 1)
    return of_grid(stiffness, numpy.full(n, -1 / (n + 1)), -0.1, numpy.inf, x[:, None], **facts)


def _grid(n: int) -> tuple[numpy.ndarray, numpy.ndarray, scipy.sparse.spmatrix]:
    """Inner nodes of the unit square, x first, and linear elements' matrix of the Laplacian."""
    line, one = scipy.sparse.diags([-1, 2, -1], [-1, 0, 1], shape=(n, n)), scipy.sparse.identity(n)
    y, x = (axis.ravel() for axis in numpy.meshgrid(*2 * [numpy.arange(1, n + 1) / (n + 1)], indexing="ij"))
    return x, y, scipy.sparse.kron(line, one) + scipy.sparse.kron(one, line)


def _obstacle(n: int, **facts: Any) -> ContactProblem:
    """Problem A of More and Toraldo, SIAM J. Optim. 1 (1991)."""
    x, y, stiffness = _grid(n)
    return of_grid(stiffness, numpy.full(n * n, (n + 1.0) ** -2), numpy.sin(3.2 * x) * numpy.sin(3.3 * y), numpy.inf,
                   numpy.column_stack([x, y]), **facts)


def _torsion(n: int, **facts: Any) -> ContactProblem:
    """DEPT of MINPACK-2 (Averick, Carter, More, Xue 1992)."""
    x, y, stiffness = _grid(n)
    depth = numpy.minimum(numpy.minimum(x, 1 - x), numpy.minimum(y, 1 - y))
    return of_grid(stiffness, numpy.full(n * n, 5 * (n + 1.0) ** -2), -depth, depth, numpy.column_stack([x, y]), **facts)


def _journal_bearing(n: int, **facts: Any) -> ContactProblem:
    """DPJB of MINPACK-2, as packages/benchmarks has it: eccentricity 0.1, 2 pi x 20."""
    hx, hy = 2 * numpy.pi / (n + 1), 20 / (n + 1)
    x, y = hx * numpy.arange(1, n + 1), hy * numpy.arange(1, n + 1)

    def p(xi: numpy.ndarray) -> numpy.ndarray:
        return (1 + 0.1 * numpy.cos(xi)) ** 3

    east, west = ((p(x) + p(x + step)) / 2 * hy / hx for step in (hx, -hx))
    height = (4 * p(x) + p(x + hx) + p(x - hx)) / 6 * hx / hy
    along = scipy.sparse.diags([-west[1:], east + west, -east[:-1]], [-1, 0, 1])
    across = scipy.sparse.diags([-1, 2, -1], [-1, 0, 1], shape=(n, n))
    stiffness = scipy.sparse.kron(scipy.sparse.identity(n), along) + scipy.sparse.kron(across, scipy.sparse.diags(height))
    return of_grid(stiffness, numpy.tile(0.1 * hx * hy * numpy.sin(x), n), 0.0, numpy.inf,
                   numpy.column_stack([numpy.tile(x, n), numpy.repeat(y, n)]), **facts)


def _block(box: list, elements: list, modulus: float, order: int, **more: Any) -> dict:
    plane = len(box) == 4
    return {"Physics": "plane strain" if plane else "elasticity 3-D", "Rectangle" if plane else "Box": box, "Elements": elements,
            "Young's Modulus": modulus, "Poisson's Ratio": 0.3, "Order": order, **more}


def _force(box: list, force: float) -> dict:
    return {"Kind": "body", "Box": box, "Force": [0, 0, force]}


HALF_CLOSED = {
    "Bodies": {"lower": _block([0, 10, 0, 10, 0, 10], [8, 8, 8], 210000.0, 1,
                               Supports={"floor": {"Surface": "bottom", "X": 0.0, "Y": 0.0, "Z": 0.0}}),
               "upper": _block([0, 10, 0, 10, 10, 20], [8, 8, 8], 210000.0, 1,
                               Supports={"wall": {"Surface": "left", "X": 0.0, "Y": 0.0, "Z": 0.0}},
                               Loads={"weight": _force([5, 10, 0, 10, 10, 20], -20.0), "lift": _force([0, 10, 5, 10, 10, 20], 20.0)})},
    "Contact": {"joint": {"First Body": "lower", "First Surface": "top", "Second Body": "upper", "Second Surface": "bottom"}}}


def _on_floor(force: list, **contact: Any) -> dict:
    """A square block, or a cube, on a rigid floor, whose top is pressed; nothing else holds it."""
    d = len(force)
    return {"Bodies": {"block": _block(d * [0, 1], d * [16 if d == 2 else 8], 1.0, 4 - d,
                                       Loads={"press": {"Kind": "traction", "Surface": "top", "Force": force}})},
            "Obstacles": {"floor": {"Kind": "plane", "Point": d * [0], "Normal": [*(d - 1) * [0], 1]}},
            "Contact": {"foot": {"First Body": "block", "First Surface": "bottom", "Obstacle": "floor", **contact}}}


MM = "mm, N, MPa"
ONE = "without dimension"
EXACT = "active sets with residuals in extended precision; "


def _scene(scene: Any, title: str, units: str, energy: float | None, found: str = EXACT + "FETI-DP agrees to 1e-10",
           **more: Any) -> tuple:
    source = SCENES / scene if isinstance(scene, str) else scene
    return partial(of_scene, source), dict(title=title, units=units, energy=energy, found=found, **more)


def _own(make: Any, n: int, title: str, energy: float) -> tuple:
    return partial(make, n), dict(title=title, units=ONE, energy=energy, verdict="one solution",
                                  found="active sets with SuperLU; MPRGP agrees to 1e-10")


# Energies to ten digits. Where a mesh is Gmsh's they hold for the one of Debian 12.
PROBLEMS = {
    "string": _own(_string, 399, "A string over a floor", -0.040371287535),
    "obstacle": _own(_obstacle, 98, "A membrane over an obstacle", 1.9629761708),
    "torsion": _own(_torsion, 98, "Elastic-plastic torsion of a square bar", -0.41838678325),
    "journal_bearing": _own(_journal_bearing, 98, "Pressure in a journal bearing", -0.18057327324),
    "coercive": _scene("coercive.xml", "Two membranes, both held", ONE, -0.1191392141),
    "semicoercive": _scene("semicoercive.xml", "Two membranes, one of which floats", ONE, -0.54360523879),
    "three_bodies": _scene("three_bodies.xml", "A membrane that floats between two", ONE, -0.29385394276),
    "regions": _scene("regions.xml", "Two membranes with jumps of the conductivity", ONE, -0.092012726971),
    "channels": _scene("channels.xml", "Blocks with steel plates, jumps of 10 500", MM, -28.34694458),
    "two_blocks": _scene(HALF_CLOSED, "Two blocks in space, half closed", MM, -12.032690249),
    "board": _scene("board.xml", "A board on a block", MM, -6.5804148239),
    "punch": _scene("punch.xml", "A punch that floats on a block", MM, -19.169903427),
    "nafems_punch": _scene("nafems_punch.xml", "NAFEMS: punch with a rounded edge, of revolution", MM, -71508.64148),
    "nafems_roller": _scene("nafems_roller.xml", "NAFEMS: roller on a block", MM, -14854.701704),
    "notch": _scene("notch.xml", "A block with a notch in space, on a floor", MM, -135.99066083),
    "cattaneo_mindlin": _scene("cattaneo_mindlin.xml", "Cattaneo and Mindlin: cylinders with Coulomb friction", MM, -2545.3688603),
    "sheared_block": _scene(_on_floor([0.002, -0.01], Friction=0.3), "A block that Coulomb friction holds", ONE, -5.7644022686e-05),
    "tresca_block": _scene(_on_floor([0.002, -0.01], **{"Friction Bound": 0.003}), "The same with a bound of friction", ONE,
                           -5.9292735492e-05),
    "sheared_cube": _scene(_on_floor([0.0018, 0.0009, -0.01], Friction=0.3), "A cube that Coulomb friction holds", ONE,
                           -6.2444988193e-05),
    "tresca_cube": _scene(_on_floor([0.0018, 0.0009, -0.01], **{"Friction Bound": 0.003}), "The same with a bound of friction",
                          ONE, -6.4630601859e-05),
    "may_slide": _scene(_on_floor([0.0, -0.01]), "A block that may stand anywhere", ONE, -4.55e-05,
                        "closed form: p^2 (1 - nu^2) / 2E of even pressure", verdict="many solutions"),
    "lifted": _scene("semicoercive.xml", "A membrane that nothing holds down", ONE, None,
                     "its load goes on working when it rises", verdict="no solution",
                     set={"Bodies/right/Loads/lower strip/Value": 1.0}),
}
