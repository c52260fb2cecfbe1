#pragma once

/// Which element of a mesh a point lies in.

#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <array>
#include <optional>
#include <vector>

namespace epafi::accuracy {

/// A point as the sum of an element's nodes times weights, their shape functions there.
struct Location {
  GlobalOrdinal element = 0;
  std::array<double, mesh::mostNodes> weights{}; ///< as many as the element has nodes; their sum is 1
};

class PointLocation {
public:
  /// Keeps the reference. Of a structured mesh nothing is stored, of another a tree of the elements' boxes.
  explicit PointLocation(const mesh::Mesh& mesh);

  /// The element that contains the point; for a point outside of the body, as finer meshes of round bodies
  /// have, that of a near one, and the weights are those of a point of it; of a piece of a mesh, of the held
  /// ones. Not collective.
  [[nodiscard]] Location find(const Point& point) const;

private:
  [[nodiscard]] Location best(const Point& point, const std::vector<std::size_t>& candidates,
                              double& outside) const;

  const mesh::Mesh& mesh_;
  std::optional<mesh::BoxTree> boxes_; ///< of the held elements; none of structured meshes
};

} // namespace epafi::accuracy
