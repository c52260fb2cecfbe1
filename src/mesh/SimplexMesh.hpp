#pragma once

/// A body in triangles or tetrahedra that can be split where it matters: nodes at corners alone, surfaces and
/// groups as marks that parts inherit, edges that need not be straight.

#include "epafi/mesh/MeshArrays.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace epafi::mesh {

struct SimplexMesh {
  struct Element {
    std::array<LocalOrdinal, 4> corners{}; ///< in the order of Cell.hpp; dimension + 1 of them
    /// Of the facet opposite to each corner: which of `facetMarks` it has.
    std::array<int, 4> facets{};
    int group = 0; ///< which of `groupMarks` the element has
  };
  using Edge = std::uint64_t; ///< see edgeBetween()

  std::string name; ///< how errors call the body
  int dimension = 2;
  std::vector<Point> points;
  std::vector<Element> elements;
  std::vector<std::string> surfaces, groups;
  /// Sets of surfaces that facets lie on, of groups that elements belong to; the first of each is empty.
  std::vector<std::vector<int>> facetMarks{{}}, groupMarks{{}};
  /// Of curved edges: from the middle of the chord to that of the arc, a parabola.
  std::unordered_map<Edge, Point> bends;

  static Edge edgeBetween(LocalOrdinal a, LocalOrdinal b) {
    const auto [low, high] = a < b ? std::pair(a, b) : std::pair(b, a);
    return (static_cast<Edge>(low) << 32U) | static_cast<std::uint32_t>(high);
  }
};

/// The same body in simplices: triangles and tetrahedra as they are, a quadrilateral as two triangles,
/// another cell as tetrahedra round its lowest node, a hexahedron as six, faces cut from their lowest node
/// on, the same from both sides. Edges of elements of order 2 keep their curvature. O(n).
SimplexMesh simplicesOf(const Mesh& mesh);
/// Whether its elements are triangles or tetrahedra, of any order.
bool isOfSimplices(const Mesh& mesh);

/// As a mesh of an order. Elements keep their numbers.
MeshArrays arraysOf(const SimplexMesh& mesh, int order);

/// Bisects elements at their longest edges, of equal ones that between the higher nodes, and those around
/// them as far as no node is to hang (Rivara 1984). Parts take over marks; a new node on a curved edge lies
/// on its arc.
/// \param times  how often each element is to be split at least: it ends in 2^times parts or more
/// Returns for each new element the old one of which it is a part.
std::vector<LocalOrdinal> bisect(SimplexMesh& mesh, std::vector<int> times);

} // namespace epafi::mesh
