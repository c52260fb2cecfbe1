// The expansion that predicts the active set. Where many entries near their bounds depend on each other, as the forces of a
// wide contact do, the projection of one CG step is no good: what it cuts off had balanced the rest. A primal–dual active
// set method (Hintermüller, Ito, Kunisch, SIAM J. Optim. 13 (2003)) goes on from there,
//   minimise on the face as if it had no bounds;  put the entries that leave the set on their bounds;
//   take those off whose multipliers have the wrong sign,
// through points that may be worse than the first. It may also cycle. Here it only proposes: the best of its points counts,
// if it is better than x^½, so that MPRGP converges as it does with the other expansions (Moré, Toraldo, SIAM J. Optim. 1
// (1991), look for a face that way by gradient projection).

#include "epafi/qp/LocalData.hpp"
#include "epafi/qp/Mprgp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::qp {
namespace {

constexpr int maxRounds = 20;
constexpr int maxFaceSteps = 30;  ///< of CG in a face
constexpr double reduction = 0.1; ///< of the gradient in a face
constexpr double wrongShare =
    0.1; ///< multipliers as wrong as this share of the worst one come off their bounds
constexpr double leastCurvature = 1e-12; ///< pᵀAp beside ‖A‖ pᵀp
constexpr int longestPause = 64;         ///< expansions after predictions that failed

} // namespace

/// Makes x the best point of a prediction, with its gradient, if it is better than x^½; else x and g stay what they
/// are. p and Ap are lost.
bool Mprgp::predictActiveSet(StepKind intent, double halfObjective) {
  if (bestX_.is_null()) {
    for (RCP<Vector>* vector : {&face_, &released_, &bestX_, &bestG_})
      *vector = rcp(new Vector(a_->getDomainMap()));
    if (preconditioner_.is_null()) {
      residual_ = rcp(new Vector(a_->getDomainMap()));
      z_ = rcp(new Vector(a_->getDomainMap()));
    }
  }
  bestX_->assign(x_);
  bestG_->assign(g_);
  double best = halfObjective, target = 0;
  bool isFound = false;
  for (int round = 0; round < maxRounds; ++round) {
    takeBoundsOff(intent, round == 0);
    if (!minimiseOnFace(target)) { // x may leave the set
      predicts_ = false;
      break;
    }
    p_.assign(x_);
    set_->project(p_);
    const Trial trial = tryPoint();
    const bool isInside = !(trial.squared > 0); // P(x) = x
    std::swap(x_, p_);
    if (trial.objective < best) {
      best = trial.objective;
      bestX_->assign(x_);
      bestG_->assign(g_);
      isFound = true;
    }
    if (isInside || !std::isfinite(trial.objective) ||
        counts_.hessianMultiplications >= parameters_.maxMultiplications)
      break;
  }
  x_.assign(*bestX_);
  g_.assign(*bestG_);
  if (isFound) {
    objective_ = best;
    gradientIsFresh_ = true;
    failures_ = 0;
    return true;
  }
  ++counts_.safeguards;
  pause_ = std::min(1 << std::min(failures_++, 6), longestPause);
  return false;
}

/// The face of x with, in a step that leaves it or in later rounds, entries off their bounds whose multipliers have the wrong
/// sign. From the second round on only the worst of these: most others only follow what the projection did.
void Mprgp::takeBoundsOff(StepKind intent, bool isFirst) {
  set_->freeIndicator(x_, *face_);
  if (isFirst && intent == StepKind::conjugateGradient)
    return;
  set_->choppedGradient(x_, g_, 1e-12 * projectedGradient_, *released_);
  const double atLeast = isFirst ? 0.0 : wrongShare * released_->normInf();
  const auto wrong = localData(*released_);
  const auto face = localDataNonConst(*face_);
  for (std::size_t i = 0; i < face.size(); ++i)
    if (wrong[i] != 0 && std::abs(wrong[i]) >= atLeast)
      face[i] = 1;
}

/// CG in the face, from x with its gradient g, until rᵀMr has fallen below `reduction`² times itself or what it was in the
/// first round, `target` (0: this is the first). False if it does not get there, as on a face without a
/// minimum (such problems are left to the other expansions), or if the run is to end.
bool Mprgp::minimiseOnFace(double& target) {
  double curvature = 0, goal = 0;
  for (int k = 0; k <= maxFaceSteps; ++k) {
    const auto face = localData(*face_);
    {
      const auto g = localData(g_);
      const auto r = localDataNonConst(*residual_);
      for (std::size_t i = 0; i < r.size(); ++i)
        r[i] = face[i] * g[i];
    }
    if (preconditioner_.is_null())
      z_->assign(*residual_);
    else
      precondition();
    {
      const auto z = localDataNonConst(*z_);
      for (std::size_t i = 0; i < z.size(); ++i)
        z[i] *= face[i];
    }
    stepReduction_.clear();
    addPreconditionedSums(stepReduction_.sums());
    stepReduction_.sums()[2] = AccurateSum(timeIsUpHere() || isToStopHere() ? 1.0 : 0.0);
    stepReduction_.reduce();
    const double residual = stepReduction_.sum(0), image = scale_ * stepReduction_.sum(1);
    if (k == 0) {
      target = target > 0 ? target : residual;
      goal = reduction * reduction * std::min(residual, target);
    }
    if (!(residual > goal))
      return true;
    if (k == maxFaceSteps || counts_.hessianMultiplications >= parameters_.maxMultiplications ||
        stepReduction_.sum(2) > 0)
      return false;
    const double conjugation = k == 0 ? 0.0 : image / curvature;
    {
      const auto z = localData(*z_);
      const auto p = localDataNonConst(p_);
      for (std::size_t i = 0; i < p.size(); ++i)
        p[i] = z[i] - (k == 0 ? 0.0 : conjugation * p[i]);
    }
    applyHessian(p_, ap_);
    const StepSizes sizes = stepSizes();
    if (!(sizes.curvature > leastCurvature * norm_ * sizes.squared))
      return false;
    curvature = sizes.curvature;
    addScaled(-sizes.slope / sizes.curvature, p_, x_);
    addScaled(-sizes.slope / sizes.curvature * scale_, ap_, g_);
  }
  return true;
}

} // namespace epafi::qp
