#include "UndecomposedSolution.hpp"

#include "WholeRun.hpp"

#include "epafi/decomposition/Decompose.hpp"

#include <Eigen/SparseLU>
#include <Teuchos_ArrayRCP.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <stdexcept>

namespace epafi::test {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// min ½uᵀKu − fᵀu, Bu ≤ c for all bodies together.
struct Whole {
  Triplets stiffness;
  Eigen::VectorXd load, gap;
  std::vector<std::vector<std::pair<int, double>>> rows; ///< of B
  std::vector<Eigen::Index> offset;                      ///< first unknown of each body
};

Whole assemble(const decomposition::DecomposedProblem& problem) {
  Whole whole;
  const auto c = problem.gap->getData();
  whole.gap = Eigen::Map<const Eigen::VectorXd>(c.getRawPtr(), c.size());
  whole.rows.resize(static_cast<std::size_t>(c.size()));
  Eigen::Index size = 0;
  for (const auto& subdomain : problem.subdomains) {
    whole.offset.push_back(size);
    for (int column = 0; column < subdomain.stiffness->outerSize(); ++column)
      for (decomposition::SparseMatrix::InnerIterator entry(*subdomain.stiffness, column); entry; ++entry)
        whole.stiffness.emplace_back(static_cast<int>(size + entry.row()), static_cast<int>(size + column),
                                     entry.value());
    for (const auto& entry : subdomain.constraint) {
      const auto global = problem.multiplierGhostMap->getGlobalElement(entry.multiplier);
      whole.rows[static_cast<std::size_t>(problem.multiplierMap->getLocalElement(global))].emplace_back(
          static_cast<int>(size) + entry.unknown, entry.coefficient);
    }
    size += subdomain.stiffness->rows();
  }
  whole.load.resize(size);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    whole.load.segment(whole.offset[s], problem.subdomains[s].load.size()) = problem.subdomains[s].load;
  return whole;
}

/// (u, λ) with the rows of `active` as equations and λ = 0 elsewhere.
Eigen::VectorXd solveSaddlePoint(const Whole& whole, const std::vector<bool>& active) {
  const Eigen::Index n = whole.load.size(), m = whole.gap.size();
  Triplets triplets = whole.stiffness;
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n + m);
  rhs.head(n) = whole.load;
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto& row = whole.rows[static_cast<std::size_t>(i)];
    const int line = static_cast<int>(n + i);
    if (!active[static_cast<std::size_t>(i)] || row.empty()) {
      triplets.emplace_back(line, line, 1.0);
      continue;
    }
    for (const auto& [unknown, coefficient] : row) {
      triplets.emplace_back(line, unknown, coefficient);
      triplets.emplace_back(unknown, line, coefficient);
    }
    rhs[line] = whole.gap[i];
  }
  Eigen::SparseMatrix<double> matrix(n + m, n + m);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("the saddle point system is singular");
  return factor.solve(rhs);
}

Eigen::VectorXd slack(const Whole& whole, const Eigen::VectorXd& u) {
  Eigen::VectorXd result = whole.gap;
  for (Eigen::Index i = 0; i < result.size(); ++i)
    for (const auto& [unknown, coefficient] : whole.rows[static_cast<std::size_t>(i)])
      result[i] -= coefficient * u[unknown];
  return result;
}

} // namespace

UndecomposedSolution solveUndecomposed(const scene::Scene& scene) {
  const auto decomposition = decomposition::decompose(cutByMetis(scene, 1), thisRankOnly());
  const auto& problem = decomposition.problem;
  const Whole whole = assemble(problem);
  const Eigen::Index n = whole.load.size(), m = whole.gap.size();
  std::vector<bool> active(static_cast<std::size_t>(m), true);
  Eigen::VectorXd u, lambda, gap;
  for (int iteration = 0;; ++iteration) {
    if (iteration == 100)
      throw std::runtime_error("the active set does not settle");
    const Eigen::VectorXd both = solveSaddlePoint(whole, active);
    u = both.head(n);
    lambda = both.tail(m);
    gap = slack(whole, u);
    std::vector<bool> next(active.size());
    for (Eigen::Index i = 0; i < m; ++i)
      next[static_cast<std::size_t>(i)] = lambda[i] - gap[i] > 0;
    if (next == active)
      break;
    active = next;
  }

  UndecomposedSolution solution;
  solution.contactForce = lambda.sum();
  solution.energy = -whole.load.dot(u);
  for (const auto& entry : whole.stiffness)
    solution.energy += 0.5 * u[entry.row()] * entry.value() * u[entry.col()];
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const auto& subdomain = problem.subdomains[s];
    Eigen::VectorXd values = subdomain.prescribed;
    for (std::size_t i = 0; i < subdomain.unknownPosition.size(); ++i)
      values[subdomain.unknownPosition[i]] = u[whole.offset[s] + static_cast<Eigen::Index>(i)];
    decomposition::toSpace(subdomain, values);
    solution.deflection.push_back(values);
    solution.energy += subdomain.energyOffset;
  }
  for (std::size_t i = 0; i < active.size(); ++i)
    solution.activeContactNodes += active[i] && !whole.rows[i].empty() ? 1 : 0;
  return solution;
}

} // namespace epafi::test
