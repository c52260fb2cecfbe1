#include "epafi/fetidp/Contradiction.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::fetidp {

void requireFeasibleGaps(const decomposition::DecomposedProblem& problem) {
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<double> magnitude = exchange.values();
  std::fill(magnitude.begin(), magnitude.end(), 0.0);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      magnitude[static_cast<std::size_t>(entry.multiplier)] += std::abs(entry.coefficient);
  Vector rowSum(problem.multiplierMap);
  exchange.sumToOwners(rowSum);
  // The gaps are differences of prescribed values: what is round-off of these does not overlap.
  double largest = problem.gap->normInf();
  for (const auto& subdomain : problem.subdomains)
    if (subdomain.prescribed.size() > 0)
      largest = std::max(largest, subdomain.prescribed.lpNorm<Eigen::Infinity>());
  const double roundOff = 1e-12 * maxOverRanks(*problem.comm, largest);
  collectively(*problem.comm, [&] {
    const auto sums = rowSum.getData();
    const auto gaps = problem.gap->getData();
    for (Teuchos_Ordinal i = 0; i < sums.size(); ++i)
      if (sums[i] == 0 && gaps[i] < -roundOff)
        throw SolvabilityError(
            SolvabilityError::Kind::noSolution,
            "no solution: contact row " +
                std::to_string(problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i))) +
                " lies where supports hold both sides, and they overlap by " + text(-gaps[i]) +
                "; change a gap, an obstacle or a support");
  });
}

void refuseContradiction(const decomposition::DecomposedProblem& problem, const Vector& d) {
  constexpr double roundOff = 1e-6; // what MPRGP calls zero curvature leaves as much of a direction
  const Comm& comm = *problem.comm;
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<const double> values = exchange.toSubdomains(d);
  double left = 0, terms = 0; // of Bᵀd at an unknown
  for (const decomposition::Subdomain& subdomain : problem.subdomains) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(subdomain.load.size()), size = force;
    for (const decomposition::ConstraintEntry& entry : subdomain.constraint) {
      const double part = entry.coefficient * values[static_cast<std::size_t>(entry.multiplier)];
      force[entry.unknown] += part;
      size[entry.unknown] += std::abs(part);
    }
    if (force.size() > 0) {
      left = std::max(left, force.lpNorm<Eigen::Infinity>());
      terms = std::max(terms, size.lpNorm<Eigen::Infinity>());
    }
  }
  AccurateSum gaps[2]; // cᵀd and the size of its terms
  double tension = 0;
  const auto mine = d.getData(), gap = problem.gap->getData();
  for (Teuchos_Ordinal i = 0; i < mine.size(); ++i) {
    gaps[0].add(gap[i] * mine[i]);
    gaps[1].add(std::abs(gap[i] * mine[i]));
    if (problem.kindOf(decomposition::OwnedMultiplier(static_cast<LocalOrdinal>(i))) ==
        decomposition::RowKind::contact)
      tension = std::max(tension, -mine[i]);
  }
  sumOverRanks(comm, gaps);
  left = maxOverRanks(comm, left);
  terms = maxOverRanks(comm, terms);
  tension = maxOverRanks(comm, tension);
  if (terms > 0 && left <= roundOff * terms && tension <= roundOff * d.normInf() &&
      gaps[0].value() < -1e-6 * gaps[1].value())
    throw SolvabilityError(
        SolvabilityError::Kind::noSolution,
        "no solution: contact rows contradict each other, no displacement satisfies them all; change a gap, "
        "an obstacle or a direction of contact");
}

} // namespace epafi::fetidp
