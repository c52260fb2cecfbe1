#pragma once

/// Structured mesh of quadrilaterals on a rectangle, or of hexahedra on an axis-parallel box, of order p.
/// Nodes are numbered row by row and layer by layer from the lowest corner, x fastest, then y, then z: node
/// (i,j,k) is i + (p n_x + 1)(j + (p n_y + 1)k); element (i,j,k) is i + n_x(j + n_y k). Nothing of the mesh's
/// size is stored.

#include "epafi/mesh/Box.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <array>
#include <cstddef>

namespace epafi::mesh {

/// Column, row and layer of numbers in a numbering row by row and layer by layer.
/// Numbers that follow each other cost a division a row at most; others two.
class GridWalk {
public:
  /// \param rowLength  numbers a row, ≥ 1
  /// \param rowsPerLayer  rows a layer, ≥ 1
  GridWalk(GlobalOrdinal rowLength, GlobalOrdinal rowsPerLayer)
      : rowLength_(rowLength), rowsPerLayer_(rowsPerLayer) {}

  /// Goes to a number ≥ 0.
  void to(GlobalOrdinal number) {
    place_[0] += number - number_;
    number_ = number;
    if (place_[0] < 0 || place_[0] >= rowLength_) {
      const GlobalOrdinal row = number / rowLength_;
      place_[0] = number - row * rowLength_;
      place_[2] = row / rowsPerLayer_;
      place_[1] = row - place_[2] * rowsPerLayer_;
    }
  }

  /// Column, row and layer.
  [[nodiscard]] const std::array<GlobalOrdinal, 3>& place() const { return place_; }
  [[nodiscard]] GlobalOrdinal operator[](std::size_t axis) const { return place_[axis]; }

private:
  GlobalOrdinal rowLength_, rowsPerLayer_;
  GlobalOrdinal number_ = 0;
  std::array<GlobalOrdinal, 3> place_{0, 0, 0};
};

class StructuredMesh final : public Mesh {
public:
  /// \param elements  in x, y and z; z: 0 in the plane, where the box's third coordinates do not matter
  /// \param order  1 or 2
  /// Precondition: elements ≥ 1 in all directions, box of positive and finite size (the scene's validation
  /// sees to both).
  StructuredMesh(const Box& box, const std::array<int, 3>& elements, int order = 1);

  [[nodiscard]] const StructuredMesh* structured() const override { return this; }
  [[nodiscard]] GlobalOrdinal numNodes() const override;
  [[nodiscard]] GlobalOrdinal numElements() const override;
  [[nodiscard]] CellType cellType() const override {
    return withOrder(dimension_ == 2 ? CellType::quadrilateral : CellType::hexahedron, order_);
  }
  [[nodiscard]] Point point(GlobalOrdinal node) const override;
  void elementNodes(GlobalOrdinal element, std::span<GlobalOrdinal> nodes) const override {
    elementNodes(std::span(&element, 1), nodes);
  }
  void elementNodes(std::span<const GlobalOrdinal> elements, std::span<GlobalOrdinal> nodes) const override;
  void nodeElements(GlobalOrdinal node, std::vector<GlobalOrdinal>& elements) const override;
  void numNodeElements(std::span<const GlobalOrdinal> nodes, std::span<int> numbers) const override;
  void elementNeighbours(GlobalOrdinal element, std::vector<GlobalOrdinal>& elements) const override;
  [[nodiscard]] bool isBoundaryNode(GlobalOrdinal node) const override;
  /// "left" and "right" (lowest and highest x); in the plane "bottom" and "top" (y), in space "front" and
  /// "back" (y), "bottom" and "top" (z).
  [[nodiscard]] std::vector<std::string> surfaceNames() const override;
  /// Facets in the order of their elements, which ascend.
  [[nodiscard]] Surface surface(const std::string& name) const override;
  [[nodiscard]] std::vector<std::string> groupNames() const override { return {}; }
  [[nodiscard]] std::vector<GlobalOrdinal> group(const std::string& /*name*/) const override { return {}; }

  /// 2 or 3.
  [[nodiscard]] int dimension() const { return dimension_; }
  /// In x, y and z; z: 1 in the plane.
  [[nodiscard]] const std::array<int, 3>& elements() const { return elements_; }
  /// In the plane z is 0.
  [[nodiscard]] const Box& box() const { return box_; }
  /// Lengths of the sides of an element, 0 in z in the plane. All elements are congruent: what depends on
  /// size and shape alone, such as a stiffness, is the same for all; the coordinates of point() differ from
  /// this by round-off only.
  [[nodiscard]] const Vector3& elementSize() const { return elementSize_; }
  /// Nodes of every element, from its lowest corner on.
  [[nodiscard]] std::vector<Point> elementShape() const;
  /// (i,j,k) of each node of an element among its (p + 1)³ or (p + 1)² nodes, x fastest.
  [[nodiscard]] std::span<const std::array<int, 3>> places() const;
  /// Coordinate of the k-th plane (in the plane: line) between elements across an axis.
  [[nodiscard]] double coordinate(std::size_t axis, GlobalOrdinal k) const {
    return nodeCoordinate(axis, order_ * k);
  }
  /// From element to element.
  [[nodiscard]] GridWalk elementWalk() const { return {elements_[0], elements_[1]}; }

private:
  /// Of the k-th plane of nodes.
  [[nodiscard]] double nodeCoordinate(std::size_t axis, GlobalOrdinal k) const;

  Box box_;
  int dimension_, order_;
  std::array<int, 3> elements_; ///< layers in z: 1 in the plane
  std::array<int, 3> nodes_;    ///< along each axis; in z: 1 in the plane
  Vector3 elementSize_{0, 0, 0};
};

/// Nodes of every element, from the origin on, where the mesh is structured and all are congruent; else
/// empty.
std::vector<Point> congruentShape(const Mesh& mesh);

} // namespace epafi::mesh
