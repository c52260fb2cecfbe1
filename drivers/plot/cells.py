"""Cells, facets and edges as arrays of node numbers (order of corners: src/mesh/Cell.hpp)."""

import numpy

FACETS = {
    "triangle": [(0, 1), (1, 2), (2, 0)],
    "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tetrahedron": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
    "hexahedron": [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
}


HEX_LATTICE = numpy.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
                           (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
                           (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1), (0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1),
                           (1, 1, 0), (1, 1, 2), (1, 1, 1)])


def octants():
    """The eight hexahedra between the 27 nodes of a quadratic one."""
    number = {tuple(place): node for node, place in enumerate(HEX_LATTICE)}
    return [tuple(number[tuple(first + corner // 2)] for corner in HEX_LATTICE[:8])
            for first in numpy.ndindex(2, 2, 2)]


# Linear cells between the nodes of quadratic ones; of cells without inner nodes that of their corners.
PIECES = {
    "line": [(0, 2), (2, 1)],
    "triangle": [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    "quadrilateral": [(0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)],
    "tetrahedron": [(0, 4, 6, 7), (4, 1, 5, 8), (6, 5, 2, 9), (7, 8, 9, 3), (6, 8, 4, 5), (6, 8, 5, 9), (6, 8, 9, 7),
                    (6, 8, 7, 4)],
    "hexahedron": octants(),
}


# Corners of cells of several shapes, by their numbers of nodes, as quadrilaterals or hexahedra whose corners fall together.
COLLAPSED = {
    "quadrilateral": {3: (0, 1, 2, 2), 6: (0, 1, 2, 2)},
    "hexahedron": {4: (0, 1, 2, 2, 3, 3, 3, 3), 10: (0, 1, 2, 2, 3, 3, 3, 3), 5: (0, 1, 2, 3, 4, 4, 4, 4),
                   13: (0, 1, 2, 3, 4, 4, 4, 4), 6: (0, 1, 2, 2, 3, 4, 5, 5), 15: (0, 1, 2, 2, 3, 4, 5, 5)},
}


def collapsed(shape, cells):
    """The shape and the rows of cells that are not all alike, or of prisms and pyramids; None of others."""
    sizes = cells.shape[1] - numpy.cumprod((cells == cells[:, -1:])[:, ::-1], axis=1).sum(axis=1) + 1
    if shape not in ("prism", "pyramid") and (sizes == cells.shape[1]).all():
        return None
    common = "quadrilateral" if shape == "quadrilateral" else "hexahedron"
    rows = cells[:, :min(cells.shape[1], 8 if common == "hexahedron" else 4)]
    if common == "hexahedron" and rows.shape[1] < 8:
        rows = numpy.pad(rows, ((0, 0), (0, 8 - rows.shape[1])), mode="edge")
    for size, places in COLLAPSED[common].items():
        rows = numpy.where((sizes == size)[:, None], cells[:, numpy.minimum(places, cells.shape[1] - 1)], rows)
    return common, rows


def linear(cell_type, cells):
    """Linear cells that draw quadratic ones, by ascending first nodes, each with its cell; linear ones are left alone."""
    shape = cell_type.removeprefix("quadratic ")
    if rows := collapsed(cell_type.split(" ")[-1], cells):
        return *rows, numpy.arange(len(cells))
    if cell_type.startswith("serendipity "):
        shape = cell_type.removeprefix("serendipity ")
        return shape, cells[:, :len(set(sum(FACETS[shape], ())))], numpy.arange(len(cells))
    if shape == cell_type:
        return cell_type, cells, numpy.arange(len(cells))
    pieces = PIECES[shape]
    parts = cells[:, numpy.array(pieces)].reshape(-1, len(pieces[0]))
    order = numpy.argsort(parts[:, 0], kind="stable")
    return shape, parts[order], numpy.repeat(numpy.arange(len(cells)), len(pieces))[order]


def is_plane(cell_type):
    return cell_type in ("triangle", "quadrilateral")


def keys(tuples):
    """One number for each row of node numbers, the same for rows of the same nodes in any order."""
    ordered = numpy.sort(tuples, axis=1).astype(numpy.uint64)
    again = numpy.pad(ordered[:, 1:] == ordered[:, :-1], ((0, 0), (1, 0)))  # a node that is there twice counts as the greatest
    ordered = numpy.sort(numpy.where(again, ordered[:, -1:], ordered), axis=1)
    factor = ordered.max(initial=0) + numpy.uint64(1)
    key = ordered[:, 0]
    for column in (1, ordered.shape[1] - 1) if ordered.shape[1] > 2 else (1,):  # least, next and greatest tell facets apart
        key = key * factor + ordered[:, column]
    return key


def facets(cell_type, cells):
    """All facets of all cells, each with its cell."""
    sides = FACETS[cell_type]
    rows, cell = (numpy.concatenate([cells[:, list(side)] for side in sides]), numpy.tile(numpy.arange(len(cells)), len(sides)))
    whole = distinct(rows) >= min(3, rows.shape[1])
    return rows[whole], cell[whole]


def distinct(rows):
    """How many different numbers each row has."""
    ordered = numpy.sort(rows, axis=1)
    return 1 + (ordered[:, 1:] != ordered[:, :-1]).sum(axis=1)


def outer_facets(cell_type, cells, owner=None):
    """Facets that one cell alone has, normal outwards, each with its cell; if cells have owners, those between two too."""
    all_facets, cell = facets(cell_type, cells)
    key = keys(all_facets)
    order = numpy.argsort(key, kind="stable")
    twin = key[order][1:] == key[order][:-1]
    if owner is not None:
        twin &= owner[cell[order]][1:] == owner[cell[order]][:-1]
    alone = ~(numpy.concatenate([[False], twin]) | numpy.concatenate([twin, [False]]))
    chosen = numpy.sort(order[alone])
    return all_facets[chosen], cell[chosen]


def triangles(polygons):
    """Polygons of three or four corners cut into triangles, each with its polygon and the corners' places in that."""
    places = numpy.array([[0, 1, 2], [0, 2, 3]][:polygons.shape[1] - 2])
    parts = polygons[:, places].swapaxes(0, 1).reshape(-1, 3)
    whole = distinct(parts) == 3
    return (parts[whole], numpy.tile(numpy.arange(len(polygons)), len(places))[whole],
            numpy.repeat(places, len(polygons), axis=0)[whole])


def edges(polygons):
    """Every edge once, n x 2, with the one or two polygons (-1: none) that meet there, n x 2."""
    corners = polygons.shape[1]
    ends = numpy.concatenate([polygons[:, [k, (k + 1) % corners]] for k in range(corners)])
    polygon = numpy.tile(numpy.arange(len(polygons)), corners)
    ends, polygon = ends[ends[:, 0] != ends[:, 1]], polygon[ends[:, 0] != ends[:, 1]]
    order = numpy.argsort(keys(ends), kind="stable")
    ends, polygon, key = ends[order], polygon[order], keys(ends)[order]
    first = numpy.concatenate([[True], key[1:] != key[:-1]]) if len(key) else numpy.zeros(0, bool)
    start = numpy.flatnonzero(first)
    following = numpy.minimum(start + 1, len(key) - 1)
    second = numpy.where(first[following] | (following == start), -1, polygon[following])
    return ends[start], numpy.column_stack([polygon[start], second])


def chain(links, count):
    """Rows of open or closed curves in their order, curve after curve, from links (row to following row) that each row has
    at most one of in each direction: list of arrays."""
    following = numpy.full(count, -1)
    following[links[:, 0]] = links[:, 1]
    has_previous = numpy.zeros(count, bool)
    has_previous[links[:, 1]] = True
    seen, curves = numpy.zeros(count, bool), []
    for start in [*numpy.flatnonzero(~has_previous), *range(count)]:  # open curves from their beginnings, then loops
        if seen[start]:
            continue
        curve, row = [], start
        while row >= 0 and not seen[row]:
            seen[row] = True
            curve.append(row)
            row = following[row]
        curves.append(numpy.array(curve))
    return curves


def places(points, wanted):
    """Index in `points` of each of the `wanted` points, which are among them to the last digit; -1 where not."""
    def whole(rows):
        return numpy.ascontiguousarray(rows + 0.0).view([("x", "f8"), ("y", "f8"), ("z", "f8")]).ravel()

    known, asked = whole(points), whole(wanted)
    order = numpy.argsort(known, order=("x", "y", "z"))
    place = order[numpy.minimum(numpy.searchsorted(known[order], asked), len(known) - 1)]
    return numpy.where(known[place] == asked, place, -1)
