#pragma once

/// Where a body's unknowns are. They belong to entities of its mesh; a *node* here is a point that carries
/// unknowns, `components` of them. Shape functions are of the mesh's order, so that the nodes are those of
/// the mesh, and nothing is stored or looked up beyond it.

#include "epafi/mesh/Mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace epafi::fem {

/// Keeps a reference to the mesh, which must outlive it. Every query is local and as cheap as the mesh's own.
class UnknownMap {
public:
  /// \param components  unknowns a node: 1, 2 or 3
  UnknownMap(const mesh::Mesh& mesh, int components) : mesh_(&mesh), components_(components) {}

  [[nodiscard]] const mesh::Mesh& mesh() const { return *mesh_; }
  [[nodiscard]] int components() const { return components_; }
  /// Of the whole body.
  [[nodiscard]] GlobalOrdinal numNodes() const { return mesh_->numNodes(); }
  /// Length of rows (Cell.hpp).
  [[nodiscard]] int nodesPerElement() const { return numNodesOf(mesh_->cellType()); }
  /// Unknowns of a row: size of the largest elements' stiffness.
  [[nodiscard]] int unknownsPerElement() const { return nodesPerElement() * components_; }
  /// Nodes of elements, one row after the other, in the order of the shape functions; quickest where the
  /// elements ascend.
  void elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const {
    mesh_->elementNodes(elements, nodes);
  }
  [[nodiscard]] Point point(GlobalOrdinal node) const { return mesh_->point(node); }
  /// Elements at a node, ascending; `elements` is overwritten.
  void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const {
    mesh_->nodeElements(node, elements);
  }
  /// How many elements are at each of some ascending nodes.
  void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const {
    mesh_->numNodeElements(nodes, numbers);
  }
  /// Whether a node lies on the boundary of the body.
  [[nodiscard]] bool isBoundaryNode(GlobalOrdinal node) const { return mesh_->isBoundaryNode(node); }
  /// Facets of a surface with their nodes. Precondition: the mesh has one of that name.
  [[nodiscard]] mesh::Surface surface(const std::string& name) const { return mesh_->surface(name); }

private:
  const mesh::Mesh* mesh_;
  int components_;
};

} // namespace epafi::fem
