#pragma once

/// Programs with bounds and orthonormal rows, and what their solutions meet.

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include "support/Problems.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace epafi::test {

/// min ½xᵀax − bᵀx, gx = 0, x ≥ lower.
struct EqualityProblem {
  Eigen::MatrixXd a, g; ///< g: orthonormal rows, or none
  Eigen::VectorXd b, lower;
};

/// Bounds on two of three entries; n, rows > 0.
inline EqualityProblem randomProblem(int n, int rows, double condition, std::mt19937& random) {
  std::normal_distribution<double> normal;
  EqualityProblem problem{randomSpd(n, condition, random), randomOrthogonal(n, random).topRows(rows),
                          Eigen::VectorXd(n), Eigen::VectorXd::Constant(n, -0.3)};
  for (int i = 0; i < n; ++i) {
    problem.b[i] = normal(random);
    if (i % 3 == 0)
      problem.lower[i] = -std::numeric_limits<double>::infinity();
  }
  return problem;
}

/// ‖g^P‖ from scratch, with the multiplier of Gx = 0 that makes g + Gᵀμ shortest on the free entries.
inline double projectedGradient(const EqualityProblem& problem, const Eigen::VectorXd& x) {
  Eigen::VectorXd g = problem.a * x - problem.b;
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (x[i] > problem.lower[i])
      free.push_back(i);
  if (problem.g.rows() > 0) {
    const Eigen::MatrixXd columns = problem.g(allOf, free).transpose();
    g += problem.g.transpose() * direct::leastSquares(columns, -g(free));
  }
  double squared = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    squared += std::pow(x[i] > problem.lower[i] ? g[i] : std::min(g[i], 0.0), 2);
  return std::sqrt(squared);
}

} // namespace epafi::test
