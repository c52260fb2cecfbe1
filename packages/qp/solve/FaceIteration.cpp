#include "epafi/qp/solve/FaceIteration.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/operators/LocalData.hpp"

#include <Tpetra_Map.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace epafi::qp {
namespace {

/// sum += aᵀb, this rank's share.
void addDot(const Vector& a, const Vector& b, AccurateSum& sum) {
  const auto x = localData(a), y = localData(b);
  for (std::size_t i = 0; i < x.size(); ++i)
    sum.add(x[i] * y[i]);
}

} // namespace

FaceIteration::FaceIteration(ScaledObjective& objective, RCP<const Operator> m,
                             const RCP<const ReplicatedEquality>& equality, const Interruption& interruption,
                             StepCounts& counts)
    : x(objective.map()), face(objective.map()), objective_(objective), m_(std::move(m)),
      equality_(equality, objective.map()), interruption_(interruption), counts_(counts), g_(objective.map()),
      r_(objective.map()), z_(objective.map()), p_(objective.map()), image_(objective.map()),
      reduction_(objective.map()->getComm(), numOwnSums + equality_.numRows()),
      rows_(static_cast<std::size_t>(equality_.numRows())), multiplier_(rows_.size()),
      missing_(rows_.size()) {}

void FaceIteration::enter(Point point) {
  equality_.setFace(face);
  if (point != Point::reached) {
    moveOntoEquality();
    computeGradient(point == Point::origin && residual_ == 0); // and so it has stayed
  }
  // What rows that hardly reach the face leave of a large g, the second pass takes.
  for (int pass = 0; pass < (rows_.empty() ? 1 : 2); ++pass) {
    copy(g_, r_);
    equality_.addWholeTransposed(equality_.fit(r_), -1.0, g_);
    if (pass == 0) {
      face.curve(g_);
      face.addBendingFromOrigin(x, 1.0, g_); // where Bx = c has moved x
    }
  }
  // M overrates what it inverts, by about as much entry by entry on contacts (2.5 to 10 measured).
  constexpr double overrated = 4;
  const auto estimate = [&] {
    return inverseStiffness_ > 0 ? overrated * objective_.scale() / inverseStiffness_ : 0;
  };
  stiffness_ = estimate();
  curvature_ = 0;
  numKept_ = 0;
  numIdle_ = 0;
  precondition();
  hasFollowers_ = reduction_.sum(following) > 0;
  if (stiffness_ == 0 && reduction_.sum(bent) > 0) { // the first face
    stiffness_ = estimate();
    precondition();
  }
}

/// Ax − b and the objective.
void FaceIteration::computeGradient(bool isOrigin) {
  if (isOrigin) { // no product
    image_.putScalar(0.0);
    f_ = objective_.constant();
  } else {
    objective_.multiply(x, image_);
    f_ = objective_.evaluate(x, image_, x, p_).objective;
  }
  objective_.gradient(image_, g_);
}

/// What follows does so here too, but for what little is left. Collective.
void FaceIteration::moveOntoEquality() {
  constexpr int mostPasses = 3;
  constexpr double little = 1e-4;
  const auto pass = [&](bool withFollowers) {
    equality_.multiplierOf(missing_, multiplier_);
    p_.putScalar(0.0);
    equality_.addTransposed(multiplier_, -1.0, p_);
    if (withFollowers)
      face.addFollowers(p_);
    addScaled(1.0, p_, x);
    equality_.residual(x, missing_);
    residual_ = equality_.normOf(missing_);
  };
  equality_.residual(x, missing_);
  const double most = little * equality_.normOf(missing_);
  if (!rows_.empty() && sumOverRanks(*x.getMap()->getComm(), static_cast<double>(face.followers.size())) > 0)
    for (int k = 0; k == 0 || (k < mostPasses && residual_ > most); ++k)
      pass(true);
  pass(false);
}

const Vector& FaceIteration::plainGradient() {
  if (face.tangents.empty())
    return g_;
  copy(g_, r_);
  face.addBendingFromOrigin(x, -1.0, r_);
  return r_;
}

/// As Bx − c = (I − N N⁻)r for some r, with N = B_F B_Fᵀ, ν = (I − N⁻N)(Bx − c) has νᵀ(Bx − c) = ‖Bx − c‖²
/// and Nν = 0.
void FaceIteration::unbalanced(Vector& change) {
  change.putScalar(0.0);
  equality_.addTransposed(missing_, 1.0, change);
  const std::span<const double> held = equality_.fit(change); // N⁻N(Bx − c)
  for (std::size_t i = 0; i < rows_.size(); ++i)
    rows_[i] = missing_[i] - held[i];
  change.putScalar(0.0);
  equality_.addWholeTransposed(rows_, 1.0, change);
}

/// z = P_F M Zg, gᵀz, zᵀAp, ‖Zg‖, in one message. As Zg is in Ker B, gᵀz is that of M Zg.
void FaceIteration::precondition() {
  face.restrict(g_, r_);
  reduction_.clear();
  applyPreconditioner();
  const auto sums = reduction_.sums();
  addDot(r_, z_, sums[first]);
  addDot(z_, image_, sums[second]);
  addDot(r_, r_, sums[third]);
  sums[following] = AccurateSum(static_cast<double>(face.followers.size()));
  sums[bent] = AccurateSum(static_cast<double>(face.tangents.size()));
  sums[timeIsUp] = AccurateSum(interruption_.timeIsUp() ? 1.0 : 0.0);
  sums[interrupted] = AccurateSum(interruption_.isWanted() ? 1.0 : 0.0);
  sums[look] = AccurateSum(interruption_.isLookWanted() ? 1.0 : 0.0);
  equality_.addLocalSums(z_, rowSums());
  reduction_.reduce();
  energy_ = reduction_.sum(first);
  timesImage_ = reduction_.sum(second);
  gradient_ = std::sqrt(reduction_.sum(third));
  if (reduction_.sum(alongTangents) > 0)
    inverseStiffness_ = reduction_.sum(tangentEnergy) / reduction_.sum(alongTangents);
  else if (reduction_.sum(third) > 0)
    inverseStiffness_ = energy_ / reduction_.sum(third);
  wish_.reset();
  if (reduction_.sum(interrupted) > 0)
    wish_ = Status::interrupted;
  else if (reduction_.sum(timeIsUp) > 0)
    wish_ = Status::timeLimit;
  isLookWanted_ = reduction_.sum(look) > 0;
  equality_.finish(rowSums(), rows_);
  equality_.multiplierOf(rows_, multiplier_);
  equality_.addTransposed(multiplier_, -1.0, z_);
}

/// z = Z W M W r; with W = 1 where nothing is bent.
void FaceIteration::applyPreconditioner() {
  if (m_.is_null()) {
    copy(r_, z_);
    return;
  }
  const bool isWeighed = stiffness_ > 0 && !face.tangents.empty();
  if (isWeighed)
    face.weigh(stiffness_, r_);
  m_->apply(r_, z_);
  ++counts_.preconditionerApplications;
  const auto r = localData(r_), z = localData(z_);
  for (const CircleTangent& tangent : face.tangents) {
    reduction_.sums()[tangentEnergy].add(tangent.component(r) * tangent.component(z));
    reduction_.sums()[alongTangents].add(tangent.component(r) * tangent.component(r));
  }
  if (isWeighed) {
    face.weigh(stiffness_, z_);
    face.restrict(g_, r_);
  }
  face.restrict(z_, z_);
}

std::optional<Status> FaceIteration::step() {
  const auto status = hasFollowers_ ? followingStep() : conjugateStep();
  if (status)
    return status;
  ++counts_.conjugateGradient;
  precondition();
  if (!std::isfinite(gradient_))
    return Status::notFinite;
  return std::nullopt;
}

std::optional<Status> FaceIteration::conjugateStep() {
  setConjugate(z_, curvature_ > 0 ? objective_.scale() * timesImage_ / curvature_ : 0.0,
               p_); // z − (zᵀAp/pᵀAp) p
  objective_.multiply(p_, image_);
  face.addBending(p_, 1 / objective_.scale(), image_);
  face.restrict(image_, r_);
  reduction_.clear();
  const auto sums = reduction_.sums();
  addDot(p_, image_, sums[first]);
  addDot(g_, p_, sums[second]);
  addDot(p_, p_, sums[third]);
  equality_.addLocalSums(r_, rowSums());
  reduction_.reduce();
  curvature_ = objective_.scale() * reduction_.sum(first);
  slope_ = reduction_.sum(second);
  if (!(curvature_ > objective_.zeroCurvature(reduction_.sum(third))))
    return Status::unbounded;
  const double length = slope_ / curvature_;
  equality_.finish(rowSums(), rows_);
  equality_.multiplierOf(rows_, multiplier_);
  equality_.addWholeTransposed(multiplier_, -1.0, image_); // Ap − Bᵀη, on the face in Ker B
  addScaled(-length, p_, x);
  addScaled(-length * objective_.scale(), image_, g_);
  f_ += length * (0.5 * length * curvature_ - slope_);
  return std::nullopt;
}

/// p = Tz and what balances it: most of that moves what follows, too, and what little is left does not.
void FaceIteration::makeFollowingDirection() {
  constexpr int passes = 3;
  for (int pass = 0; pass < (rows_.empty() ? 0 : passes); ++pass) {
    copy(z_, p_);
    face.addFollowers(p_);
    equality_.balance(p_, z_);
  }
  copy(z_, p_);
  face.addFollowers(p_);
  r_.putScalar(0.0);
  equality_.balance(p_, r_);
  addScaled(1.0, r_, p_);
}

/// The shortest Zg along the directions so far. Where that gets no shorter, nothing follows from now on.
std::optional<Status> FaceIteration::followingStep() {
  constexpr std::size_t mostKept = 60;
  constexpr int mostIdle = 4;
  constexpr double hardly = 0.98;
  if (numKept_ == mostKept)
    numKept_ = 0;
  if (numKept_ == kept_.size())
    kept_.push_back({Vector(x.getMap()), Vector(x.getMap())});
  makeFollowingDirection();
  objective_.multiply(p_, image_);
  face.addBending(p_, 1 / objective_.scale(), image_);
  copy(image_, r_);
  equality_.addWholeTransposed(equality_.fit(r_), -1.0, image_);
  face.restrict(image_, r_);
  sums_.assign(numKept_, AccurateSum());
  for (std::size_t i = 0; i < numKept_; ++i)
    addDot(kept_[i].image, r_, sums_[i]);
  sumOverRanks(*x.getMap()->getComm(), sums_);
  for (std::size_t i = 0; i < numKept_; ++i) {
    const double share = sums_[i].value() / kept_[i].squared;
    addScaled(-share, kept_[i].direction, p_);
    addScaled(-share, kept_[i].image, image_);
  }
  face.restrict(image_, r_);
  std::array<AccurateSum, 6> sums;
  addDot(r_, r_, sums[0]);
  addDot(g_, r_, sums[1]);
  addDot(p_, image_, sums[2]);
  addDot(g_, p_, sums[3]);
  addDot(p_, r_, sums[4]); // pᵀAp of the face
  addDot(p_, p_, sums[5]);
  sumOverRanks(*x.getMap()->getComm(), sums);
  const double squared = sums[0].value(), along = sums[1].value();
  if (!(squared > 0)) {
    hasFollowers_ = false;
    return std::nullopt;
  }
  if (objective_.scale() * sums[4].value() < -objective_.zeroCurvature(sums[5].value()))
    ++counts_.negativeCurvatures;
  const double length = along / (objective_.scale() * squared);
  copy(p_, kept_[numKept_].direction);
  copy(image_, kept_[numKept_].image);
  kept_[numKept_++].squared = squared;
  addScaled(-length, p_, x);
  addScaled(-length * objective_.scale(), image_, g_);
  f_ += length * (0.5 * length * objective_.scale() * sums[2].value() - sums[3].value());
  const double rest = gradient_ * gradient_ - along * along / squared;
  numIdle_ = rest > hardly * gradient_ * gradient_ ? numIdle_ + 1 : 0;
  if (numIdle_ > mostIdle)
    hasFollowers_ = false;
  return std::nullopt;
}

} // namespace epafi::qp
