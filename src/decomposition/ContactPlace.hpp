#pragma once

#include "epafi/base/Types.hpp"

#include <Eigen/Core>

namespace epafi::decomposition {

/// Where a row of contact lies, and how the smooth surfaces face each other there: whether more than their
/// facets hinders a rigid motion. In the plane third coordinates are 0.
struct ContactPlace {
  /// One of the two bodies.
  struct Side {
    int body = -1;
    Eigen::Vector3d place{0, 0, 0}; ///< the mean of what the row takes of it
    Eigen::Vector3d normal{0, 0,
                           0}; ///< of its smooth surface, of length 1, from the first body to the second
    double uncertainty = 0;    ///< angle by which the normal may be off
  };
  GlobalOrdinal row = 0; ///< number among those of contact
  Side first, second;
};

} // namespace epafi::decomposition
