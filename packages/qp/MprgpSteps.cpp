// The passes of MPRGP over its vectors.

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
  sums[6] = AccurateSum(timeIsUpHere() ? 1.0 : 0.0);
  sums[7] = AccurateSum(isToStopHere() ? 1.0 : 0.0);
  sums[8] = AccurateSum(observer_ != nullptr && observer_->wantsToLook() ? 1.0 : 0.0);
  if (isForeseen_) {
    set_->subtractFromFreeGradient(x_, g_, 0.0, *residual_);
    precondition();
    set_->restrictToFree(x_, *z_);
    addPreconditionedSums(sums.subspan(9));
  }
  rule.addLocalSums(x_, sums.subspan(numOwnSums));
  measureReduction_.reduce();
  freeSquared_ = measureReduction_.sum(0);
  choppedSquared_ = measureReduction_.sum(1);
  reducedTimesFree_ = measureReduction_.sum(2);
  directionTimesImage_ = scale_ * measureReduction_.sum(isForeseen_ ? 10 : 3);
  residualTimesZ_ = measureReduction_.sum(9);
  solutionNorm_ = std::sqrt(measureReduction_.sum(4));
  active_ = static_cast<long long>(measureReduction_.sum(5));
  timeIsUp_ = measureReduction_.sum(6) > 0;
  isInterrupted_ = measureReduction_.sum(7) > 0;
  isLookedAt_ = measureReduction_.sum(8) > 0;
  projectedGradient_ = std::sqrt(freeSquared_ + choppedSquared_);
  const double energy = rule.usesEnergy() ? energyOfGradient() : 0.0;
  isSatisfied_ = rule.isSatisfied({projectedGradient(), energy}, sums.subspan(numOwnSums));
}

/// (g^Pᵀ M g^P)^½: computed where the gradient is fresh, estimated from φᵀMφ elsewhere, or from the last M r.
double Mprgp::energyOfGradient() {
  const double squared = freeSquared_ + choppedSquared_;
  if (isForeseen_ && freeSquared_ > 0) {
    energyShare_ = residualTimesZ_ / freeSquared_;
  } else if ((gradientIsFresh_ || energyShare_ == 0) && squared > 0) {
    set_->projectedGradient(x_, g_, 0.0, *residual_);
    precondition();
    stepReduction_.clear();
    addPreconditionedSums(stepReduction_.sums());
    stepReduction_.reduce();
    energyShare_ = stepReduction_.sum(0) / squared;
  }
  // r is scaled by 1/‖A‖.
  return std::sqrt(std::max(0.0, energyShare_ * squared)) / scale_;
}

} // namespace epafi::qp
