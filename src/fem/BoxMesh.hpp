#pragma once

/// Structured mesh of Q1 hexahedra on an axis-parallel box. Nodes are numbered row by row and layer by layer
/// from the lowest corner, x fastest, then y, then z: node (i,j,k) is i + (n_x + 1)(j + (n_y + 1)k); element
/// (i,j,k) is i + n_x(j + n_y k). Nothing of the mesh's size is stored.

#include "epafi/fem/Mesh.hpp"
#include "epafi/scene/Solid.hpp"

namespace epafi::fem {

class BoxMesh final : public Mesh {
public:
  /// Precondition: elements ≥ 1 in all directions, box of positive and finite size (the scene's validation sees
  /// to both).
  BoxMesh(const scene::Box& box, std::array<int, 3> elements);

  [[nodiscard]] GlobalOrdinal numNodes() const override;
  [[nodiscard]] GlobalOrdinal numElements() const override;
  [[nodiscard]] CellType cellType() const override { return CellType::hexahedron; }
  [[nodiscard]] Point point(GlobalOrdinal node) const override;
  void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const override;
  void elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const override;
  void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const override;
  void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const override;
  void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const override;
  [[nodiscard]] bool isBoundaryNode(GlobalOrdinal node) const override;
  /// "left" and "right" (lowest and highest x), "front" and "back" (y), "bottom" and "top" (z).
  [[nodiscard]] std::vector<std::string> surfaceNames() const override;
  /// Facets in the order of their elements, which ascend.
  [[nodiscard]] Surface surface(const std::string& name) const override;
  [[nodiscard]] std::vector<std::string> groupNames() const override { return {}; }
  [[nodiscard]] std::vector<GlobalOrdinal> group(const std::string& name) const override;

  [[nodiscard]] std::array<int, 3> elements() const { return elements_; }
  [[nodiscard]] const scene::Box& box() const { return box_; }
  /// Lengths of the sides of an element. All elements are congruent: what depends on size and shape alone, such
  /// as a stiffness, is the same for all; the coordinates of point() differ from this by round-off only.
  [[nodiscard]] scene::Vector3 elementSize() const;
  /// Box that an element fills.
  [[nodiscard]] scene::Box elementBox(GlobalOrdinal element) const;

private:
  scene::Box box_;
  std::array<int, 3> elements_;
};

} // namespace epafi::fem
