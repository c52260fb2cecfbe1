#include "epafi/qp/solve/ActiveSets.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/ActiveSetIteration.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace epafi::qp {
namespace {

constexpr int maxFaces = 300;
constexpr int caution = 4; ///< from so many idle faces on one bound is released at a time
/// In CG the gradient is updated; that of the certificate, computed afresh, is to be small enough as well.
constexpr double safety = 0.5;
/// Gradients that have grown so much on entering a face, beside b and the first one, come from entries that
/// nearly depend on each other, with forces out of all proportion. The faces that follow may make up for it;
/// where it happens again and again they do not.
constexpr double runaway = 1e3;
constexpr int mostRunaways = 1, mostRunawayFaces = 8;

} // namespace

ActiveSetIteration::ActiveSetIteration(const QuadraticProgram& program, const Vector& start,
                                       const ActiveSetParameters& parameters, const Tolerances& tolerances,
                                       const MprgpParameters& limits)
    : program_(program), set_(program.set),
      objective_(program.hessian, program.operatorNorm, limits.maxMultiplications, counts_),
      tolerances_(tolerances), interruption_(limits.timeLimit),
      on_(objective_, program.preconditioner,
          Teuchos::rcp_dynamic_cast<const ReplicatedEquality>(program.equality, true), interruption_,
          counts_),
      start_(start, Teuchos::Copy), best_(start, Teuchos::Copy), inside_(objective_.map()),
      next_(objective_.map()), work_(objective_.map()), fixed_(objective_.map()),
      reduction_(objective_.map()->getComm(), 5), faceReduction_(parameters.faceReduction) {
  objective_.setLinearTerm(*program.linearTerm, 0);
  if (tolerances.error != nullptr)
    watch_.emplace(*tolerances.error);
  copy(start, on_.x);
  set_->project(on_.x);
  if (parameters.firstFace != nullptr)
    copy(*parameters.firstFace, on_.face.isFree);
  else
    chooseFirstFace(program);
  next_.isFree.putScalar(1.0);
  addScaled(-1.0, on_.face.isFree, next_.isFree);
  set_->activate(next_.isFree, on_.x);
  set_->followBoundary(on_.x, on_.gradient(), 0, nullptr, on_.face);
  if (start_.normInf() == 0) // it says nothing of directions on circles: pairs may move as they want to
    on_.face.tangents.clear();
  if (!program.setAt || start_.normInf() == 0)
    on_.face.followers.clear();
  if (program_.setAt)
    set_->fixedIndicator(fixed_);
  if (on_.x.normInf() == 0)
    point_ = FaceIteration::Point::origin;
}

Status ActiveSetIteration::run(Observer* observer) {
  interruption_.setObserver(observer);
  const Status status = settle();
  if ((status != Status::stagnated && status != Status::unbounded) || set_->isCurved() || program_.setAt)
    return status;
  const Status further = descend();
  return further == Status::stagnated ? status : further;
}

Status ActiveSetIteration::settle() {
  double least = std::numeric_limits<double>::infinity(), highest = 0, largest = 0;
  int numIdle = 0, numRunaways = 0, numRunawayFaces = 0;
  bool isRunaway = false;
  const int mostIdle = program_.setAt ? mostIdleWithMovingSet : maxIdleFaces;
  for (int faces = 0; faces < maxFaces && numIdle <= mostIdle; ++faces) {
    copy(on_.x, inside_);
    const FaceIteration::Point point = std::exchange(point_, FaceIteration::Point::elsewhere);
    on_.enter(point); // Bx = c, g afresh if x has moved
    gradient_ = on_.gradientNorm();
    record(faces == 0 ? StepKind::start : StepKind::expansion);
    if (!std::isfinite(gradient_))
      return Status::notFinite;
    if (!holdsEquality()) {
      if (!balance())
        break;
      continue;
    }
    if (isSolved()) {
      if (point != FaceIteration::Point::reached)
        return Status::converged;
      continue; // the certificate's gradient is computed afresh
    }
    numIdle = gradient_ < 0.9 * least ? 0 : numIdle + 1;
    if (std::isinf(least)) {
      highest = on_.objective();
      largest = runaway * std::max(gradient_, tolerances_.gradientReference * objective_.scale());
    }
    numRunaways += gradient_ > largest && !isRunaway ? 1 : 0;
    isRunaway = gradient_ > largest;
    numRunawayFaces += isRunaway ? 1 : 0;
    if (numRunaways > mostRunaways || numRunawayFaces > mostRunawayFaces)
      break;
    if (gradient_ < least && (program_.setAt || on_.objective() <= highest)) {
      least = gradient_;
      copy(on_.x, best_);
    }
    do {
      if (const auto status = minimise(maxFaceSteps)) { // on the face, as if it had no bounds
        if (*status == Status::stagnated || *status == Status::unbounded)
          copy(best_, on_.x);
        return *status;
      }
    } while (!chooseFace(numIdle >= caution) && // where x left Ω, where multipliers are wrong
             !isSmall(on_.gradientNorm() / safety, on_.energy()));
    if (hasMovingBoundary()) { // where the face was kept though x is off it by little
      copy(inside_, on_.x);
      copy(next_, on_.face);
    }
    ++counts_.expansion;
  }
  copy(best_, on_.x);
  return Status::stagnated;
}

/// Whether the face can hold Bx = c.
bool ActiveSetIteration::holdsEquality() const {
  return on_.constraintResidual() <= tolerances_.constraintLimit();
}

/// CG until ‖Zg‖ and (gᵀMg)^½ have fallen to a share of themselves, or are small enough.
std::optional<Status> ActiveSetIteration::minimise(int maxSteps) {
  const double goal = faceReduction_ * faceReduction_ * on_.energy(),
               most = faceReduction_ * on_.gradientNorm();
  for (int step = 0; (on_.energy() > goal || on_.gradientNorm() > most) && !isNearlySmall(); ++step) {
    if (on_.wish())
      return on_.wish();
    if (objective_.isSpent())
      return Status::maxIterations;
    if (step == maxSteps)
      return Status::stagnated;
    if (const auto status = on_.step()) {
      if (*status != Status::unbounded || isEndless())
        return status;
      return leave() ? std::nullopt : std::optional(Status::stagnated);
    }
    gradient_ = on_.gradientNorm();
    record(StepKind::conjugateGradient);
  }
  return std::nullopt;
}

/// Whether the set goes on for ever where the last direction leads down, or nearly so.
bool ActiveSetIteration::isEndless() {
  constexpr double mostOff = 0.1;
  work_.update(on_.slope() > 0 ? -1.0 : 1.0, on_.direction(), 0.0);
  copy(work_, next_.isFree);
  set_->recessionCone(objective_.map())->project(next_.isFree);
  addScaled(-1.0, work_, next_.isFree);
  return accurateNorm(next_.isFree) <= mostOff * accurateNorm(work_);
}

/// Where the face has no minimum but Ω has: from where CG entered the face along what has no curvature, which
/// changes no other entry's gradient, until x leaves Ω. False if it never does. Precondition: work_ is the
/// direction, as `isEndless` leaves it, inside_ where CG came from. Collective.
bool ActiveSetIteration::leave() {
  constexpr double noise = 1e-3, beyond = 2, least = 0.1; // beside d, the step to the boundary, and x
  const double largest = work_.normInf();
  for (double& entry : localDataNonConst(work_)) // x moves against it
    entry = std::abs(entry) > noise * largest ? -entry / largest : 0;
  const double room = minOverRanks(*work_.getMap()->getComm(), set_->maxFeasibleStep(inside_, work_));
  const double length = beyond * room + least * inside_.normInf();
  if (!std::isfinite(length) || !(length > 0) || ++numLeft_ > mostLeft)
    return false;
  copy(inside_, on_.x);
  addScaled(-length, work_, on_.x);
  return true;
}

/// Whether CG has done what the tolerance asks for, with something to spare.
bool ActiveSetIteration::isNearlySmall() const {
  return watch_ ? std::sqrt(std::max(0.0, on_.energy())) / objective_.scale() <= watch_->limit()
                : on_.gradientNorm() <= safety * enough();
}

/// Whether x, with g afresh, is within Ω and its projected gradient meets the tolerance.
bool ActiveSetIteration::isSolved() {
  copy(on_.x, inside_);
  const Vector& gradient = on_.plainGradient();
  followSet(gradient);
  set_->project(inside_);
  set_->projectedGradient(inside_, gradient, 0.0, work_);
  on_.face.restrict(work_, next_.isFree);
  addScaled(-1.0, next_.isFree, work_);
  reduction_.clear();
  {
    const auto on = localData(on_.face.isFree), off = localData(work_), x = localData(on_.x),
               inside = localData(inside_);
    const auto sums = reduction_.sums();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double out = x[i] - inside[i];
      sums[0].add(off[i] * off[i]);
      sums[1].add(out * out);
      sums[2].add(x[i] * x[i]);
      sums[3].add(1 - on[i]);
    }
  }
  reduction_.reduce();
  numActive_ = static_cast<long long>(reduction_.sum(3));
  const double outside = std::sqrt(reduction_.sum(1));
  if (!program_.setAt && outside > roundOffOfX * std::sqrt(reduction_.sum(2)))
    return false;
  const double whole =
      std::hypot(gradient_, std::sqrt(reduction_.sum(0)), objective_.norm() * (program_.setAt ? outside : 0));
  const double share = gradient_ > 0 ? whole / gradient_ : 1;
  if (!isSmall(whole, share * share * on_.energy()))
    return false;
  gradient_ = whole;
  copy(inside_, on_.x);
  return true;
}

/// Whether the tolerance is met. \param energy an upper bound of the squared error, of a scaled gradient.
/// Collective.
bool ActiveSetIteration::isSmall(double gradient, double energy) {
  return watch_ ? watch_->isSmallEnough(std::sqrt(std::max(0.0, energy)) / objective_.scale(), on_.x)
                : gradient <= enough();
}

void ActiveSetIteration::record(StepKind kind) {
  Observer* const observer = interruption_.observer();
  if (observer == nullptr)
    return;
  StepRecord step;
  step.iteration = counts_.conjugateGradient + counts_.expansion;
  step.kind = kind;
  step.projectedGradient = relativeTo(tolerances_.gradientReference, gradient_ / objective_.scale());
  step.constraintResidual = relativeTo(tolerances_.constraintReference, on_.constraintResidual());
  step.objective = on_.objective() / objective_.scale();
  step.activeBounds = numActive_;
  step.hessianMultiplications = counts_.hessianMultiplications;
  observer->step(step);
  if (!on_.isLookWanted())
    return;
  copy(on_.x, next_.isFree);
  set_->project(next_.isFree);
  observer->look(next_.isFree);
}

void ActiveSetIteration::describe(SolveReport& report) const {
  report.reason = explain(report.status);
  report.counts = counts_;
  report.relativeProjectedGradient =
      relativeTo(tolerances_.gradientReference, gradient_ / objective_.scale());
  report.relativeConstraintResidual = relativeTo(tolerances_.constraintReference, on_.constraintResidual());
  report.objective = on_.objective() / objective_.scale();
  report.operatorNorm = objective_.norm() / objective_.scale();
  if (report.status != Status::converged)
    return;
  report.gradient = rcp(new Vector(on_.gradient(), Teuchos::Copy));
  report.gradient->scale(1.0 / objective_.scale());
}

SolveReport solveByActiveSets(const QuadraticProgram& program, Vector& x,
                              const ActiveSetParameters& parameters, const Tolerances& tolerances,
                              const MprgpParameters& limits, Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  ActiveSetIteration method(program, x, parameters, tolerances, limits);
  report.status = method.run(&recorder);
  x.assign(method.solution());
  (program.setAt ? program.setAt(x) : program.set)->project(x);
  method.describe(report);
  return report;
}

} // namespace epafi::qp
