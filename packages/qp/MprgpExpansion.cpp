// The expansion step of MPRGP: where a CG step goes that would leave the set.

#include "epafi/qp/LocalData.hpp"
#include "epafi/qp/Mprgp.hpp"

#include <cmath>
#include <utility>

namespace epafi::qp {

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
  constexpr double slightRise = 1e-3; // of the objective beside its terms: a fixed step mends it
  constexpr int patience = 3;         // with such steps; a bad one is a sign of a wide contact
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
    if (repeats == 0 && parameters_.expansion == Expansion::automatic && !preconditioner_.is_null()) {
      const bool isSlight = trial.objective - halfObjective <= slightRise * trial.size;
      projectionFailures_ += isSlight ? 1 : patience;
      predicts_ = projectionFailures_ >= patience;
    }
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

} // namespace epafi::qp
