#include "epafi/fetidp/NonNegativeLeastSquares.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <limits>
#include <vector>

namespace epafi::fetidp {
namespace {

/// Least squares on the columns of the passive set; zero elsewhere.
Eigen::VectorXd solveOn(const std::vector<Eigen::Index>& passive, const Eigen::MatrixXd& a,
                        const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.cols());
  const Eigen::VectorXd values = a(Eigen::all, passive).colPivHouseholderQr().solve(b);
  for (std::size_t k = 0; k < passive.size(); ++k)
    x[passive[k]] = values[static_cast<Eigen::Index>(k)];
  return x;
}

} // namespace

NonNegativeSolution nonNegativeLeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  NonNegativeSolution solution{Eigen::VectorXd::Zero(a.cols()), b};
  const double tolerance = 1e-14 * std::max(a.norm(), 1e-300) * b.norm();
  std::vector<Eigen::Index> passive;
  for (Eigen::Index step = 0; step < 3 * a.cols() + 10; ++step) {
    const Eigen::VectorXd gradient = a.transpose() * solution.residual;
    Eigen::Index entering = -1;
    double steepest = tolerance;
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      if (gradient[j] > steepest && std::find(passive.begin(), passive.end(), j) == passive.end()) {
        steepest = gradient[j];
        entering = j;
      }
    if (entering < 0)
      return solution;
    passive.push_back(entering);

    Eigen::VectorXd candidate = solveOn(passive, a, b);
    while (candidate.minCoeff() < 0) { // go as far as feasible, let go of what became zero
      double length = 1.0;
      Eigen::Index blocking = -1;
      for (const Eigen::Index j : passive)
        if (candidate[j] < 0) {
          const double ratio = solution.x[j] / (solution.x[j] - candidate[j]);
          if (blocking < 0 || ratio < length) {
            length = ratio;
            blocking = j;
          }
        }
      solution.x += length * (candidate - solution.x);
      solution.x[blocking] = 0;
      passive.erase(std::find(passive.begin(), passive.end(), blocking));
      if (passive.empty()) {
        candidate.setZero();
        break;
      }
      candidate = solveOn(passive, a, b);
    }
    solution.x = candidate;
    solution.residual = b - a * solution.x;
  }
  return solution;
}

} // namespace epafi::fetidp
