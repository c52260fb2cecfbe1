#include "UndecomposedSolution.hpp"

#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace epafi::drivers {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;
using Matrix = UndecomposedSystem::Matrix;

bool isEmpty(const Matrix& matrix, Eigen::Index row) {
  return matrix.outerIndexPtr()[row] == matrix.outerIndexPtr()[row + 1];
}

/// (u, λ) with the rows of an active set as equations and λ = 0 elsewhere.
class SaddlePoint {
public:
  SaddlePoint(const UndecomposedSystem& system, const std::vector<bool>& active);

  /// \throws std::runtime_error if the system is singular
  [[nodiscard]] Eigen::VectorXd solve();
  /// A better solution from one by `solve`, by residuals in extended precision.
  [[nodiscard]] Eigen::VectorXd refined(const Eigen::VectorXd& both) const;

private:
  Eigen::SparseMatrix<double> matrix_;
  Eigen::VectorXd rhs_;
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factor_;
};

SaddlePoint::SaddlePoint(const UndecomposedSystem& system, const std::vector<bool>& active) {
  const Eigen::Index n = system.load.size(), m = system.gap.size();
  Triplets triplets;
  triplets.reserve(system.stiffness.nonZeros() + 2 * system.constraint.nonZeros() + m);
  for (int row = 0; row < n; ++row)
    for (Matrix::InnerIterator entry(system.stiffness, row); entry; ++entry)
      triplets.emplace_back(row, entry.col(), entry.value());
  rhs_ = Eigen::VectorXd::Zero(n + m);
  rhs_.head(n) = system.load;
  for (int i = 0; i < m; ++i) {
    const int line = static_cast<int>(n) + i;
    if (!active[i] || isEmpty(system.constraint, i)) {
      triplets.emplace_back(line, line, 1.0);
      continue;
    }
    for (Matrix::InnerIterator entry(system.constraint, i); entry; ++entry) {
      triplets.emplace_back(line, entry.col(), entry.value());
      triplets.emplace_back(entry.col(), line, entry.value());
    }
    rhs_[line] = system.gap[i];
  }
  matrix_.resize(n + m, n + m);
  matrix_.setFromTriplets(triplets.begin(), triplets.end());
}

Eigen::VectorXd SaddlePoint::solve() {
  factor_.compute(matrix_);
  if (factor_.info() != Eigen::Success)
    throw std::runtime_error("the saddle point system is singular");
  return factor_.solve(rhs_);
}

Eigen::VectorXd SaddlePoint::refined(const Eigen::VectorXd& both) const {
  using Extended = Eigen::VectorX<long double>;
  Extended solution = both.cast<long double>();
  for (int step = 0; step < 4; ++step) {
    Extended residual = rhs_.cast<long double>();
    for (int column = 0; column < matrix_.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix_, column); entry; ++entry)
        residual[entry.row()] -= static_cast<long double>(entry.value()) * solution[column];
    solution += Eigen::VectorXd(factor_.solve(residual.cast<double>())).cast<long double>();
  }
  return solution.cast<double>();
}

double ratio(double value, double reference) {
  return reference > 0 ? value / reference : value;
}

/// rᵀD⁻¹r.
double squared(const Eigen::VectorXd& r, const Eigen::VectorXd& diagonal) {
  return r.cwiseAbs2().cwiseQuotient(diagonal).sum();
}

} // namespace

UndecomposedSolution solveUndecomposed(const UndecomposedSystem& system) {
  const Eigen::Index n = system.load.size(), m = system.gap.size();
  std::vector<bool> active(m, true);
  UndecomposedSolution solution;
  for (int iteration = 0;; ++iteration) {
    if (iteration == 100)
      throw std::runtime_error("the active set does not settle");
    SaddlePoint saddlePoint(system, active);
    const Eigen::VectorXd direct = saddlePoint.solve(), both = saddlePoint.refined(direct);
    solution.unknowns = both.head(n);
    solution.multiplier = both.tail(m);
    solution.roundOff = energyNormError(system, direct.head(n), solution.unknowns);
    const Eigen::VectorXd slack = system.gap - system.constraint * solution.unknowns;
    std::vector<bool> next(active.size());
    for (Eigen::Index i = 0; i < m; ++i)
      next[i] = i >= system.numContacts || solution.multiplier[i] - slack[i] > 0;
    if (next == active)
      break;
    active = next;
  }
  const Eigen::VectorXd& u = solution.unknowns;
  solution.contactForce = solution.multiplier.head(system.numContacts).sum();
  solution.energy = 0.5 * u.dot(system.stiffness * u) - system.load.dot(u) + system.energyOffset;
  solution.deflection = system.valuesOf(u);
  for (Eigen::Index i = 0; i < system.numContacts; ++i)
    solution.activeContactNodes += active[i] && !isEmpty(system.constraint, i) ? 1 : 0;
  return solution;
}

Optimality optimalityOf(const UndecomposedSystem& system, const Eigen::VectorXd& u,
                        const Eigen::VectorXd& multiplier) {
  const Matrix size = system.stiffness.cwiseAbs(), weight = system.constraint.cwiseAbs();
  const Eigen::VectorXd diagonal = system.stiffness.diagonal(), slack = system.gap - system.constraint * u;
  const Eigen::VectorXd imbalance =
      system.stiffness * u - system.load + system.constraint.transpose() * multiplier;
  const Eigen::VectorXd forces =
      size * u.cwiseAbs() + system.load.cwiseAbs() + weight.transpose() * multiplier.cwiseAbs();
  Optimality result;
  result.balance = ratio(std::sqrt(squared(imbalance, diagonal)), std::sqrt(squared(forces, diagonal)));
  if (slack.size() == 0)
    return result;
  const double length =
      std::max({u.size() > 0 ? u.lpNorm<Eigen::Infinity>() : 0.0, system.gap.lpNorm<Eigen::Infinity>()});
  const auto deepest = [](const auto& values) {
    return values.size() > 0 ? std::max(0.0, -values.minCoeff()) : 0.0;
  };
  const Eigen::Index numTies = slack.size() - system.numContacts;
  const Eigen::VectorXd apart = -slack.tail(numTies).cwiseAbs();
  result.penetration = ratio(std::max(deepest(slack.head(system.numContacts)), deepest(apart)), length);
  result.tension = ratio(deepest(multiplier.head(system.numContacts)), multiplier.lpNorm<Eigen::Infinity>());
  result.complementarity = ratio(multiplier.cwiseAbs().dot(slack.cwiseAbs()),
                                 u.dot(system.stiffness * u) + std::abs(system.load.dot(u)));
  return result;
}

double energyNormError(const UndecomposedSystem& system, const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
  const Eigen::VectorXd difference = u - v;
  const double error = std::max(0.0, difference.dot(system.stiffness * difference)),
               size = std::max({0.0, v.dot(system.stiffness * v)});
  const double work = std::abs(system.load.dot(v));
  return std::sqrt(ratio(error, size > 1e-12 * work ? size : work));
}

} // namespace epafi::drivers
