#pragma once

/// A body's mesh as plain arrays, as a file gives them: what UnstructuredMesh is made from, and MeshChecks
/// looks at.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace epafi::mesh {

/// A named part of the boundary: facets by their corners, in rows (Cell.hpp) as long as the largest facet of
/// the cells has corners, in any order round the facet.
struct NamedFacets {
  std::string name;
  std::vector<LocalOrdinal> nodes;
};

struct NamedElements {
  std::string name;
  std::vector<LocalOrdinal> elements;
};

/// Nodes with a name, wherever they lie: those of points and lines.
struct NamedNodes {
  std::string name;
  std::vector<LocalOrdinal> nodes;
};

struct MeshArrays {
  std::string name;                       ///< how errors call the body, such as `"plate" of "press.msh"`
  CellType cellType = CellType::triangle; ///< of the largest elements
  std::vector<Point> points;
  std::vector<LocalOrdinal> cells; ///< nodes of the elements, in rows (Cell.hpp) of numNodesOf(cellType) each
  std::vector<NamedFacets> surfaces;
  std::vector<NamedElements> groups;
  std::vector<NamedNodes> nodeSets;
  /// Numbers that nodes and elements have in the file, for errors; −1: the file does not have the node.
  std::vector<GlobalOrdinal> nodeTags, elementTags;

  [[nodiscard]] LocalOrdinal numElements() const {
    return static_cast<LocalOrdinal>(cells.size() / numNodesOf(cellType));
  }
};

/// The row of one element among those of all. \param largest  type of the largest
inline std::span<const LocalOrdinal> rowOf(CellType largest, std::span<const LocalOrdinal> cells,
                                           std::size_t element) {
  const std::size_t count = numNodesOf(largest);
  return cells.subspan(element * count, count);
}

/// The nodes of one element.
inline std::span<const LocalOrdinal> nodesOf(CellType largest, std::span<const LocalOrdinal> cells,
                                             std::size_t element) {
  return withoutFilling(rowOf(largest, cells, element));
}

} // namespace epafi::mesh
