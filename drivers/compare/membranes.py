"""The membranes of the model problem on undecomposed meshes: Q1 elements, scene and numbers as in xml/coercive.xml and
xml/semicoercive.xml. Assembled by numpy and scipy as a whole, so that it takes little time and memory."""

import dataclasses

import numpy
import scipy.sparse

# Q1 element on a square, nodes counter-clockwise from the lower left.
ELEMENT = numpy.array([[4, -1, -2, -1], [-1, 4, -1, -2], [-2, -1, 4, -1], [-1, -2, -1, 4]]) / 6.0


@dataclasses.dataclass
class System:
    stiffness: scipy.sparse.csr_matrix
    load: numpy.ndarray
    jumps: numpy.ndarray  # indices of the unknowns w >= 0


def body(size, density):
    """Stiffness and load of one body with all its nodes, node (i,j) is i + j (size + 1)."""
    count = size + 1
    first = (numpy.arange(size)[:, None] * count + numpy.arange(size)).ravel().astype(numpy.int32)
    nodes = first[:, None] + numpy.array([0, 1, count + 1, count], dtype=numpy.int32)
    rows, columns = numpy.repeat(nodes, 4, axis=1).ravel(), numpy.tile(nodes, 4).ravel()
    stiffness = scipy.sparse.csr_matrix((numpy.tile(ELEMENT.ravel(), size**2), (rows, columns)), shape=(count**2, count**2))
    element_load = numpy.repeat(density, size) / (4.0 * size**2)
    return stiffness, numpy.bincount(nodes.ravel(), numpy.repeat(element_load, 4), count**2)


def densities(coercive, size):
    """Loads of both bodies, a value for each row of elements."""
    rows, (left, right) = numpy.arange(size), (-1.0, -3.0) if coercive else (-5.0, -1.0)
    return numpy.where(4 * rows >= 3 * size, left, 0.0), numpy.where(4 * rows < size, right, 0.0)


def with_jump(coercive, size):
    """Both bodies; on the contact line the unknowns are m and the jump w >= 0, u1 = m - w/2 and u2 = m + w/2, elsewhere
    the deflections themselves. (With u1 and w, u2 = u1 + w, hypre takes half as many iterations more.)"""
    column = numpy.tile(numpy.arange(size + 1), size + 1)
    parts = [body(size, density) for density in densities(coercive, size)]
    stiffness = scipy.sparse.block_diag([part[0] for part in parts], format="csr")
    load = numpy.concatenate([part[1] for part in parts])
    free = numpy.concatenate([column > 0, column < size if coercive else column >= 0])
    line1, line2 = numpy.flatnonzero(column == size), (size + 1)**2 + numpy.flatnonzero(column == 0)
    change = change_of_variables(len(load), line1, line2)[:, free]
    reduced = (change.T @ stiffness @ change).tocsr()
    reduced.eliminate_zeros()
    reduced.sort_indices()
    return System(reduced, change.T @ load, numpy.cumsum(free)[line2] - 1)


def change_of_variables(count, line1, line2):
    """u = T z; m stands in the place of u1, w in that of u2."""
    identity = numpy.ones(count)
    identity[line2] = 0.5
    rows = numpy.concatenate([numpy.arange(count), line2, line1])
    columns = numpy.concatenate([numpy.arange(count), line1, line2])
    values = numpy.concatenate([identity, numpy.ones(len(line1)), numpy.full(len(line1), -0.5)])
    return scipy.sparse.csr_matrix((values, (rows, columns)), shape=(count, count))
