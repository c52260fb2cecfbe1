#pragma once

/// Shapes of elements and the order of their nodes, which is that of VTK: first the corners,
///   line           0 1                               triangle       0 1 2, counter-clockwise
///   tetrahedron    0 1 2 seen counter-clockwise      quadrilateral  0 1 2 3, counter-clockwise
///                  from outside, i.e. 3 above        hexahedron     0 1 2 3 below, 4 5 6 7 above them, both
///                                                                   counter-clockwise seen from above
/// then, of cells of order 2, one node on each edge, on each face of a hexahedron, and inside of bricks:
///   line3          2 between 0 and 1                 triangle6      edges 01 12 20
///   tetrahedron10  edges 01 12 20 03 13 23           quadrilateral9 edges 01 12 23 30, centre
///   hexahedron27 edges 01 12 23 30, 45 56 67 74, 04 15 26 37; faces −x +x −y +y −z +z (x from 0 to 1, y from
///   0 to 3,
///                  z from 0 to 4); centre
/// quadrilateral8 and hexahedron20 are quadrilateral9 and hexahedron27 without their *inner* nodes, those of
/// centres and faces (Serendipity).
///
/// A *facet* is an edge of a plane element, a face of a solid one: a cell of one dimension less.
///
/// The *order* of a cell is that of the polynomials on its edges.

#include <cstddef>
#include <span>

namespace epafi::mesh {

/// Shapes of cells, and of their facets: those of order 1, then those of order 2 in the same sequence, then
/// those without inner nodes.
enum class CellType {
  triangle,
  quadrilateral,
  tetrahedron,
  hexahedron,
  line,
  triangle6,
  quadrilateral9,
  tetrahedron10,
  hexahedron27,
  line3,
  quadrilateral8,
  hexahedron20
};

/// One of the facets of a cell.
struct Facet {
  CellType type;
  /// Places of its nodes among those of the cell, such that the normal points outwards: an edge has the cell
  /// on its left, a face is seen counter-clockwise from outside.
  std::span<const int> nodes;

  [[nodiscard]] int operator[](std::size_t i) const { return nodes[i]; } ///< place of the i-th node
  [[nodiscard]] std::size_t size() const { return nodes.size(); }        ///< its nodes
  [[nodiscard]] auto begin() const { return nodes.begin(); }             ///< the first place
  [[nodiscard]] auto end() const { return nodes.end(); }                 ///< behind the last
};

/// Nodes of the largest cell and of the largest facet, and corners of the latter.
constexpr std::size_t mostNodes = 27, mostFacetNodes = 9, mostFacetCorners = 4;

int dimensionOf(CellType type);  ///< 1, 2 or 3
int orderOf(CellType type);      ///< 1 or 2
int numNodesOf(CellType type);   ///< all of them
int numCornersOf(CellType type); ///< 2, 3, 4, 4 or 8
/// The cell of the same corners and an order, 1 or 2. One without inner nodes is of order 2 itself.
CellType withOrder(CellType type, int order);
/// Whether it is a quadrilateral or brick of order 2 without inner nodes.
bool isSerendipity(CellType type);
/// The cell of order 2 with inner nodes instead of one without; others as they are.
CellType withInnerNodes(CellType type);
/// The other way round.
CellType withoutInnerNodes(CellType type);
/// Where the functions of a cell without inner nodes put the middle of a quadrilateral, or of a brick: the
/// share of each corner, and of each middle of an edge.
constexpr double cornerInMiddle = -0.25;
constexpr double edgeInMiddle(int dimension) { ///< 2 or 3
  return dimension == 2 ? 0.5 : 0.25;
}
/// Of plane and solid cells: facets of one type each.
std::span<const Facet> facetsOf(CellType type);
/// Type of all these facets.
CellType facetTypeOf(CellType type);
/// Nodes of each of them.
int nodesPerFacet(CellType type);
/// Pairs of corners that are joined by an edge, in the order of the nodes that lie on them.
std::span<const int> edgesOf(CellType type);

/// "line", "triangle", "quadrilateral", "tetrahedron", "hexahedron", "quadratic …" of order 2, and
/// "serendipity …" without inner nodes.
const char* toString(CellType type);

} // namespace epafi::mesh
