#pragma once

/// Nodes that lie on the boundary of an element without belonging to it.

#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/MeshArrays.hpp"
#include "epafi/mesh/MeshTopology.hpp"

#include <optional>

namespace epafi::mesh {

struct HangingNode {
  LocalOrdinal node = 0;
  LocalOrdinal element = 0; ///< on whose facet it lies
};

/// The first of them by element, if there is any. Only unmatched facets are looked at: an element whose edge
/// or face is divided on the other side has no neighbour there. *On* means nearer than 1e-6 of the facet's
/// diameter, because of coordinates written with few digits, and than 1/100 of the node's distance to its own
/// neighbours. O(n log n).
///
/// \param tree  of the mesh's points; no two of them may coincide.
std::optional<HangingNode> findHangingNode(const MeshArrays& mesh, const MeshTopology& topology,
                                           const BoxTree& tree);

/// Distance of a point from a facet: an edge, a triangle, or the bilinear patch that four points span. Exact
/// where the nearest point is not on the facet's rim, else an upper bound.
double distanceFrom(CellType type, std::span<const Point> facet, const Point& point);

} // namespace epafi::mesh
