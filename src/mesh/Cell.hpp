#pragma once

/// Shapes of elements and the order of their nodes, which is that of VTK: first the corners,
///   line           0 1                               triangle       0 1 2, counter-clockwise
///   tetrahedron    0 1 2 seen counter-clockwise      quadrilateral  0 1 2 3, counter-clockwise
///                  from outside, i.e. 3 above        hexahedron     0 1 2 3 below, 4 5 6 7 above them, both
///                                                                   counter-clockwise seen from above
///   pyramid        0 1 2 3 below, 4 above them       prism          0 1 2 below, 3 4 5 above them
/// then, of cells of order 2, one node on each edge, on each face of a hexahedron, and inside of bricks:
///   line3          2 between 0 and 1                 triangle6      edges 01 12 20
///   tetrahedron10  edges 01 12 20 03 13 23           quadrilateral9 edges 01 12 23 30, centre
///   hexahedron27 edges 01 12 23 30, 45 56 67 74, 04 15 26 37; faces −x +x −y +y −z +z (x from 0 to 1, y from
///   0 to 3,
///                  z from 0 to 4); centre
///   pyramid13      edges 01 12 23 30, 04 14 24 34    prism15        edges 01 12 20, 34 45 53, 03 14 25
/// quadrilateral8 and hexahedron20 are quadrilateral9 and hexahedron27 without their *inner* nodes, those of
/// centres and faces (Serendipity).
///
/// A *facet* is an edge of a plane element, a face of a solid one: a cell of one dimension less.
///
/// The *order* of a cell is that of the polynomials on its edges.
///
/// Meshes and surfaces may have cells of several shapes, all of one dimension and order. They are stored in
/// rows of one length, that of the largest of them; a smaller one repeats its last node to the row's end, so
/// that its number of nodes says what it is (cellOf).

#include <cstddef>
#include <span>
#include <vector>

namespace epafi::mesh {

/// Shapes of cells, and of their facets: those of order 1, then those of order 2 in the same sequence, then
/// those without inner nodes. Of a dimension and order they grow.
enum class CellType {
  triangle,
  quadrilateral,
  tetrahedron,
  pyramid,
  prism,
  hexahedron,
  line,
  triangle6,
  quadrilateral9,
  tetrahedron10,
  pyramid13,
  prism15,
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
int numCornersOf(CellType type); ///< 2 to 8
/// The cell of the same corners and an order, 1 or 2. One without inner nodes is of order 2 itself.
CellType withOrder(CellType type, int order);
/// Whether it is a quadrilateral or brick of order 2 without inner nodes.
bool isSerendipity(CellType type);
/// Whether it has a rule of its own with fewer points (ShapeFunctions.hpp) that others use: the cells of the
/// line before, and prisms.
bool hasReducedRule(CellType type);
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
/// Of plane and solid cells.
std::span<const Facet> facetsOf(CellType type);
/// Type of the largest of these facets.
CellType facetTypeOf(CellType type);
/// Nodes of that one.
int nodesPerFacet(CellType type);
/// Pairs of corners that are joined by an edge, in the order of the nodes that lie on them.
std::span<const int> edgesOf(CellType type);

/// "line", "triangle", "quadrilateral", "tetrahedron", "pyramid", "prism", "hexahedron", "quadratic …" of
/// order 2, and "serendipity …" without inner nodes.
const char* toString(CellType type);

/// The cell with as many nodes that a mesh or surface may have beside cells of the largest type; the largest
/// itself if there is none.
CellType cellOf(CellType largest, std::size_t numNodes);

/// The nodes of a row, without those that fill it up.
template <class Number>
std::span<const Number> withoutFilling(std::span<const Number> row) {
  std::size_t count = row.size();
  while (count > 1 && row[count - 2] == row.back())
    --count;
  return row.first(count);
}

/// Fills the last row up, which begins at `first`, to a length.
template <class Number>
void fillRow(std::vector<Number>& rows, std::size_t first, std::size_t length) {
  rows.resize(first + length, rows.back());
}

} // namespace epafi::mesh
