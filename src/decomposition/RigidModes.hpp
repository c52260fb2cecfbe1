#pragma once

/// The rigid motions of a body, and which of them its supports leave free.

#include "epafi/base/Types.hpp"

#include <Eigen/Core>

#include <span>

namespace epafi::decomposition {

/// A direction, of length 1, in which a support holds a point.
struct HeldDirection {
  Point point;
  Eigen::Vector3d direction;
};

/// Motions that supports leave free.
struct FreeModes {
  Eigen::MatrixXd modes; ///< columns: combinations of the rigid modes, orthonormal
  /// How much the supports hold of the motion that they hold least: the mean square of the held
  /// displacements, its root relative to the motion. Infinite if nothing is held.
  double leastHold = 0;
};

/// Rigid motions of a body, about its centre, rotations scaled by its size so that all are of one magnitude:
/// 1 of a scalar field, 3 in the plane (x, y, rotation), 6 in space (x, y, z, rotations about x, y, z); of a
/// solid of revolution about the y-axis 1, along it.
class RigidModes {
public:
  /// A motion is free if it moves the held points, in the root mean square, by less than this share of
  /// itself: what round-off makes of 0. It is held if it moves them by more than `heldFrom`; between the two
  /// nobody can tell.
  static constexpr double freeUpTo = 1e-9, heldFrom = 1e-6;

  /// \param components  unknowns a node: 1, 2 or 3
  RigidModes(int components, const Point& centre, double size, bool isOfRevolution = false)
      : components_(components), isOfRevolution_(isOfRevolution), centre_(centre), size_(size) {}

  [[nodiscard]] int number() const {
    return components_ == 1 || isOfRevolution_ ? 1 : components_ == 2 ? 3 : 6;
  }
  /// Displacement of a point in one component by each mode.
  [[nodiscard]] Eigen::VectorXd at(const Point& point, int component) const;
  /// The same along a direction.
  [[nodiscard]] Eigen::VectorXd along(const Point& point, const Eigen::Vector3d& direction) const;
  /// The motions that vanish along all held directions; all modes themselves if nothing is held.
  [[nodiscard]] FreeModes freeOf(std::span<const HeldDirection> held) const;
  /// Each mode as a motion in space: displacement of the body's centre (3 rows), rotation vector (3 rows).
  /// Not of a scalar field.
  [[nodiscard]] Eigen::MatrixXd twists() const;
  [[nodiscard]] const Point& centre() const { return centre_; }
  /// Half the body's largest extent.
  [[nodiscard]] double size() const { return size_; }

private:
  int components_;
  bool isOfRevolution_;
  Point centre_;
  double size_;
};

} // namespace epafi::decomposition
