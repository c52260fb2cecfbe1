#!/usr/bin/python3
"""test_surfaces.py DRIVERS: what epafi-plot finds of meshes and hides of surfaces, on cases that one can count."""

import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), sys.argv[1]]

import elastic_runs  # noqa: E402
import numpy  # noqa: E402
from plot import cells, part, pressure, render  # noqa: E402
from plot.errors import PlotError  # noqa: E402
from plot.run import Contact, Run, read_run  # noqa: E402


class Surfaces(unittest.TestCase):
    def test_outer_facets_cover_the_boundary_once_with_normals_outwards(self):
        for cell_type, count in (("triangle", 16), ("quadrilateral", 16), ("tetrahedron", 192), ("hexahedron", 96)):
            points, mesh = elastic_runs.block(cell_type, 4, 0.0)
            facets, cell = cells.outer_facets(cell_type, mesh)
            self.assertEqual(len(facets), count)
            outwards = points[facets].mean(axis=1) - points[mesh[cell]].mean(axis=1)
            if cells.is_plane(cell_type):
                along = points[facets[:, 1]] - points[facets[:, 0]]
                normal = numpy.column_stack([along[:, 1], -along[:, 0], 0 * along[:, 0]])
            else:
                normal = render.normals(points[facets])
            self.assertTrue(((normal * outwards).sum(axis=1) > 0).all(), cell_type)

    def test_cylinders_are_unrolled_at_their_true_lengths_and_cut_opposite_of_what_is_closed(self):
        """A skew one of radius 3 and length 4, a bore or a pin, in quadrilaterals; planes stay as they are."""
        frame = numpy.linalg.qr(numpy.array([[1.0, 2, 3], [0, 1, -1], [2, 0, 1]]))[0]
        angle, height = (part.ravel() for part in numpy.meshgrid(numpy.arange(24) * numpy.pi / 12, numpy.linspace(0, 4, 5)))
        radial = numpy.column_stack([numpy.cos(angle), numpy.sin(angle), 0 * angle]) @ frame.T
        points = 3 * radial + height[:, None] * frame[:, 2] + [7, -5, 2]
        facets = numpy.array([(24 * k + i, 24 * k + (i + 1) % 24, 24 * (k + 1) + (i + 1) % 24, 24 * (k + 1) + i)
                              for k in range(4) for i in range(24)])
        closed = numpy.cos(angle - 1) > 0.9
        for sense in (1, -1):
            zeros = numpy.zeros(len(points))
            pair = Contact("c", "c", points, zeros, zeros, closed, zeros, closed.astype(float), sense * radial, facets)
            seen = pressure.view(pair)
            place = seen.place(points)
            self.assertAlmostEqual(abs(place[closed][:, 0].mean()), 0, delta=3 * numpy.pi / 24)
            shown = seen.shown(facets, place)
            self.assertEqual(len(shown), 4 * 23)
            arcs = numpy.ptp(place[shown][:, :, 0], axis=1), numpy.ptp(place[shown][:, :, 1], axis=1)
            numpy.testing.assert_allclose(arcs[0], 3 * numpy.pi / 12, rtol=1e-9)
            numpy.testing.assert_allclose(arcs[1], 1, rtol=1e-9)
        flat = Contact("c", "c", points, zeros, zeros, closed, zeros, closed.astype(float), numpy.tile([0, 0, 1.0], (len(points), 1)), facets)
        numpy.testing.assert_array_equal(pressure.view(flat).place(points), points[:, :2])

    def test_contacts_of_membranes_with_obstacles_are_surfaces_and_no_lines(self):
        points, mesh = elastic_runs.block("quadrilateral", 4, 0.0)
        zeros, up = numpy.zeros(len(points)), numpy.tile([0, 0, 1.0], (len(points), 1))
        over = Contact("o", "o", points, zeros, zeros, zeros > 0, zeros, zeros, up, mesh)
        edge = Contact("e", "e", points, zeros, zeros, zeros > 0, zeros, zeros, up, cells.outer_facets("quadrilateral", mesh)[0])
        self.assertEqual(Run("r", "r", [], [over, edge], None).lines(), [edge])
        self.assertTrue(over.is_surface())
        self.assertIn("largest pressure 0", pressure.figure(Run("r", "r", [], [over], None), over).axes[0].get_title())

    def test_of_balls_what_faces_away_is_not_drawn_over_what_is_pressed(self):
        rng = numpy.random.default_rng(3)
        normal = rng.normal(size=(400, 3))
        normal /= numpy.linalg.norm(normal, axis=1)[:, None]
        zeros, closed = numpy.zeros(400), normal[:, 1] > 0.95
        facets = rng.integers(0, 400, (300, 3))
        seen = pressure.view(Contact("c", "c", normal, zeros, zeros, closed, zeros, closed.astype(float), normal, facets))
        shown = seen.shown(facets, seen.place(normal))
        self.assertTrue(0 < len(shown) < len(facets))
        self.assertGreater((normal[shown][:, :, 1]).min(), -0.3)

    def test_cells_of_several_shapes_have_the_facets_of_their_shapes(self):
        # A cube, a prism and a pyramid at its sides, and a tetrahedron on the pyramid: 4 + 4 + 3 + 3 facets are outside.
        points = numpy.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1),
                              (2, 0, 0), (2, 0, 1), (0.5, 0.5, 2), (0.5, -1, 1.5)], float)
        rows = [(0, 1, 2, 3, 4, 5, 6, 7), (1, 8, 2, 5, 9, 6, 6, 6), (4, 5, 6, 7, 10, 10, 10, 10), (4, 5, 10, 11, 11, 11, 11, 11)]
        shape, mesh, whole = cells.linear("hexahedron", numpy.array(rows))
        facets, cell = cells.outer_facets(shape, mesh)
        self.assertEqual(numpy.bincount(cell).tolist(), [4, 4, 3, 3])
        self.assertEqual(whole.tolist(), [0, 1, 2, 3])
        corners, polygon, _ = cells.triangles(facets)
        self.assertEqual(len(corners), 4 * 2 + (2 * 2 + 2) + 3 + 3)
        outwards = points[corners].mean(axis=1) - points[mesh[cell[polygon]]].mean(axis=1)
        first, second = points[corners[:, 1]] - points[corners[:, 0]], points[corners[:, 2]] - points[corners[:, 0]]
        self.assertTrue(((numpy.cross(first, second) * outwards).sum(axis=1)[cell[polygon] < 3] > 0).all())
        ends, _ = cells.edges(facets)
        self.assertTrue((ends[:, 0] != ends[:, 1]).all())

    def test_facets_between_owners_are_outer_ones_of_both(self):
        points, mesh = elastic_runs.block("hexahedron", 4, 0.0)
        owner = (points[mesh].mean(axis=1)[:, 0] > 0.5).astype(int)
        self.assertEqual(len(cells.outer_facets("hexahedron", mesh, owner)[0]), 96 + 2 * 16)

    def test_a_part_keeps_what_the_box_holds_and_the_contact_on_it(self):
        for cell_type, box in (("hexahedron", [0, 0.5, 0, 1, 0.5, 1.5]), ("quadrilateral", [0, 0.45, 0.55, 1.45])):
            with tempfile.TemporaryDirectory() as place:
                file = pathlib.Path(place) / "run.h5"
                elastic_runs.write(file, cell_type, n=10)
                run = read_run(file)
            kept = part.of(run, box)
            self.assertEqual([body.name for body in kept.bodies], ["lower", "upper"])
            for body in kept.bodies:  # 5 of 10 columns and layers each; in the plane the rim of 10 % is kept too
                self.assertEqual(len(body.cells), {"hexahedron": 5 * 10 * 5, "quadrilateral": 5 * 5}[cell_type])
                self.assertEqual(len(body.u), body.cells.max() + 1)
                self.assertEqual((len(body.points), len(body.von_mises)), (len(body.u), len(body.u)))
                self.assertLessEqual(body.points[:, 0].max(), 0.5 + 1e-12)
            whole, pair = run.contacts[0], kept.contacts[0]
            self.assertEqual(len(pair.points), 6 * 11 if cell_type == "hexahedron" else 6)
            self.assertEqual(len(pair.cells), 5 * 10 if cell_type == "hexahedron" else 5)
            places = cells.places(whole.points, pair.points)
            numpy.testing.assert_array_equal(pair.pressure, whole.pressure[places])
            sides = numpy.linalg.norm(pair.points[pair.cells[:, 0]] - pair.points[pair.cells[:, 1]], axis=1)
            numpy.testing.assert_allclose(sides, 0.1, rtol=1e-9)  # still links of neighbours
            lower = part.of(run, [0, 1, 0, 0.4] if cell_type == "quadrilateral" else [0, 1, 0, 1, 0, 0.4])
            self.assertEqual([body.name for body in lower.bodies], ["lower"])
            self.assertEqual(len(lower.contacts[0].points), 0)
            with self.assertRaisesRegex(PlotError, "bodies fill"):
                part.of(run, [5, 6, 0, 1])

    def test_every_edge_is_found_once_with_the_polygons_that_meet_there(self):
        ends, meeting = cells.edges(numpy.array([[0, 1, 2], [0, 2, 3]]))
        self.assertEqual(sorted(map(tuple, numpy.sort(ends, axis=1))), [(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)])
        inner = numpy.flatnonzero(meeting[:, 1] >= 0)
        self.assertEqual([sorted(ends[k]) for k in inner], [[0, 2]])
        self.assertEqual(sorted(meeting[inner[0]]), [0, 1])

    def test_chains_follow_links_and_close_loops(self):
        links = numpy.array([[2, 0], [0, 1], [4, 5], [5, 3], [3, 4]])
        self.assertEqual([list(curve) for curve in cells.chain(links, 6)], [[2, 0, 1], [3, 4, 5]])

    def test_the_nearer_triangle_hides_the_farther_one_in_any_order(self):
        near = numpy.array([[0, 0, 1], [1, 0, 1], [0, 1, 1]], float)
        far = numpy.array([[0, 0, 0], [1, 0, 0], [1, 1, 0]], float)
        red, blue = numpy.tile([1.0, 0, 0], (3, 1)), numpy.tile([0, 0, 1.0], (3, 1))
        for first, second in ((0, 1), (1, 0)):
            picture = render.Picture(numpy.zeros(2), numpy.ones(2), 40)
            both = numpy.array([near, far]), numpy.array([red, blue])
            picture.draw(both[0][[first, second]], both[1][[first, second]])
            pixels = picture.pixels()
            self.assertEqual(list(pixels[10, 15]), [255, 0, 0])  # in both
            self.assertEqual(list(pixels[20, 35]), [0, 0, 255])  # in the farther one alone
            self.assertEqual(list(pixels[38, 10]), [255, 255, 255])  # in none
            line = numpy.array([[[0.1, 0.05, 0.5], [0.95, 0.05, 0.5]]])
            seen = picture.visible(line, 1e-6)
            self.assertEqual(len(seen), 0)  # between the two, along the nearer one
            self.assertGreater(len(picture.visible(line + [0, 0, 1], 1e-6)), 0)

    def test_a_square_of_two_triangles_has_no_holes_and_no_pixel_outside(self):
        square = numpy.array([[[0.2, 0.2, 0], [0.8, 0.2, 0], [0.8, 0.8, 0]], [[0.2, 0.2, 0], [0.8, 0.8, 0], [0.2, 0.8, 0]]])
        picture = render.Picture(numpy.zeros(2), numpy.ones(2), 100)
        picture.draw(square, numpy.zeros((2, 3, 3)))
        dark = (picture.pixels() == 0).all(axis=2)
        self.assertTrue(dark[21:79, 21:79].all())
        self.assertFalse(dark[:19].any() or dark[81:].any() or dark[:, :19].any() or dark[:, 81:].any())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
