#pragma once

/// What differs between Eigen 3.4 and 5. For units that use Eigen; base itself does not.

#include <Eigen/Core>

namespace epafi {

/// All rows or all columns of a matrix that is indexed by lists.
#if EIGEN_VERSION_AT_LEAST(3, 4, 90)
inline const auto allOf = Eigen::placeholders::all;
#else
inline const auto allOf = Eigen::all;
#endif

} // namespace epafi
