#pragma once

/// min ‖Ax − b‖, x ≥ 0 for a small dense A: Lawson, Hanson, *Solving Least Squares Problems* (1974), ch. 23.

#include <Eigen/Core>

namespace epafi::direct {

struct NonNegativeSolution {
  Eigen::VectorXd x; ///< n, ≥ 0
  Eigen::VectorXd
      residual; ///< m, b − Ax; Aᵀ residual ≤ 0, so that it separates b from the cone of A's columns
};

/// \param a  m × n with few rows. Ends after a finite number of steps (each a least-squares problem of at
/// most m columns).
NonNegativeSolution nonNegativeLeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

} // namespace epafi::direct
