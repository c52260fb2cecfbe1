#pragma once

/// Shapes of elements and the order of their nodes, which is that of Gmsh and VTK:
///   line           0 1                               triangle       0 1 2, counter-clockwise
///   tetrahedron    0 1 2 seen counter-clockwise      quadrilateral  0 1 2 3, counter-clockwise
///                  from outside, i.e. 3 above        hexahedron     0 1 2 3 below, 4 5 6 7 above them, both
///                                                                   counter-clockwise seen from above
/// A *facet* is an edge of a plane element, a face of a solid one: a cell of one dimension less.
///
/// The *order* of a cell is that of the polynomials on its edges; what there is at present is of order 1, whose nodes are
/// the corners.

#include <cstddef>
#include <span>

namespace epafi::fem {

/// Shapes of cells, and of their facets.
enum class CellType { triangle, quadrilateral, tetrahedron, hexahedron, line };

/// One of the facets of a cell.
struct Facet {
  CellType type;
  /// Places of its nodes among those of the cell, such that the normal points outwards: an edge has the cell on its left, a
  /// face is seen counter-clockwise from outside.
  std::span<const int> nodes;

  [[nodiscard]] int operator[](std::size_t i) const { return nodes[i]; } ///< place of the i-th node
  [[nodiscard]] std::size_t size() const { return nodes.size(); }        ///< its nodes
  [[nodiscard]] auto begin() const { return nodes.begin(); }             ///< the first place
  [[nodiscard]] auto end() const { return nodes.end(); }                 ///< behind the last
};

/// Nodes of the largest cell and of the largest facet.
constexpr std::size_t mostNodes = 8, mostFacetNodes = 4;

int dimensionOf(CellType type); ///< 1, 2 or 3
/// 2, 3, 4, 4 or 8 of order 1.
int numNodesOf(CellType type, int order = 1);
/// Of plane and solid cells: facets of one type each.
std::span<const Facet> facetsOf(CellType type, int order = 1);
/// Type of all these facets.
CellType facetTypeOf(CellType type);
/// Nodes of each of them.
int nodesPerFacet(CellType type, int order = 1);

/// "line", "triangle", "quadrilateral", "tetrahedron", "hexahedron".
const char* toString(CellType type);

} // namespace epafi::fem
