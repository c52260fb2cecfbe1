#include "epafi/fetidp/equilibrium/ProblemScales.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace epafi::fetidp {

using decomposition::DecomposedProblem;
using decomposition::ProblemData;

ProblemScales::ProblemScales(const DecomposedProblem& problem, const ProblemData& data) {
  measureMotions(problem);
  measureLoads(problem, data);
  measureRows(problem);
}

void ProblemScales::measureMotions(const DecomposedProblem& problem) {
  motions_.setZero(problem.numRigidModes());
  for (const auto& subdomain : problem.subdomains) {
    const auto offset = problem.bodies[subdomain.body].kernelOffset;
    const Eigen::MatrixXd modes = subdomain.kernel * problem.clusterAt(subdomain).ofBody;
    for (Eigen::Index mode = 0; mode < modes.cols() && modes.rows() > 0; ++mode)
      motions_[offset + mode] = std::max(motions_[offset + mode], modes.col(mode).lpNorm<Eigen::Infinity>());
  }
  for (double& length : motions_) {
    length = maxOverRanks(*problem.comm, length);
    length = length > 0 ? length : 1.0;
  }
}

void ProblemScales::measureLoads(const DecomposedProblem& problem, const ProblemData& data) {
  // Forces of prescribed displacements are sums that cancel where these move a body as a whole, or across
  // them.
  constexpr double left = 1e-5; // times `resultant`: some round-off of the terms
  const std::size_t numClusters = problem.clusters.size();
  std::vector<double> sums(numClusters, 0.0), largest(numClusters + 1, 0.0);
  std::vector<double> modes(problem.kernelDimension, 0.0);
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s) {
    const auto& subdomain = problem.subdomains[s];
    const decomposition::SubdomainData& own = data.subdomains()[s];
    const std::size_t cluster = problem.clusterOf[subdomain.number];
    sums[cluster] += own.rightHandSide().lpNorm<1>() + own.heldLoad;
    const double prescribed = own.prescribed.size() > 0 ? own.prescribed.lpNorm<Eigen::Infinity>() : 0.0;
    if (prescribed > 0 && subdomain.stiffness->rows() > 0)
      largest[cluster] = std::max(
          largest[cluster], left * prescribed * Eigen::VectorXd(subdomain.stiffness->diagonal()).maxCoeff());
    largest.back() = std::max(largest.back(), prescribed);
    for (Eigen::Index mode = 0; mode < subdomain.kernel.cols() && subdomain.kernel.rows() > 0; ++mode) {
      double& size = modes[problem.kernelOffsetOf(subdomain) + mode];
      size = std::max(size, subdomain.kernel.col(mode).lpNorm<Eigen::Infinity>());
    }
  }
  sumOverRanks(*problem.comm, std::span<double>(sums));
  for (auto* values : {&largest, &modes})
    for (double& value : *values)
      value = maxOverRanks(*problem.comm, value);
  length_ = std::max(largest.back(), data.gap().normInf());
  resultants_.setZero(problem.kernelDimension);
  std::vector<double> ofBodies(problem.bodies.size(), 0.0);
  for (std::size_t c = 0; c < numClusters; ++c) {
    const decomposition::Cluster& cluster = problem.clusters[c];
    const double load = std::max(sums[c], largest[c]);
    ofBodies[cluster.body] += load;
    for (int mode = cluster.kernelOffset; mode < cluster.kernelOffset + cluster.kernelDimension; ++mode)
      resultants_[mode] = load * modes[mode];
  }
  // What supports take is no load here; what is left of it in other directions is round-off.
  double heaviest = 0;
  for (const double load : ofBodies)
    heaviest = std::max(heaviest, load);
  double least = heaviest;
  for (const double load : ofBodies)
    least = load > roundOff * heaviest ? std::min(least, load) : least;
  loads_.setZero(problem.numRigidModes());
  for (std::size_t b = 0; b < ofBodies.size(); ++b)
    loads_.segment(problem.bodies[b].kernelOffset, problem.bodies[b].kernelDimension)
        .setConstant(std::max(ofBodies[b], least));
}

void ProblemScales::measureRows(const DecomposedProblem& problem) {
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<double> sizes = exchange.zeros();
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      sizes[entry.multiplier] += std::abs(entry.coefficient);
  Vector owned(problem.multiplierMap);
  exchange.sumToOwners(owned);
  const auto values = owned.getData();
  rowSizes_.assign(values.begin(), values.end());
}

std::map<int, Eigen::VectorXd> ProblemScales::hinderingRows(const std::vector<KernelEntry>& entries) const {
  std::map<int, Eigen::VectorXd> rows;
  for (const KernelEntry& entry : entries)
    rows.try_emplace(entry.row, Eigen::VectorXd::Zero(motions_.size())).first->second[entry.mode] +=
        entry.value / motions_[entry.mode];
  std::erase_if(rows, [this](const auto& row) { return !hinders(row.first, row.second); });
  return rows;
}

} // namespace epafi::fetidp
