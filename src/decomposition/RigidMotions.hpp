#pragma once

#include <Eigen/Core>

namespace epafi::decomposition {

/// Rigid modes of a body as motions in space.
struct RigidMotions {
  Eigen::Vector3d centre{0, 0, 0}; ///< of the body
  double size = 1;                 ///< half its largest extent
  Eigen::MatrixXd twists;          ///< 6 × number of modes: displacement of the centre, rotation vector
};

} // namespace epafi::decomposition
