// Which face is next.

#include "epafi/base/Collective.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/ActiveSetIteration.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace epafi::qp {

/// That of the start; at the origin, where it says nothing, that of Mb, as if M were A⁻¹. What is bounded on
/// all sides, as forces of friction are, stays free where it is.
void ActiveSetIteration::chooseFirstFace(const QuadraticProgram& program) {
  copy(on_.x, inside_);
  if (on_.x.normInf() == 0 && !program.preconditioner.is_null()) {
    program.preconditioner->apply(objective_.linearTerm(), inside_);
    ++counts_.preconditionerApplications;
  }
  if (program.setAt)
    set_ = program.setAt(inside_);
  set_->project(inside_);
  set_->freeIndicator(inside_, on_.face.isFree);
  const RCP<const ConvexSet> cone = set_->recessionCone(objective_.map());
  work_.putScalar(1.0);
  next_.isFree.putScalar(-1.0);
  cone->project(work_);
  cone->project(next_.isFree);
  set_->freeIndicator(on_.x, inside_);
  const auto up = localData(work_), down = localData(next_.isFree), free = localData(inside_);
  const auto face = localDataNonConst(on_.face.isFree);
  for (std::size_t i = 0; i < face.size(); ++i)
    if (up[i] == 0 && down[i] == 0)
      face[i] = std::max(face[i], free[i]);
}

/// The next face: x is projected, and may move where no bound holds it or the multiplier of one has the wrong
/// sign; with caution only where it is the largest of these. Bounds are followed where few entries change:
/// among many it is not known yet which way what slips does. False if that is the present face.
bool ActiveSetIteration::chooseFace(bool isCautious) {
  const Vector& gradient = on_.plainGradient();
  copy(on_.x, inside_);
  followSet(gradient);
  set_->project(inside_);
  const double negligible = negligibleShare * on_.gradientNorm();
  set_->choppedGradient(inside_, gradient, negligible, work_);
  const double least = std::max(negligible, isCautious ? work_.normInf() : 0.0);
  constexpr double few = 0.1;  // beside what follows
  constexpr double most = 0.3; // of the gradient that is left, by what the boundary has moved
  set_->freeIndicator(inside_, next_.isFree);
  reduction_.clear();
  {
    const auto on = localData(on_.face.isFree), wrong = localData(work_), x = localData(on_.x),
               inside = localData(inside_);
    const auto next = localDataNonConst(next_.isFree);
    for (std::size_t i = 0; i < next.size(); ++i)
      if (on[i] == 0 && next[i] == 0)
        next[i] = wrong[i] != 0 && std::abs(wrong[i]) >= least ? 1 : 0;
    set_->followBoundary(inside_, gradient, least, &on_.face, next_);
    const auto sums = reduction_.sums();
    for (std::size_t i = 0; i < next.size(); ++i) {
      sums[0].add(next[i] != on[i] ? 1.0 : 0.0);
      sums[1].add(1 - next[i]);
      sums[2].add((x[i] - inside[i]) * (x[i] - inside[i]));
      sums[4].add(x[i] * x[i]);
    }
    sums[0].add(isSameFace() ? 0.0 : 1.0);
    sums[3].add(static_cast<double>(next_.followers.size()));
  }
  reduction_.reduce();
  numActive_ = static_cast<long long>(reduction_.sum(1));
  if (!program_.setAt || reduction_.sum(0) > few * reduction_.sum(3))
    next_.followers.clear();
  const bool hasMoved =
      hasMovingBoundary() && on_.stiffness() * std::sqrt(reduction_.sum(2)) > most * on_.gradientNorm();
  if (reduction_.sum(0) == 0 && !hasMoved)
    return false;
  // g as CG updates it will do where the tolerance is far from its round-off.
  constexpr double roundOff = 1e3 * std::numeric_limits<double>::epsilon();
  const bool isKnown =
      !hasMovingBoundary() && reduction_.sum(2) == 0 &&
      enough() >= roundOff * (objective_.norm() * std::sqrt(reduction_.sum(4)) + objective_.linearNorm());
  point_ = isKnown ? FaceIteration::Point::reached : FaceIteration::Point::elsewhere;
  copy(inside_, on_.x);
  copy(next_, on_.face);
  if (program_.setAt)
    set_->fixedIndicator(fixed_);
  return true;
}

/// Ω(x) for the point inside; what is at a bound there, or on a circle, moves along with it. What had to stay
/// on the last face and may move now, the friction of a node that has closed, goes against its slip as far as
/// the set lets it: it slips, and the next face tells whether it sticks.
void ActiveSetIteration::followSet(const Vector& gradient) {
  constexpr double far = 1e3; // beside what undoes a slip
  if (!program_.setAt)
    return;
  set_ = program_.setAt(inside_);
  const auto on = localData(on_.face.isFree);
  const auto held = localDataNonConst(next_.isFree);
  for (std::size_t i = 0; i < held.size(); ++i)
    held[i] = 1 - on[i];
  for (const CircleTangent& tangent : on_.face.tangents)
    held[tangent.first] = held[tangent.second] = 1;
  set_->activate(next_.isFree, inside_);
  const auto wasHeld = localData(fixed_), slope = localData(gradient);
  const auto direction = localDataNonConst(work_);
  for (std::size_t i = 0; i < direction.size(); ++i)
    direction[i] = wasHeld[i] * slope[i];
  set_->move(far / on_.stiffness(), work_, inside_);
}

/// Whether the next face has the tangents of this one's circles; on this rank.
bool ActiveSetIteration::isSameFace() const {
  return std::equal(
      next_.tangents.begin(), next_.tangents.end(), on_.face.tangents.begin(), on_.face.tangents.end(),
      [](const CircleTangent& next, const CircleTangent& now) { return next.first == now.first; });
}

/// Where the face cannot hold Bx = c, lets those move that first stop the motion which is left: along it the
/// multipliers of bounds fall. False if nothing stops it.
bool ActiveSetIteration::balance() {
  constexpr double hindering = 1e-9; // beside what hinders it most
  on_.unbalanced(work_);
  const double least = hindering * work_.normInf();
  set_->releases(inside_, on_.plainGradient(), work_, least, next_.isFree);
  const auto distance = localData(next_.isFree);
  const auto face = localDataNonConst(on_.face.isFree);
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < face.size(); ++i)
    if (face[i] == 0)
      first = std::min(first, distance[i]);
  for (const CircleTangent& tangent : on_.face.tangents)
    first = std::min(first, distance[tangent.first]);
  first = minOverRanks(*work_.getMap()->getComm(), first);
  if (!std::isfinite(first))
    return false;
  const double most = (1 + hindering) * first;
  for (std::size_t i = 0; i < face.size(); ++i)
    if (distance[i] <= most)
      face[i] = 1;
  std::erase_if(on_.face.tangents,
                [&](const CircleTangent& tangent) { return distance[tangent.first] <= most; });
  on_.face.followers.clear();
  copy(inside_, on_.x);
  ++counts_.expansion;
  return true;
}

} // namespace epafi::qp
