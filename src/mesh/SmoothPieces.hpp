#pragma once

/// Smooth pieces of a body's boundary: what CAD would call its faces. Scenes may name one by a point of it,
/// "at 10 0 30", which holds on finer meshes, too.

#include "epafi/mesh/Mesh.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace epafi::mesh {

/// "at 10 0 30". \param dimension  of space, 2 or 3
std::string wordsOfPlace(const Point& place, int dimension);
/// The place that such words name, z = 0 in the plane; nothing if they name none.
std::optional<Point> placeIn(const std::string& words);

using PointAt = std::function<Point(GlobalOrdinal node)>; ///< where nodes lie

/// Numbers of a boundary's facets, ascending in each piece: neighbours are of one piece where their normals
/// differ by 40 degrees at most. O(n log n).
std::vector<std::vector<std::size_t>> smoothPieces(const Surface& boundary, const PointAt& pointAt);

/// The facet that is nearest to a place, taken as flat between its corners. Precondition: there is one.
std::size_t nearestFacet(const Surface& surface, const PointAt& pointAt, const Point& place);

} // namespace epafi::mesh
