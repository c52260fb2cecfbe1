#include "epafi/fetidp/solve/Recovery.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/equilibrium/Balancing.hpp"
#include "epafi/fetidp/equilibrium/Friction.hpp"
#include "epafi/fetidp/equilibrium/Proportion.hpp"
#include "epafi/fetidp/equilibrium/RigidMotion.hpp"
#include "epafi/fetidp/precondition/SharedRows.hpp"
#include "epafi/fetidp/solve/ContactResponse.hpp"
#include "epafi/fetidp/solve/HeldRows.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::ProblemData;

/// c − B̄u + Cλ on the owners' multipliers.
void slackOf(const DualProblem& dual, const ProblemData& data, const SubdomainVectors& u,
             const Vector& lambda, Vector& slack) {
  MultiplierExchange exchange(dual.inverse().multiplierPlan());
  dual.inverse().constraint(u, exchange.values());
  exchange.sumToOwners(slack);
  slack.update(1.0, data.gap(), -1.0);
  if (const RCP<const Vector>& compliance = dual.problem().compliance; !compliance.is_null())
    slack.elementWiseMultiply(1.0, *compliance, lambda, 1.0);
}

/// ½uᵀKu − fᵀu over all subdomains, and ½λᵀCλ. Of u before its rigid part Rα, which has no energy but −ẽᵀα:
/// in the sum it would only bring round-off, the more the stiffer the body.
double energyOf(const DecomposedProblem& problem, const ProblemData& data, const SubdomainVectors& u,
                const Vector& lambda) {
  AccurateSum energy;
  for (std::size_t s = 0; s < u.size(); ++s) {
    const decomposition::SubdomainData& own = data.subdomains()[s];
    const auto values = u[s].col(0);
    energy.add(0.5 * values.dot(*problem.subdomains[s].stiffness * values) - own.rightHandSide().dot(values) +
               own.energyOffset());
  }
  if (!problem.compliance.is_null()) {
    const auto compliance = problem.compliance->getData(), force = lambda.getData();
    for (LocalOrdinal i = 0; i < force.size(); ++i)
      energy.add(0.5 * compliance[i] * force[i] * force[i]);
  }
  sumOverRanks(*problem.comm, {&energy, 1});
  return energy.value();
}

/// Largest |c| of the rows that hold or overlap: the distance of a contact that stays open is no size of the
/// solution. Collective.
double largestGap(const DecomposedProblem& problem, const Vector& gaps, const Vector& lambda) {
  const auto gap = gaps.getData(), force = lambda.getData();
  double largest = 0;
  for (LocalOrdinal i = 0; i < gap.size(); ++i)
    if (problem.kindOf(decomposition::OwnedMultiplier(i)) != decomposition::RowKind::contact ||
        force[i] > 0 || gap[i] < 0)
      largest = std::max(largest, std::abs(gap[i]));
  return maxOverRanks(*problem.comm, largest);
}

/// Fills active set, force, and the accuracy from λ and the slack g = c − B̄u, the gradient of the dual
/// problem. \param sizes  see sizesOfRows
void assess(const DualProblem& dual, const ProblemData& data, const Vector& sizes, const DualSolution& found,
            double largestValue, ContactSolution& solution) {
  const DecomposedProblem& problem = dual.problem();
  const double operatorNorm = dual.norm().norm;
  Vector gradient(problem.multiplierMap); // g^P
  dual.feasibleForces(data, *solution.multiplier)
      ->projectedGradient(*solution.multiplier, *solution.slack, 0.0, gradient);
  const auto force = solution.multiplier->getData(), slack = solution.slack->getData();
  const auto size = sizes.getData(), projected = gradient.getData();
  const auto active = solution.active->getDataNonConst();
  for (const decomposition::FrictionNode& node : problem.frictionNodes)
    for (int k = 0; k < problem.components - 1; ++k)
      active[node.firstTangent + k] = sticks(problem, data, node, *solution.multiplier) ? 1.0 : 0.0;
  AccurateSum sums[5]; // ‖g^P‖², λᵀg, force, active nodes, work of friction
  double violation = 0;
  for (LocalOrdinal i = 0; i < force.size(); ++i) {
    const decomposition::RowKind kind = problem.kindOf(decomposition::OwnedMultiplier(i));
    const bool isContact = kind == decomposition::RowKind::contact,
               isFriction = kind == decomposition::RowKind::friction;
    sums[0].add(projected[i] * projected[i]);
    if (isFriction)
      sums[4].add(-force[i] * slack[i]);
    if (!isFriction || active[i] != 0)
      violation = std::max(violation, isContact ? -slack[i] : std::abs(slack[i]) / size[i]);
    if (!isContact)
      continue;
    sums[1].add(force[i] * slack[i]);
    sums[2].add(force[i]);
    // λ − (c − Bu)/‖F‖ > 0; where motions of bodies alone fix all forces, ‖F‖ = 0
    active[i] = (operatorNorm > 0 ? operatorNorm * force[i] > slack[i] : force[i] > 0) ? 1.0 : 0.0;
    sums[3].add(active[i]);
  }
  const Comm& comm = *problem.comm;
  sumOverRanks(comm, sums);
  violation = maxOverRanks(comm, violation);
  const double scale =
      std::max(maxOverRanks(comm, largestValue), largestGap(problem, data.gap(), *solution.multiplier));
  const auto relative = [](double value, double reference) {
    return reference > 0 ? value / reference : value;
  };
  solution.relativeProjectedGradient = relative(std::sqrt(sums[0].value()), found.reference);
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * scale;
  constexpr double most = 1e-4; // where rounding makes more of it, nothing is solved
  solution.roundOff = std::min(
      most, relative(rounding * std::sqrt(static_cast<double>(gradient.getGlobalLength())), found.reference));
  solution.feasibility = relative(violation, scale);
  solution.complementarity = relative(std::abs(sums[1].value()), std::abs(solution.energy));
  solution.equilibrium = found.equilibrium;
  solution.isEstimated = found.isEstimated;
  solution.contactForce = sums[2].value();
  solution.dissipation = sums[4].value();
  solution.activeContactNodes = static_cast<GlobalOrdinal>(sums[3].value());
}

/// K̄⁺(f̄ − B̄ᵀλ)
SubdomainVectors unknownsOf(const ProblemData& data, const GeneralizedInverse& inverse,
                            const Vector& lambda) {
  SubdomainVectors forces = loadsOf(data), u;
  MultiplierExchange exchange(inverse.multiplierPlan());
  inverse.subtractForces(exchange.toSubdomains(lambda), forces); // f̄ − B̄ᵀλ
  inverse.apply(forces, u);
  return u;
}

/// What is allowed, where products are added, and who may want an end.
struct Settling {
  AllowedViolation allowed;
  qp::SolveReport& report;
  const qp::Interruption& interruption;

  /// Whether somebody wants it; the report then says so. Collective.
  [[nodiscard]] bool isUnwanted(const Comm& comm) const {
    for (const auto& [isAsked, status] : {std::pair(interruption.isWanted(), qp::Status::interrupted),
                                          {interruption.timeIsUp(), qp::Status::timeLimit}})
      if (holdsAnywhere(comm, isAsked)) {
        report.status = status;
        report.reason = qp::explain(status);
        return true;
      }
    return false;
  }
};

/// One step: u, λ and the slack by what follows where the held rows move by what they lack, so that Bu = c
/// there, and the forces of the others become loads that go away. K(u̇) = −B̄ᵀ(λ̇), so that the energy grows
/// by −½(λ + λ_new)ᵀ(B̄u̇ − Cλ̇). Collective.
void settleRows(const DualProblem& dual, const ProblemData& data, const Vector& held, SubdomainVectors& u,
                ContactSolution& solution, qp::SolveReport& report) {
  constexpr double tolerance = 1e-3; // there are more steps
  const DecomposedProblem& problem = dual.problem();
  Vector &lambda = *solution.multiplier, &slack = *solution.slack;
  const Vector slackBefore(slack, Teuchos::Copy), lambdaBefore(lambda, Teuchos::Copy);
  const RCP<Vector> lacking = rcp(new Vector(problem.multiplierMap)); // ċ
  lacking->elementWiseMultiply(1.0, held, slack, 0.0);
  lambda.elementWiseMultiply(1.0, held, lambdaBefore, 0.0);
  Vector dropped(lambda, Teuchos::Copy);
  dropped.update(-1.0, lambdaBefore, 1.0); // −λ of the others
  SubdomainVectors forces;
  for (const auto& subdomain : problem.subdomains)
    forces.emplace_back(Eigen::MatrixXd::Zero(subdomain.stiffness->rows(), 1));
  MultiplierExchange exchange(dual.inverse().multiplierPlan());
  dual.inverse().subtractForces(exchange.toSubdomains(dropped), forces);
  const UnknownsResponse response =
      unknownsResponse(dual, held, {{forces.begin(), forces.end()}, lacking}, tolerance);
  qp::append(response.report, report);
  lambda.update(1.0, *response.multiplier, 1.0);
  for (std::size_t s = 0; s < u.size(); ++s)
    u[s] += response.unknowns[s];
  slackOf(dual, data, u, lambda, slack);
  Vector moved(slackBefore, Teuchos::Copy), force(lambdaBefore, Teuchos::Copy);
  moved.update(-1.0, slack, 1.0); // B̄u̇ − Cλ̇
  force.update(1.0, lambda, 1.0);
  solution.energy -= 0.5 * accurateDot(force, moved);
}

/// Whether the energy that was followed is that of u: else forces that were large on the way have left u and
/// λ out of balance. Collective.
bool isBalanced(const DecomposedProblem& problem, const ProblemData& data, const SubdomainVectors& u,
                const Vector& lambda, double energy) {
  constexpr double share = 1e-7, roundOff = 1e-12;
  AccurateSum sums[2]; // uᵀKu, |u|ᵀ|K||u|
  for (std::size_t s = 0; s < u.size(); ++s) {
    const auto& stiffness = *problem.subdomains[s].stiffness;
    const auto values = u[s].col(0);
    sums[0].add(values.dot(stiffness * values));
    sums[1].add(values.cwiseAbs().dot(stiffness.cwiseAbs() * values.cwiseAbs()));
  }
  sumOverRanks(*problem.comm, sums);
  return std::abs(energyOf(problem, data, u, lambda) - energy) <=
         share * (std::abs(energy) + std::abs(sums[0].value())) + roundOff * sums[1].value();
}

/// Steps until held rows are open by no more than is allowed, or by the round-off of u: a step is as exact as
/// the last digits that it starts from. Then rows change until all contacts push and none penetrates; returns
/// whether they do, in balance. Collective.
bool settle(const DualProblem& dual, const ProblemData& data, const Settling& settling, const Vector& sizes,
            SubdomainVectors& u, ContactSolution& solution) {
  constexpr int maxSteps = 60;
  double largest = 0; // displacement
  for (const Eigen::MatrixXd& values : u)
    largest = values.size() > 0 ? std::max(largest, values.lpNorm<Eigen::Infinity>()) : largest;
  double allowed =
      settling.allowed.relative * std::max(maxOverRanks(*dual.problem().comm, largest),
                                           largestGap(dual.problem(), data.gap(), *solution.multiplier));
  if (settling.allowed.absolute > 0)
    allowed = std::min(allowed, settling.allowed.absolute);
  const RCP<const qp::ConvexSet> forces = dual.feasibleForces(data, *solution.multiplier);
  HeldRows rows(*forces, sizes, *solution.multiplier);
  double open = std::numeric_limits<double>::infinity();
  for (int step = 0; step < maxSteps && !settling.isUnwanted(*dual.problem().comm); ++step) {
    try {
      settleRows(dual, data, rows.indicator(), u, solution, settling.report);
    } catch (const UnheldResultant&) {
      return false;
    }
    const double now = rows.largestOpen(*solution.slack);
    if (now <= 0.5 * open && now > allowed) {
      open = now;
    } else if (rows.change(*solution.multiplier, *solution.slack, allowed)) {
      open = std::numeric_limits<double>::infinity();
    } else {
      forces->project(*solution.multiplier); // the last digits
      return isBalanced(dual.problem(), data, u, *solution.multiplier, solution.energy);
    }
  }
  return false;
}

} // namespace

std::vector<Eigen::VectorXd> displacementOf(const DualProblem& dual, const ProblemData& data,
                                            const Vector& lambda) {
  const DecomposedProblem& problem = dual.problem();
  SubdomainVectors u = unknownsOf(data, dual.inverse(), lambda);
  std::vector<Eigen::VectorXd> displacement;
  for (std::size_t s = 0; s < u.size(); ++s)
    displacement.push_back(
        decomposition::atAllPositions(problem.subdomains[s], u[s], data.subdomains()[s].prescribed));
  return displacement;
}

namespace {

/// Collective.
RestCheck restCheck(const DualProblem& dual, const ProblemData& data, const DualSolution& found) {
  const DecomposedProblem& problem = dual.problem();
  if (found.report.status != qp::Status::converged || dual.coarseSpace().is_null())
    return {};
  const double tolerance = dual.plan().tolerance;
  const double norm = dual.norm().norm,
               reference = equilibriumReference(problem, data, *dual.coarseSpace(), kernelLoad(problem, data),
                                                found.reference, norm);
  return {true, std::max(dual.parameters().equilibriumTolerance, tolerance) * reference, norm,
          std::max(1e-6, 100 * tolerance)};
}

/// Nothing if it cannot be settled. \param settling  null if that is not wanted
std::optional<ContactSolution> recovered(const DualProblem& dual, const ProblemData& data,
                                         const DualSolution& found, const Settling* settling) {
  const DecomposedProblem& problem = dual.problem();
  const GeneralizedInverse& inverse = dual.inverse();
  ContactSolution solution;
  solution.multiplier = rcp(new Vector(*found.lambda, Teuchos::Copy));
  solution.slack = rcp(new Vector(problem.multiplierMap));
  solution.active = rcp(new Vector(problem.multiplierMap));

  SubdomainVectors u = unknownsOf(data, inverse, *found.lambda);
  slackOf(dual, data, u, *found.lambda, *solution.slack);
  solution.energy = energyOf(problem, data, u, *found.lambda);
  if (problem.kernelDimension > 0) {
    const RestCheck check = restCheck(dual, data, found);
    const Eigen::VectorXd alpha =
        rigidMotion(problem, data, dual.kernelEntries(), *found.lambda, *solution.slack, check);
    solution.energy -= kernelLoad(problem, data).dot(alpha);
    for (std::size_t s = 0; s < u.size(); ++s) { // + Rα
      const auto& subdomain = problem.subdomains[s];
      const int offset = problem.kernelOffsetOf(subdomain);
      if (subdomain.kernel.cols() > 0)
        u[s] += subdomain.kernel * alpha.segment(offset, subdomain.kernel.cols());
    }
    slackOf(dual, data, u, *found.lambda, *solution.slack);
  }
  const RCP<const Vector> sizes = sizesOfRows(problem, *inverse.multiplierPlan());
  if (settling != nullptr && !settle(dual, data, *settling, *sizes, u, solution))
    return std::nullopt;

  if (found.report.status == qp::Status::converged)
    requireProportion(problem, data, u, *found.lambda);
  double largest = 0;
  AccurateSum work;
  for (std::size_t s = 0; s < u.size(); ++s) {
    const decomposition::SubdomainData& own = data.subdomains()[s];
    work.add(own.load.dot(u[s].col(0)) + own.heldWork);
    solution.displacement.push_back(
        decomposition::atAllPositions(problem.subdomains[s], u[s], data.subdomains()[s].prescribed));
    u[s].resize(0, 0); // primal vectors are what takes memory once the factors are shared
    if (solution.displacement.back().size() > 0)
      largest = std::max(largest, solution.displacement.back().lpNorm<Eigen::Infinity>());
  }
  sumOverRanks(*problem.comm, {&work, 1});
  solution.loadWork = work.value();
  assess(dual, data, *sizes, found, largest, solution);
  if (settling != nullptr && !dual.coarseSpace().is_null()) { // of the λ that has been settled
    const NaturalCoarseSpace& space = *dual.coarseSpace();
    const Eigen::VectorXd resultants = kernelLoad(problem, data);
    const double imbalance = space.normOf(space.product(*solution.multiplier) - resultants),
                 reference = equilibriumReference(problem, data, space, resultants, found.reference,
                                                  dual.norm().norm);
    solution.equilibrium = reference > 0 ? imbalance / reference : imbalance;
  }
  return solution;
}

} // namespace

ContactSolution recover(const DualProblem& dual, const ProblemData& data, const DualSolution& found) {
  return *recovered(dual, data, found, nullptr);
}

std::optional<ContactSolution> recoverSettled(const DualProblem& dual, const ProblemData& data,
                                              const DualSolution& found, const AllowedViolation& allowed,
                                              qp::SolveReport& report, const qp::Interruption& interruption) {
  const Settling settling{allowed, report, interruption};
  return recovered(dual, data, found, &settling);
}

} // namespace epafi::fetidp
