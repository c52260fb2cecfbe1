#include "epafi/fetidp/Recovery.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/ContactResponse.hpp"
#include "epafi/fetidp/RigidMotion.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// c − B̄u on the owners' multipliers.
void slackOf(const DecomposedProblem& problem, const GeneralizedInverse& inverse, const SubdomainVectors& u,
             Vector& slack) {
  MultiplierExchange exchange(inverse.multiplierPlan());
  inverse.constraint(u, exchange.values());
  exchange.sumToOwners(slack);
  slack.update(1.0, *problem.gap, -1.0);
}

/// ½uᵀKu − fᵀu over all subdomains. Of u before its rigid part Rα, which has no energy but −ẽᵀα: in the sum it would
/// only bring round-off, the more the stiffer the body.
double energyOf(const DecomposedProblem& problem, const SubdomainVectors& u) {
  AccurateSum energy;
  for (std::size_t s = 0; s < u.size(); ++s) {
    const auto& subdomain = problem.subdomains[s];
    const auto values = u[s].col(0);
    energy.add(0.5 * values.dot(*subdomain.stiffness * values) - subdomain.load.dot(values) +
               subdomain.energyOffset);
  }
  sumOverRanks(*problem.comm, {&energy, 1});
  return energy.value();
}

/// λ − (c − Bu)/‖F‖ > 0
bool isClosed(double operatorNorm, double force, double slack) {
  return operatorNorm * force > slack;
}

/// Fills active set, force, and the accuracy from λ and the slack g = c − B̄u, the gradient of the dual
/// problem.
void assess(const DecomposedProblem& problem, const DualSolution& dual, double operatorNorm,
            double largestValue, ContactSolution& solution) {
  const auto force = solution.multiplier->getData(), slack = solution.slack->getData();
  const auto gap = problem.gap->getData();
  const auto active = solution.active->getDataNonConst();
  AccurateSum sums[4]; // ‖g^P‖², λᵀg, force, active nodes
  double violation = 0, largestGap = 0;
  for (LocalOrdinal i = 0; i < force.size(); ++i) {
    const bool isContact =
        problem.kindOf(decomposition::OwnedMultiplier(i)) == decomposition::RowKind::contact;
    const double projected = isContact && !(force[i] > 0) ? std::min(slack[i], 0.0) : slack[i];
    sums[0].add(projected * projected);
    violation = std::max(violation, isContact ? -slack[i] : std::abs(slack[i]));
    largestGap = std::max(largestGap, std::abs(gap[i]));
    if (!isContact)
      continue;
    sums[1].add(force[i] * slack[i]);
    sums[2].add(force[i]);
    active[i] = isClosed(operatorNorm, force[i], slack[i]) ? 1.0 : 0.0;
    sums[3].add(active[i]);
  }
  const Comm& comm = *problem.comm;
  sumOverRanks(comm, sums);
  violation = maxOverRanks(comm, violation);
  const double scale = maxOverRanks(comm, std::max(largestGap, largestValue));
  const auto relative = [](double value, double reference) {
    return reference > 0 ? value / reference : value;
  };
  solution.relativeProjectedGradient = relative(std::sqrt(sums[0].value()), dual.reference);
  solution.feasibility = relative(violation, scale);
  solution.complementarity = relative(std::abs(sums[1].value()), std::abs(solution.energy));
  solution.equilibrium = dual.equilibrium;
  solution.isEstimated = dual.isEstimated;
  solution.contactForce = sums[2].value();
  solution.activeContactNodes = static_cast<GlobalOrdinal>(sums[3].value());
}

/// K̄⁺(f̄ − B̄ᵀλ)
SubdomainVectors unknownsOf(const DecomposedProblem& problem, const GeneralizedInverse& inverse,
                            const Vector& lambda) {
  SubdomainVectors forces = loadsOf(problem), u;
  MultiplierExchange exchange(inverse.multiplierPlan());
  inverse.subtractForces(exchange.toSubdomains(lambda), forces); // f̄ − B̄ᵀλ
  inverse.apply(forces, u);
  return u;
}

/// Adds to u, λ and the energy what follows where the closed rows move by what they lack, so that Bu = c there. Collective.
void settle(const DualProblem& dual, SubdomainVectors& u, ContactSolution& solution) {
  constexpr double tolerance = 1e-8; // of what is round-off already
  const DecomposedProblem& problem = dual.problem();
  DataChange change;
  for (const auto& subdomain : problem.subdomains)
    change.load.emplace_back(Eigen::VectorXd::Zero(subdomain.load.size()));
  Vector closed(problem.multiplierMap);
  const RCP<Vector> lacking = rcp(new Vector(*solution.slack, Teuchos::Copy)); // ċ
  {
    const auto isHeld = closed.getDataNonConst(), gap = lacking->getDataNonConst();
    const auto force = solution.multiplier->getData();
    for (LocalOrdinal i = 0; i < gap.size(); ++i) {
      const bool isContact =
          problem.kindOf(decomposition::OwnedMultiplier(i)) == decomposition::RowKind::contact;
      isHeld[i] = !isContact || isClosed(dual.norm().norm, force[i], gap[i]) ? 1.0 : 0.0;
      gap[i] *= isHeld[i];
    }
  }
  change.gap = lacking;
  const UnknownsResponse response = unknownsResponse(dual, closed, change, tolerance);
  solution.energy -=
      accurateDot(*lacking, *solution.multiplier) + 0.5 * accurateDot(*lacking, *response.multiplier);
  solution.multiplier->update(1.0, *response.multiplier, 1.0);
  const auto force = solution.multiplier->getDataNonConst();
  for (LocalOrdinal i = 0; i < force.size(); ++i)
    if (problem.kindOf(decomposition::OwnedMultiplier(i)) == decomposition::RowKind::contact)
      force[i] = std::max(force[i], 0.0); // in the last digit
  for (std::size_t s = 0; s < u.size(); ++s)
    u[s] += response.unknowns[s];
  slackOf(problem, dual.inverse(), u, *solution.slack);
}

} // namespace

std::vector<Eigen::VectorXd> displacementOf(const DualProblem& dual, const Vector& lambda) {
  const DecomposedProblem& problem = dual.problem();
  SubdomainVectors u = unknownsOf(problem, dual.inverse(), lambda);
  std::vector<Eigen::VectorXd> displacement;
  for (std::size_t s = 0; s < u.size(); ++s)
    displacement.push_back(
        decomposition::atAllPositions(problem.subdomains[s], u[s], problem.subdomains[s].prescribed));
  return displacement;
}

ContactSolution recover(const DualProblem& dual, const DualSolution& found, bool settles) {
  const DecomposedProblem& problem = dual.problem();
  const GeneralizedInverse& inverse = dual.inverse();
  ContactSolution solution;
  solution.multiplier = rcp(new Vector(*found.lambda, Teuchos::Copy));
  solution.slack = rcp(new Vector(problem.multiplierMap));
  solution.active = rcp(new Vector(problem.multiplierMap));

  SubdomainVectors u = unknownsOf(problem, inverse, *found.lambda);
  slackOf(problem, inverse, u, *solution.slack);
  solution.energy = energyOf(problem, u);
  if (problem.kernelDimension > 0) {
    const Eigen::VectorXd alpha = rigidMotion(problem, dual.kernelEntries(), *found.lambda, *solution.slack,
                                              found.report.status == qp::Status::converged);
    solution.energy -= kernelLoad(problem).dot(alpha);
    for (std::size_t s = 0; s < u.size(); ++s) { // + Rα
      const auto& subdomain = problem.subdomains[s];
      const int offset = problem.kernelOffsetOf(subdomain);
      if (subdomain.kernel.cols() > 0)
        u[s] += subdomain.kernel * alpha.segment(offset, subdomain.kernel.cols());
    }
    slackOf(problem, inverse, u, *solution.slack);
  }
  if (settles)
    settle(dual, u, solution);

  double largest = 0;
  for (std::size_t s = 0; s < u.size(); ++s) {
    solution.displacement.push_back(
        decomposition::atAllPositions(problem.subdomains[s], u[s], problem.subdomains[s].prescribed));
    u[s].resize(0, 0); // primal vectors are what takes memory once the factors are shared
    if (solution.displacement.back().size() > 0)
      largest = std::max(largest, solution.displacement.back().lpNorm<Eigen::Infinity>());
  }
  assess(problem, found, dual.norm().norm, largest, solution);
  return solution;
}

} // namespace epafi::fetidp
