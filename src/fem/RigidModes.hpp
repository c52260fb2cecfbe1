#pragma once

/// The rigid motions of a body, and which of them its supports leave free.

#include "epafi/fem/Mesh.hpp"

#include <Eigen/Core>

#include <span>

namespace epafi::fem {

/// A component of a node's displacement that a support holds.
struct HeldComponent {
  Point point;
  int component = 0;
};

/// Rigid motions of a body, about its centre, rotations scaled by its size so that all are of one magnitude: 1 of a scalar
/// field, 3 in the plane (x, y, rotation), 6 in space (x, y, z, rotations about x, y, z).
class RigidModes {
public:
  /// \param components  unknowns a node: 1, 2 or 3
  RigidModes(int components, const Point& centre, double size)
      : components_(components), centre_(centre), size_(size) {}

  [[nodiscard]] int number() const { return components_ == 1 ? 1 : components_ == 2 ? 3 : 6; }
  /// Displacement of a point in one component by each mode.
  [[nodiscard]] Eigen::VectorXd at(const Point& point, int component) const;
  /// The motions that vanish in all held components: combinations of the modes, orthonormal columns. All modes themselves
  /// if nothing is held.
  [[nodiscard]] Eigen::MatrixXd freeOf(std::span<const HeldComponent> held) const;

private:
  int components_;
  Point centre_;
  double size_;
};

} // namespace epafi::fem
