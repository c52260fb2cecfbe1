#pragma once

/// Structured mesh of Q1 quadrilaterals on a rectangle. Nodes are numbered row by row from the lower left
/// corner: node (i,j) is i + j(n_x + 1); element (i,j) is i + j n_x. Nothing of the mesh's size is stored.

#include "epafi/fem/Mesh.hpp"
#include "epafi/scene/Scene.hpp"

namespace epafi::fem {

class RectangleMesh final : public Mesh {
public:
  /// Precondition: elements ≥ 1 in both directions, rectangle of positive size (the scene's validation sees
  /// to both).
  RectangleMesh(const scene::Rectangle& rectangle, std::array<int, 2> elements);

  [[nodiscard]] GlobalOrdinal numNodes() const override;
  [[nodiscard]] GlobalOrdinal numElements() const override;
  [[nodiscard]] CellType cellType() const override { return CellType::quadrilateral; }
  [[nodiscard]] Point point(GlobalOrdinal node) const override;
  void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const override;
  void elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const override;
  void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const override;
  void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const override;
  void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const override;
  [[nodiscard]] bool isBoundaryNode(GlobalOrdinal node) const override;
  /// "left", "right", "bottom", "top".
  [[nodiscard]] std::vector<std::string> surfaceNames() const override;
  [[nodiscard]] Surface surface(const std::string& name) const override;
  [[nodiscard]] std::vector<std::string> groupNames() const override { return {}; }
  [[nodiscard]] std::vector<GlobalOrdinal> group(const std::string& name) const override;

  [[nodiscard]] std::array<int, 2> elements() const { return elements_; }
  [[nodiscard]] const scene::Rectangle& rectangle() const { return rectangle_; }
  /// Rectangle that an element fills.
  [[nodiscard]] scene::Rectangle elementBox(GlobalOrdinal element) const;
  /// Number of nodes on an edge.
  [[nodiscard]] GlobalOrdinal numEdgeNodes(scene::Edge edge) const;
  /// The k-th node of an edge; edges run upwards (left, right) or to the right (bottom, top).
  [[nodiscard]] GlobalOrdinal edgeNode(scene::Edge edge, GlobalOrdinal k) const;
  /// Position of a node on an edge, or −1 if it does not lie on it.
  [[nodiscard]] GlobalOrdinal positionOnEdge(scene::Edge edge, GlobalOrdinal node) const;
  /// Places in `nodes`, which ascend, of those that lie on an edge; `places` is overwritten. Costs a search a
  /// row of the mesh, not a step a node.
  void placesOnEdge(scene::Edge edge, std::span<const GlobalOrdinal> nodes,
                    std::vector<std::size_t>& places) const;

private:
  scene::Rectangle rectangle_;
  std::array<int, 2> elements_;
};

} // namespace epafi::fem
