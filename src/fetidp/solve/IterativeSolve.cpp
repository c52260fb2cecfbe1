#include "epafi/fetidp/solve/IterativeSolve.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/equilibrium/Balancing.hpp"
#include "epafi/fetidp/equilibrium/Friction.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::ProblemData;

/// d̃ = B̄ K̄⁺ f̄ − c. Collective.
RightHandSide rightHandSide(const DualProblem& dual, const ProblemData& data) {
  const DecomposedProblem& problem = dual.problem();
  SubdomainVectors u;
  dual.inverse().apply(loadsOf(data), u);
  MultiplierExchange exchange(dual.inverse().multiplierPlan());
  dual.inverse().constraint(u, exchange.values());
  RightHandSide rhs{rcp(new Vector(problem.multiplierMap))};
  exchange.sumToOwners(*rhs.values);
  rhs.values->update(-1.0, data.gap(), 1.0);
  for (const Eigen::MatrixXd& values : u)
    rhs.largest = values.size() > 0 ? std::max(rhs.largest, values.lpNorm<Eigen::Infinity>()) : rhs.largest;
  rhs.largest = maxOverRanks(*problem.comm, rhs.largest);
  rhs.termSize = rhs.largest + data.gap().normInf();
  return rhs;
}

/// Without contact and with an error to balance it is CG by MPRGP, which watches the error.
qp::Method methodOf(Algorithm algorithm, bool isBalanced) {
  return algorithm == Algorithm::activeSets                         ? qp::Method::activeSets
         : algorithm == Algorithm::fixedPoint                       ? qp::Method::fixedPoint
         : algorithm == Algorithm::conjugateGradient && !isBalanced ? qp::Method::conjugateGradient
                                                                    : qp::Method::mprgp;
}

} // namespace

IterativeSolve::IterativeSolve(const DualProblem& dual, const ProblemData& data, const Vector* start,
                               qp::Observer* observer, const ErrorBalance* balance)
    : dual_(dual), problem_(dual.problem()), data_(data), start_(start), observer_(observer),
      balance_(balance), wholeRhs_(rightHandSide(dual, data)) {
  solution_.lambda = rcp(new Vector(problem_.multiplierMap));
}

/// λ of the iterate of the deflated problem. Collective.
void IterativeSolve::completeJumps(Vector& lambda) const {
  if (!dual_.deflatedOperator().is_null())
    dual_.deflatedOperator()->complete(*wholeRhs_.values, lambda);
}

/// What forces may be where the iteration begins: with Coulomb's friction that of the normal forces, which
/// are not known, comes face by face.
RCP<const qp::ConvexSet> IterativeSolve::feasibleForces() const {
  return fetidp::feasibleForces(problem_, data_,
                                data_.hasCoulombFriction() ? nullptr : solution_.lambda.get());
}

/// min ½λᵀFλ − λᵀd̃ over what forces may be; with F_U and Pᵀd̃ where jumps are deflated.
qp::QuadraticProgram IterativeSolve::program() const {
  const RCP<Vector> rhs = rcp(new Vector(*wholeRhs_.values, Teuchos::Copy));
  if (!dual_.deflatedOperator().is_null())
    dual_.deflatedOperator()->space().projectTransposed(*rhs);
  qp::QuadraticProgram program;
  program.hessian = dual_.operators().flexibility();
  program.linearTerm = rhs;
  program.set = feasibleForces();
  program.preconditioner = dual_.operators().facePreconditioner;
  program.operatorNorm = dual_.norm().norm;
  program.hessianOnKernel = dual_.hessian();
  program.preconditionerOnKernel = dual_.preconditioner();
  if (data_.hasCoulombFriction())
    program.setAt = [this](const Vector& lambda) { return dual_.feasibleForces(data_, lambda); };
  program.unsettled = "the bounds of Coulomb's friction do not settle; its coefficient may be larger than "
                      "those for which there is one solution";
  return program;
}

/// Residuals are relative to the size of d̃ or Pd (Balancing.hpp). One that is the round-off of its terms is
/// set to zero, and their size becomes the measure. Collective.
void IterativeSolve::setReference(Vector& rhs) {
  constexpr double roundOff = 1e-13;
  const bool vanishes = rhs.normInf() <= roundOff * wholeRhs_.termSize;
  if (vanishes)
    rhs.putScalar(0.0);
  solution_.reference =
      vanishes ? wholeRhs_.termSize : gradientReference(*feasibleForces(), rhs, roundOff * wholeRhs_.largest);
}

/// Forces that are out of balance by no more than the iteration allows are balanced.
/// \param reference  of what they miss. Collective.
void IterativeSolve::balance(const Eigen::VectorXd& resultants, double reference) {
  const double imbalance =
      fetidp::balance(*dual_.feasibleForces(data_, *solution_.lambda), *dual_.coarseSpace(), resultants,
                      dual_.parameters().equilibriumTolerance * reference, *solution_.lambda);
  solution_.equilibrium = reference > 0 ? imbalance / reference : imbalance;
}

/// Where bodies float with λ = λ̃ + μ: min ½μᵀPFPμ − μᵀPd, G̃μ = 0, μ_I ≥ −λ̃_I, where d = d̃ − Fλ̃.
/// \param shift  in: 0; out: λ̃ with G̃λ̃ = ẽ. Collective.
qp::QuadraticProgram IterativeSolve::shiftedProgram(const Eigen::VectorXd& resultants,
                                                    const RCP<Vector>& shift) {
  qp::QuadraticProgram whole = program();
  const RCP<const NaturalCoarseSpace> space = dual_.coarseSpace();
  if (!space.is_null()) {
    space->feasiblePoint(resultants, *shift);
    whole = whole.shiftedBy(shift);
    whole.equality = space;
  }
  const RCP<Vector> rhs = rcp(new Vector(*whole.linearTerm, Teuchos::Copy));
  if (!space.is_null())
    space->project(*rhs); // Pd
  setReference(*rhs);
  whole.linearTerm = rhs;
  return whole;
}

DualSolution IterativeSolve::run(const Eigen::VectorXd& resultants) {
  const RCP<Vector> shift = rcp(new Vector(problem_.multiplierMap));
  const qp::QuadraticProgram shifted = shiftedProgram(resultants, shift);
  const RCP<const NaturalCoarseSpace> space = dual_.coarseSpace();
  const bool vanishes = shifted.linearTerm->normInf() == 0;
  const qp::Method method = methodOf(dual_.algorithm(), balance_ != nullptr);
  Vector& mu = *solution_.lambda;
  if (start_ != nullptr && !vanishes) // else μ = 0 solves it, and no other start gets there
    mu.update(1.0, *start_, -1.0, *shift, 0.0);
  qp::Tolerances tolerances{.gradient = dual_.plan().tolerance, .gradientReference = solution_.reference};
  if (!space.is_null()) {
    tolerances.constraint = dual_.parameters().equilibriumTolerance;
    tolerances.constraintReference =
        equilibriumReference(problem_, data_, *space, resultants, solution_.reference, dual_.norm().norm);
    if (method == qp::Method::conjugateGradient) // in Ker G, which P does not leave
      space->project(mu);
  } else if (vanishes) {
    tolerances.gradientReference = 0;
  }
  if (balance_ != nullptr && !vanishes)
    tolerances.error = &target_.emplace(dual_, data_, *balance_, [&](Vector& x) {
      x.update(1.0, *shift, 1.0);
      completeJumps(x);
    });
  std::optional<ShiftedObserver> observer;
  if (observer_ != nullptr)
    observer.emplace(*observer_, *shift);
  solution_.report = qp::solve(shifted, method, tolerances,
                               {.mprgp = dual_.plan().mprgp,
                                .smalbe = dual_.parameters().smalbe,
                                .faceReduction = dual_.plan().faceReduction,
                                .beginsFree = start_ == nullptr && dual_.plan().beginsClosed,
                                .patience = 300},
                               mu, observer ? &*observer : nullptr);
  mu.update(1.0, *shift, 1.0); // λ
  if (!space.is_null())
    balance(resultants, tolerances.constraintReference);
  return finished();
}

/// λ is there but for its deflated jumps. Collective.
DualSolution IterativeSolve::finished() {
  completeJumps(*solution_.lambda);
  ontoFrictionBounds(problem_, data_, *solution_.lambda);
  if (target_) {
    solution_.errorTarget = target_->last();
    solution_.isEstimated = target_->hasSeen(*solution_.lambda);
  }
  return std::move(solution_);
}

} // namespace epafi::fetidp
