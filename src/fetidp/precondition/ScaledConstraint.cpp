#include "epafi/fetidp/precondition/ScaledConstraint.hpp"

#include "epafi/fetidp/operator/CoarseProblem.hpp"
#include "epafi/fetidp/precondition/SharedRows.hpp"

#include <algorithm>

namespace epafi::fetidp {

using decomposition::Subdomain;

namespace {

/// For each unknown the mean of `weightOf` over the unknowns of its node, which follow each other.
template <class WeightOf>
std::vector<double> meansOfNodes(const decomposition::DecomposedProblem& problem, const Subdomain& subdomain,
                                 const WeightOf& weightOf) {
  std::vector<double> means(subdomain.unknownPosition.size());
  const auto nodeOf = [&](int unknown) { return subdomain.unknownPosition[unknown] / problem.components; };
  for (int first = 0, end = 0; first < std::ssize(means); first = end) {
    double sum = 0;
    for (; end < std::ssize(means) && nodeOf(end) == nodeOf(first); ++end)
      sum += weightOf(subdomain, end);
    for (int unknown = first; unknown < end; ++unknown)
      means[unknown] = sum / (end - first);
  }
  return means;
}

} // namespace

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
  // A node's rows of contact and friction, which are perpendicular, are so in D⁻¹ where its components weigh
  // alike.
  std::vector<std::vector<double>> means(problem.subdomains.size());
  for (std::size_t s = 0; s < means.size() && problem.numFriction > 0; ++s)
    means[s] = meansOfNodes(problem, problem.subdomains[s], weightOf);
  const auto weightIn = [&](std::size_t s, const decomposition::ConstraintEntry& entry) {
    const bool isMean =
        problem.numFriction > 0 && problem.kindOf(entry.multiplier) != decomposition::RowKind::gluing;
    return isMean ? means[s][entry.unknown] : weightOf(problem.subdomains[s], entry.unknown);
  };
  const std::vector<std::vector<char>> counts = ownEntries(problem, *plan).counts;
  MultiplierExchange exchange(plan);
  const std::span<double> sums = exchange.zeros();
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (std::size_t e = 0; e < counts[s].size(); ++e)
      if (const auto& entry = problem.subdomains[s].constraint[e]; counts[s][e] != 0)
        sums[entry.multiplier] += entry.coefficient * entry.coefficient / weightIn(s, entry);
  MultiVector total(problem.multiplierMap, 1); // Σ_k b_k²/δ_k
  exchange.sumToOwners(total);

  ScaledConstraint result;
  const auto owned = total.getData(0);
  for (int row = 0; row < owned.size(); ++row)
    if (owned[row] == 0)
      result.untouched.push_back(row);
  const std::span<const double> totals = exchange.toSubdomains(total);
  result.boundaryShares.assign(totals.size(), 0.0);
  result.boundary.resize(problem.subdomains.size());
  for (std::size_t s = 0; s < problem.subdomains.size(); ++s)
    for (std::size_t e = 0; e < counts[s].size(); ++e) {
      const auto& entry = problem.subdomains[s].constraint[e];
      const std::size_t row = entry.multiplier;
      const double weight = counts[s][e] == 0 ? 0.0 : entry.coefficient / weightIn(s, entry) / totals[row];
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
