#pragma once

/// Bound-constrained problems with dense copies, solved by MPRGP.

#include "support/Problems.hpp"

#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace epafi::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A bound-constrained problem with dense copies.
struct Problem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, lower, upper;

  RCP<const Map> map() const { return linearMap(static_cast<int>(b.size())); }
};

struct Answer {
  Eigen::VectorXd x;
  qp::SolveReport report;
  int applications;
};

inline Answer solve(const Problem& problem, double tolerance = 1e-10, double norm = 1.0,
                    const Eigen::VectorXd& start = Eigen::VectorXd(), qp::Observer* observer = nullptr) {
  const auto map = problem.map();
  const auto a = rcp(new DenseOperator(map, problem.a));
  const RCP<const qp::ConvexSet> box =
      rcp(new qp::Box(makeVector(map, problem.lower), makeVector(map, problem.upper)));
  const auto b = makeVector(map, problem.b);
  const auto x = start.size() > 0 ? makeVector(map, start) : rcp(new Vector(map));
  const auto report = qp::solveByMprgp({.hessian = a, .linearTerm = b, .set = box, .operatorNorm = norm}, *x,
                                       {tolerance, accurateNorm(*b)}, {}, observer);
  return {gather(*x), report, a->applications};
}

/// Norm of the projected gradient, from scratch.
inline double projectedGradient(const Problem& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd g = problem.a * x - problem.b;
  double squared = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double p = g[i];
    if (x[i] <= problem.lower[i])
      p = std::min(p, 0.0);
    if (x[i] >= problem.upper[i])
      p = problem.lower[i] < problem.upper[i] ? std::max(p, 0.0) : 0.0;
    squared += p * p;
  }
  return std::sqrt(squared);
}

/// Random problem with entries bounded below, above, on both sides, on none, or fixed.
inline Problem randomProblem(int n, double condition, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> kind(0, 4);
  Problem problem{randomSpd(n, condition, random), Eigen::VectorXd(n), Eigen::VectorXd(n),
                  Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    problem.b[i] = normal(random);
    const double centre = normal(random);
    const int k = kind(random);
    problem.lower[i] = k == 0 || k == 1 ? centre - 0.5 : k == 4 ? centre : -infinity;
    problem.upper[i] = k == 0 || k == 2 ? centre + 0.5 : k == 4 ? centre : infinity;
  }
  return problem;
}

} // namespace epafi::test
