#include "epafi/qp/Mprgp.hpp"

#include <Teuchos_Time.hpp>
#include <Teuchos_TimeMonitor.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace epafi::qp {
namespace {

/// A curvature pᵀAp ≤ zeroCurvature · ‖A‖ pᵀp is zero, as far as products in double precision can tell.
constexpr double zeroCurvature = 1e-14;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

} // namespace

Mprgp::Mprgp(RCP<const Operator> a, RCP<const ConvexSet> set, const MprgpParameters& parameters,
             double operatorNorm, RCP<const Operator> preconditioner)
    : a_(std::move(a)), preconditioner_(std::move(preconditioner)), set_(std::move(set)),
      parameters_(parameters),
      proportioningConstant_(parameters.proportioningConstant > 0 ? parameters.proportioningConstant : 1.0),
      sufficientShare_(parameters.sufficientShare > 0 ? parameters.sufficientShare : 1.0),
      scale_(operatorNorm > 0 ? 1.0 / operatorNorm : 1.0), norm_(operatorNorm > 0 ? 1.0 : 0.0),
      comm_(a_->getDomainMap()->getComm()),
      hessianTimer_(Teuchos::TimeMonitor::getNewCounter("Epafi::qp: product with the Hessian")),
      preconditionerTimer_(Teuchos::TimeMonitor::getNewCounter("Epafi::qp: preconditioner")),
      x_(a_->getDomainMap()), b_(a_->getDomainMap()), g_(a_->getDomainMap()), p_(a_->getDomainMap()),
      ap_(a_->getDomainMap()), stepReduction_(comm_, 4), measureReduction_(comm_, numOwnSums) {
  if (!preconditioner_.is_null()) {
    residual_ = rcp(new Vector(a_->getDomainMap()));
    z_ = rcp(new Vector(a_->getDomainMap()));
  }
  if (parameters_.expansion == Expansion::barzilaiBorwein) {
    lastX_ = rcp(new Vector(a_->getDomainMap()));
    lastG_ = rcp(new Vector(a_->getDomainMap()));
  }
  predicts_ = parameters_.expansion == Expansion::activeSet;
  if (parameters_.timeLimit > 0)
    deadline_ = Teuchos::Time::wallTime() + parameters_.timeLimit;
}

// The loop of the paper.
Status Mprgp::run(StoppingRule& rule, Observer* observer) {
  measureReduction_ = FusedReduction(comm_, numOwnSums + rule.numSums());
  observer_ = observer;
  progress_.restart();
  conjugate_ = staysInFace_ = false;
  refreshes_ = 0;
  measure(rule);
  startGradient_ = projectedGradient_;
  record(rule, StepKind::start);

  while (true) {
    if (const auto status = ending(rule))
      return *status;
    const StepKind intent = isProportional() ? StepKind::conjugateGradient : StepKind::proportioning;
    if (const auto status = setDirection(intent)) // p = z − (zᵀAp/pᵀAp) p, or p = z, with z = φ, φ + β or β
      return *status;
    applyHessian(p_, ap_);
    const StepSizes sizes = stepSizes(); // pᵀAp, gᵀp, α_f
    if (const auto status = endingOf(sizes))
      return *status;
    if (fits(sizes, intent)) { // α_cg = gᵀp/pᵀAp ≤ α_f
      step(sizes, intent);     // x −= α_cg p, g −= α_cg Ap
      measure(rule);
      record(rule, intent);
    } else {
      const auto status = expansionStep(sizes, intent);
      measure(rule);
      record(rule, StepKind::expansion);
      if (status)
        return *status;
    }
  }
}

bool Mprgp::isProportional() const {
  const double gamma = proportioningConstant_;
  return choppedSquared_ <= gamma * gamma * reducedTimesFree_; // βᵀβ ≤ Γ² φ̃ᵀφ
}

/// Whether the iterate is so far from leaving its face that the next one will hardly do so either.
bool Mprgp::isWellProportional() const {
  constexpr double margin = 0.1;
  const double gamma = proportioningConstant_;
  return choppedSquared_ <= margin * gamma * gamma * reducedTimesFree_;
}

/// Why the iteration is over at the present iterate, if it is.
std::optional<Status> Mprgp::ending(StoppingRule& rule) {
  constexpr int maxRefreshes = 4;
  while (true) {
    if (!std::isfinite(projectedGradient_))
      return Status::notFinite;
    if (isSatisfied_)
      return Status::converged;
    if (counts_.hessianMultiplications >= parameters_.maxMultiplications)
      return Status::maxIterations;
    if (isInterrupted_)
      return Status::interrupted;
    if (timeIsUp_)
      return Status::timeLimit;
    // The gradient is a difference: below this it is round-off.
    const double attainable = 2 * epsilon * (norm_ * solutionNorm_ + linearNorm_);
    const bool isRoundOff = projectedGradient_ <= attainable;
    if (!isRoundOff && !progress_.standsStill())
      return std::nullopt;
    if ((isRoundOff && gradientIsFresh_) || refreshes_ >= maxRefreshes)
      return Status::stagnated;
    ++refreshes_;
    refreshGradient(); // the updated gradient may have drifted away
    progress_.forgive();
    conjugate_ = false;
    measure(rule);
  }
}

/// Why no step along p can be made, if so.
std::optional<Status> Mprgp::endingOf(const StepSizes& sizes) const {
  if (!std::isfinite(sizes.curvature) || !std::isfinite(sizes.slope))
    return Status::notFinite;
  if (!(sizes.squared > 0))
    return Status::stagnated;
  const double threshold = zeroCurvature * norm_ * sizes.squared;
  if (sizes.curvature < -threshold)
    return Status::indefiniteOperator;
  if (sizes.curvature <= threshold && !std::isfinite(sizes.feasible))
    return Status::unbounded;
  return std::nullopt;
}

/// Whether the step to the minimum along p stays in the set. Along the chopped gradient alone a step is cut at the
/// boundary instead (Dostál's algorithm 5.8 does without the cut, for bounds on one side).
bool Mprgp::fits(const StepSizes& sizes, StepKind intent) const {
  return sizes.slope <= sizes.feasible * sizes.curvature ||
         (intent == StepKind::proportioning && parameters_.release == Release::choppedGradient);
}

void Mprgp::step(const StepSizes& sizes, StepKind kind) {
  const bool isConjugateGradient = kind == StepKind::conjugateGradient;
  ++(isConjugateGradient ? counts_.conjugateGradient : counts_.proportioning);
  staysInFace_ = isConjugateGradient && !preconditioner_.is_null() && isWellProportional();
  const double threshold = zeroCurvature * norm_ * sizes.squared;
  const double exact = sizes.curvature > threshold ? sizes.slope / sizes.curvature : sizes.feasible;
  move(std::min(exact, sizes.feasible), sizes);
  curvature_ = sizes.curvature;
  conjugate_ =
      isConjugateGradient || (parameters_.release == Release::projectedGradient && exact <= sizes.feasible);
}

RCP<Vector> Mprgp::certificate() const {
  const RCP<Vector> direction = rcp(new Vector(p_, Teuchos::Copy));
  const double length = accurateNorm(*direction);
  if (length > 0)
    direction->scale(-1.0 / length);
  return direction;
}

std::string Mprgp::description() const {
  std::ostringstream text;
  text << "Epafi::qp::Mprgp {unknowns: " << a_->getDomainMap()->getGlobalNumElements()
       << ", ‖A‖: " << operatorNorm()
       << ", preconditioner: " << (preconditioner_.is_null() ? "none" : preconditioner_->description())
       << ", products: " << counts_.hessianMultiplications << ", steps: " << counts_.conjugateGradient
       << " CG, " << counts_.expansion << " expansion, " << counts_.proportioning
       << " proportioning, ‖g^P‖: " << projectedGradient() << "}";
  return text.str();
}

bool Mprgp::timeIsUpHere() const {
  return deadline_ > 0 && Teuchos::Time::wallTime() > deadline_;
}

bool Mprgp::isToStopHere() const {
  return observer_ != nullptr && observer_->wantsToStop();
}

void Mprgp::record(const StoppingRule& rule, StepKind kind) {
  progress_.look(projectedGradient_, objective_);
  if (observer_ == nullptr)
    return;
  StepRecord step;
  step.iteration = counts_.conjugateGradient + counts_.expansion + counts_.proportioning;
  step.outer = counts_.outer;
  step.kind = kind;
  step.projectedGradient = projectedGradient();
  step.objective = objective();
  step.activeBounds = active_;
  step.hessianMultiplications = counts_.hessianMultiplications;
  rule.describe(step);
  observer_->step(step);
  if (isLookedAt_)
    observer_->look(x_);
}

} // namespace epafi::qp
