#pragma once

/// A mesh of one body as the decomposition sees it. Nodes and elements are numbered from 0; every query is
/// local (no communication) and cheap, so that each rank asks only about its own part of the body: more it
/// need not hold (MeshPart.hpp).

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Cell.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace epafi::mesh {

/// A named part of a body's boundary, whole on every rank: facets, each with the element that it bounds.
struct Surface {
  CellType facetType = CellType::line; ///< of the largest facets that the mesh may have
  /// In rows (Cell.hpp) of nodesPerFacet() each, in an order that makes the normal point outwards.
  std::vector<GlobalOrdinal> facetNodes;
  std::vector<GlobalOrdinal> elements; ///< of each facet

  [[nodiscard]] int nodesPerFacet() const { return numNodesOf(facetType); } ///< length of the rows
  [[nodiscard]] std::size_t numFacets() const { return elements.size(); }   ///< of the whole surface
  /// Nodes of one facet.
  [[nodiscard]] std::span<const GlobalOrdinal> facet(std::size_t number) const {
    const std::size_t count = nodesPerFacet();
    return withoutFilling(std::span(facetNodes).subspan(number * count, count));
  }
  /// What one facet is.
  [[nodiscard]] CellType typeOf(std::size_t number) const { return cellOf(facetType, facet(number).size()); }
  /// Corners of one facet.
  [[nodiscard]] std::span<const GlobalOrdinal> corners(std::size_t number) const {
    return facet(number).first(numCornersOf(typeOf(number)));
  }
  /// Adds a facet without its element. \param nodes  in any container
  template <class Nodes>
  void add(const Nodes& nodes) {
    const std::size_t first = facetNodes.size();
    facetNodes.insert(facetNodes.end(), nodes.begin(), nodes.end());
    fillRow(facetNodes, first, nodesPerFacet());
  }
};

class StructuredMesh;
class MeshPart;

class Mesh {
public:
  virtual ~Mesh() = default;

  /// The mesh itself if it is structured, else null.
  [[nodiscard]] virtual const StructuredMesh* structured() const { return nullptr; }
  /// The mesh itself if it is one rank's piece of a body's, else null.
  [[nodiscard]] virtual const MeshPart* part() const { return nullptr; }
  [[nodiscard]] virtual CellType cellType() const = 0;         ///< of its largest elements
  [[nodiscard]] virtual GlobalOrdinal numNodes() const = 0;    ///< of the whole body
  [[nodiscard]] virtual GlobalOrdinal numElements() const = 0; ///< likewise
  /// Length of the rows (Cell.hpp) in which elementNodes() gives the nodes of its elements.
  [[nodiscard]] int nodesPerElement() const { return numNodesOf(cellType()); }
  [[nodiscard]] virtual Point point(GlobalOrdinal node) const = 0; ///< where a node lies
  /// Nodes of an element in the order of its shape functions (Cell.hpp), in a row of nodesPerElement().
  virtual void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const = 0;
  /// The same for many elements, one after the other; quickest where the elements ascend.
  virtual void elementNodes(std::span<const GlobalOrdinal> elements,
                            std::span<GlobalOrdinal> nodes) const = 0;
  /// Elements that touch a node, appended to nothing: `elements` is overwritten.
  virtual void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const = 0;
  /// How many elements touch each of some ascending nodes.
  virtual void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const = 0;
  /// Elements that share an edge (2-D) or a face (3-D) with an element: its neighbours in the dual graph.
  virtual void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const = 0;
  /// Whether a node lies on the boundary of the body.
  [[nodiscard]] virtual bool isBoundaryNode(GlobalOrdinal node) const = 0;

  /// Names of the surfaces: "left" … "top" of a structured mesh, physical groups of a Gmsh file.
  [[nodiscard]] virtual std::vector<std::string> surfaceNames() const = 0;
  /// Precondition: `name` is one of surfaceNames(), or empty: all elements of a whole mesh in the plane,
  /// facing upwards.
  [[nodiscard]] virtual Surface surface(const std::string& name) const = 0;
  /// Names of the element groups that a file gives; structured meshes have none.
  [[nodiscard]] virtual std::vector<std::string> groupNames() const = 0;
  /// Elements of a group, ascending. Precondition: `name` is one of groupNames().
  [[nodiscard]] virtual std::vector<GlobalOrdinal> group(const std::string& name) const = 0;

  /// Names of sets of nodes that a file gives, as physical groups of points and, in space, of curves do.
  [[nodiscard]] virtual std::vector<std::string> nodeSetNames() const { return {}; }
  /// Nodes of a set, ascending; perhaps none. Precondition: `name` is one of nodeSetNames().
  [[nodiscard]] virtual std::vector<GlobalOrdinal> nodeSet(const std::string& name) const;

  /// Where some nodes lie; `points` is overwritten.
  void pointsAt(std::span<const GlobalOrdinal> nodes, std::vector<Point>& points) const;
  /// All elements as facets.
  [[nodiscard]] Surface elementsAsSurface() const;
  /// Where the nodes of an element lie; `points` is overwritten.
  void elementPoints(GlobalOrdinal element, std::vector<Point>& points) const;
};

/// The nodes of one element.
class ElementNodes {
public:
  /// Of the element of a mesh.
  ElementNodes(const Mesh& mesh, GlobalOrdinal element) {
    const CellType largest = mesh.cellType();
    const auto row = std::span(nodes_).first(numNodesOf(largest));
    mesh.elementNodes(element, row);
    number_ = withoutFilling(std::span<const GlobalOrdinal>(row)).size();
    type_ = cellOf(largest, number_);
  }
  [[nodiscard]] CellType type() const { return type_; }      ///< what the element is
  [[nodiscard]] std::size_t size() const { return number_; } ///< its number of nodes
  /// The i-th.
  [[nodiscard]] GlobalOrdinal operator[](std::size_t i) const { return nodes_[i]; }
  [[nodiscard]] const GlobalOrdinal* begin() const { return nodes_.data(); }         ///< the first
  [[nodiscard]] const GlobalOrdinal* end() const { return nodes_.data() + number_; } ///< behind the last

private:
  std::array<GlobalOrdinal, mostNodes> nodes_{};
  std::size_t number_ = 0;
  CellType type_{};
};

inline std::vector<GlobalOrdinal> Mesh::nodeSet(const std::string& /*name*/) const {
  return {};
}

inline Surface Mesh::elementsAsSurface() const {
  Surface surface{cellType(), {}, {}};
  for (GlobalOrdinal element = 0; element < numElements(); ++element) {
    surface.add(ElementNodes(*this, element));
    surface.elements.push_back(element);
  }
  return surface;
}

inline void Mesh::pointsAt(std::span<const GlobalOrdinal> nodes, std::vector<Point>& points) const {
  points.clear();
  for (const GlobalOrdinal node : nodes)
    points.push_back(point(node));
}

inline void Mesh::elementPoints(GlobalOrdinal element, std::vector<Point>& points) const {
  const ElementNodes nodes(*this, element);
  pointsAt({nodes.begin(), nodes.size()}, points);
}

} // namespace epafi::mesh
