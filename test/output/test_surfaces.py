#!/usr/bin/python3
"""test_surfaces.py DRIVERS: what epafi-plot finds of meshes and hides of surfaces, on cases that one can count."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), sys.argv[1]]

import elastic_runs  # noqa: E402
import numpy  # noqa: E402
from plot import cells, render  # noqa: E402


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

    def test_facets_between_owners_are_outer_ones_of_both(self):
        points, mesh = elastic_runs.block("hexahedron", 4, 0.0)
        owner = (points[mesh].mean(axis=1)[:, 0] > 0.5).astype(int)
        self.assertEqual(len(cells.outer_facets("hexahedron", mesh, owner)[0]), 96 + 2 * 16)

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
