#include "epafi/fetidp/equilibrium/KernelConstraint.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/Records.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace epafi::fetidp {

namespace {

using decomposition::DecomposedProblem;

/// What a subdomain adds to an entry of G̃ᵀ.
struct Term {
  GlobalOrdinal row;
  int mode;
  double value;
  [[nodiscard]] bool operator<(const Term& other) const {
    return std::tie(row, mode, value) < std::tie(other.row, other.mode, other.value);
  }
};

/// Of this rank's subdomains; rows that glue a body which is one cluster are left out.
std::vector<Term> termsOf(const DecomposedProblem& problem) {
  std::vector<int> numClusters(problem.bodies.size(), 0);
  for (const decomposition::Cluster& cluster : problem.clusters)
    ++numClusters[cluster.body];
  std::vector<Term> terms;
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint) {
      if (problem.kindOf(entry.multiplier) == decomposition::RowKind::gluing &&
          numClusters[subdomain.body] == 1)
        continue;
      for (int mode = 0; mode < subdomain.kernel.cols(); ++mode)
        if (const double value = entry.coefficient * subdomain.kernel(entry.unknown, mode); value != 0)
          terms.push_back(
              {problem.numberOf(entry.multiplier), problem.kernelOffsetOf(subdomain) + mode, value});
    }
  return terms;
}

/// Ranks of the terms' rows. Collective.
std::vector<int> ownersOfRows(const Map& map, const std::vector<Term>& terms) {
  std::vector<GlobalOrdinal> rows;
  for (const Term& term : terms)
    rows.push_back(term.row);
  return ownersOf(map, rows);
}

/// The cluster of each column of R.
std::vector<std::size_t> clustersOfModes(const DecomposedProblem& problem) {
  std::vector<std::size_t> clusterOf;
  for (std::size_t c = 0; c < problem.clusters.size(); ++c)
    clusterOf.insert(clusterOf.end(), problem.clusters[c].kernelDimension, c);
  return clusterOf;
}

} // namespace

std::vector<KernelEntry> kernelConstraint(const decomposition::DecomposedProblem& problem) {
  std::vector<KernelEntry> entries;
  if (problem.kernelDimension == 0)
    return entries;
  const std::vector<Term> mine = termsOf(problem);
  std::vector<Term> terms = sendRecords<Term>(problem.comm, mine, ownersOfRows(*problem.multiplierMap, mine));
  std::sort(terms.begin(), terms.end());
  for (auto first = terms.begin(), end = first; first != terms.end(); first = end) {
    AccurateSum sum;
    double magnitude = 0;
    for (; end != terms.end() && end->row == first->row && end->mode == first->mode; ++end) {
      sum.add(end->value);
      magnitude += std::abs(end->value);
    }
    // What glues a cluster cancels: copies of a node have the same value of R, but for round-off.
    const bool isGluing =
        problem.kindOf(decomposition::MultiplierNumber(first->row)) == decomposition::RowKind::gluing;
    constexpr double roundOff = 1e-12;
    if (std::abs(sum.value()) > (isGluing ? roundOff * magnitude : 0.0))
      entries.push_back({problem.multiplierMap->getLocalElement(first->row), first->mode, sum.value()});
  }
  return entries;
}

std::vector<KernelEntry> kernelConstraintOfBodies(const DecomposedProblem& problem,
                                                  const std::vector<KernelEntry>& entries) {
  const std::vector<std::size_t> clusterOf = clustersOfModes(problem);
  std::map<std::pair<int, int>, double> values; // of a row and a body's mode
  for (const KernelEntry& entry : entries) {
    if (problem.kindOf(decomposition::OwnedMultiplier(entry.row)) == decomposition::RowKind::gluing)
      continue;
    const decomposition::Cluster& cluster = problem.clusters[clusterOf[entry.mode]];
    const int first = problem.bodies[cluster.body].kernelOffset;
    for (int mode = 0; mode < cluster.ofBody.cols(); ++mode)
      values[{entry.row, first + mode}] +=
          entry.value * cluster.ofBody(entry.mode - cluster.kernelOffset, mode);
  }
  std::vector<KernelEntry> result;
  for (const auto& [place, value] : values)
    if (value != 0)
      result.push_back({place.first, place.second, value});
  return result;
}

namespace {

/// Σ product(r, f) of the modes r and the loads f over all subdomains.
template <class Product>
Eigen::VectorXd resultants(const decomposition::DecomposedProblem& problem, const SubdomainVectors& loads,
                           const Product& product) {
  std::vector<AccurateSum> sums(problem.kernelDimension);
  for (std::size_t s = 0; s < loads.size(); ++s) {
    const decomposition::Subdomain& subdomain = problem.subdomains[s];
    const int offset = problem.kernelOffsetOf(subdomain);
    for (Eigen::Index mode = 0; mode < subdomain.kernel.cols(); ++mode)
      sums[offset + mode].add(product(subdomain.kernel.col(mode), loads[s].col(0)));
  }
  Eigen::VectorXd result(problem.kernelDimension);
  sumOverRanks(*problem.comm, sums, result.data());
  return result;
}

} // namespace

Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem, const SubdomainVectors& loads) {
  return resultants(problem, loads, [](const auto& r, const auto& f) { return r.dot(f); });
}

Eigen::VectorXd kernelLoad(const decomposition::DecomposedProblem& problem,
                           const decomposition::ProblemData& data) {
  return kernelLoad(problem, loadsOf(data));
}

Eigen::VectorXd onBodies(const DecomposedProblem& problem, const Eigen::VectorXd& resultants) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(problem.numRigidModes());
  for (const decomposition::Cluster& cluster : problem.clusters)
    sums.segment(problem.bodies[cluster.body].kernelOffset, cluster.ofBody.cols()) +=
        cluster.ofBody.transpose() * resultants.segment(cluster.kernelOffset, cluster.kernelDimension);
  return sums;
}

} // namespace epafi::fetidp
