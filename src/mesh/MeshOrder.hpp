#pragma once

/// Meshes of order 2 from those of order 1, and back.

#include "epafi/mesh/MeshArrays.hpp"

namespace epafi::mesh {

/// What becomes of the inner nodes that quadrilaterals and bricks of order 2 have in the middle of faces and
/// of themselves.
enum class InnerNodes {
  added, ///< where they are missing
  none   ///< elements without them stay as they are
};

/// Adds the nodes that elements of order 2 have beyond those that are given: where they are missing, in the
/// middle of straight edges; and on faces with four corners and inside of bricks where the given nodes of the
/// edges put them (Serendipity), so that elements of 8 and 20 nodes keep their form. Added nodes stand behind
/// the others, with the tag −1.
/// \param mesh  cells with their corners and, if `hasEdgeNodes`, the nodes on their edges, in the order of
/// Cell.hpp; `cellType` of any order. Nodes of surfaces are corners of facets
/// \param hasEdgeNodes  whether the cells have them
/// \param inner  whether quadrilaterals and bricks are to have inner nodes; bricks beside other cells, which
/// have none on their faces, never do
MeshArrays completed(MeshArrays mesh, bool hasEdgeNodes, InnerNodes inner = InnerNodes::added);

/// The corners alone; all others are dropped.
MeshArrays linearised(MeshArrays mesh);

} // namespace epafi::mesh
