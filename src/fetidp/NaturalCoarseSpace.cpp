#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/qp/LocalData.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
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
        ghost.sumIntoLocalValue(static_cast<LocalOrdinal>(entry.multiplier),
                                static_cast<std::size_t>(offset + mode),
                                entry.coefficient * subdomain.kernel(entry.unknown, mode));
  }
  const Import plan(problem.multiplierMap, problem.multiplierGhostMap);
  owned.doExport(ghost, plan, Tpetra::ADD);

  for (std::size_t mode = 0; mode < numModes; ++mode) {
    const auto column = owned.getData(mode);
    for (LocalOrdinal row = 0; row < column.size(); ++row) {
      // Gluing rows cancel: both copies of a node have the same value of R.
      const bool isGluing =
          problem.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::gluing;
      if (!isGluing && column[row] != 0)
        entries.push_back({static_cast<int>(row), static_cast<int>(mode), column[row]});
    }
  }
  return entries;
}

namespace {

/// Σ product(r, f) of the modes r and the loads f over all subdomains.
template <class Product>
Eigen::VectorXd resultants(const decomposition::DecomposedProblem& problem, const SubdomainVectors& loads,
                           const Product& product) {
  std::vector<AccurateSum> sums(static_cast<std::size_t>(problem.kernelDimension));
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    const auto offset = problem.bodies[static_cast<std::size_t>(subdomain.body)].kernelOffset;
    for (Eigen::Index mode = 0; mode < subdomain.kernel.cols(); ++mode)
      sums[static_cast<std::size_t>(offset + mode)].add(product(subdomain.kernel.col(mode), loads[s].col(0)));
  }
  Eigen::VectorXd result(problem.kernelDimension);
  sumOverRanks(*problem.comm, sums, result.data());
  return result;
}

/// G̃G̃ᵀ, k × k, on every rank. Collective.
Eigen::MatrixXd kernelGram(const decomposition::DecomposedProblem& problem,
                           const std::vector<KernelEntry>& entries) {
  const Eigen::Index k = problem.kernelDimension;
  std::vector<AccurateSum> sums(static_cast<std::size_t>(k * k));
  std::vector<std::vector<KernelEntry>> rows(numLocal(*problem.multiplierMap));
  for (const KernelEntry& entry : entries)
    rows[static_cast<std::size_t>(entry.row)].push_back(entry);
  for (const auto& row : rows)
    for (const KernelEntry& a : row)
      for (const KernelEntry& b : row)
        sums[static_cast<std::size_t>(a.mode + k * b.mode)].add(a.value * b.value);
  Eigen::MatrixXd gram(k, k);
  sumOverRanks(*problem.comm, sums, gram.data());
  return gram;
}

} // namespace

Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem, const SubdomainVectors& loads) {
  return resultants(problem, loads, [](const auto& r, const auto& f) { return r.dot(f); });
}

Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem) {
  return kernelLoad(problem, loadsOf(problem));
}

Eigen::VectorXd kernelLoadMagnitude(const decomposition::DecomposedProblem& problem) {
  return resultants(problem, loadsOf(problem),
                    [](const auto& r, const auto& f) { return r.cwiseAbs().dot(f.cwiseAbs()); });
}

NaturalCoarseSpace::NaturalCoarseSpace(const decomposition::DecomposedProblem& problem,
                                       std::vector<KernelEntry> entries)
    : comm_(problem.comm), entries_(std::move(entries)),
      sums_(static_cast<std::size_t>(problem.kernelDimension)), work_(problem.kernelDimension),
      product_(problem.kernelDimension) {
  const Eigen::LLT<Eigen::MatrixXd> factor(kernelGram(problem, entries_));
  if (factor.info() != Eigen::Success)
    throw Error(
        "the rows of G are linearly dependent: some rigid motion of the floating bodies meets no contact");
  cholesky_ = factor.matrixL();
}

/// G̃x; L⁻¹ waits for the sum, so that the order of the terms does not matter.
void NaturalCoarseSpace::addLocalProduct(const Vector& x, std::span<AccurateSum> sums) const {
  const std::span<const double> values = qp::localData(x);
  for (const KernelEntry& entry : entries_)
    sums[static_cast<std::size_t>(entry.mode)].add(entry.value * values[static_cast<std::size_t>(entry.row)]);
}

void NaturalCoarseSpace::finishProduct(std::span<const AccurateSum> sums, std::span<double> gx) const {
  for (std::size_t k = 0; k < gx.size(); ++k)
    gx[k] = sums[k].value();
  Eigen::Map<Eigen::VectorXd> product(gx.data(), static_cast<Eigen::Index>(gx.size()));
  cholesky_.triangularView<Eigen::Lower>().solveInPlace(product); // L⁻¹ G̃x
}

void NaturalCoarseSpace::addTransposedProduct(std::span<const double> mu, double factor, Vector& y) const {
  for (std::size_t k = 0; k < mu.size(); ++k)
    work_[static_cast<Eigen::Index>(k)] = factor * mu[k];
  cholesky_.transpose().triangularView<Eigen::Upper>().solveInPlace(work_); // L⁻ᵀ μ
  const std::span<double> values = qp::localDataNonConst(y);
  for (const KernelEntry& entry : entries_)
    values[static_cast<std::size_t>(entry.row)] += entry.value * work_[entry.mode]; // G̃ᵀ
}

const Eigen::VectorXd& NaturalCoarseSpace::product(const Vector& x) const {
  std::fill(sums_.begin(), sums_.end(), AccurateSum());
  addLocalProduct(x, sums_);
  sumOverRanks(*comm_, sums_);
  finishProduct(sums_, {product_.data(), sums_.size()});
  return product_;
}

void NaturalCoarseSpace::project(Vector& x) const {
  const Eigen::VectorXd& gx = product(x);
  addTransposedProduct({gx.data(), sums_.size()}, -1.0, x);
}

Eigen::VectorXd NaturalCoarseSpace::normalized(const Eigen::VectorXd& kernelLoad) const {
  return cholesky_.triangularView<Eigen::Lower>().solve(kernelLoad);
}

Eigen::VectorXd NaturalCoarseSpace::motionOf(std::span<const double> mu) const {
  const Eigen::Map<const Eigen::VectorXd> given(mu.data(), static_cast<Eigen::Index>(mu.size()));
  return cholesky_.transpose().triangularView<Eigen::Upper>().solve(given);
}

void NaturalCoarseSpace::feasiblePoint(const Eigen::VectorXd& e, Vector& lambda) const {
  lambda.putScalar(0.0);
  addTransposedProduct({e.data(), static_cast<std::size_t>(e.size())}, 1.0, lambda);
}

} // namespace epafi::fetidp
