#include "epafi/fetidp/equilibrium/FeasibleForces.hpp"

#include "epafi/qp/constraints/Discs.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <limits>
#include <utility>
#include <vector>

namespace epafi::fetidp {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// λ_n ≥ 0.
RCP<Vector> leastForces(const decomposition::DecomposedProblem& problem) {
  const RCP<Vector> lower = rcp(new Vector(problem.multiplierMap));
  const auto least = qp::localDataNonConst(*lower);
  for (LocalOrdinal row = 0; row < std::ssize(least); ++row)
    if (problem.kindOf(decomposition::OwnedMultiplier(row)) != decomposition::RowKind::contact)
      least[row] = -unbounded;
  return lower;
}

} // namespace

RCP<const qp::ConvexSet> feasibleForces(const decomposition::DecomposedProblem& problem,
                                        const decomposition::ProblemData& data, const Vector* normal) {
  const RCP<Vector> lower = leastForces(problem);
  if (problem.numFriction == 0 || normal == nullptr)
    return rcp(new qp::Box(lower));
  constexpr double roundOff = 1e-12; // of a force that is none: a circle of such a size has no use
  const auto force = qp::localData(*normal);
  const double least = roundOff * normal->normInf();
  const auto boundOf = [&](const decomposition::FrictionNode& node) {
    const double pressing = force[node.contact];
    return data.frictionBound(node, pressing > least ? pressing : 0.0);
  };
  const auto slopeOf = [&](const decomposition::FrictionNode& node) {
    return data.frictionBound(node, 1) - data.frictionBound(node, 0);
  };
  std::vector<qp::Disc> discs;
  if (problem.components > 2) {
    for (const decomposition::FrictionNode& node : problem.frictionNodes)
      discs.push_back(
          {node.firstTangent, node.firstTangent + 1, boundOf(node), {}, node.contact, slopeOf(node)});
    return rcp(new qp::Discs(qp::Box(lower), std::move(discs), problem.multiplierMap));
  }
  const RCP<Vector> upper = rcp(new Vector(problem.multiplierMap));
  upper->putScalar(unbounded);
  std::vector<qp::Box::Growth> growth;
  for (const decomposition::FrictionNode& node : problem.frictionNodes) {
    if (const double slope = slopeOf(node); slope > 0)
      growth.push_back({node.firstTangent, node.contact, slope});
    upper->replaceLocalValue(node.firstTangent, boundOf(node));
    lower->replaceLocalValue(node.firstTangent, -boundOf(node));
  }
  return rcp(new qp::Box(lower, upper, std::move(growth)));
}

RCP<const qp::ConvexSet> feasibleForcesWithoutFriction(const decomposition::DecomposedProblem& problem) {
  const RCP<Vector> lower = leastForces(problem), upper = rcp(new Vector(problem.multiplierMap));
  const auto least = qp::localDataNonConst(*lower), most = qp::localDataNonConst(*upper);
  for (LocalOrdinal row = 0; row < std::ssize(least); ++row)
    if (problem.kindOf(decomposition::OwnedMultiplier(row)) == decomposition::RowKind::friction)
      least[row] = 0;
    else
      most[row] = unbounded;
  return rcp(new qp::Box(lower, upper));
}

} // namespace epafi::fetidp
