#include "epafi/fetidp/ScaledConstraint.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"

#include <algorithm>

namespace epafi::fetidp {
namespace {

using decomposition::Subdomain;

/// The diagonal of K̄ at the crosspoint values that contact touches: B has an entry for one copy of each, whose own
/// stiffness may be far from that of all. Collective.
Eigen::VectorXd crosspointStiffness(const decomposition::DecomposedProblem& problem,
                                    const ContactCrosspoints& crosspoints) {
  std::vector<AccurateSum> sums(static_cast<std::size_t>(crosspoints.size()));
  for (const Subdomain& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      if (const int touched = crosspoints.indexOf(subdomain.crosspointIndices[i]); touched >= 0) {
        const int unknown = subdomain.crosspointUnknowns[i];
        sums[static_cast<std::size_t>(touched)].add(subdomain.stiffness->coeff(unknown, unknown));
      }
  sumOverRanks(*problem.comm, sums);
  Eigen::VectorXd diagonal(crosspoints.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    diagonal[static_cast<Eigen::Index>(i)] = sums[i].value();
  return diagonal;
}

/// δ of the unknowns.
class Weights {
public:
  Weights(const ContactCrosspoints& crosspoints, Eigen::VectorXd atCrosspoints, bool areStiffnesses)
      : crosspoints_(crosspoints), atCrosspoints_(std::move(atCrosspoints)), areStiffnesses_(areStiffnesses) {
  }

  /// Index in ContactCrosspoints of an unknown that contact touches; −1: it is a remainder.
  [[nodiscard]] int touchedIndexOf(const Subdomain& subdomain, int unknown) const {
    const auto& all = subdomain.crosspointUnknowns; // ascending
    const auto found = std::lower_bound(all.begin(), all.end(), unknown);
    if (found == all.end() || *found != unknown)
      return -1;
    return crosspoints_.indexOf(subdomain.crosspointIndices[static_cast<std::size_t>(found - all.begin())]);
  }
  [[nodiscard]] double of(const Subdomain& subdomain, int unknown) const {
    if (!areStiffnesses_)
      return 1;
    const int touched = touchedIndexOf(subdomain, unknown);
    return touched >= 0 ? atCrosspoints_[touched] : subdomain.stiffness->coeff(unknown, unknown);
  }

private:
  const ContactCrosspoints& crosspoints_;
  Eigen::VectorXd atCrosspoints_;
  bool areStiffnesses_;
};

} // namespace

ScaledConstraint scaleConstraint(const decomposition::DecomposedProblem& problem,
                                 const ContactCrosspoints& crosspoints,
                                 PreconditionerParameters::Scaling scaling, const RCP<const Import>& plan) {
  const Weights weights(crosspoints, crosspointStiffness(problem, crosspoints),
                        scaling == PreconditionerParameters::Scaling::stiffness);
  MultiplierExchange exchange(plan);
  const std::span<double> sums = exchange.values();
  std::fill(sums.begin(), sums.end(), 0.0);
  for (const Subdomain& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      sums[static_cast<std::size_t>(entry.multiplier)] +=
          entry.coefficient * entry.coefficient / weights.of(subdomain, entry.unknown);
  MultiVector total(problem.multiplierMap, 1); // Σ_k b_k²/δ_k
  exchange.sumToOwners(total);

  ScaledConstraint result;
  const auto owned = total.getData(0);
  for (Teuchos_Ordinal row = 0; row < owned.size(); ++row)
    if (owned[row] == 0)
      result.untouched.push_back(static_cast<int>(row));
  const std::span<const double> totals = exchange.toSubdomains(total);
  result.boundaryShares.assign(totals.size(), 0.0);
  result.boundary.resize(problem.subdomains.size());
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (const auto& entry : problem.subdomains[s].constraint) {
      const auto row = static_cast<std::size_t>(entry.multiplier);
      const double weight =
          entry.coefficient / weights.of(problem.subdomains[s], entry.unknown) / totals[row];
      if (const int touched = weights.touchedIndexOf(problem.subdomains[s], entry.unknown); touched >= 0) {
        result.atCrosspoints.push_back({entry.multiplier, touched, weight});
        continue;
      }
      result.boundary[s].push_back(weight);
      result.boundaryShares[row] += weight * entry.coefficient;
    }
  return result;
}

} // namespace epafi::fetidp
