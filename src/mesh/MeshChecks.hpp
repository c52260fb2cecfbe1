#pragma once

/// What is wrong with a mesh that a file gave. Nothing is repaired.

#include "epafi/mesh/MeshArrays.hpp"
#include "epafi/mesh/MeshTopology.hpp"

namespace epafi::mesh {

/// Throws InputError, which names the element or node by its number in the file and says what to do, if
///   an element has a node twice, or a node belongs to no element,
///   a coordinate is not finite, or a plane element leaves the plane z = 0,
///   an element is inverted, flat, or folded (at a corner; of order 2 anywhere),
///   two nodes are at the same place, up to 1e-10 of the body's size,
///   three elements share a facet, or two share more than one, or the corners of one but not its other nodes,
///   a node lies on an element's facet without belonging to it (hanging node), up to 1e-6 of the facet's
///   size.
/// O(n log n): about 2 s for a million hexahedra. Bodies are checked one by one: two may well touch.
///
/// Precondition: all nodes in mesh.cells are in [0, points), as many tags as nodes and elements; `topology`
/// is that of the cells.
void checkMesh(const MeshArrays& mesh, const MeshTopology& topology);

} // namespace epafi::mesh
