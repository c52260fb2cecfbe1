#pragma once

/// Shapes of linear elements and the order of their nodes, which is that of Gmsh and VTK:
///   triangle       0 1 2, counter-clockwise          quadrilateral  0 1 2 3, counter-clockwise
///   tetrahedron    0 1 2 seen counter-clockwise      hexahedron     0 1 2 3 below, 4 5 6 7 above them, both
///                  from outside, i.e. 3 above                       counter-clockwise seen from above
/// A *facet* is an edge of a plane element, a face of a solid one.

#include <array>
#include <span>

namespace epafi::fem {

/// The elements there are, all linear.
enum class CellType { triangle, quadrilateral, tetrahedron, hexahedron };

/// 2 or 3.
int dimensionOf(CellType type);
int numNodesOf(CellType type); ///< 3, 4, 4 or 8
/// 2 (edges), 3 or 4.
int nodesPerFacet(CellType type);
/// Facets by the places of their nodes among those of the element; the first nodesPerFacet() of each four hold. Their
/// order is such that the normal points outwards: an edge has the element on its left, a face is seen counter-clockwise from
/// outside.
std::span<const std::array<int, 4>> facetsOf(CellType type);

/// "triangle", "quadrilateral", "tetrahedron", "hexahedron".
const char* toString(CellType type);

} // namespace epafi::fem
