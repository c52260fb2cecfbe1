#include "epafi/fetidp/precondition/DualPreconditioner.hpp"

#include "epafi/base/Collective.hpp"

#include <utility>

namespace epafi::fetidp {

DualPreconditioner::DualPreconditioner(const decomposition::DecomposedProblem& problem,
                                       std::shared_ptr<const GeneralizedInverse> inverse,
                                       const PreconditionerParameters& parameters,
                                       const RCP<const qp::DeflatedOperator>& deflated)
    : SymmetricOperator(problem.multiplierMap), inverse_(std::move(inverse)),
      rest_(rcp(new MultiVector(problem.multiplierMap, 1))) {
  // Adaptive constraints join all clusters.
  ContactCrosspoints crosspoints(problem, *inverse_,
                                 deflated.is_null() ? inverse_->coarseProblem().team() : problem.comm);
  ScaledConstraint scaled =
      scaleConstraint(problem, crosspoints, parameters.scaling, inverse_->multiplierPlan());
  boundary_.emplace(problem, inverse_, scaled, parameters);
  if (holdsAnywhere(*problem.comm, crosspoints.size() > 0))
    motion_.emplace(problem, inverse_, std::move(crosspoints), scaled, deflated);
  untouched_ = std::move(scaled.untouched);
}

void DualPreconditioner::multiply(const MultiVector& x, MultiVector& y) const {
  const std::size_t numColumns = x.getNumVectors();
  if (motion_) {
    if (rest_->getNumVectors() != numColumns)
      rest_ = rcp(new MultiVector(x.getMap(), numColumns));
    motion_->split(x, displacement_, *rest_);
    boundary_->apply(*rest_, y);
    motion_->addForces(displacement_, y);
  } else {
    boundary_->apply(x, y);
  }
  for (std::size_t j = 0; j < numColumns && !untouched_.empty(); ++j) {
    const auto image = y.getDataNonConst(j);
    const auto given = x.getData(j);
    for (const LocalOrdinal row : untouched_)
      image[row] = given[row];
  }
}

/// The boundaries are held at u, where they would go to v without, by the forces S_Δ(v − u)_Δ.
RCP<Vector> DualPreconditioner::multipliersOf(const decomposition::DecomposedProblem& problem,
                                              const decomposition::ProblemData& data,
                                              const SubdomainVectors& given) const {
  const SubdomainVectors loads = loadsOf(data);
  SubdomainVectors free = given;
  GeneralizedInverse::Workspace work;
  inverse_->solveRemainders(loads, free, 1, work); // v
  SubdomainVectors held;
  for (std::size_t s = 0; s < free.size(); ++s)
    held.emplace_back(free[s] - given[s]);
  RCP<Vector> multipliers = rcp(new Vector(problem.multiplierMap));
  boundary_->applyTo(held, *multipliers);
  if (motion_)
    motion_->addForcesAtRest(problem, loads, free, *multipliers);
  return multipliers;
}

} // namespace epafi::fetidp
