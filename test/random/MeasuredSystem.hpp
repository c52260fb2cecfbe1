#pragma once

/// A scene's system with one scale for each kind of quantity.

#include "UndecomposedSystem.hpp"

#include "epafi/scene/Scene.hpp"

#include <Eigen/Core>

namespace epafi::test {

/// The system with rows of length 1, gaps that are round-off of places set to 0, and the rigid motions that
/// supports leave.
struct Measured {
  drivers::UndecomposedSystem system;
  double size = 0;              ///< of the scene
  Eigen::MatrixXd motion;       ///< Z, n × k: the kernel of K; entries of about 1
  Eigen::MatrixXd rows;         ///< B, m × n, each row of length 1 or 0
  Eigen::VectorXd lengths, gap; ///< c by the rows' lengths
  double gapScale = 0;          ///< its largest entry
  double loadScale = 0;         ///< Σ |f|, or the loads that supports carry if they are more

  /// \throws Uncertain
  Measured(drivers::UndecomposedSystem given, const scene::Scene& scene);
  [[nodiscard]] Eigen::Index numContacts() const { return system.numContacts; }

private:
  void findMotions();
};

} // namespace epafi::test
