#include "epafi/fetidp/ScaledConstraint.hpp"

#include "epafi/fetidp/CoarseProblem.hpp"
#include "epafi/fetidp/SharedRows.hpp"

#include <algorithm>

namespace epafi::fetidp {

using decomposition::Subdomain;

ScaledConstraint scaleConstraint(const decomposition::DecomposedProblem& problem,
                                 const ContactCrosspoints& crosspoints,
                                 PreconditionerParameters::Scaling scaling, const RCP<const Import>& plan) {
  // B has an entry for one copy of each crosspoint value that contact touches, whose own stiffness may be far
  // from that of all.
  const Eigen::VectorXd atCrosspoints =
      crosspointDiagonal(problem, *crosspoints.comm(), crosspoints.size(),
                         [&](GlobalOrdinal unknown) { return crosspoints.indexOf(unknown); });
  const auto weightOf = [&](const Subdomain& subdomain, int unknown) { // δ
    if (scaling == PreconditionerParameters::Scaling::multiplicity)
      return 1.0;
    const int touched = crosspoints.indexOf(subdomain, unknown);
    return touched >= 0 ? atCrosspoints[touched] : subdomain.stiffness->coeff(unknown, unknown);
  };
  const std::vector<std::vector<char>> counts = ownEntries(problem, *plan).counts;
  MultiplierExchange exchange(plan);
  const std::span<double> sums = exchange.zeros();
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (std::size_t e = 0; e < counts[s].size(); ++e)
      if (const auto& entry = problem.subdomains[s].constraint[e]; counts[s][e] != 0)
        sums[entry.multiplier] +=
            entry.coefficient * entry.coefficient / weightOf(problem.subdomains[s], entry.unknown);
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
    for (std::size_t e = 0; e < counts[s].size(); ++e) {
      const auto& entry = problem.subdomains[s].constraint[e];
      const std::size_t row = entry.multiplier;
      const double weight =
          counts[s][e] == 0
              ? 0.0
              : entry.coefficient / weightOf(problem.subdomains[s], entry.unknown) / totals[row];
      if (const int touched = crosspoints.indexOf(problem.subdomains[s], entry.unknown); touched >= 0) {
        result.atCrosspoints.push_back({entry.multiplier, touched, weight});
        continue;
      }
      result.boundary[s].push_back(weight);
      result.boundaryShares[row] += weight * entry.coefficient;
      for (const decomposition::EdgeEnd& end : problem.subdomains[s].edgeEnds)
        if (end.unknown == entry.unknown && crosspoints.follows(end.average))
          result.atCrosspoints.push_back(
              {entry.multiplier, crosspoints.indexOf(end.average), end.share * weight});
    }
  return result;
}

} // namespace epafi::fetidp
