"""A small run of the model problem, solved here by a dense active-set method, in the layout of src/output/FieldWriter.hpp:
something for epafi-plot to draw that does not need Epafi."""

import h5py
import numpy

SQUARE = numpy.array([[4, -1, -2, -1], [-1, 4, -1, -2], [-2, -1, 4, -1], [-1, -2, -1, 4]]) / 6.0


def body(x0, n):
    """points, cells of (x0, x0 + 1) x (0, 1) in n x n squares."""
    x, y = numpy.meshgrid(x0 + numpy.arange(n + 1) / n, numpy.arange(n + 1) / n)
    points = numpy.column_stack([x.ravel(), y.ravel(), numpy.zeros(x.size)])
    corner = (numpy.arange(n)[:, None] * (n + 1) + numpy.arange(n)).ravel()
    return points, numpy.column_stack([corner, corner + 1, corner + n + 2, corner + n + 1])


def system(points, cells, strip, value, n):
    """Stiffness and load; the load fills the strip y in [strip[0], strip[1]]."""
    stiffness, load = numpy.zeros((len(points), len(points))), numpy.zeros(len(points))
    for cell in cells:
        stiffness[numpy.ix_(cell, cell)] += SQUARE
        if strip[0] < points[cell, 1].mean() < strip[1]:
            load[cell] += value / n**2 / 4
    return stiffness, load


def solve(n):
    """u of both bodies, multipliers and remaining gaps on x = 1 (coercive problem)."""
    bodies = [body(0.0, n), body(1.0, n)]
    parts = [system(*bodies[0], (0.75, 1), -1.0, n), system(*bodies[1], (0, 0.25), -3.0, n)]
    size = (n + 1)**2
    stiffness = numpy.zeros((2 * size, 2 * size))
    stiffness[:size, :size], stiffness[size:, size:] = parts[0][0], parts[1][0]
    load = numpy.concatenate([parts[0][1], parts[1][1]])
    free = numpy.ones(2 * size, bool)
    free[0:size:n + 1] = False
    free[size + n::n + 1] = False
    index = numpy.cumsum(free) - 1
    inverse = numpy.linalg.inv(stiffness[numpy.ix_(free, free)])
    rows = numpy.zeros((n + 1, int(free.sum())))  # B: u1 - u2 <= 0
    for k in range(n + 1):
        rows[k, index[k * (n + 1) + n]] = 1
        rows[k, index[size + k * (n + 1)]] = -1
    dual, right = rows @ inverse @ rows.T, rows @ inverse @ load[free]
    active = numpy.ones(n + 1, bool)
    for _ in range(50):
        multiplier = numpy.zeros(n + 1)
        multiplier[active] = numpy.linalg.solve(dual[numpy.ix_(active, active)], right[active])
        gap = dual @ multiplier - right
        now = multiplier - gap > 0
        if (now == active).all():
            break
        active = now
    u = numpy.zeros(2 * size)
    u[free] = inverse @ (load[free] - rows.T @ multiplier)
    return bodies, (u[:size], u[size:]), multiplier, gap, active


def crosspoints(x0, parts):
    lines = numpy.arange(parts + 1) / parts
    return numpy.array([[x0 + a, b, 0] for b in lines for a in lines if not (a in (0, 1) and b in (0, 1))]).reshape(-1, 3)


def write_history(group, outer):
    """A history with the shape of a SMALBE run (or of MPRGP alone, with one outer iteration)."""
    random = numpy.random.default_rng(7)
    steps, rows, products, value = "scccceccpccc", [], 0, 1.0
    for k in range(outer):
        for letter in steps[:max(3, len(steps) - 2 * k)]:
            products += 2 if letter in "e" else 1
            value *= {"s": 1.6, "c": 0.55, "e": 0.8, "p": 0.7}[letter] * random.uniform(0.8, 1.2) ** 2
            rows.append((len(rows), k, ord(letter), value, 0.8 * 0.2**k * value**0.1 if outer > 1 else 0.0, -1 + value**2,
                         9, products))
    names = ["iteration", "outer", "step", "projected_gradient", "constraint_residual", "objective", "active_bounds",
             "hessian_multiplications"]
    types = ["i4", "i4", "i1", "f8", "f8", "f8", "i8", "i4"]
    for name, kind, column in zip(names, types, zip(*rows)):
        group[name] = numpy.array(column, dtype=kind)


def write(file, n=16, parts=4, outer=5, refine=1):
    """Solves on n x n elements a body and writes the run, each cell split into refine^2 (to make large files cheaply)."""
    bodies, fields, multiplier, gap, active = solve(n)
    fine = n * refine
    with h5py.File(file, "w") as content:
        for b, (name, u) in enumerate(zip(("left", "right"), fields)):
            points, cells = body(float(b), fine)
            coarse, line = u.reshape(n + 1, n + 1), numpy.arange(fine + 1) / refine
            along = numpy.array([numpy.interp(line, numpy.arange(n + 1), row) for row in coarse])
            values = numpy.array([numpy.interp(line, numpy.arange(n + 1), column) for column in along.T]).T
            middle = points[cells].mean(axis=1)
            part = (middle[:, 1] * parts).astype(int) * parts + ((middle[:, 0] - b) * parts).astype(int)
            group = content.create_group(f"bodies/{name}")
            group.attrs["name"] = name
            group["points"], group["cells"], group["u"] = points, cells, values.reshape(-1, 1)
            group["subdomain"] = (part + b * parts**2).astype("i4")
            group["crosspoints"] = crosspoints(float(b), parts)
        group = content.create_group("contact/middle")
        group.attrs["name"] = "middle"
        group["points"] = bodies[0][0][n::n + 1]
        group["initial_gap"], group["gap"] = numpy.zeros(n + 1), gap
        group["multiplier"], group["active"] = multiplier, active.astype("i4")
        write_history(content.create_group("history"), outer)
