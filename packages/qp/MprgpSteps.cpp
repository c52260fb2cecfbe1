// The passes of MPRGP over its vectors, and its expansion step.

#include "epafi/qp/LocalData.hpp"
#include "epafi/qp/Mprgp.hpp"
#include "epafi/qp/Timing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::qp {

void Mprgp::start(const Vector& b, const Vector& x0, double constant) {
  b_.assign(b);
  linearNorm_ = scale_ * accurateNorm(b_);
  x_.assign(x0);
  set_->project(x_);
  constant_ = scale_ * constant;
  if (!lastX_.is_null())
    lastX_->assign(x_);
  if (x_.normInf() == 0) { // g = −b needs no product
    g_.update(-scale_, b_, 0.0);
    objective_ = constant_;
    gradientIsFresh_ = true;
  } else {
    refreshGradient();
  }
  if (!lastG_.is_null())
    lastG_->assign(g_);
}

void Mprgp::changeHessian(const Vector& gradientChange, double objectiveChange, const Vector& b,
                          double constant, double operatorNorm) {
  g_.update(scale_, gradientChange, 1.0);
  objective_ += scale_ * objectiveChange;
  b_.assign(b);
  linearNorm_ = scale_ * accurateNorm(b_);
  constant_ = scale_ * constant;
  norm_ = std::max(norm_, scale_ * operatorNorm);
}

void Mprgp::refreshGradient() {
  const Trial fresh = tryAlong(x_, 0.0);
  accept(fresh);
}

void Mprgp::shiftLinearTerm(const Vector& shift, double objectiveShift) {
  b_.update(-1.0, shift, 1.0);
  g_.update(scale_, shift, 1.0);
  linearNorm_ = scale_ * accurateNorm(b_);
  objective_ += scale_ * objectiveShift;
  constant_ += scale_ * (objectiveShift - accurateDot(shift, x_));
}

void Mprgp::applyHessian(const Vector& x, Vector& ax) {
  const Timing timing(*hessianTimer_);
  a_->apply(x, ax);
  ++counts_.hessianMultiplications;
}

/// z = M r for r = `residual_`.
void Mprgp::precondition() {
  const Timing timing(*preconditionerTimer_);
  preconditioner_->apply(*residual_, *z_);
  ++counts_.preconditionerApplications;
}

/// p for the step that is meant: in the face z = φ, or M φ on the free set; out of it z = φ + β, or M(φ + β) where the
/// set lets it move, or β alone.
std::optional<Status> Mprgp::setDirection(StepKind intent) {
  const bool isInFace = intent == StepKind::conjugateGradient;
  const double negligible = 1e-12 * projectedGradient_;
  if (!isInFace && parameters_.release == Release::choppedGradient) {
    set_->choppedGradient(x_, g_, negligible, p_);
    return std::nullopt;
  }
  if (preconditioner_.is_null()) {
    if (isInFace)
      set_->subtractFromFreeGradient(x_, g_, conjugate_ ? directionTimesImage_ / curvature_ : 0.0, p_);
    else
      set_->projectedGradient(x_, g_, negligible, p_);
    return std::nullopt;
  }
  if (!isInFace || !isForeseen_) {
    if (isInFace)
      set_->subtractFromFreeGradient(x_, g_, 0.0, *residual_);
    else
      set_->projectedGradient(x_, g_, negligible, *residual_);
    precondition();
    if (isInFace)
      set_->restrictToFree(x_, *z_);
    else
      set_->restrictToReleased(x_, g_, negligible, *z_);
    stepReduction_.clear();
    addPreconditionedSums(stepReduction_.sums());
    stepReduction_.reduce();
    residualTimesZ_ = stepReduction_.sum(0);
    directionTimesImage_ = scale_ * stepReduction_.sum(1);
  }
  if (!std::isfinite(residualTimesZ_))
    return Status::notFinite;
  if (!(residualTimesZ_ > 0)) // rᵀMr ≤ 0: no descent, M is not positive definite
    return Status::indefinitePreconditioner;
  const bool conjugates = isInFace && conjugate_;
  const double conjugation = conjugates ? directionTimesImage_ / curvature_ : 0.0;
  const auto z = localData(*z_);
  const auto p = localDataNonConst(p_);
  for (std::size_t i = 0; i < p.size(); ++i)
    p[i] = z[i] - (conjugates ? conjugation * p[i] : 0.0);
  return std::nullopt;
}

/// rᵀz and zᵀAp, this rank's shares.
void Mprgp::addPreconditionedSums(std::span<AccurateSum> sums) const {
  const auto r = localData(*residual_), z = localData(*z_), ap = localData(ap_);
  for (std::size_t i = 0; i < z.size(); ++i) {
    sums[0].add(r[i] * z[i]);
    sums[1].add(z[i] * ap[i]);
  }
}

/// pᵀAp, gᵀp, pᵀp and α_f in one message. Streams p, Ap, g, then x, p, l, u.
Mprgp::StepSizes Mprgp::stepSizes() {
  const auto g = localData(g_), p = localData(p_), ap = localData(ap_);
  AccurateSum curvature, slope, squared;
  for (std::size_t i = 0; i < p.size(); ++i) {
    curvature.add(p[i] * ap[i]);
    slope.add(g[i] * p[i]);
    squared.add(p[i] * p[i]);
  }
  stepReduction_.clear();
  stepReduction_.sums()[0] = curvature;
  stepReduction_.sums()[1] = slope;
  stepReduction_.sums()[2] = squared;
  stepReduction_.setMinimum(set_->maxFeasibleStep(x_, p_));
  stepReduction_.reduce();
  const StepSizes sizes{scale_ * stepReduction_.sum(0), stepReduction_.sum(1), stepReduction_.sum(2),
                        stepReduction_.minimum()};
  if (sizes.squared > 0 && sizes.curvature > norm_ * sizes.squared) // a Rayleigh quotient above ‖A‖
    correctNorm(sizes.curvature / sizes.squared);
  return sizes;
}

void Mprgp::correctNorm(double rayleighQuotient) {
  constexpr double margin = 1.05; // quotients approach the norm from below
  norm_ = margin * rayleighQuotient;
  ++counts_.normCorrections;
}

/// x −= αp, g −= αAp, f follows: f(x − αp) = f − α gᵀp + ½α² pᵀAp. Streams x, g, p, Ap, l, u.
void Mprgp::move(double length, const StepSizes& sizes) {
  set_->move(length, p_, x_); // feasible already but for the last digit
  addScaled(-length * scale_, ap_, g_);
  objective_ += length * (0.5 * length * sizes.curvature - sizes.slope);
  gradientIsFresh_ = false;
}

/// x^½ = x − α_f p, then, if that is only a small part of the step, a trial point beyond it that must not raise the
/// objective.
std::optional<Status> Mprgp::expansionStep(const StepSizes& sizes, StepKind intent) {
  ++counts_.expansion;
  const bool hasCurvature = sizes.curvature > 1e-14 * norm_ * sizes.squared;
  conjugate_ = false;
  if (predicts_ && hasCurvature && pause_-- <= 0) {
    const double half =
        objective_ + sizes.feasible * (0.5 * sizes.feasible * sizes.curvature - sizes.slope); // f(x^½)
    if (predictActiveSet(intent, half))
      return std::nullopt;
    set_->projectedGradient(x_, g_, 0.0, ap_); // p is gone
    return safeTrial(tryAlong(ap_, parameters_.expansionStep / (norm_ > 0 ? norm_ : 1.0)));
  }
  move(sizes.feasible, sizes);
  if (sufficientShare_ < 1 && sizes.feasible * sizes.curvature >= sufficientShare_ * sizes.slope)
    return std::nullopt; // x^½ is good enough
  const bool projects = parameters_.expansion == Expansion::projectedCg ||
                        parameters_.expansion == Expansion::automatic ||
                        parameters_.expansion == Expansion::activeSet;
  if (projects && hasCurvature) {
    set_->subtractFromFreeGradient(x_, g_, 0.0, ap_); // φ(x^½), for the safeguard
    return safeTrial(tryAlong(p_, sizes.slope / sizes.curvature - sizes.feasible));
  }
  set_->subtractFromFreeGradient(x_, g_, 0.0, ap_);
  return safeTrial(tryAlong(ap_, expansionLength(sizes)));
}

/// Length of the step along φ(x^½), which Ap holds.
double Mprgp::expansionLength(const StepSizes& /*sizes*/) {
  const double fixed = parameters_.expansionStep / (norm_ > 0 ? norm_ : 1.0);
  AccurateSum numerator, denominator;
  if (parameters_.expansion == Expansion::optimal) { // φᵀφ/φᵀAφ
    applyHessian(ap_, p_);
    const auto free = localData(ap_), image = localData(p_);
    for (std::size_t i = 0; i < free.size(); ++i) {
      numerator.add(free[i] * free[i]);
      denominator.add(scale_ * free[i] * image[i]);
    }
  } else if (parameters_.expansion == Expansion::barzilaiBorwein) { // sᵀs/sᵀy
    const auto x = localData(x_), g = localData(g_), lastX = localData(*lastX_), lastG = localData(*lastG_);
    for (std::size_t i = 0; i < x.size(); ++i) {
      numerator.add((x[i] - lastX[i]) * (x[i] - lastX[i]));
      denominator.add((x[i] - lastX[i]) * (g[i] - lastG[i]));
    }
  } else {
    return fixed;
  }
  stepReduction_.clear();
  stepReduction_.sums()[0] = numerator;
  stepReduction_.sums()[1] = denominator;
  stepReduction_.reduce();
  const double length = stepReduction_.sum(0) / stepReduction_.sum(1);
  return std::isfinite(length) && length > 0 ? length : fixed;
}

/// Goes to the trial point if the objective does not grow by it; else to a shorter one along φ(x^½), with ᾱ‖A‖ < 2:
/// should that one raise the objective too, ‖A‖ was underestimated, and the step shows by how much.
std::optional<Status> Mprgp::safeTrial(Trial trial) {
  constexpr int maxCorrections = 40;
  const double halfObjective = objective_;
  for (int repeats = 0; repeats <= maxCorrections; ++repeats) {
    if (!std::isfinite(trial.objective)) // x is x^½ still
      return Status::notFinite;
    if (trial.objective <= halfObjective + 1e-13 * (std::abs(halfObjective) + trial.size)) {
      std::swap(x_, p_);
      accept(trial);
      if (!lastX_.is_null()) {
        lastX_->assign(x_);
        lastG_->assign(g_);
      }
      return std::nullopt;
    }
    ++counts_.safeguards;
    predicts_ = predicts_ || (parameters_.expansion == Expansion::automatic && !preconditioner_.is_null());
    if (counts_.hessianMultiplications >= parameters_.maxMultiplications)
      break;
    const bool wasFixed = repeats > 0 || parameters_.expansion == Expansion::fixedStep;
    if (wasFixed && trial.squared > 0) // dᵀAd = 2(f(x^½ + d) − f(x^½) − φᵀd)
      correctNorm(std::max(norm_, 2 * (trial.objective - halfObjective - trial.gradient) / trial.squared));
    trial = tryAlong(ap_, parameters_.expansionStep / (norm_ > 0 ? norm_ : 1.0));
  }
  refreshGradient();
  return counts_.hessianMultiplications >= parameters_.maxMultiplications ? Status::maxIterations
                                                                          : Status::stagnated;
}

/// The point P(x − length · direction) goes into p, its gradient into g. The direction may be p itself. Ap, which holds
/// φ(x^½), is left alone.
Mprgp::Trial Mprgp::tryAlong(const Vector& direction, double length) {
  const auto start = localData(x_), along = localData(direction);
  const auto trialPoint = localDataNonConst(p_);
  for (std::size_t i = 0; i < trialPoint.size(); ++i)
    trialPoint[i] = start[i] - length * along[i];
  set_->project(p_);
  return tryPoint();
}

/// The gradient at the point that p holds goes into g.
Mprgp::Trial Mprgp::tryPoint() {
  applyHessian(p_, g_);
  const auto trial = localData(p_), half = localData(x_), b = localData(b_), free = localData(ap_);
  const auto g = localDataNonConst(g_);
  AccurateSum quadratic, linear, squared, gradient, linearSquared;
  for (std::size_t i = 0; i < trial.size(); ++i) {
    const double d = trial[i] - half[i];
    quadratic.add(trial[i] * g[i]);
    linear.add(trial[i] * b[i]);
    squared.add(d * d);
    gradient.add(d * free[i]);
    g[i] = scale_ * (g[i] - b[i]);
  }
  stepReduction_.clear();
  const auto sums = stepReduction_.sums();
  sums[0] = quadratic;
  sums[1] = linear;
  sums[2] = squared;
  sums[3] = gradient;
  stepReduction_.reduce();
  const double xax = scale_ * stepReduction_.sum(0), xb = scale_ * stepReduction_.sum(1);
  return {0.5 * xax - xb + constant_, std::abs(xax) + std::abs(xb), stepReduction_.sum(2),
          stepReduction_.sum(3)};
}

void Mprgp::accept(const Trial& trial) {
  objective_ = trial.objective;
  gradientIsFresh_ = true;
}

/// All that the loop asks of the split gradient, in one pass and one message. Streams x, g, Ap, l, u. Where the next
/// step will most likely stay in the face, it is preconditioned now, so that its two sums travel along.
void Mprgp::measure(StoppingRule& rule) {
  isForeseen_ = staysInFace_;
  staysInFace_ = false;
  const GradientSums mine = set_->measure(x_, g_, ap_, parameters_.expansionStep / (norm_ > 0 ? norm_ : 1.0));
  measureReduction_.clear();
  const std::span<AccurateSum> sums = measureReduction_.sums();
  sums[0] = mine.freeSquared;
  sums[1] = mine.choppedSquared;
  sums[2] = mine.reducedTimesFree;
  sums[3] = mine.freeTimesImage;
  sums[4] = mine.solutionSquared;
  sums[5] = AccurateSum(static_cast<double>(mine.active));
  sums[6] = AccurateSum(deadline_ > 0 && Teuchos::Time::wallTime() > deadline_ ? 1.0 : 0.0);
  if (isForeseen_) {
    set_->subtractFromFreeGradient(x_, g_, 0.0, *residual_);
    precondition();
    set_->restrictToFree(x_, *z_);
    addPreconditionedSums(sums.subspan(7));
  }
  rule.addLocalSums(x_, sums.subspan(numOwnSums));
  measureReduction_.reduce();
  freeSquared_ = measureReduction_.sum(0);
  choppedSquared_ = measureReduction_.sum(1);
  reducedTimesFree_ = measureReduction_.sum(2);
  directionTimesImage_ = scale_ * measureReduction_.sum(isForeseen_ ? 8 : 3);
  residualTimesZ_ = measureReduction_.sum(7);
  solutionNorm_ = std::sqrt(measureReduction_.sum(4));
  active_ = static_cast<long long>(measureReduction_.sum(5));
  timeIsUp_ = measureReduction_.sum(6) > 0;
  projectedGradient_ = std::sqrt(freeSquared_ + choppedSquared_);
  isSatisfied_ = rule.isSatisfied(projectedGradient(), sums.subspan(numOwnSums));
}

} // namespace epafi::qp
