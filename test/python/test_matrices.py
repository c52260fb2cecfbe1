#!/usr/bin/python3
"""test_matrices.py: contact of matrices of one's own, beside dense solutions."""

import sys
import unittest

import numpy
import scipy.sparse

import epafi


def membrane(columns, rows, x0=0.0):
    """Coordinates, nodes of elements, and matrices of bilinear squares with the conductivity 1."""
    i, j = numpy.meshgrid(numpy.arange(columns + 1), numpy.arange(rows + 1))
    coordinates = numpy.column_stack([x0 + i.ravel() / columns, j.ravel() / rows])
    corner = (numpy.arange(rows)[:, None] * (columns + 1) + numpy.arange(columns)).ravel()
    nodes = corner[:, None] + [0, 1, columns + 2, columns + 1]
    square = numpy.array([[4, -1, -2, -1], [-1, 4, -1, -2], [-2, -1, 4, -1], [-1, -2, -1, 4]]) / 6
    return coordinates, nodes, numpy.broadcast_to(square, (len(nodes), 4, 4))


def blocks(columns, rows):
    """The same of plane strain, E = 1, nu = 0: two unknowns a node."""
    coordinates, nodes, _ = membrane(columns, rows)
    law, hx, hy = numpy.diag([1, 1, 0.5]), 1 / columns, 1 / rows
    matrix = numpy.zeros((8, 8))
    for x in (-3 ** -0.5, 3 ** -0.5):
        for y in (-3 ** -0.5, 3 ** -0.5):
            strain = numpy.zeros((3, 8))
            for a, (sx, sy) in enumerate([(-1, -1), (1, -1), (1, 1), (-1, 1)]):
                strain[0, 2 * a] = strain[2, 2 * a + 1] = sx * (1 + sy * y) / (2 * hx)
                strain[1, 2 * a + 1] = strain[2, 2 * a] = sy * (1 + sx * x) / (2 * hy)
            matrix += strain.T @ law @ strain * hx * hy / 4
    unknowns = (2 * nodes[:, :, None] + [0, 1]).reshape(len(nodes), 8)
    return coordinates, unknowns, numpy.broadcast_to(matrix, (len(nodes), 8, 8))


def solid(count, low, high):
    """Bricks or squares of order 1, elastic, E = 1, nu = 0: coordinates, nodes of cells, unknowns and matrices of these."""
    d, step = len(count), (numpy.array(high) - low) / count
    axes = [low[k] + step[k] * numpy.arange(count[k] + 1) for k in range(d)]
    places = numpy.column_stack([axis.ravel("F") for axis in numpy.meshgrid(*axes, indexing="ij")])
    strides = numpy.cumprod([1, *(n + 1 for n in count[:-1])])
    numbers = numpy.meshgrid(*map(numpy.arange, count), indexing="ij")
    first = sum(axis.ravel("F") * stride for axis, stride in zip(numbers, strides))
    corners = numpy.array([[(a >> k) & 1 for k in range(d)] for a in range(2 ** d)])
    cells, matrix = first[:, None] + corners @ strides, numpy.zeros(2 * (2 ** d, d))
    for point in numpy.ndindex(*d * [2]):
        xi = 0.5 + (numpy.array(point) - 0.5) / 3 ** 0.5
        parts = numpy.where(corners, xi, 1 - xi)
        gradient = numpy.column_stack([(2 * corners[:, k] - 1) * numpy.delete(parts, k, axis=1).prod(axis=1) / step[k]
                                       for k in range(d)])
        laplacian = numpy.einsum("ak,bk,ij->aibj", gradient, gradient, numpy.eye(d))
        matrix += (laplacian + numpy.einsum("aj,bi->aibj", gradient, gradient)) / 2 * step.prod() / 2 ** d
    unknowns = (d * cells[:, :, None] + numpy.arange(d)).reshape(len(cells), -1)
    return places, cells, unknowns, numpy.broadcast_to(matrix.reshape(2 * [d * 2 ** d]), (len(cells), *2 * [d * 2 ** d]))


def on_side(places, count, level):
    """Facets of such a body on a plane of the last axis: nodes in turn, and of each node what an even load of 1 gives it."""
    d, own = len(count), numpy.flatnonzero(numpy.isclose(places[:, -1], level))
    grid = own.reshape([n + 1 for n in count[:-1]], order="F")
    facets = (numpy.column_stack([grid[:-1], grid[1:]]) if d == 2 else numpy.column_stack(
        [grid[:-1, :-1].ravel(), grid[1:, :-1].ravel(), grid[1:, 1:].ravel(), grid[:-1, 1:].ravel()]))
    share = numpy.zeros(len(places))
    numpy.add.at(share, facets, 1 / facets.size)
    return facets, share


def summed(unknowns, matrices, size):
    row = numpy.repeat(unknowns, unknowns.shape[1], axis=1).ravel()
    column = numpy.tile(unknowns, unknowns.shape[1]).ravel()
    return scipy.sparse.csr_matrix((numpy.ravel(matrices), (row, column)), shape=(size, size))


class Matrices(unittest.TestCase):
    def shelf_and_cloth(self, n, parts=None):
        """The membranes of README.md: a shelf held at its left edge, a cloth whose weight presses on its right one."""
        problem = epafi.Problem(2, components=1)
        bodies = [membrane(n, n, x0) for x0 in (0.0, 1.0)]
        held = {k * (n + 1): 0.0 for k in range(n + 1)}
        numbers = []
        for body, ((coordinates, nodes, matrices), own) in enumerate(zip(bodies, (held, None))):
            if parts is None:
                k = summed(nodes, matrices, len(coordinates))
                numbers.append(problem.add_body(k, coordinates, held=own, name=("shelf", "cloth")[body]))
            else:
                numbers.append(problem.add_elements(nodes, matrices, coordinates, parts=parts, held=own))
        edge = numpy.arange(n + 1) * (n + 1)
        rows = scipy.sparse.csr_matrix((numpy.tile([1.0, -1.0], n + 1), (numpy.repeat(numpy.arange(n + 1), 2), numpy.column_stack(
            [numbers[0][0] + edge + n, numbers[1][0] + edge]).ravel())), shape=(n + 1, problem.unknowns))
        problem.set_contact(rows, 0)
        loads = numpy.zeros(problem.unknowns)
        numpy.add.at(loads, bodies[1][1] + numbers[1][0], -0.25 / n ** 2)
        return problem, loads, rows

    def test_whole_and_cut_bodies_have_the_solution_of_the_scene(self):
        scene = epafi.solve({"Bodies": {
            "shelf": {"Order": 1, "Rectangle": [0, 1, 0, 1], "Elements": [16, 16], "Supports": {"wall": {"Edge": "left"}}},
            "cloth": {"Order": 1, "Rectangle": [1, 2, 0, 1], "Elements": [16, 16], "Loads": {"weight": {"Value": -1}}}},
            "Contact": {"seam": {"First Body": "shelf", "First Edge": "right", "Second Body": "cloth", "Second Edge": "left"}},
            "Solver": {"Tolerance": 1e-12}})
        for parts in (None, 5, numpy.arange(256) // 64):
            problem, loads, rows = self.shelf_and_cloth(16, parts)
            solution = problem.solve(loads, tolerance=1e-12)
            self.assertAlmostEqual(solution.energy, scene.energy, delta=1e-10)
            self.assertAlmostEqual(solution.forces.sum(), 1, delta=1e-9)
            self.assertLess((rows @ solution.u).max(), 1e-9)
            self.assertEqual(solution.subdomains, {None: 2, 5: 10}.get(parts if numpy.ndim(parts) == 0 else 0, 8))

    def test_loads_and_gaps_change_without_new_factors(self):
        problem, loads, _ = self.shelf_and_cloth(8, 3)
        first = problem.solve(loads, tolerance=1e-11)
        double = problem.solve(2 * loads)
        numpy.testing.assert_allclose(double.u, 2 * first.u, atol=1e-8)
        self.assertEqual(double.setup_seconds, first.setup_seconds)
        with self.assertRaisesRegex(epafi.InputError, "those of the first solve"):
            problem.solve(loads, tolerance=1e-3)
        moved = problem.solve(loads, gaps=numpy.full(9, 0.5))  # the cloth hangs lower by the gap
        self.assertAlmostEqual((moved.u - first.u)[81:].mean(), -0.5, delta=1e-8)

    def test_eliminated_supports_are_as_good_as_held_ones(self):
        coordinates, unknowns, matrices = blocks(4, 4)
        k, bottom = summed(unknowns, matrices, 50), numpy.arange(10)
        free = numpy.arange(10, 50)
        top = scipy.sparse.csr_matrix((numpy.ones(5), (numpy.arange(5), 41 + 2 * numpy.arange(5))), shape=(5, 50))
        loads = numpy.zeros(50)
        loads[41::2] = 0.1
        found = []
        for arguments in (dict(stiffness=k, held=dict.fromkeys(bottom, 0.0)), dict(stiffness=k[free][:, free], unknowns=free)):
            problem = epafi.Problem(2)
            problem.add_body(coordinates=coordinates, **arguments)
            problem.set_contact(top, 0.05)
            found.append(problem.solve(loads, tolerance=1e-12))
        numpy.testing.assert_allclose(found[0].u, found[1].u, atol=1e-11)
        self.assertAlmostEqual((top @ found[0].u).max(), 0.05, delta=1e-11)

    def test_friction_holds_what_would_slide(self):
        coordinates, unknowns, matrices = blocks(4, 4)
        bottom = scipy.sparse.csr_matrix((-numpy.ones(5), (numpy.arange(5), 1 + 2 * numpy.arange(5))), shape=(5, 50))
        loads = numpy.zeros(50)
        loads[41::2], loads[40::2] = -1.0, 0.2  # pressed down, and pulled aside by a fifth of it
        problem = epafi.Problem(2)
        problem.add_elements(unknowns, matrices, coordinates, parts=2)
        problem.set_contact(bottom, 0, friction=0.6)
        solution = problem.solve(loads, tolerance=1e-10)
        self.assertAlmostEqual(solution.forces.sum(), 5, delta=1e-7)
        slides = epafi.Problem(2)
        slides.add_elements(unknowns, matrices, coordinates, parts=2, name="block")
        slides.set_contact(bottom, 0)
        with self.assertRaisesRegex(epafi.SolvabilityError, "block"):
            slides.solve(loads)

    def test_bodies_meshed_apart_rub_as_those_of_a_scene(self):
        """In the plane and in space, Coulomb's law and Tresca's; the scene makes its own mortars."""
        for d, counts, push in ((2, ([6, 4], [4, 3]), [0.02]), (3, ([3, 3, 3], [2, 2, 2]), [0.02, 0.01])):
            for law in ({"friction": 0.3}, {"bound": 0.0235}):
                with self.subTest(dimension=d, **law):
                    problem, loads, sides, bodies = epafi.Problem(d), [], [], {}
                    for number, count in enumerate(counts):
                        low, high = numpy.zeros(d), numpy.ones(d)
                        low[-1], high[-1] = number, number + 1.0
                        places, cells, unknowns, matrices = solid(count, low, high)
                        floor = numpy.flatnonzero(places[:, -1] == 0)
                        held = None if number else {d * node + k: 0.0 for node in floor for k in range(d)}
                        own = problem.add_elements(unknowns, matrices, places, held=held, parts=1 + number)
                        sides.append((own, on_side(places, count, 1.0)[0][:, ::1 - 2 * number], cells))
                        force = numpy.array([*push, -0.1]) * number
                        loads.append(numpy.outer(on_side(places, count, 1.0 + number)[1], force).ravel())
                        box = numpy.column_stack([low, high]).ravel().tolist()
                        bodies[("lower", "upper")[number]] = {
                            "Physics": ("plane strain", "elasticity 3-D")[d - 2], ("Rectangle", "Box")[d - 2]: box,
                            "Elements": count, "Young's Modulus": 1.0, "Poisson's Ratio": 0.0, "Order": 1, **(
                                {"Loads": {"top": {"Kind": "traction", "Surface": "top", "Force": force.tolist()}}} if number else
                                {"Supports": {"floor": {"Surface": "bottom", **{axis: 0.0 for axis in "XYZ"[:d]}}}})}
                    joint = problem.joint(*sides)
                    self.assertAlmostEqual(joint.areas.sum(), 1)
                    numpy.testing.assert_allclose(joint.directions - numpy.eye(d)[-1], 0, atol=1e-14)
                    traction = {name: value * (joint.areas if name == "bound" else 1) for name, value in law.items()}
                    problem.set_contact(joint.rows, joint.gaps, **traction)
                    found = problem.solve(numpy.concatenate(loads), tolerance=1e-13, parameters={"Equilibrium Tolerance": 1e-13})
                    self.assertAlmostEqual(found.forces.sum(), 0.1, delta=1e-10)
                    self.assertEqual(found.tangential.shape, ((d - 1) * len(joint.gaps),))
                    rubs = numpy.linalg.norm(found.tangential.reshape(-1, d - 1), axis=1)
                    most = 0.3 * found.forces if "friction" in law else traction["bound"]
                    self.assertLess((rubs - most).max(), 1e-10)
                    self.assertGreater((rubs > most - 1e-10).sum(), 0)
                    scene = epafi.solve({"Bodies": bodies, "Contact": {"joint": {
                        "First Body": "lower", "First Surface": "top", "Second Body": "upper", "Second Surface": "bottom",
                        **({"Friction": 0.3} if "friction" in law else {"Friction Bound": 0.0235})}},
                        "Solver": {"Tolerance": 1e-13, "Equilibrium Tolerance": 1e-13}})
                    self.assertAlmostEqual(found.energy / scene.energy, 1, delta=1e-12)

    def test_own_tangents_and_slips_count(self):
        """A block that is held against its pull by what it has slipped before: s moves it, bounds of 1 hold it."""
        coordinates, unknowns, matrices = blocks(4, 4)
        sole, loads = 2 * numpy.arange(5), numpy.zeros(50)
        bottom, along = (scipy.sparse.csr_matrix((sign * numpy.ones(5), (numpy.arange(5), sole + k)), shape=(5, 50))
                         for sign, k in ((-1, 1), (1, 0)))
        loads[41::2] = -1.0
        found = []
        for slips in (0.0, 0.25):
            problem = epafi.Problem(2)
            problem.add_elements(unknowns, matrices, coordinates)
            problem.set_contact(bottom, 0, bound=1.0, tangents=along[::-1], slips=slips, nodes=range(4, -1, -1))
            found.append(problem.solve(loads, tolerance=1e-12))
        numpy.testing.assert_allclose((found[1].u - found[0].u)[::2], 0.25, atol=1e-10)
        for solution in found:
            reactions = bottom.T @ solution.forces + along[::-1].T @ solution.tangential
            self.assertLess(abs(summed(unknowns, matrices, 50) @ solution.u + reactions - loads).max(), 1e-12)

    def test_ties_hold_beside_contact_as_the_conditions_of_a_solution_have_it(self):
        """A block on a floor that it may leave: its right side stays upright, d away from where it was."""
        coordinates, unknowns, matrices = blocks(4, 4)
        k, right = summed(unknowns, matrices, 50), 8 + 10 * numpy.arange(5)
        sole = scipy.sparse.csr_matrix((-numpy.ones(5), (numpy.arange(5), 1 + 2 * numpy.arange(5))), shape=(5, 50))
        upright = scipy.sparse.csr_matrix((numpy.ones(5), (numpy.arange(5), right)), shape=(5, 50))
        loads = numpy.zeros(50)
        loads[41:50:2] = [-0.1, -0.1, 0, 0.05, 0.1]
        for parts in (1, 3):
            problem = epafi.Problem(2)
            problem.add_elements(unknowns, matrices, coordinates, parts=parts, held={10 * i: 0.0 for i in range(5)})
            problem.set_contact(sole, 0.01)
            problem.set_ties(upright)
            setups = set()
            for d in (0.0, numpy.linspace(0.1, 0.2, 5)):
                found = problem.solve(loads, tie_gaps=d, tolerance=1e-12)
                setups.add(found.setup_seconds)
                numpy.testing.assert_allclose(found.u[right], d * numpy.ones(5), atol=1e-10)
                rest = k @ found.u + sole.T @ found.forces + upright.T @ found.tie_forces - loads
                self.assertLess(abs(numpy.delete(rest, 10 * numpy.arange(5))).max(), 1e-10)
                self.assertGreaterEqual(found.forces.min(), 0)
                self.assertLess((sole @ found.u).max(), 0.01 + 1e-10)
                self.assertLess(abs(found.forces @ (0.01 - sole @ found.u)), 1e-11)
            self.assertTrue(0 < (found.forces > 0).sum() < 5)
            self.assertEqual(len(setups), 1)

    def test_ties_alone_are_a_linear_problem(self):
        coordinates, unknowns, matrices = blocks(3, 3)
        k, free = summed(unknowns, matrices, 32).toarray(), numpy.arange(8, 32)
        rows, d, loads = numpy.random.default_rng(1).normal(size=(3, 32)), [0.1, -0.2, 0.3], numpy.linspace(0, 1, 32)
        problem = epafi.Problem(2)
        problem.add_elements(unknowns, matrices, coordinates, parts=2, held=dict.fromkeys(range(8), 0.0))
        problem.set_ties(rows, d)
        found = problem.solve(loads, tolerance=1e-13)
        own = rows[:, free]
        exact = numpy.linalg.solve(numpy.block([[k[8:, 8:], own.T], [own, numpy.zeros((3, 3))]]), numpy.append(loads[8:], d))
        numpy.testing.assert_allclose(numpy.append(found.u[free], found.tie_forces), exact, atol=1e-9)

    def test_bodies_meshed_apart_are_stretched_evenly_where_they_are_tied(self):
        """By a traction of 1, which supports on symmetry planes do not hinder: u of the last axis is the height."""
        for d, counts in ((2, ([6, 4], [4, 3])), (3, ([3, 3, 2], [2, 4, 2]))):
            problem, sides, loads = epafi.Problem(d), [], []
            for number, count in enumerate(counts):
                low, high = numpy.zeros(d), numpy.ones(d)
                low[-1], high[-1] = number, number + 1.0
                places, cells, unknowns, matrices = solid(count, low, high)
                held = {int(d * node + k): 0.0 for k in range(d) for node in numpy.flatnonzero(places[:, k] == 0)}
                own = problem.add_elements(unknowns, matrices, places, held=held, parts=1 + number)
                sides.append((own, on_side(places, count, 1.0)[0], cells))
                loads.append(numpy.outer(on_side(places, count, 2.0)[1] if number else 0 * places[:, 0], numpy.eye(d)[-1]).ravel())
            joint = problem.joint(*sides, tied=True)
            problem.set_ties(joint.rows, joint.gaps)
            found = problem.solve(numpy.concatenate(loads), tolerance=1e-13)
            u, heights = found.u.reshape(-1, d), numpy.concatenate([body[:, -1] for body in problem._points])
            with self.subTest(dimension=d):
                numpy.testing.assert_allclose(u, numpy.outer(heights, numpy.eye(d)[-1]), atol=1e-10)
                numpy.testing.assert_allclose(abs(found.tie_forces @ joint.directions), numpy.eye(d)[-1], atol=1e-10)

    def test_numbers_that_are_none_are_refused_in_a_sentence(self):
        coordinates, nodes, matrices = membrane(2, 2)
        k, bad = summed(nodes, matrices, 9), numpy.array([numpy.nan, *numpy.ones(8)])
        worse = k.copy()
        worse.data[3] = numpy.inf

        def solved(add=None, contact=(numpy.eye(9), 1.0), loads=numpy.ones(9), ties=None, law={}, **more):
            problem = epafi.Problem(2, components=1)
            problem.add_body(**{"stiffness": k, "coordinates": coordinates, "held": {0: 0.0}, **(add or {})})
            problem.set_contact(*contact, **law)
            if ties:
                problem.set_ties(*ties)
            return problem.solve(loads, **more)

        self.assertTrue(solved().converged)
        for what, sentence in (
                (dict(add={"stiffness": worse}), "entry 3 of a matrix's data is inf"), (dict(add={"held": {0: numpy.nan}}), "finite"),
                (dict(add={"coordinates": numpy.column_stack([bad, bad])}), "entry 0, 0 of the coordinates is nan"),
                (dict(contact=(numpy.diag(bad), 0)), "entry 0, 0 of a matrix is nan"), (dict(loads=bad), "entry 0 of the loads is nan"),
                (dict(contact=(numpy.eye(9), bad)), "entry 0 of the gaps is nan"), (dict(gaps=bad), "entry 0 of the gaps is nan"),
                (dict(law={"friction": bad}), "entry 0 of coefficients of friction is nan"),
                (dict(law={"bound": bad}), "entry 0 of bounds of friction is nan"),
                (dict(law={"bound": 1, "slips": numpy.nan, "tangents": numpy.eye(9)}), "entry 0 of the slips is nan"),
                (dict(ties=(numpy.eye(2, 9, 3), [0, numpy.nan])), "entry 1 of the gaps of ties is nan"),
                (dict(gaps=[1, 2]), "the gaps have 2 entries, but there are 9 rows")):
            with self.subTest(sentence), self.assertRaisesRegex(epafi.InputError, sentence):
                solved(**what)
        with self.assertRaisesRegex(epafi.InputError, "entry 0, 0, 0 of the element matrices is nan"):
            epafi.Problem(2, components=1).add_elements(nodes, numpy.nan * matrices, coordinates)

    def test_arrays_may_be_used_again_before_the_first_solve(self):
        coordinates, nodes, matrices = membrane(2, 2)
        k, rows, gap = summed(nodes, matrices, 9), numpy.eye(1, 9, 4), numpy.array([0.1])
        for add in ("add_body", "add_elements"):
            forces = []
            for is_reused in (False, True):
                problem, given = epafi.Problem(2, components=1), [k.copy(), nodes.copy(), matrices.copy(), coordinates.copy()]
                getattr(problem, add)(*([given[0]] if add == "add_body" else given[1:3]), given[3], held={0: 0})
                own, c = rows.copy(), gap.copy()
                problem.set_contact(own, c)
                if is_reused:
                    for array in (given[0].data, *given[1:], own, c):
                        array *= 3
                forces.append(problem.solve(numpy.ones(9)).forces)
            with self.subTest(add):
                self.assertGreater(forces[0], 0)
                numpy.testing.assert_array_equal(*forces)

    def test_what_does_not_fit_is_refused_in_a_sentence(self):
        coordinates, nodes, matrices = membrane(2, 2)
        k = summed(nodes, matrices, 9)
        for wrong, sentence in (
                (lambda p: p.add_body(k, coordinates[:, :1]), "coordinates have shape"),
                (lambda p: p.add_body(k[:5, :5], coordinates), "has 5 rows, but the body 9"),
                (lambda p: p.add_body(scipy.sparse.hstack([k, k]), coordinates), "an entry in column 17"),
                (lambda p: p.add_elements(nodes + 1, matrices, coordinates), "numbered from 0 to 8"),
                (lambda p: p.add_elements(nodes, matrices[:3], coordinates), "element matrices have shape"),
                (lambda p: p.add_elements(nodes, matrices, coordinates, parts=[0, 1]), "2 numbers of parts"),
                (lambda p: p.add_elements(nodes, matrices, coordinates, parts=0), "4 elements cannot be cut into 0 parts"),
                (lambda p: p.add_elements(nodes, matrices, coordinates, parts=5), "4 elements cannot be cut into 5 parts"),
                (lambda p: p.add_elements(nodes + 0.7, matrices, coordinates), "float64, but must be integers"),
                (lambda p: p.add_body(k, coordinates, held={0: 0, 9: 1}), "held unknowns are numbered from 0 to 8"),
                (lambda p: p.add_elements(nodes, matrices, coordinates, held={0: 0, -1: 1}), "held unknowns are numbered"),
                (lambda p: p.add_body(k, coordinates, held={0: 0, 1.5: 1}), "held unknowns are numbers of type float64"),
                (lambda p: p.add_body(k[1:, 1:], coordinates, unknowns=range(1, 9), held={0: 1}), "0 is held, but has no row"),
                (lambda p: p.add_body(1j * k, coordinates), "are complex"),
                (lambda p: (p.add_body(k, coordinates, held={0: 0}), p.solve(numpy.full(9, 1j))), "are complex"),
                (lambda p: p.joint(*2 * [(p.add_body(k, coordinates), [[0, 2]], nodes)]), "facet 0 belongs to no cell"),
                (lambda p: p.joint(*2 * [(p.add_body(k, coordinates), [[0, 1, 2]], nodes)]), "facets have 3 nodes"),
                (lambda p: p.joint(*2 * [(p.add_body(k, coordinates), [[0, 9]], nodes)]), "numbered from 0 to 8"),
                (lambda p: p.joint(*2 * [(range(3), [[0, 1]], nodes)]), "not the unknowns of a body"),
                (lambda p: p.set_contact(numpy.eye(2, 9), 0), "9 columns, but there are 0 unknowns"),
                (lambda p: (p.add_body(k, coordinates), p.set_ties(numpy.eye(2, 8))), "8 columns, but there are 9 unknowns"),
                (lambda p: (p.add_body(k, coordinates),
                            p.set_contact(numpy.eye(2, 9), 0, 0.3, tangents=numpy.eye(1, 9), nodes=[2])), "different rows of"),
                (lambda p: (p.add_body(k, coordinates), p.solve([1.0])), "loads have shape"),
                (lambda p: (p.add_body(k, coordinates, held={0: 0}), p.solve(numpy.ones(9)), p.set_contact(numpy.eye(9), 0)),
                 "solved already"),
                (lambda p: (p.add_body(k, coordinates, held={0: 0}), p.set_contact(numpy.eye(9), 0, bound=-1), p.solve(numpy.ones(9))),
                 "friction"),
                (lambda p: (p.add_body(k, coordinates, held={0: 0}), p.solve(numpy.ones(9), parameters={"Tolerence": 1})),
                 "Tolerence")):
            with self.subTest(sentence), self.assertRaisesRegex(epafi.InputError, sentence):
                wrong(epafi.Problem(2, components=1))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
