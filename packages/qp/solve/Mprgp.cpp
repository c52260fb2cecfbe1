#include "epafi/qp/solve/Mprgp.hpp"

#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace epafi::qp {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double impatience = 0.1; ///< what Γ is multiplied by on faces that last long
constexpr int growthOfPatience = 16;

/// The sums of a measurement: its own, then those of the preconditioner, then the rule's.
enum Sums : int {
  freeSquared,
  choppedSquared,
  reducedTimesFree,
  freeTimesImage,
  solutionSquared,
  active,
  timeIsUp,
  interrupted,
  look,
  preconditioned,
  numOwnSums = preconditioned + FacePreconditioner::numSums
};

double orDefault(double parameter) {
  return parameter > 0 ? parameter : 1.0;
}

} // namespace

Mprgp::Mprgp(RCP<const Operator> a, RCP<const ConvexSet> set, const MprgpParameters& parameters,
             double operatorNorm, RCP<const Operator> preconditioner)
    : parameters_(parameters), set_(std::move(set)),
      objective_(std::move(a), operatorNorm, parameters.maxMultiplications, counts_),
      interruption_(parameters.timeLimit), iterate_(objective_.map()), work_(objective_.map()),
      measureReduction_(objective_.map()->getComm(), numOwnSums) {
  if (preconditioner.is_null() || parameters.proportioningConstant > 0)
    patience_ = std::numeric_limits<int>::max();
  parameters_.proportioningConstant = orDefault(parameters.proportioningConstant);
  parameters_.sufficientShare = orDefault(parameters.sufficientShare);
  if (!preconditioner.is_null())
    preconditioner_.emplace(std::move(preconditioner), objective_.map(), counts_);
}

// The loop of the paper.
Status Mprgp::run(StoppingRule& rule, Observer* observer) {
  measureReduction_ = FusedReduction(objective_.map()->getComm(), numOwnSums + rule.numSums());
  interruption_.setObserver(observer);
  ProgressWatch progress(150);
  int refreshes = 0;
  lastCurvature_.reset();
  measure(rule, false);
  startGradient_ = now_.projectedGradient;
  record(rule, StepKind::start);

  while (true) {
    progress.look(now_.projectedGradient, iterate_.f);
    if (const auto status = ending(rule, progress, refreshes))
      return *status;
    const StepKind intent = isProportional(1) ? StepKind::conjugateGradient : StepKind::proportioning;
    if (const auto status = setDirection(intent)) // p = z − (zᵀAp/pᵀAp) p, or p = z, with z = φ, φ + β or β
      return *status;
    objective_.multiply(work_.p, work_.image);
    const StepSizes sizes = stepSizes(); // pᵀAp, gᵀp, α_f
    if (const auto status = endingOf(sizes))
      return *status;
    if (fits(sizes)) { // α_cg = gᵀp/pᵀAp ≤ α_f
      // so far from leaving the face that the next iterate will hardly do so either
      const bool staysInFace = intent == StepKind::conjugateGradient && isProportional(0.1);
      step(sizes, intent); // x −= α_cg p, g −= α_cg Ap
      measure(rule, staysInFace);
      record(rule, intent);
    } else {
      const auto status = expand(sizes, intent); // x = P(x − α_cg p), g = Ax − b
      measure(rule, false);
      record(rule, StepKind::expansion);
      if (status)
        return *status;
    }
  }
}

/// βᵀβ ≤ margin Γ² φ̃ᵀφ, with a smaller Γ where the face lasts long.
bool Mprgp::isProportional(double margin) const {
  const bool lastsLong = stepsInFace_ >= patience_;
  const double gamma = parameters_.proportioningConstant * (lastsLong ? impatience : 1);
  return now_.choppedSquared <= margin * gamma * gamma * now_.reducedTimesFree;
}

/// Why the iteration is over at the present iterate, if it is.
std::optional<Status> Mprgp::ending(StoppingRule& rule, ProgressWatch& progress, int& refreshes) {
  constexpr int maxRefreshes = 4;
  while (true) {
    if (!std::isfinite(now_.projectedGradient))
      return Status::notFinite;
    if (now_.isSatisfied)
      return Status::converged;
    if (objective_.isSpent())
      return Status::maxIterations;
    if (now_.isInterrupted)
      return Status::interrupted;
    if (now_.timeIsUp)
      return Status::timeLimit;
    // The gradient is a difference: below this it is round-off.
    const double attainable = 2 * epsilon * (objective_.norm() * now_.solutionNorm + objective_.linearNorm());
    const bool isRoundOff = now_.projectedGradient <= attainable;
    if (!isRoundOff && !progress.standsStill())
      return std::nullopt;
    if ((isRoundOff && iterate_.isFresh) || refreshes >= maxRefreshes)
      return Status::stagnated;
    ++refreshes;
    refreshGradient(); // the updated gradient may have drifted away
    progress.forgive();
    measure(rule, false);
  }
}

/// Why no step along p can be made, if so.
std::optional<Status> Mprgp::endingOf(const StepSizes& sizes) const {
  if (!std::isfinite(sizes.curvature) || !std::isfinite(sizes.slope))
    return Status::notFinite;
  if (!(sizes.squared > 0))
    return Status::stagnated;
  const double zero = objective_.zeroCurvature(sizes.squared);
  if (sizes.curvature < -zero)
    return Status::indefiniteOperator;
  if (sizes.curvature <= zero && !std::isfinite(sizes.feasible))
    return Status::unbounded;
  return std::nullopt;
}

/// Whether the step to the minimum along p stays in the set.
bool Mprgp::fits(const StepSizes& sizes) const {
  return sizes.slope <= sizes.feasible * sizes.curvature;
}

/// p for the step that is meant: in the face z = φ, or M φ on the free set; out of it z = φ + β, or M(φ + β)
/// where the set lets it move.
std::optional<Status> Mprgp::setDirection(StepKind intent) {
  const bool isInFace = intent == StepKind::conjugateGradient;
  const double negligible = negligibleShare * now_.projectedGradient;
  const auto& [x, g, f, isFresh] = iterate_;
  if (preconditioner_)
    return setPreconditionedDirection(isInFace, negligible);
  if (isInFace)
    set_->subtractFromFreeGradient(x, g, conjugation(now_.freeTimesImage), work_.p);
  else
    set_->projectedGradient(x, g, negligible, work_.p);
  return std::nullopt;
}

std::optional<Status> Mprgp::setPreconditionedDirection(bool isInFace, double negligible) {
  std::optional<FacePreconditioner::Products> products;
  if (isInFace)
    products = now_.preconditioned;
  if (!products) {
    if (isInFace)
      preconditioner_->applyToFree(*set_, iterate_.x, iterate_.g);
    else
      preconditioner_->applyToReleased(*set_, iterate_.x, iterate_.g, negligible);
    products = preconditioner_->products(work_.image);
  }
  if (!std::isfinite(products->energy))
    return Status::notFinite;
  if (!(products->energy > 0)) // rᵀMr ≤ 0: no descent, M is not positive definite
    return Status::indefinitePreconditioner;
  setConjugate(preconditioner_->z(), isInFace ? conjugation(products->timesImage) : 0.0, work_.p);
  return std::nullopt;
}

/// zᵀAp/pᵀAp.
double Mprgp::conjugation(double timesImage) const {
  return lastCurvature_ ? objective_.scale() * timesImage / *lastCurvature_ : 0.0;
}

/// pᵀAp, gᵀp, pᵀp and α_f in one message.
StepSizes Mprgp::stepSizes() {
  return objective_.stepSizes(iterate_.g, work_.p, work_.image, set_->maxFeasibleStep(iterate_.x, work_.p));
}

void Mprgp::step(const StepSizes& sizes, StepKind kind) {
  const bool isConjugateGradient = kind == StepKind::conjugateGradient;
  if (!isConjugateGradient && stepsInFace_ >= patience_)
    patience_ *= growthOfPatience; // if that was rash, it is not soon again
  stepsInFace_ = isConjugateGradient ? stepsInFace_ + 1 : 0;
  ++(isConjugateGradient ? counts_.conjugateGradient : counts_.proportioning);
  const bool hasCurvature = sizes.curvature > objective_.zeroCurvature(sizes.squared);
  const double exact = hasCurvature ? sizes.slope / sizes.curvature : sizes.feasible;
  move(std::min(exact, sizes.feasible), sizes);
  lastCurvature_.reset(); // a step that ends at a bound leaves its face: the next direction starts anew
  if (isConjugateGradient || exact <= sizes.feasible)
    lastCurvature_ = sizes.curvature;
}

/// x −= αp, g −= αAp, f follows: f(x − αp) = f − α gᵀp + ½α² pᵀAp. Streams x, g, p, Ap, l, u.
void Mprgp::move(double length, const StepSizes& sizes) {
  set_->move(length, work_.p, iterate_.x); // feasible already but for the last digit
  addScaled(-length * objective_.scale(), work_.image, iterate_.g);
  iterate_.f += length * (0.5 * length * sizes.curvature - sizes.slope);
  iterate_.isFresh = false;
}

RCP<Vector> Mprgp::certificate() const {
  const RCP<Vector> direction = rcp(new Vector(work_.p, Teuchos::Copy));
  const double length = accurateNorm(*direction);
  if (length > 0)
    direction->scale(-1.0 / length);
  return direction;
}

std::string Mprgp::description() const {
  std::ostringstream text;
  text << "Epafi::qp::Mprgp {unknowns: " << objective_.map()->getGlobalNumElements()
       << ", ‖A‖: " << operatorNorm()
       << ", preconditioner: " << (preconditioner_ ? preconditioner_->description() : "none")
       << ", products: " << counts_.hessianMultiplications << ", steps: " << counts_.conjugateGradient
       << " CG, " << counts_.expansion << " expansion, " << counts_.proportioning
       << " proportioning, ‖g^P‖: " << projectedGradient() << "}";
  return text.str();
}

void Mprgp::start(const Vector& b, const Vector& x0, double constant) {
  objective_.setLinearTerm(b, constant);
  iterate_.x.assign(x0);
  set_->project(iterate_.x);
  if (iterate_.x.normInf() > 0) {
    refreshGradient();
    return;
  }
  iterate_.g.update(-objective_.scale(), b, 0.0); // g = −b needs no product
  iterate_.f = objective_.constant();
  iterate_.isFresh = true;
}

void Mprgp::changeHessian(const Vector& gradientChange, double objectiveChange, const Vector& b,
                          double constant, double operatorNorm) {
  iterate_.g.update(objective_.scale(), gradientChange, 1.0);
  iterate_.f += objective_.scale() * objectiveChange;
  objective_.setLinearTerm(b, constant);
  objective_.raiseNorm(operatorNorm);
}

void Mprgp::refreshGradient() {
  objective_.multiply(iterate_.x, work_.image);
  iterate_.f = objective_.evaluate(iterate_.x, work_.image, iterate_.x, work_.p).objective;
  objective_.gradient(work_.image, iterate_.g);
  iterate_.isFresh = true;
  lastCurvature_.reset(); // Ap is gone
}

void Mprgp::shiftLinearTerm(const Vector& shift, double objectiveShift) {
  objective_.shiftLinearTerm(shift, objectiveShift, iterate_.x);
  iterate_.g.update(objective_.scale(), shift, 1.0);
  iterate_.f += objective_.scale() * objectiveShift;
}

/// All that the loop asks of the split gradient, in one pass and one message. Streams x, g, Ap, l, u. Where
/// the next step will most likely stay in the face, it is preconditioned now, so that its two sums travel
/// along.
void Mprgp::measure(StoppingRule& rule, bool staysInFace) {
  const bool preconditions = staysInFace && preconditioner_.has_value();
  const GradientSums mine = set_->measure(iterate_.x, iterate_.g, work_.image, fixedStep());
  measureReduction_.clear();
  const std::span<AccurateSum> sums = measureReduction_.sums();
  sums[freeSquared] = mine.freeSquared;
  sums[choppedSquared] = mine.choppedSquared;
  sums[reducedTimesFree] = mine.reducedTimesFree;
  sums[freeTimesImage] = mine.freeTimesImage;
  sums[solutionSquared] = mine.solutionSquared;
  sums[active] = AccurateSum(static_cast<double>(mine.active));
  sums[timeIsUp] = AccurateSum(interruption_.timeIsUp() ? 1.0 : 0.0);
  sums[interrupted] = AccurateSum(interruption_.isWanted() ? 1.0 : 0.0);
  sums[look] = AccurateSum(interruption_.isLookWanted() ? 1.0 : 0.0);
  if (preconditions) {
    preconditioner_->applyToFree(*set_, iterate_.x, iterate_.g);
    preconditioner_->addSums(work_.image, sums.subspan(preconditioned));
  }
  rule.addLocalSums(iterate_.x, sums.subspan(numOwnSums));
  measureReduction_.reduce();

  const auto sum = [&](int index) { return measureReduction_.sum(index); };
  now_ = {};
  now_.freeSquared = sum(freeSquared);
  now_.choppedSquared = sum(choppedSquared);
  now_.reducedTimesFree = sum(reducedTimesFree);
  now_.freeTimesImage = sum(freeTimesImage);
  if (preconditions)
    now_.preconditioned = {sum(preconditioned), sum(preconditioned + 1)};
  now_.projectedGradient = std::sqrt(now_.freeSquared + now_.choppedSquared);
  now_.solutionNorm = std::sqrt(sum(solutionSquared));
  now_.active = static_cast<long long>(sum(active));
  now_.timeIsUp = sum(timeIsUp) > 0;
  now_.isInterrupted = sum(interrupted) > 0;
  now_.isLookWanted = sum(look) > 0;
  const double energy = rule.usesEnergy() ? energyOfGradient() : 0.0;
  now_.isSatisfied = rule.isSatisfied({projectedGradient(), energy}, sums.subspan(numOwnSums));
}

/// (g^Pᵀ M g^P)^½: computed where the gradient is fresh, estimated from φᵀMφ elsewhere, or from the last M r.
double Mprgp::energyOfGradient() {
  const double squared = now_.freeSquared + now_.choppedSquared;
  if (now_.preconditioned && now_.freeSquared > 0)
    energyShare_ = now_.preconditioned->energy / now_.freeSquared;
  else if ((iterate_.isFresh || energyShare_ == 0) && squared > 0)
    energyShare_ = preconditioner_->energyOf(*set_, iterate_.x, iterate_.g) / squared;
  // r is scaled by 1/‖A‖.
  return std::sqrt(std::max(0.0, energyShare_ * squared)) / objective_.scale();
}

void Mprgp::record(const StoppingRule& rule, StepKind kind) {
  Observer* const observer = interruption_.observer();
  if (observer == nullptr)
    return;
  StepRecord step;
  step.iteration = counts_.conjugateGradient + counts_.expansion + counts_.proportioning;
  step.outer = counts_.outer;
  step.kind = kind;
  step.projectedGradient = projectedGradient();
  step.objective = objective();
  step.activeBounds = now_.active;
  step.hessianMultiplications = counts_.hessianMultiplications;
  rule.describe(step);
  observer->step(step);
  if (now_.isLookWanted)
    observer->look(iterate_.x);
}

/// ᾱ.
double Mprgp::fixedStep() const {
  return parameters_.expansionStep / (objective_.norm() > 0 ? objective_.norm() : 1.0);
}

} // namespace epafi::qp
