"""Surfaces in space as a picture with hidden parts removed: a depth buffer over pixels, parallel projection, one light."""

import numpy

LIGHT = numpy.array([0.25, -0.55, 0.80])
AT_ONCE = 500_000  # pixels looked at together: what fits in caches


def spread(counts, first):
    """Numbers first, first + 1, …, `counts` of them, for each entry; with the entry that each belongs to."""
    entry = numpy.repeat(numpy.arange(len(counts)), counts)
    return entry, first[entry] + numpy.arange(len(entry)) - numpy.repeat(numpy.cumsum(counts) - counts, counts)


def parts(counts, most):
    """Slices of entries with about `most` counts together."""
    ends = numpy.unique(numpy.searchsorted(numpy.cumsum(counts), numpy.arange(most, counts.sum() + most, most)))
    ends = [*(ends[ends < len(counts)]), len(counts)]
    return [slice(a, b) for a, b in zip([0, *ends[:-1]], ends)]


class View:
    """The projection: right and up in the picture, and towards the eye."""

    def __init__(self, elevation=24.0, azimuth=-58.0):
        e, a = numpy.radians([elevation, azimuth])
        self.eye = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
        right = numpy.array([-numpy.sin(a), numpy.cos(a), 0.0])
        self.axes = numpy.array([right, numpy.cross(self.eye, right), self.eye])

    def project(self, points):
        """x, y in the picture, and the depth, which grows towards the eye."""
        return points @ self.axes.T


def normals(corners):
    """Of length 1, of polygons n x 3 or 4 x 3."""
    last = corners[:, -1] - corners[:, 1] if corners.shape[1] == 4 else corners[:, 2] - corners[:, 0]
    first = corners[:, 2] - corners[:, 0] if corners.shape[1] == 4 else corners[:, 1] - corners[:, 0]
    normal = numpy.cross(first, last)
    return normal / numpy.maximum(numpy.linalg.norm(normal, axis=1, keepdims=True), 1e-300)


def shade(normal):
    """Brightness of facets by their normals, 1 for those that face the light."""
    light = LIGHT / numpy.linalg.norm(LIGHT)
    return 0.66 + 0.34 * numpy.clip(normal @ light, 0, 1)


class Picture:
    """Pixels with the nearest triangle's colour and depth."""

    def __init__(self, low, high, width):
        """From `low` to `high` in the projected plane, `width` pixels for the longer side."""
        self.low, extent = low, numpy.maximum(high - low, 1e-300)
        self.pixel = extent.max() / width
        self.shape = tuple(int(n) for n in numpy.ceil(extent[::-1] / self.pixel).astype(int) + 1)
        self.depth = numpy.full(self.shape[0] * self.shape[1], -numpy.inf)
        self.colour = numpy.ones((len(self.depth), 3), numpy.float32)

    def extent(self):
        rows, columns = self.shape
        return (self.low[0], self.low[0] + columns * self.pixel, self.low[1], self.low[1] + rows * self.pixel)

    def pixels(self):
        return (255 * self.colour).round().astype(numpy.uint8).reshape(*self.shape, 3)

    def draw(self, corners, colours):
        """Triangles n x 3 x 3, projected, with the colour of each corner, n x 3 x 3."""
        place = corners.copy()
        place[:, :, :2] = (corners[:, :, :2] - self.low) / self.pixel - 0.5
        (ax, bx, cx), (ay, by, cy) = place[:, :, 0].T, place[:, :, 1].T
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        kept = numpy.abs(area) > 1e-9
        area = numpy.where(kept, area, 1.0)
        # Shares of the second and third corner at (x, y): constant + x · slope + y · slope.
        slopes = numpy.array([[(cy - ay) / area, (ax - cx) / area], [(ay - by) / area, (bx - ax) / area]])
        constants = numpy.array([-(s[0] * ax + s[1] * ay) for s in slopes])
        bottom = numpy.clip(numpy.ceil(place[:, :, 1].min(axis=1)).astype(int), 0, None)
        top = numpy.minimum(numpy.floor(place[:, :, 1].max(axis=1)).astype(int), self.shape[0] - 1)
        rows = numpy.where(kept, numpy.clip(top - bottom + 1, 0, None), 0)
        triangle, y = spread(rows, bottom)
        start, end = self.intervals(slopes[:, :, triangle], constants[:, triangle], y)
        for part in parts(end - start, AT_ONCE):
            self.fill(triangle[part], y[part], start[part], end[part], slopes, constants, place[:, :, 2], colours)

    def intervals(self, slopes, constants, y):
        """First pixel, and the one after the last, of triangles' rows: where no corner's share is negative."""
        low, high = numpy.zeros(len(y)), numpy.full(len(y), self.shape[1] - 1.0)
        second, third = (constants[k] + slopes[k, 1] * y for k in range(2))
        for slope, value in ((slopes[0, 0], second), (slopes[1, 0], third),
                             (-slopes[0, 0] - slopes[1, 0], 1 - second - third)):
            with numpy.errstate(divide="ignore", invalid="ignore"):
                zero = -value / slope
            low = numpy.where(slope > 0, numpy.maximum(low, zero), low)
            high = numpy.where(slope < 0, numpy.minimum(high, zero), high)
            high = numpy.where((slope == 0) & (value < 0), -1.0, high)
        start = numpy.ceil(low - 1e-6).astype(int)
        return start, numpy.maximum(numpy.floor(high + 1e-6).astype(int) + 1, start)

    def fill(self, triangle, y, start, end, slopes, constants, depths, colours):
        """Depth test of all pixels in some rows of triangles at once."""
        row, x = spread(end - start, start)
        triangle, y = triangle[row], y[row]
        second = constants[0][triangle] + slopes[0, 0][triangle] * x + slopes[0, 1][triangle] * y
        third = constants[1][triangle] + slopes[1, 0][triangle] * x + slopes[1, 1][triangle] * y
        first = 1 - second - third
        depth = depths[triangle, 0] * first + depths[triangle, 1] * second + depths[triangle, 2] * third
        pixel = y * self.shape[1] + x
        near = numpy.flatnonzero(depth > self.depth[pixel])
        order = near[numpy.argsort(depth[near])]  # the last one written to a pixel is the nearest
        pixel, triangle = pixel[order], triangle[order]
        self.depth[pixel] = depth[order]
        shares = (first[order], second[order], third[order])
        self.colour[pixel] = sum(share[:, None] * colours[triangle, k] for k, share in enumerate(shares))

    def visible(self, ends, tolerance):
        """The pieces of projected lines, n x 2 x 3, that nothing hides: m x 2 x 2."""
        length = numpy.linalg.norm(ends[:, 1, :2] - ends[:, 0, :2], axis=1)
        count = numpy.clip(numpy.ceil(length / (6 * self.pixel)).astype(int), 1, 4000)
        line = numpy.repeat(numpy.arange(len(ends)), count)
        step = (numpy.arange(len(line)) - numpy.repeat(numpy.cumsum(count) - count, count))
        pieces = [ends[line, 0] + ((step + s) / count[line])[:, None] * (ends[line, 1] - ends[line, 0]) for s in (0, 0.5, 1)]
        column, row = ((pieces[1][:, :2] - self.low) / self.pixel).astype(int).T
        nearest = numpy.full(len(line), numpy.inf)  # of the neighbouring pixels' depths the least: outlines lie between pixels
        for x, y in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
            pixel = (numpy.clip(row + y, 0, self.shape[0] - 1) * self.shape[1] + numpy.clip(column + x, 0, self.shape[1] - 1))
            nearest = numpy.minimum(nearest, self.depth[pixel])
        seen = pieces[1][:, 2] >= nearest - tolerance
        return numpy.stack([pieces[0][seen, :2], pieces[2][seen, :2]], axis=1)
