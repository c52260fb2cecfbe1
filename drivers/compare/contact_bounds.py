"""Contact problems of epafi-export with bounds in place of rows of constraints: min 1/2 z'Kz - f'z, z <= upper."""

import dataclasses

import numpy


class Rows:
    """B and c, whole on every rank. \\raises ValueError if two rows have an unknown in common."""

    def __init__(self, starts, columns, values, gap):
        filled = numpy.diff(starts) > 0
        self.rows = [slice(a, b) for a, b in zip(starts[:-1][filled], starts[1:][filled])]
        self.columns, self.values, self.gap = columns, values, gap[filled]
        if len(numpy.unique(columns)) != len(columns):
            raise ValueError("two contact conditions share an unknown; no bounds on single unknowns can stand for them")
        self.pivots = numpy.array([columns[row][numpy.argmax(numpy.abs(values[row]))] for row in self.rows], dtype=numpy.int32)

    def slope(self, row):
        """b, the pivot's place in it."""
        values = self.values[row]
        return values, int(numpy.argmax(numpy.abs(values)))

    def change_of_variables(self):
        """Entries (unknown of u, unknown of z, value) of T - I, u = T z: on the unknowns of a row b u <= c

             u = w b / |b|^2 + N m,   w = b u in the pivot's place,   N: the other unknowns, the pivot from b N = 0.

        Of two nodes that face each other, w is the jump between them and m their mean."""
        entries = []
        for row in self.rows:
            columns, (values, pivot) = self.columns[row], self.slope(row)
            for j, column in enumerate(columns):
                entries.append((column, columns[pivot], values[j] / (values @ values) - (j == pivot)))
                if j != pivot:
                    entries.append((columns[pivot], column, -values[j] / values[pivot]))
        return entries

    def invert(self, u):
        """z = T^-1 u, in place; u: unknowns x anything."""
        for row in self.rows:
            columns, (values, pivot) = self.columns[row], self.slope(row)
            jump = values @ u[columns]
            u[columns] -= numpy.outer(values, jump) / (values @ values)
            u[columns[pivot]] = jump


@dataclasses.dataclass
class System:
    stiffness: object  # PETSc.Mat
    load: object
    upper: object
    modes: list  # the bodies' common rigid motions, orthonormal
    offset: float

    def energy(self, z):
        product = z.duplicate()
        self.stiffness.mult(z, product)
        return 0.5 * product.dot(z) - self.load.dot(z) + self.offset

    def closed_nodes(self, z):
        """Unknowns at their bounds."""
        from mpi4py import MPI
        here = int(numpy.count_nonzero(z.getArray() >= self.upper.getArray()))
        return z.comm.tompi4py().allreduce(here, MPI.SUM)


class PetscFile:
    """Reads PETSc's binary format piece by piece, without holding more of it than is asked for."""

    def __init__(self, file):
        self.bytes, self.position = numpy.memmap(file, dtype=numpy.uint8, mode="r"), 0

    def take(self, count, kind):
        begin, self.position = self.position, self.position + count * numpy.dtype(kind).itemsize
        return self.bytes[begin:self.position].view(kind)

    def array(self, kind):
        _, count = self.take(2, ">i4")
        return self.take(count, kind).astype(kind[1:])

    def matrix(self, part):
        """Row starts, columns, values and shape; part(number of rows) is the range of rows that is wanted."""
        _, rows, columns, entries = map(int, self.take(4, ">i4"))
        starts = numpy.concatenate([[0], numpy.cumsum(self.take(rows, ">i4"), dtype=numpy.int64)])
        all_columns, all_values = self.take(entries, ">i4"), self.take(entries, ">f8")
        first, last = part(rows)
        here = slice(starts[first], starts[last])
        return ((starts[first:last + 1] - starts[first]).astype("i4"), all_columns[here].astype("i4"),
                all_values[here].astype("f8"), (rows, columns))


def own_rows(comm, size):
    """Range of rows of this rank; nodes stay together where all have three unknowns."""
    cuts = [3 * (size // 3 * rank // comm.size) for rank in range(comm.size)] + [size]
    return cuts[comm.rank], cuts[comm.rank + 1]


def rigid_modes(places, directions):
    """Values of the six rigid motions, about the mean place, at the unknowns."""
    arms = places - places.mean(axis=0)
    return numpy.hstack([directions, numpy.cross(arms / numpy.abs(arms).max(), directions)])


def load(PETSc, file):
    """The system on all ranks, unknowns in epafi-export's order."""
    comm = PETSc.COMM_WORLD
    source = PetscFile(file)
    starts, columns, values, shape = source.matrix(lambda size: own_rows(comm, size))
    first, last = own_rows(comm, shape[0])
    sizes = (last - first, shape[0])
    stiffness = PETSc.Mat().createAIJ((sizes, sizes), csr=(starts, columns, values), comm=comm)
    forces = source.array(">f8")[first:last]
    b_starts, b_columns, b_values, _ = source.matrix(lambda size: (0, size))
    rows = Rows(b_starts, b_columns, b_values, source.array(">f8"))
    offset = float(source.array(">f8")[0])
    source.array(">i4")  # bodies
    nodes = source.array(">i4")
    modes = rigid_modes(source.array(">f8").reshape(-1, 3), source.array(">f8").reshape(-1, 3))
    rows.invert(modes)

    change = matrix_of(PETSc, rows, sizes, first, last)
    reduced = stiffness.ptap(change)
    if shape[0] % 3 == 0 and numpy.all(nodes.reshape(-1, 3) == nodes[::3, None]):
        reduced.setBlockSize(3)
    reduced.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    reduced.setOption(PETSc.Mat.Option.SPD, True)
    load_vector, upper = reduced.createVecs()
    change.multTranspose(PETSc.Vec().createWithArray(forces, (sizes[0], None), comm=comm), load_vector)
    upper.set(PETSc.INFINITY)
    mine = (first <= rows.pivots) & (rows.pivots < last)
    upper.getArray()[rows.pivots[mine] - first] = rows.gap[mine]
    return System(reduced, load_vector, upper, vectors_of(PETSc, reduced, modes[first:last]), offset)


def matrix_of(PETSc, rows, sizes, first, last):
    """T."""
    change = PETSc.Mat().createAIJ((sizes, sizes), nnz=(8, 8), comm=PETSc.COMM_WORLD)
    change.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    for unknown in range(first, last):
        change.setValue(unknown, unknown, 1.0, PETSc.InsertMode.ADD_VALUES)
    for i, j, value in rows.change_of_variables():
        if first <= i < last:
            change.setValue(i, j, value, PETSc.InsertMode.ADD_VALUES)
    change.assemble()
    return change


def vectors_of(PETSc, matrix, columns):
    """Orthonormal vectors from columns of this rank's values."""
    vectors = []
    for column in columns.T:
        vector = matrix.createVecRight()
        vector.getArray()[:] = column
        for other in vectors:
            vector.axpy(-vector.dot(other), other)
        vector.normalize()
        vectors.append(vector)
    return vectors
