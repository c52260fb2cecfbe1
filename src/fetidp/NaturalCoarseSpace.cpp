#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::fetidp {

std::vector<KernelEntry> kernelConstraint(const decomposition::DecomposedProblem& problem) {
  const auto numModes = static_cast<std::size_t>(problem.kernelDimension);
  std::vector<KernelEntry> entries;
  if (numModes == 0)
    return entries;
  MultiVector ghost(problem.multiplierGhostMap, numModes), owned(problem.multiplierMap, numModes);
  for (const auto& subdomain : problem.subdomains) {
    const int offset = problem.bodies[static_cast<std::size_t>(subdomain.body)].kernelOffset;
    for (const auto& entry : subdomain.constraint)
      for (Eigen::Index mode = 0; mode < subdomain.kernel.cols(); ++mode)
        ghost.sumIntoLocalValue(entry.multiplier, static_cast<std::size_t>(offset + mode),
                                entry.coefficient * subdomain.kernel(entry.unknown, mode));
  }
  const Import plan(problem.multiplierMap, problem.multiplierGhostMap);
  owned.doExport(ghost, plan, Tpetra::ADD);

  for (std::size_t mode = 0; mode < numModes; ++mode) {
    const auto column = owned.getData(mode);
    for (Teuchos_Ordinal row = 0; row < column.size(); ++row) {
      // Gluing rows cancel: both copies of a node have the same value of R.
      const bool isContact =
          problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(row)) < problem.numInequalities;
      if (isContact && column[row] != 0)
        entries.push_back({static_cast<int>(row), static_cast<int>(mode), column[row]});
    }
  }
  return entries;
}

Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem, const SubdomainVectors& load) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(problem.kernelDimension);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const auto& subdomain = problem.subdomains[s];
    const int offset = problem.bodies[static_cast<std::size_t>(subdomain.body)].kernelOffset;
    if (subdomain.kernel.cols() > 0)
      result.segment(offset, subdomain.kernel.cols()) += subdomain.kernel.transpose() * load[s];
  }
  sumOverRanks(*problem.comm, {result.data(), static_cast<std::size_t>(result.size())});
  return result;
}

NaturalCoarseSpace::NaturalCoarseSpace(const decomposition::DecomposedProblem& problem,
                                       std::vector<KernelEntry> entries)
    : comm_(problem.comm), entries_(std::move(entries)), work_(problem.kernelDimension),
      sums_(problem.kernelDimension) {
  // G̃G̃ᵀ from the rows of G̃ᵀ.
  const auto numRows = numLocal(*problem.multiplierMap);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(problem.kernelDimension, problem.kernelDimension);
  std::vector<std::vector<KernelEntry>> rows(numRows);
  for (const KernelEntry& entry : entries_)
    rows[static_cast<std::size_t>(entry.row)].push_back(entry);
  for (const auto& row : rows)
    for (const KernelEntry& a : row)
      for (const KernelEntry& b : row)
        gram(a.mode, b.mode) += a.value * b.value;
  sumOverRanks(*comm_, {gram.data(), static_cast<std::size_t>(gram.size())});
  const Eigen::LLT<Eigen::MatrixXd> factor(gram);
  if (factor.info() != Eigen::Success)
    throw Error(
        "the rows of G are linearly dependent: some rigid motion of the floating bodies meets no contact");
  cholesky_ = factor.matrixL();
}

void NaturalCoarseSpace::addLocalProduct(const Vector& x, std::span<double> gx) const {
  const std::span<const double> values = qp::localData(x);
  work_.setZero();
  for (const KernelEntry& entry : entries_)
    work_[entry.mode] += entry.value * values[static_cast<std::size_t>(entry.row)]; // G̃x
  cholesky_.triangularView<Eigen::Lower>().solveInPlace(work_);                     // L⁻¹
  for (std::size_t k = 0; k < gx.size(); ++k)
    gx[k] += work_[static_cast<Eigen::Index>(k)];
}

void NaturalCoarseSpace::addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const {
  for (std::size_t k = 0; k < mu.size(); ++k)
    work_[static_cast<Eigen::Index>(k)] = factor * mu[k];
  cholesky_.transpose().triangularView<Eigen::Upper>().solveInPlace(work_); // L⁻ᵀ μ
  const std::span<double> values = qp::localDataNonConst(y);
  for (const KernelEntry& entry : entries_)
    values[static_cast<std::size_t>(entry.row)] += entry.value * work_[entry.mode]; // G̃ᵀ
}

Eigen::VectorXd NaturalCoarseSpace::product(const Vector& x) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(size());
  const std::span<double> values(result.data(), static_cast<std::size_t>(result.size()));
  addLocalProduct(x, values);
  sumOverRanks(*comm_, values);
  return result;
}

void NaturalCoarseSpace::project(Vector& x) const {
  sums_.setZero();
  const std::span<double> gx(sums_.data(), static_cast<std::size_t>(sums_.size()));
  addLocalProduct(x, gx);
  sumOverRanks(*comm_, gx);
  addTransposedProduct(gx, -1.0, x);
}

Eigen::VectorXd NaturalCoarseSpace::normalized(const Eigen::VectorXd& kernelLoad) const {
  return cholesky_.triangularView<Eigen::Lower>().solve(kernelLoad);
}

void NaturalCoarseSpace::feasiblePoint(const Eigen::VectorXd& e, Vector& lambda) const {
  lambda.putScalar(0.0);
  addTransposedProduct({e.data(), static_cast<std::size_t>(e.size())}, 1.0, lambda);
}

} // namespace epafi::fetidp
