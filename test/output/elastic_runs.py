"""Small runs of elastic bodies in the layout of src/output/FieldWriter.hpp, made up of closed forms: something for epafi-plot
to draw that does not need Epafi."""

import h5py
import numpy

import model_problem

CUTS = {
    "triangle": [(0, 1, 3), (0, 3, 2)],
    "quadrilateral": [(0, 1, 3, 2)],
    "tetrahedron": [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)],
    "hexahedron": [(0, 1, 3, 2, 4, 5, 7, 6)],
}


def block(cell_type, n, bottom):
    """points, cells of the unit square or cube in n cells a side, its last coordinate from `bottom` on."""
    dimension = 2 if cell_type in ("triangle", "quadrilateral") else 3
    node = numpy.indices((n + 1,) * dimension).reshape(dimension, -1)[::-1].T  # x fastest
    points = numpy.zeros((len(node), 3))
    points[:, :dimension] = node / n
    points[:, dimension - 1] += bottom
    steps = (n + 1) ** numpy.arange(dimension)
    first = numpy.indices((n,) * dimension).reshape(dimension, -1)[::-1].T @ steps
    bits = numpy.array([sum(steps[d] * (k >> d & 1) for d in range(dimension)) for k in range(2**dimension)])
    return points, numpy.concatenate([first[:, None] + bits[list(cut)] for cut in CUTS[cell_type]])


def write(file, cell_type, n=6, amplitude=0.002, gap=0.0):
    """Two blocks, the upper one sinking into the lower one in the middle of their joint."""
    dimension = 2 if cell_type in ("triangle", "quadrilateral") else 3
    with h5py.File(file, "w") as content:
        for b, name in enumerate(("lower", "upper")):
            points, cells = block(cell_type, n, float(b))
            group = content.create_group(f"bodies/{name}")
            group.attrs["name"], group.attrs["cell_type"] = name, cell_type
            height = points[:, dimension - 1]
            u = numpy.zeros((len(points), dimension))
            u[:, dimension - 1] = -amplitude * height
            u[:, 0] = 0.3 * amplitude * points[:, 0]
            group["points"], group["cells"], group["u"] = points, cells, u
            group["von_mises"] = 1 + points[:, 0] * height
            group["subdomain"] = ((points[cells].mean(axis=1)[:, 0] > 0.5).astype("i4") + 2 * b).astype("i4")
            group["crosspoints"] = points[:0]
            if b == 0:
                write_contact(content, points, n, dimension, cell_type, gap)
        model_problem.write_history(content.create_group("history"), 1)


def write_contact(content, points, n, dimension, cell_type, gap):
    """The lower block's top; rows in an order of their own, as surfaces from files have it."""
    rows = numpy.flatnonzero(points[:, dimension - 1] == 1)
    order = numpy.random.default_rng(3).permutation(len(rows))
    place = numpy.argsort(order)
    group = content.create_group("contact/joint")
    group.attrs["name"], group.attrs["first_body"] = "joint", "lower"
    if dimension == 2:
        cells = numpy.column_stack([numpy.arange(1, n + 1), numpy.arange(n)])
    else:
        corner = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
        cells = numpy.column_stack([corner, corner + 1, corner + n + 2, corner + n + 1])
        if cell_type == "tetrahedron":
            cells = numpy.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    surface = points[rows]
    away = numpy.linalg.norm(surface[:, :dimension - 1] - 0.5, axis=1)
    pressure = numpy.sqrt(numpy.maximum(0, 1 - (away / 0.4)**2))
    area = numpy.full(len(rows), 1 / n**(dimension - 1))
    normal = numpy.zeros((len(rows), 3))
    normal[:, dimension - 1] = 1
    fields = {"points": surface, "normal": normal, "area": area, "pressure": pressure, "multiplier": pressure * area,
              "gap": numpy.maximum(0, away - 0.4)**2, "initial_gap": numpy.full(len(rows), gap),
              "active": (pressure > 0).astype("i4")}
    for name, values in fields.items():
        group[name] = values[order]
    group["cells"] = place[cells]
