#include "epafi/fetidp/solve/IterativeSolve.hpp"

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/equilibrium/Balancing.hpp"
#include "epafi/fetidp/equilibrium/Contradictions.hpp"
#include "epafi/fetidp/equilibrium/Friction.hpp"
#include "epafi/fetidp/solve/MovingBounds.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/ConjugateGradient.hpp"
#include "epafi/qp/RecessionDirection.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

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

} // namespace

IterativeSolve::IterativeSolve(const DualProblem& dual, const ProblemData& data, const Vector* start,
                               qp::Observer* observer, const ErrorBalance* balance)
    : dual_(dual), problem_(dual.problem()), data_(data), start_(start), observer_(observer),
      balance_(balance), tolerance_(dual.plan().tolerance), wholeRhs_(rightHandSide(dual, data)),
      rhs_(wholeRhs_.values) {
  if (!dual.deflatedOperator().is_null()) {
    rhs_ = rcp(new Vector(*wholeRhs_.values, Teuchos::Copy));
    dual.deflatedOperator()->space().projectTransposed(*rhs_);
  }
  solution_.lambda = rcp(new Vector(problem_.multiplierMap));
}

/// λ of the iterate of the deflated problem. Collective.
void IterativeSolve::completeJumps(Vector& lambda) const {
  if (!dual_.deflatedOperator().is_null())
    dual_.deflatedOperator()->complete(*wholeRhs_.values, lambda);
}

/// Residuals are relative to the size of d̃ or Pd (Balancing.hpp). One that is the round-off of its terms is
/// set to zero, and their size becomes the measure; returns whether that is so. Collective.
bool IterativeSolve::setReference() {
  constexpr double roundOff = 1e-13;
  const bool vanishes = rhs_->normInf() <= roundOff * wholeRhs_.termSize;
  if (vanishes)
    rhs_->putScalar(0.0);
  solution_.reference = vanishes ? wholeRhs_.termSize
                                 : gradientReference(*feasibleForces(), *rhs_, roundOff * wholeRhs_.largest);
  return vanishes;
}

DualSolution IterativeSolve::coercive() {
  const bool vanishes = setReference();
  if (start_ != nullptr && !vanishes) // else λ = 0 solves it, and no other start gets there
    solution_.lambda->assign(*start_);
  if (dual_.algorithm() == Algorithm::conjugateGradient && balance_ == nullptr)
    solution_.report =
        qp::solveUnconstrained(dual_.hessian(), rhs_, solution_.lambda, tolerance_,
                               dual_.plan().mprgp.maxMultiplications, observer_, dual_.preconditioner());
  else
    iterateInBounds();
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

/// Refuses constraints that contradict each other: then the objective falls without end along a direction.
/// Collective.
/// \param maxMultiplications  that are left
void IterativeSolve::refuseIfContradictory(const qp::ActiveSetProblem& faces, const Vector& x,
                                           int maxMultiplications) {
  constexpr int patience = 2000;                                                 // products
  const RCP<const qp::ConvexSet> set = faces.setAt ? faces.setAt(x) : faces.set; // friction has bounds
  const qp::RecessionDirection found =
      qp::findRecessionDirection(dual_.hessian(), dual_.norm().norm, *rhs_, *set, faces.equality,
                                 std::min(patience, maxMultiplications));
  solution_.report.counts.hessianMultiplications += found.multiplications;
  if (!found.direction.is_null())
    refuseContradiction(problem_, data_, *found.direction);
}

/// Goes on with a method from x; reports, counts and limits run through. Collective.
/// \param most  products of it
void IterativeSolve::goOn(const Method& method, Vector& x, int most) {
  qp::MprgpParameters limits = dual_.plan().mprgp;
  qp::SolveReport& report = solution_.report;
  limits.maxMultiplications =
      std::max(1, std::min(most, limits.maxMultiplications - report.counts.hessianMultiplications));
  if (limits.timeLimit > 0)
    limits.timeLimit = std::max(1e-9, limits.timeLimit - (Teuchos::Time::wallTime() - began_));
  qp::SolveReport further = method(x, limits);
  qp::append(further, report);
  further.counts = report.counts;
  further.history = std::move(report.history);
  report = std::move(further);
}

/// Whether another method is to go on: there are products left after one that has used up its own, or that
/// round-off has ended.
bool IterativeSolve::isToGoOn() const {
  return (solution_.report.status == qp::Status::maxIterations ||
          solution_.report.status == qp::Status::stagnated) &&
         solution_.report.counts.hessianMultiplications < dual_.plan().mprgp.maxMultiplications;
}

/// What forces may be where the iteration begins: with Coulomb's friction that of the normal forces, which
/// are not known, comes face by face.
RCP<const qp::ConvexSet> IterativeSolve::feasibleForces() const {
  return fetidp::feasibleForces(problem_, data_,
                                data_.hasCoulombFriction() ? nullptr : solution_.lambda.get());
}

/// Coulomb's friction as a fixed point of problems with given bounds: slower than faces that take the bounds
/// along, but each of them has a solution that is found. Collective.
void IterativeSolve::fixFriction(const qp::ActiveSetProblem& faces, const qp::SmalbeTolerances& tolerances,
                                 Vector& x, const MethodWithin& within) {
  constexpr int maxRounds = 60, endless = std::numeric_limits<int>::max();
  constexpr double first = 1e-2, share = 0.1; // of what bounds still move, each problem is solved to
  constexpr double exact = 1e-3;              // reduction on faces
  const double enough = tolerances.gradient * tolerances.gradientReference;
  qp::ActiveSetProblem given = faces;
  given.setAt = {};
  qp::SmalbeTolerances rough = tolerances;
  double moved = first / share * tolerances.gradientReference;
  Vector pressing(x, Teuchos::Copy); // where bounds come from
  Relaxation relaxation;
  given.set = faces.setAt(pressing);
  for (int round = 0; round < maxRounds; ++round) {
    if (tolerances.error == nullptr && tolerances.gradientReference > 0)
      rough.gradient = std::max(tolerances.gradient, share * moved / tolerances.gradientReference);
    const Method byFaces = [&](Vector& from, const qp::MprgpParameters& limits) {
      return qp::solveByActiveSets(given, from, nullptr, rough, limits, observer_);
    };
    goOn(byFaces, x, endless);
    if (isToGoOn() &&
        given.faceReduction > exact) { // small circles are stiff: half a step there leads nowhere
      given.faceReduction = exact;
      goOn(byFaces, x, endless);
    }
    if (isToGoOn() || solution_.report.status == qp::Status::unbounded)
      goOn([&](Vector& from, const qp::MprgpParameters& limits) { return within(given.set, from, limits); },
           x, endless);
    if (solution_.report.status != qp::Status::converged)
      return;
    Vector next(x, Teuchos::Copy);
    moved = dual_.norm().norm * moveWithBounds(*given.set, *faces.setAt(x), next);
    if (moved <= enough && rough.gradient <= tolerances.gradient) {
      x.assign(next);
      return;
    }
    relaxation.step(x, pressing);
    const RCP<const qp::ConvexSet> last = given.set;
    given.set = faces.setAt(pressing);
    moveWithBounds(*last, *given.set, x); // what slips goes on slipping
  }
  solution_.report.status = qp::Status::stagnated;
  solution_.report.reason =
      "the bounds of Coulomb's friction do not settle; its coefficient may be larger than "
      "those for which there is one solution";
}

/// What was chosen first. MPRGP gives way to active sets after so many products that these would most likely
/// be there, and active sets where their faces do not settle to what always gets there.
/// \param within  MPRGP, or SMALBE
void IterativeSolve::iterate(const qp::ActiveSetProblem& faces, const qp::SmalbeTolerances& tolerances,
                             Vector& x, qp::Observer* observer, const MethodWithin& within) {
  using Status = qp::Status;
  const Method always = [&](Vector& from, const qp::MprgpParameters& limits) {
    return within(faces.set, from, limits);
  };
  constexpr int patience = 300, endless = std::numeric_limits<int>::max();
  const bool isByFaces = dual_.algorithm() == Algorithm::activeSets || faces.setAt;
  if (!isByFaces) {
    goOn(always, x, patience);
    if (!isToGoOn())
      return;
  }
  Vector closed(x.getMap()); // all contact, where neither a start nor M knows better
  closed.putScalar(1.0);
  const bool isUnknown = start_ == nullptr && dual_.plan().beginsClosed;
  goOn(
      [&](Vector& from, const qp::MprgpParameters& limits) {
        return qp::solveByActiveSets(faces, from, isUnknown ? &closed : nullptr, tolerances, limits,
                                     observer);
      },
      x, endless);
  const Status status = solution_.report.status;
  if (status == Status::unbounded)
    refuseIfContradictory(
        faces, x, dual_.plan().mprgp.maxMultiplications - solution_.report.counts.hessianMultiplications);
  if (status != Status::unbounded && status != Status::stagnated && status != Status::notFinite)
    return;
  if (faces.setAt)
    fixFriction(faces, tolerances, x, within);
  else
    goOn(always, x, endless);
}

/// MPRGP, or active sets; without contact it is CG, step by step.
void IterativeSolve::iterateInBounds() {
  const qp::BoundProblem problem{dual_.hessian(), rhs_, feasibleForces(), dual_.preconditioner(),
                                 dual_.norm().norm};
  qp::ActiveSetProblem faces{problem.hessian, problem.linearTerm,     problem.set,
                             Teuchos::null,   problem.preconditioner, problem.operatorNorm};
  if (data_.hasCoulombFriction())
    faces.setAt = [this](const Vector& x) { return dual_.feasibleForces(data_, x); };
  const auto withinSet = [&](const RCP<const qp::ConvexSet>& set) {
    qp::BoundProblem other = problem;
    other.set = set;
    return other;
  };
  const double reference = rhs_->normInf() > 0 ? solution_.reference : 0;
  qp::SmalbeTolerances tolerances{.gradient = tolerance_, .gradientReference = reference};
  if (balance_ == nullptr || reference == 0) {
    iterate(faces, tolerances, *solution_.lambda, observer_,
            [&](const RCP<const qp::ConvexSet>& set, Vector& x, const qp::MprgpParameters& mprgp) {
              return qp::solveBoundProblem(withinSet(set), x, {tolerance_, reference, 0.0}, mprgp, observer_);
            });
    return;
  }
  target_.emplace(dual_, data_, *balance_, [this](Vector& x) { completeJumps(x); });
  tolerances.error = &*target_;
  iterate(faces, tolerances, *solution_.lambda, observer_,
          [&](const RCP<const qp::ConvexSet>& set, Vector& x, const qp::MprgpParameters& mprgp) {
            qp::ErrorRule rule(*target_, reference);
            return qp::solveBoundProblem(withinSet(set), x, rule, reference, mprgp, observer_);
          });
}

/// With λ = λ̃ + μ: min ½μᵀPFPμ − μᵀPd, G̃μ = 0, μ_I ≥ −λ̃_I, where d = d̃ − Fλ̃.
DualSolution IterativeSolve::semicoercive(const Eigen::VectorXd& resultants) {
  const NaturalCoarseSpace& space = *dual_.coarseSpace();
  Vector feasible(problem_.multiplierMap); // λ̃ with G̃λ̃ = ẽ
  space.feasiblePoint(resultants, feasible);
  const RCP<Vector> whole = wholeRhs_.values;
  if (rhs_ == whole)
    rhs_ = rcp(new Vector(*whole, Teuchos::Copy));
  dual_.operators().flexibility()->apply(feasible, *rhs_, Teuchos::NO_TRANS, -1.0, 1.0); // d = d̃ − Fλ̃
  space.project(*rhs_);                                                                  // Pd
  const bool vanishes = setReference();
  const double reference =
      equilibriumReference(problem_, data_, space, resultants, solution_.reference, dual_.norm().norm);

  Vector mu(problem_.multiplierMap);
  if (start_ != nullptr && !vanishes)
    mu.update(1.0, *start_, -1.0, feasible, 0.0);
  qp::SmalbeTolerances tolerances{tolerance_, solution_.reference, dual_.parameters().equilibriumTolerance,
                                  reference};
  if (balance_ != nullptr && !vanishes)
    tolerances.error = &target_.emplace(dual_, data_, *balance_, [&](Vector& x) {
      x.update(1.0, feasible, 1.0);
      completeJumps(x);
    });
  std::optional<ShiftedObserver> shifted;
  if (observer_ != nullptr)
    shifted.emplace(*observer_, feasible);
  qp::Observer* const observer = shifted ? &*shifted : nullptr;
  if (dual_.algorithm() == Algorithm::conjugateGradient &&
      balance_ == nullptr) { // in Ker G, which P does not leave
    space.project(mu);
    const RCP<Vector> start = rcp(new Vector(mu, Teuchos::Copy));
    solution_.report =
        qp::solveUnconstrained(dual_.hessian(), rhs_, start, tolerance_,
                               dual_.plan().mprgp.maxMultiplications, observer, dual_.preconditioner());
    mu.assign(*start);
  } else {
    const RCP<const qp::ConvexSet> set = feasibleForces()->shiftedBy(feasible); // μ_I ≥ −λ̃_I
    const double norm = dual_.norm().norm;
    qp::ActiveSetProblem faces{dual_.operators().flexibility(),      rhs_, set, dual_.coarseSpace(),
                               dual_.operators().facePreconditioner, norm};
    faces.faceReduction = dual_.plan().faceReduction;
    if (data_.hasCoulombFriction())
      faces.setAt = [this, &feasible](const Vector& x) {
        Vector lambda(x, Teuchos::Copy);
        lambda.update(1.0, feasible, 1.0);
        return dual_.feasibleForces(data_, lambda)->shiftedBy(feasible);
      };
    iterate(faces, tolerances, mu, observer,
            [&](const RCP<const qp::ConvexSet>& within, Vector& x, const qp::MprgpParameters& mprgp) {
              std::vector<double> multiplier;
              return qp::solveEqualityBoundProblem(
                  {dual_.hessian(), rhs_, within, dual_.coarseSpace(), dual_.preconditioner(), norm}, x,
                  multiplier, tolerances, dual_.parameters().smalbe, mprgp, observer);
            });
  }
  solution_.lambda->update(1.0, mu, 1.0, feasible, 0.0);
  const double imbalance = balance(*dual_.feasibleForces(data_, *solution_.lambda), space, resultants,
                                   dual_.parameters().equilibriumTolerance * reference, *solution_.lambda);
  solution_.equilibrium = reference > 0 ? imbalance / reference : imbalance;
  return finished();
}

} // namespace epafi::fetidp
