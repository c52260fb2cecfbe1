#include "epafi/base/Collective.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/ActiveSetIteration.hpp"
#include "epafi/qp/solve/Feasibility.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::qp {

/// Where faces do not settle: from a point of Ω towards the minimum on its face, as far as Ω goes; what Ω
/// stops there leaves the face. At a minimum those are released that are about as wrong as the worst, or,
/// where that led nowhere, the worst alone (Nocedal, Wright, *Numerical Optimization*, 2006, 16.5). The
/// objective falls, so that no face comes back.
Status ActiveSetIteration::descend() {
  constexpr double aboutAsWrong = 0.1, roundOff = 1e-13;
  constexpr int maxSteps = 40; // of CG, which far from Ω would be for nothing
  double length = 0;
  if (!startInside())
    return Status::stagnated;
  double lowest = std::numeric_limits<double>::max(), least = lowest; // objective and gradient at a minimum
  for (int numIdle = 0; numIdle <= maxIdleFaces;) {
    on_.enter();
    gradient_ = on_.gradientNorm();
    record(StepKind::expansion);
    if (!std::isfinite(gradient_))
      return Status::notFinite;
    if (isSolved())
      return Status::converged;
    copy(on_.x, inside_);
    set_->project(inside_);
    const auto status = minimise(length == 1 ? maxFaceSteps : maxSteps);
    if (status && *status != Status::unbounded && *status != Status::stagnated) {
      copy(inside_, on_.x);
      return *status;
    }
    best_.update(1.0, inside_, -1.0, on_.x, 0.0);
    length = follow(best_, 1);
    if (length == 1) {
      const bool isBetter =
          lowest - on_.objective() > roundOff * std::abs(lowest) || on_.gradientNorm() < 0.9 * least;
      numIdle = isBetter ? 0 : numIdle + 1;
      lowest = std::min(lowest, on_.objective());
      least = std::min(least, on_.gradientNorm());
    }
    if (length == 1 && !status) {
      release(numIdle > 0 ? 1 : aboutAsWrong);
    } else if (length == 1 && *status == Status::unbounded) { // a face without a minimum
      best_.update(on_.slope() > 0 ? 1.0 : -1.0, on_.direction(), 0.0);
      length = follow(best_, std::numeric_limits<double>::infinity());
      if (std::isinf(length))
        return Status::unbounded;
    }
    copy(inside_, on_.x);
    ++counts_.expansion;
  }
  return Status::stagnated;
}

/// Where multipliers are more wrong than the face's minimum is inexact, those may move whose are so to a
/// share of the worst one's. Collective.
void ActiveSetIteration::release(double share) {
  set_->choppedGradient(inside_, on_.gradient(), negligibleShare * on_.gradientNorm(), work_);
  if (accurateNorm(work_) <= on_.gradientNorm())
    return;
  const double least = share * work_.normInf();
  const auto wrong = localData(work_);
  const auto face = localDataNonConst(on_.face.isFree);
  for (std::size_t i = 0; i < face.size(); ++i)
    if (wrong[i] != 0 && std::abs(wrong[i]) >= least)
      face[i] = 1;
}

/// Moves the point inside along −p, as far as Ω goes and at most so far; what Ω stops leaves the face.
/// Returns how far. Collective.
double ActiveSetIteration::follow(const Vector& p, double most) {
  constexpr double onto = 1 + 1e-14; // and not just before it
  const double length = minOverRanks(*p.getMap()->getComm(), set_->maxFeasibleStep(inside_, p));
  if (length >= most) {
    if (std::isfinite(most))
      set_->move(most, p, inside_);
    return most;
  }
  set_->move(onto * length, p, inside_);
  next_.isFree.update(1.0, inside_, -1.0, p, 0.0);
  copy(next_.isFree, work_);
  set_->project(work_);
  set_->freeIndicator(inside_, on_.x);
  const auto outside = localData(next_.isFree), projected = localData(work_), isFree = localData(on_.x);
  const auto face = localDataNonConst(on_.face.isFree);
  for (std::size_t i = 0; i < face.size(); ++i)
    if (isFree[i] == 0 && outside[i] != projected[i])
      face[i] = 0;
  return length;
}

/// Moves the best point, or the start if that is better then, into Ω and onto Bx = c. Collective.
bool ActiveSetIteration::startInside() {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector* const from : {&start_, &best_}) {
    copy(*from, on_.x);
    set_->project(on_.x);
    if (!program_.equality.is_null() && !findFeasiblePoint(program_.equality, program_.set, on_.x).isFeasible)
      continue;
    copy(on_.x, next_.isFree);
    set_->freeIndicator(on_.x, on_.face.isFree);
    on_.enter();
    if (on_.objective() < least) {
      least = on_.objective();
      copy(next_.isFree, inside_);
    }
  }
  copy(inside_, on_.x);
  set_->freeIndicator(on_.x, on_.face.isFree);
  return std::isfinite(least);
}

} // namespace epafi::qp
