// One solve of the dual problem.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/Balancing.hpp"
#include "epafi/fetidp/Contradictions.hpp"
#include "epafi/fetidp/DualObservers.hpp"
#include "epafi/fetidp/DualProblem.hpp"
#include "epafi/fetidp/ProblemChecks.hpp"
#include "epafi/fetidp/Solvability.hpp"
#include "epafi/qp/ActiveSets.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/ConjugateGradient.hpp"
#include "epafi/qp/RecessionDirection.hpp"

#include <Teuchos_Time.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace epafi::fetidp {

namespace {

using decomposition::DecomposedProblem;
using decomposition::ProblemData;

/// A right-hand side, and what it is the difference of.
struct RightHandSide {
  RCP<Vector> values;
  double termSize = 0; ///< max |K̄⁺f̄| + max |c|
  double largest = 0;  ///< max |K̄⁺f̄|
};

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

/// A solve that iterates.
class IterativeSolve {
public:
  /// Keeps references; observer and balance may be null. Collective.
  IterativeSolve(const DualProblem& dual, const ProblemData& data, const Vector* start,
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

  DualSolution coercive();
  /// \param resultants  ẽ
  DualSolution semicoercive(const Eigen::VectorXd& resultants);

private:
  bool setReference();
  void iterateInBounds();
  using Method = std::function<qp::SolveReport(Vector&, const qp::MprgpParameters&)>;
  void iterate(const qp::ActiveSetProblem& faces, const qp::SmalbeTolerances& tolerances, Vector& x,
               qp::Observer* observer, const Method& always);
  void goOn(const Method& method, Vector& x, int most);
  [[nodiscard]] bool isToGoOn() const;
  void refuseIfContradictory(const qp::ActiveSetProblem& faces, int maxMultiplications);
  void completeJumps(Vector& lambda) const;
  DualSolution finished();

  const DualProblem& dual_;
  const DecomposedProblem& problem_;
  const ProblemData& data_;
  const Vector* start_;
  qp::Observer* observer_;
  const ErrorBalance* balance_;
  double tolerance_;
  RightHandSide wholeRhs_; ///< d̃
  RCP<Vector> rhs_;        ///< of the iteration: d̃, Pᵀd̃ where jumps are deflated, Pd where bodies float
  DualSolution solution_;
  std::optional<BalancedTarget> target_;     ///< with a balance
  double began_ = Teuchos::Time::wallTime(); ///< seconds
};

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
  solution_.reference = vanishes
                            ? wholeRhs_.termSize
                            : gradientReference(*dual_.feasibleForces(), *rhs_, roundOff * wholeRhs_.largest);
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
  if (target_) {
    solution_.errorTarget = target_->last();
    solution_.isEstimated = target_->hasSeen(*solution_.lambda);
  }
  return std::move(solution_);
}

/// Refuses constraints that contradict each other: then the objective falls without end along a direction.
/// Collective.
/// \param maxMultiplications  that are left
void IterativeSolve::refuseIfContradictory(const qp::ActiveSetProblem& faces, int maxMultiplications) {
  constexpr int patience = 2000; // products
  const qp::RecessionDirection found =
      qp::findRecessionDirection(dual_.hessian(), dual_.norm().norm, *rhs_, *faces.set, faces.equality,
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

/// What was chosen first. MPRGP gives way to active sets after so many products that these would most likely
/// be there, and active sets where their faces do not settle to what always gets there.
/// \param always  MPRGP, or SMALBE
void IterativeSolve::iterate(const qp::ActiveSetProblem& faces, const qp::SmalbeTolerances& tolerances,
                             Vector& x, qp::Observer* observer, const Method& always) {
  using Status = qp::Status;
  constexpr int patience = 300, endless = std::numeric_limits<int>::max();
  const bool isByFaces = dual_.algorithm() == Algorithm::activeSets;
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
    refuseIfContradictory(faces, dual_.plan().mprgp.maxMultiplications -
                                     solution_.report.counts.hessianMultiplications);
  if (status == Status::unbounded || status == Status::stagnated || status == Status::notFinite)
    goOn(always, x, endless);
}

/// MPRGP, or active sets; without contact it is CG, step by step.
void IterativeSolve::iterateInBounds() {
  const qp::BoundProblem problem{dual_.hessian(), rhs_, dual_.feasibleForces(), dual_.preconditioner(),
                                 dual_.norm().norm};
  const qp::ActiveSetProblem faces{problem.hessian, problem.linearTerm,     problem.set,
                                   Teuchos::null,   problem.preconditioner, problem.operatorNorm};
  const double reference = rhs_->normInf() > 0 ? solution_.reference : 0;
  qp::SmalbeTolerances tolerances{.gradient = tolerance_, .gradientReference = reference};
  if (balance_ == nullptr || reference == 0) {
    iterate(faces, tolerances, *solution_.lambda, observer_,
            [&](Vector& x, const qp::MprgpParameters& mprgp) {
              return qp::solveBoundProblem(problem, x, {tolerance_, reference, 0.0}, mprgp, observer_);
            });
    return;
  }
  target_.emplace(dual_, data_, *balance_, [this](Vector& x) { completeJumps(x); });
  tolerances.error = &*target_;
  iterate(faces, tolerances, *solution_.lambda, observer_, [&](Vector& x, const qp::MprgpParameters& mprgp) {
    qp::ErrorRule rule(*target_, reference);
    return qp::solveBoundProblem(problem, x, rule, reference, mprgp, observer_);
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
    const RCP<const qp::ConvexSet> set = dual_.feasibleForces()->shiftedBy(feasible); // μ_I ≥ −λ̃_I
    const double norm = dual_.norm().norm;
    qp::ActiveSetProblem faces{dual_.operators().flexibility(),      rhs_, set, dual_.coarseSpace(),
                               dual_.operators().facePreconditioner, norm};
    faces.faceReduction = dual_.plan().faceReduction;
    iterate(faces, tolerances, mu, observer, [&](Vector& x, const qp::MprgpParameters& mprgp) {
      std::vector<double> multiplier;
      return qp::solveEqualityBoundProblem(
          {dual_.hessian(), rhs_, set, dual_.coarseSpace(), dual_.preconditioner(), norm}, x, multiplier,
          tolerances, dual_.parameters().smalbe, mprgp, observer);
    });
  }
  solution_.lambda->update(1.0, mu, 1.0, feasible, 0.0);
  const double imbalance = balance(*dual_.feasibleForces(), space, resultants,
                                   dual_.parameters().equilibriumTolerance * reference, *solution_.lambda);
  solution_.equilibrium = reference > 0 ? imbalance / reference : imbalance;
  return finished();
}

/// Where there is nothing to iterate.
DualSolution solvedDirectly(const DecomposedProblem& problem) {
  DualSolution solution;
  solution.lambda = rcp(new Vector(problem.multiplierMap));
  solution.report.status = qp::Status::converged;
  solution.report.reason = "solved directly";
  return solution;
}

} // namespace

DualSolution DualProblem::solve(const decomposition::ProblemData& data, const Vector* start,
                                qp::Observer* observer, const ErrorBalance* balance) const {
  if (plan_.isBalanced && balance == nullptr)
    throw InputError("the tolerance 'balanced' needs an estimate of the discretisation error, and none was "
                     "given; hand one over to solve(), or ask for a number");
  requireOwnData(problem_, data);
  requireFiniteData(problem_, data);
  const Eigen::VectorXd resultants = kernelLoad(problem_, data);
  requireFeasibleGaps(problem_, data);
  requireUniqueSolution(problem_, data, kernelEntries_);
  if (algorithm() == Algorithm::direct)
    return solvedDirectly(problem_);
  IterativeSolve solve(*this, data, start, observer, plan_.isBalanced ? balance : nullptr);
  DualSolution solution = coarseSpace().is_null() ? solve.coercive() : solve.semicoercive(resultants);
  if (solution.report.status == qp::Status::unbounded && !solution.report.certificate.is_null())
    refuseContradiction(problem_, data, *solution.report.certificate);
  return solution;
}

} // namespace epafi::fetidp
