#pragma once

/// Where a body's unknowns are. They belong to entities of its mesh; a *node* here is a point that carries unknowns, `components`
/// of them. Of order 1 the nodes are the mesh's vertices, and nothing is stored or looked up beyond the mesh.

#include "epafi/fem/Mesh.hpp"

#include <cassert>
#include <span>
#include <string>
#include <vector>

namespace epafi::fem {

/// Keeps a reference to the mesh, which must outlive it. Every query is local and as cheap as the mesh's own.
class UnknownMap {
public:
  /// \param order  of the shape functions; 1. \param components  unknowns a node: 1, 2 or 3
  UnknownMap(const Mesh& mesh, int order, int components)
      : mesh_(&mesh), order_(order), components_(components) {
    assert(order == 1);
  }

  [[nodiscard]] const Mesh& mesh() const { return *mesh_; }
  [[nodiscard]] int order() const { return order_; }
  [[nodiscard]] int components() const { return components_; }
  /// Of the whole body.
  [[nodiscard]] GlobalOrdinal numNodes() const { return mesh_->numNodes(); }
  [[nodiscard]] int nodesPerElement() const { return numNodesOf(mesh_->cellType(), order_); }
  /// Unknowns an element: size of its stiffness.
  [[nodiscard]] int unknownsPerElement() const { return nodesPerElement() * components_; }
  /// Nodes of elements, one element after the other, in the order of the shape functions; quickest where the elements ascend.
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
  [[nodiscard]] Surface surface(const std::string& name) const { return mesh_->surface(name); }

private:
  const Mesh* mesh_;
  int order_, components_;
};

} // namespace epafi::fem
