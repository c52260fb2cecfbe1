#include "epafi/direct/NonNegativeLeastSquares.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <algorithm>
#include <vector>

namespace epafi::direct {
namespace {

/// Least squares on the columns of the passive set; zero elsewhere.
Eigen::VectorXd solveOn(const std::vector<Eigen::Index>& passive, const Eigen::MatrixXd& a,
                        const Eigen::VectorXd& b) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(a.cols());
  if (!passive.empty())
    x(passive) = leastSquares(a(allOf, passive), b);
  return x;
}

/// The passive set that a step of Lawson and Hanson ends with.
class PassiveSet {
public:
  PassiveSet(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) : a_(a), b_(b), isIn_(a.cols(), 0) {}

  [[nodiscard]] bool contains(Eigen::Index j) const { return isIn_[j] != 0; }

  /// Lets a column in, and goes from x as far as feasible towards the least squares solution, letting go of
  /// what becomes zero on the way. Returns whether the column is still in.
  bool enter(Eigen::Index entering, Eigen::VectorXd& x) {
    columns_.push_back(entering);
    isIn_[entering] = 1;
    for (;;) {
      const Eigen::VectorXd candidate = solveOn(columns_, a_, b_);
      double length = 1.0;
      Eigen::Index blocking = -1;
      for (const Eigen::Index j : columns_)
        if (candidate[j] < 0) {
          const double ratio = x[j] / (x[j] - candidate[j]);
          if (blocking < 0 || ratio < length) {
            length = ratio;
            blocking = j;
          }
        }
      if (blocking < 0) {
        x = candidate;
        return contains(entering);
      }
      x += length * (candidate - x);
      x[blocking] = 0;
      columns_.erase(std::find(columns_.begin(), columns_.end(), blocking));
      isIn_[blocking] = 0;
    }
  }

private:
  const Eigen::MatrixXd& a_;
  const Eigen::VectorXd& b_;
  std::vector<Eigen::Index> columns_;
  std::vector<char> isIn_;
};

} // namespace

NonNegativeSolution nonNegativeLeastSquares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  NonNegativeSolution solution{Eigen::VectorXd::Zero(a.cols()), b};
  const double tolerance = 1e-14 * std::max(a.norm(), 1e-300) * b.norm();
  PassiveSet passive(a, b);
  std::vector<char> isBarred(a.cols(),
                             0); // left at once: dependent, up to round-off
  for (Eigen::Index step = 0; step < 3 * a.cols() + 10; ++step) {
    const Eigen::VectorXd gradient = a.transpose() * solution.residual;
    Eigen::Index entering = -1;
    double steepest = tolerance;
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      if (gradient[j] > steepest && !passive.contains(j) && isBarred[j] == 0) {
        steepest = gradient[j];
        entering = j;
      }
    if (entering < 0)
      return solution;
    const double before = solution.residual.squaredNorm();
    const bool isIn = passive.enter(entering, solution.x);
    solution.residual = b - a * solution.x;
    if (solution.residual.squaredNorm() < before * (1 - 1e-14))
      std::fill(isBarred.begin(), isBarred.end(), 0);
    if (!isIn)
      isBarred[entering] = 1;
  }
  return solution;
}

} // namespace epafi::direct
