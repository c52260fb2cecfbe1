#include "epafi/fetidp/equilibrium/Friction.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/fetidp/equilibrium/FeasibleForces.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Feasibility.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::FrictionNode;
using decomposition::ProblemData;

/// The tangential force of a node, its second component 0 in the plane.
Eigen::Vector2d tangentialForce(const DecomposedProblem& problem, const FrictionNode& node,
                                const Vector& lambda) {
  const auto force = qp::localData(lambda);
  const std::size_t first = node.firstTangent;
  return {force[first], problem.components > 2 ? force[first + 1] : 0.0};
}

/// But those of the tangents of some nodes.
template <class Which>
std::vector<KernelEntry> withoutFriction(const DecomposedProblem& problem, const Which& which,
                                         std::vector<KernelEntry> entries) {
  std::set<int> left;
  for (const FrictionNode& node : problem.frictionNodes)
    if (which(node))
      for (int k = 0; k < problem.components - 1; ++k)
        left.insert(node.firstTangent + k);
  std::erase_if(entries, [&](const KernelEntry& entry) { return left.contains(entry.row); });
  return entries;
}

} // namespace

bool hasBoundAlone(const ProblemData& data, const FrictionNode& node) {
  const double bound = data.frictionBound(node, 0);
  return bound > 0 && data.frictionBound(node, 1) == bound;
}

bool sticks(const DecomposedProblem& problem, const ProblemData& data, const FrictionNode& node,
            const Vector& lambda) {
  constexpr double roundOff = 1e-9;
  const double bound = data.frictionBound(node, qp::localData(lambda)[node.contact]);
  return tangentialForce(problem, node, lambda).norm() < bound * (1 - roundOff);
}

void ontoFrictionBounds(const DecomposedProblem& problem, const ProblemData& data, Vector& lambda) {
  const auto force = qp::localDataNonConst(lambda);
  for (const FrictionNode& node : problem.frictionNodes) {
    if (sticks(problem, data, node, lambda))
      continue;
    const std::size_t first = node.firstTangent, contact = node.contact;
    const double bound = data.frictionBound(node, force[contact]);
    if (problem.components == 2) {
      force[first] = std::copysign(bound, force[first]);
      continue;
    }
    const double length = std::hypot(force[first], force[first + 1]);
    for (std::size_t k = first; k < first + 2; ++k)
      force[k] *= length > 0 ? bound / length : 0;
  }
}

std::vector<KernelEntry> withoutIdleFriction(const DecomposedProblem& problem, const ProblemData& data,
                                             std::vector<KernelEntry> entries) {
  return withoutFriction(
      problem, [&](const FrictionNode& node) { return !(data.frictionBound(node, 1) > 0); },
      std::move(entries));
}

std::vector<KernelEntry> withoutBoundedFriction(const DecomposedProblem& problem, const ProblemData& data,
                                                std::vector<KernelEntry> entries) {
  return withoutFriction(
      problem, [&](const FrictionNode& node) { return hasBoundAlone(data, node); }, std::move(entries));
}

std::vector<KernelEntry> withoutSlip(const DecomposedProblem& problem, const ProblemData& data,
                                     const Vector& lambda, std::vector<KernelEntry> entries, Vector& slack) {
  struct Share {
    int row;      ///< the node's first one, in whose place the row across its force is
    double value; ///< what a row has of that; 0 of all rows in the plane
  };
  constexpr int nowhere = -1;
  const auto values = qp::localDataNonConst(slack);
  std::map<int, Share> shares; // of rows that slip
  for (const FrictionNode& node : problem.frictionNodes) {
    if (sticks(problem, data, node, lambda))
      continue;
    const int first = node.firstTangent;
    if (problem.components < 3) {
      shares[first] = {first, 0.0};
      continue;
    }
    const Eigen::Vector2d force = tangentialForce(problem, node, lambda);
    const double length = force.norm();
    shares[first] = {first, length > 0 ? -force[1] / length : 0.0};
    shares[first + 1] = {first, length > 0 ? force[0] / length : 0.0};
    if (length > 0)
      values[first] = shares[first].value * values[first] + shares[first + 1].value * values[first + 1];
  }
  for (KernelEntry& entry : entries)
    if (const auto slips = shares.find(entry.row); slips != shares.end())
      entry = {slips->second.value != 0 ? slips->second.row : nowhere, entry.mode,
               slips->second.value * entry.value};
  std::erase_if(entries, [&](const KernelEntry& entry) { return entry.row == nowhere; });
  return entries;
}

void requireEnoughFriction(const DecomposedProblem& problem, const ProblemData& data,
                           const RCP<const NaturalCoarseSpace>& space, const Eigen::VectorXd& resultants) {
  if (data.hasCoulombFriction()) // see Solvability.hpp
    return;
  Vector feasible(problem.multiplierMap), forces(problem.multiplierMap);
  space->feasiblePoint(resultants, feasible); // G̃λ̃ = ẽ
  const RCP<const qp::ConvexSet> set = feasibleForces(problem, data, &feasible)->shiftedBy(feasible);
  const qp::Feasibility found = qp::findFeasiblePoint(space, set, forces);
  if (found.isFeasible)
    return;
  forces.update(1.0, feasible, 1.0);
  const Eigen::VectorXd missing = space->product(forces) - resultants;
  refuseSliding(text(space->normOf(missing) / space->normOf(resultants)) + " of their resultant");
}

void refuseSliding(const std::string& missing) {
  throw SolvabilityError(SolvabilityError::Kind::noSolution,
                         "no solution: the loads on floating bodies are more than friction holds, by " +
                             missing +
                             "; lower the load along the contact, raise the friction or add a support");
}

} // namespace epafi::fetidp
