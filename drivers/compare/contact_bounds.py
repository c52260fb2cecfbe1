"""Contact problems of epafi-export with bounds in place of rows of constraints: min 1/2 z'Kz - f'z, z <= upper, and z = upper
where joints are tied. All nodes get as many unknowns as the space has dimensions, those that supports hold a row of the
identity, so that multigrid sees blocks of nodes."""

import dataclasses
import warnings

import numpy
import scipy.sparse
import scipy.sparse.linalg


class Rows:
    """B and c, whole on every rank. Each row has a pivot p, an unknown in whose place z has w = B u; r are the others:

         u_p = M^-1 (w - N u_r),   B = (M N);      u_r = m + N' D w,   D = diag 1/|b|^2.

    Of two nodes that face each other, w is the jump between them and m their mean. \\raises ValueError if M is singular."""

    def __init__(self, matrix, gap):
        filled = numpy.diff(matrix.indptr) > 0
        self.matrix, self.gap, self.filled = matrix.tocsr()[filled], gap[filled], filled
        self.pivots = self.choice()
        count, size = self.matrix.shape
        self.at = scipy.sparse.csr_matrix((numpy.ones(count), (self.pivots, numpy.arange(count))), shape=(size, count))
        squares = numpy.asarray(self.matrix.multiply(self.matrix).sum(axis=1)).ravel()
        others = self.matrix - self.matrix @ self.at @ self.at.T
        others.eliminate_zeros()
        self.others, self.spread = others, others.T @ scipy.sparse.diags(1 / squares)

    def choice(self):
        """Of each row its largest unknown, if possible one that no other row has: M is then near a diagonal."""
        shared = numpy.bincount(self.matrix.indices, minlength=self.matrix.shape[1]) > 1
        taken, pivots = set(), numpy.full(self.matrix.shape[0], -1)
        rows = [(self.matrix.indices[a:b], numpy.abs(self.matrix.data[a:b]))
                for a, b in zip(self.matrix.indptr[:-1], self.matrix.indptr[1:])]
        own = [numpy.where(shared[columns], 0.0, sizes) for columns, sizes in rows]
        alone = numpy.array([mine.max() >= 0.1 * sizes.max() for mine, (_, sizes) in zip(own, rows)], dtype=bool)
        for i in numpy.concatenate([numpy.flatnonzero(alone), numpy.flatnonzero(~alone)]):
            columns, sizes = rows[i]
            order = numpy.argsort(-(own[i] if alone[i] else sizes), kind="stable")
            pivots[i] = next((columns[j] for j in order if columns[j] not in taken), -1)
            if pivots[i] < 0:
                raise ValueError("contact conditions depend on each other; no bounds can stand for them")
            taken.add(pivots[i])
        return pivots

    def change_of_variables(self):
        """T, u = T z."""
        count, size = self.matrix.shape
        with warnings.catch_warnings():
            warnings.simplefilter("error", scipy.sparse.linalg.MatrixRankWarning)
            try:
                inverse = scipy.sparse.csr_matrix(scipy.sparse.linalg.inv((self.matrix @ self.at).tocsc()))
            except (scipy.sparse.linalg.MatrixRankWarning, RuntimeError):
                raise ValueError("contact conditions depend on each other; no bounds can stand for them") from None
        rest = scipy.sparse.identity(size) - self.at @ self.at.T
        change = rest + self.spread @ self.at.T + self.at @ inverse @ (
            self.at.T - self.others - self.others @ self.spread @ self.at.T)
        return change.tocsr()

    def invert(self, u):
        """z = T^-1 u; u: unknowns x anything."""
        jumps = self.matrix @ u
        z = u - self.spread @ jumps
        z[self.pivots] = jumps
        return z


@dataclasses.dataclass
class System:
    """On this rank: all conditions are those of its unknowns."""
    stiffness: object  # PETSc.Mat
    load: object
    lower: object
    upper: object
    modes: list  # the bodies' common rigid motions, orthonormal
    offset: float
    unknowns: int  # without rows of the identity, of all ranks
    pivots: numpy.ndarray  # of the conditions: numbers of unknowns,
    gap: numpy.ndarray
    tied: numpy.ndarray
    bodies: numpy.ndarray
    places: numpy.ndarray

    def energy(self, z):
        product = z.duplicate()
        self.stiffness.mult(z, product)
        return 0.5 * product.dot(z) - self.load.dot(z) + self.offset

    def closed_nodes(self, z):
        """Conditions of contact at their bounds."""
        values = z.getArray()[self.pivots - z.getOwnershipRange()[0]]
        return z.comm.tompi4py().allreduce(int(numpy.count_nonzero((values >= self.gap) & ~self.tied)))


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

    def matrix(self, part=None):
        """Rows of a matrix, as scipy's; part(number of rows) is the range that is wanted, of None all."""
        _, rows, columns, entries = map(int, self.take(4, ">i4"))
        starts = numpy.concatenate([[0], numpy.cumsum(self.take(rows, ">i4"), dtype=numpy.int64)])
        all_columns, all_values = self.take(entries, ">i4"), self.take(entries, ">f8")
        first, last = part(rows) if part else (0, rows)
        here = slice(starts[first], starts[last])
        return scipy.sparse.csr_matrix((all_values[here].astype("f8"), all_columns[here].astype("i4"),
                                        (starts[first:last + 1] - starts[first]).astype("i4")), shape=(last - first, columns))


def rigid_modes(places, directions):
    """Values of the six rigid motions, about the mean place, at the unknowns."""
    arms = places - places.mean(axis=0)
    return numpy.hstack([directions, numpy.cross(arms / numpy.abs(arms).max(), directions)])


def slots_of(bodies, nodes, directions):
    """Places of the unknowns among `components` of each node, and the number of places: where a node has few, along the axes."""
    components = 3 if numpy.abs(directions[:, 2]).max() > 0 else 2
    begins = numpy.concatenate([[True], (numpy.diff(bodies) != 0) | (numpy.diff(nodes) != 0)])
    number = numpy.cumsum(begins) - 1
    slots = components * number + numpy.abs(directions).argmax(axis=1)
    twice = number[numpy.isin(slots, numpy.flatnonzero(numpy.bincount(slots) > 1))]
    follow = components * number + numpy.arange(len(number)) - numpy.flatnonzero(begins)[number]
    return numpy.where(numpy.isin(number, twice), follow, slots), components


def load(PETSc, file):
    """The system on all ranks, nodes in epafi-export's order."""
    comm = PETSc.COMM_WORLD
    source, later = PetscFile(file), PetscFile(file)
    later.matrix(lambda _: (0, 0))  # K is read when the places of unknowns are known
    forces, b, gap, offset = later.array(">f8"), later.matrix(), later.array(">f8"), float(later.array(">f8")[0])
    bodies, nodes = later.array(">i4"), later.array(">i4")
    places, directions = later.array(">f8").reshape(-1, 3), later.array(">f8").reshape(-1, 3)
    contacts = len(gap)  # epafi-export refuses tied joints

    slots, components = slots_of(bodies, nodes, directions)
    size = components * (slots[-1] // components + 1)
    cuts = [components * (size // components * rank // comm.size) for rank in range(comm.size + 1)]
    first, last = cuts[comm.rank:comm.rank + 2]
    sizes = (last - first, size)
    padding = scipy.sparse.csr_matrix((numpy.ones(len(slots)), (numpy.arange(len(slots)), slots)), shape=(len(slots), size))
    begin, end = numpy.searchsorted(slots // components, [first // components, last // components])
    here = (padding[begin:end, first:last].T @ (source.matrix(lambda _: (begin, end)) @ padding)).tocsr()
    held = numpy.setdiff1d(numpy.arange(first, last), slots[begin:end])
    here += scipy.sparse.csr_matrix((numpy.ones(len(held)), (held - first, held)), shape=sizes)

    rows = Rows(b @ padding, gap)
    modes = rows.invert(padding.T @ rigid_modes(places, directions))
    change = matrix_of(PETSc, rows.change_of_variables()[first:last], sizes)
    reduced = matrix_of(PETSc, here, sizes).ptap(change)
    reduced.setBlockSize(components)
    reduced.setOption(PETSc.Mat.Option.SYMMETRIC, True)
    reduced.setOption(PETSc.Mat.Option.SPD, True)
    load_vector, upper = reduced.createVecs()
    change.multTranspose(PETSc.Vec().createWithArray((padding.T @ forces)[first:last], (sizes[0], None), comm=comm), load_vector)
    mine = (first <= rows.pivots) & (rows.pivots < last)
    pivots, tied = rows.pivots[mine], numpy.flatnonzero(rows.filled)[mine] >= contacts
    lower = upper.duplicate()
    upper.set(PETSc.INFINITY)
    lower.set(PETSc.NINFINITY)
    upper.getArray()[pivots - first] = rows.gap[mine]
    lower.getArray()[pivots[tied] - first] = rows.gap[mine][tied]
    unknown = numpy.searchsorted(slots // components, pivots // components)  # one of the pivot's node
    return System(reduced, load_vector, lower, upper, vectors_of(reduced, modes[first:last]), offset, len(forces),
                  pivots.astype("i4"), rows.gap[mine], tied, bodies[unknown], places[unknown])


def matrix_of(PETSc, rows, sizes):
    """Of this rank's rows."""
    rows.sort_indices()
    return PETSc.Mat().createAIJ((sizes, sizes), csr=(rows.indptr.astype("i4"), rows.indices.astype("i4"), rows.data),
                                 comm=PETSc.COMM_WORLD)


def vectors_of(matrix, columns):
    """Orthonormal vectors from columns of this rank's values, but for those that vanish: in the plane, three do."""
    vectors = []
    for column in columns.T:
        vector = matrix.createVecRight()
        vector.getArray()[:] = column
        length = vector.norm()
        for other in vectors:
            vector.axpy(-vector.dot(other), other)
        if vector.norm() > 1e-8 * length:
            vector.normalize()
            vectors.append(vector)
    return vectors
