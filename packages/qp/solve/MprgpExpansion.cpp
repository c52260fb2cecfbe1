// The expansion step of MPRGP: where a CG step goes that would leave the set.

#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Mprgp.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace epafi::qp {

/// x^½ = x − α_f p, then, if that is only a small part of the step, a trial point beyond it that must not
/// raise the objective.
std::optional<Status> Mprgp::expand(const StepSizes& sizes, StepKind intent) {
  ++counts_.expansion;
  stepsInFace_ = 0;
  lastCurvature_.reset();
  const bool hasCurvature = sizes.curvature > objective_.zeroCurvature(sizes.squared);
  if (parameters_.expansion == Expansion::activeSet && !prediction_)
    prediction_ = makePrediction();
  if (prediction_ && hasCurvature && prediction_->isDue()) {
    const double half =
        iterate_.f + sizes.feasible * (0.5 * sizes.feasible * sizes.curvature - sizes.slope); // f(x^½)
    if (prediction_->improve(iterate_, half, intent == StepKind::proportioning,
                             negligibleShare * now_.projectedGradient, work_))
      return std::nullopt;
    copy(iterate_.g, work_.p);
    return descend(fixedStep(), true);
  }
  move(sizes.feasible, sizes);
  if (parameters_.sufficientShare < 1 &&
      sizes.feasible * sizes.curvature >= parameters_.sufficientShare * sizes.slope)
    return std::nullopt; // x^½ is good enough
  if (parameters_.expansion != Expansion::fixedStep && hasCurvature)
    return descend(sizes.slope / sizes.curvature - sizes.feasible, false); // P(x − α_cg p)
  setFixedDirection();
  return descend(fixedStep(), true); // P(x^½ − ᾱ φ(x^½))
}

/// p = φ; where a boundary is curved g, as only P(x − ᾱg) lowers the objective along it for certain.
void Mprgp::setFixedDirection() {
  if (set_->isCurved())
    copy(iterate_.g, work_.p);
  else
    set_->subtractFromFreeGradient(iterate_.x, iterate_.g, 0.0, work_.p);
}

/// x becomes P(x − length · p) if the objective does not grow by it; else a point nearer along φ, with ᾱ‖A‖ <
/// 2: should that one raise the objective too, ‖A‖ was underestimated, and the step shows by how much.
/// \param isFixedStep  whether length = ᾱ, and p the gradient or its free part
std::optional<Status> Mprgp::descend(double length, bool isFixedStep) {
  constexpr int maxCorrections = 40;
  auto& [p, image, trialPoint] = work_;
  for (int corrections = 0; corrections <= maxCorrections; ++corrections) {
    copy(iterate_.x, trialPoint);
    set_->move(length, p, trialPoint);
    objective_.multiply(trialPoint, image);
    const Trial trial = objective_.evaluate(trialPoint, image, iterate_.x, p);
    if (!std::isfinite(trial.objective))
      return Status::notFinite;
    const double rise = trial.objective - iterate_.f;
    if (trial.objective <= iterate_.f + 1e-13 * (std::abs(iterate_.f) + trial.size)) {
      std::swap(iterate_.x, trialPoint);
      objective_.gradient(image, iterate_.g);
      iterate_.f = trial.objective;
      iterate_.isFresh = true;
      return std::nullopt;
    }
    ++counts_.safeguards;
    if (corrections == 0)
      noteRise(rise, trial.size);
    if (objective_.isSpent())
      return Status::maxIterations;
    if (!isFixedStep)
      setFixedDirection();
    else if (trial.squared > 0) // dᵀAd = 2(f(x + d) − f(x) − gᵀd)
      objective_.correctNorm(std::max(objective_.norm(), 2 * (rise - trial.slope) / trial.squared));
    isFixedStep = true;
    length = fixedStep();
  }
  return Status::stagnated;
}

/// With `auto`, and a preconditioner, predictions take over from projections that fail: a few that raise the
/// objective by a little, which a fixed step mends, or one that raises it by much, a sign of a wide contact.
void Mprgp::noteRise(double rise, double size) {
  constexpr double slight = 1e-3; // of the objective's terms
  constexpr int patience = 3;
  if (parameters_.expansion != Expansion::automatic || !preconditioner_)
    return;
  projectionFailures_ += rise <= slight * size ? 1 : patience;
  if (projectionFailures_ < patience)
    return;
  if (!prediction_)
    prediction_ = makePrediction();
  prediction_->resume();
}

std::unique_ptr<ActiveSetPrediction> Mprgp::makePrediction() {
  return std::make_unique<ActiveSetPrediction>(
      objective_, *set_, preconditioner_ ? &*preconditioner_ : nullptr, interruption_, counts_);
}

} // namespace epafi::qp
