#include "epafi/qp/ActiveSets.hpp"

#include "epafi/qp/FaceEquality.hpp"
#include "epafi/qp/Interruption.hpp"
#include "epafi/qp/LocalData.hpp"
#include "epafi/qp/ScaledObjective.hpp"
#include "epafi/qp/StoppingRule.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace epafi::qp {
namespace {

constexpr int maxFaces = 300;
constexpr int patience = 12;      ///< faces in a row with no smaller gradient to begin with
constexpr int maxFaceSteps = 200; ///< of CG before the face is looked at again
/// Of ‖Zg‖ and of (gᵀMg)^½ before the face is looked at. Of both: the energy alone can be that of one direction which M overrates,
/// gone after a step; the norm alone, that of one which hardly moves x. Less, and wrong decisions are paid by further faces.
constexpr double reduction = 0.1;
/// In CG the gradient is updated; that of the certificate, computed afresh, is to be small enough as well.
constexpr double safety = 0.5;
constexpr double negligibleShare = 1e-12; ///< multipliers no larger, beside ‖Zg‖, release nothing
constexpr double roundOff = 1e-13;        ///< of x that leaves Ω by it

/// to = from where `on` is 1, 0 elsewhere.
void mask(const Vector& on, const Vector& from, Vector& to) {
  const auto face = localData(on), in = localData(from);
  const auto out = localDataNonConst(to);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = face[i] * in[i];
}

/// Passes on, and remembers the last answer.
class RememberedTarget final : public ErrorTarget {
public:
  explicit RememberedTarget(ErrorTarget& target) : target_(target) {}
  double first(double error) override { return limit_ = target_.first(error); }
  double at(const Vector& x) override { return limit_ = target_.at(x); }
  [[nodiscard]] double limit() const { return limit_; } ///< 0: none was asked for

private:
  ErrorTarget& target_;
  double limit_ = 0;
};

/// The method with its state: the point x, and the gradient g = Ax − b + Bᵀμ of the Lagrangian with the μ that makes it
/// shortest on the face, scaled by 1/‖A‖ (ScaledObjective.hpp).
class ActiveSets {
public:
  ActiveSets(const ActiveSetProblem& problem, const Vector& start, const Vector* face,
             const SmalbeTolerances& tolerances, const MprgpParameters& limits);
  /// The loop of the paper.
  Status run(Observer* observer);
  void describe(SolveReport& report) const;
  [[nodiscard]] const Vector& solution() const { return x_; }

private:
  /// The sums of a step, before those of B's rows: three products, and who wants to stop.
  enum Sums : int { first, second, third, timeIsUp, interrupted, look, numOwnSums };

  bool enterFace();
  std::optional<Status> minimise();
  [[nodiscard]] bool isNearlySmall() const;
  void updateAlong(double slope);
  void precondition();
  bool chooseFace();
  bool isSolved();
  [[nodiscard]] bool isSmall(double gradient, double energy);
  void record(StepKind kind);
  [[nodiscard]] double sum(Sums which) const { return reduction_.sum(which); }
  [[nodiscard]] double enough() const {
    return tolerances_.gradient * tolerances_.gradientReference * objective_.scale();
  }
  [[nodiscard]] std::span<AccurateSum> rowSums() {
    return reduction_.sums().subspan(numOwnSums, rows_.size());
  }

  StepCounts counts_;
  const ConvexSet& set_;
  ScaledObjective objective_;
  RCP<const Operator> m_;
  FaceEquality equality_;
  SmalbeTolerances tolerances_;
  std::optional<RememberedTarget> target_;
  std::optional<ErrorWatch> watch_; ///< of the target
  Interruption interruption_;
  Vector x_, g_;
  Vector r_, z_;       ///< Zg, or another masked vector; P_F M Zg
  Vector p_, image_;   ///< direction and A times it; work elsewhere
  Vector face_, next_; ///< Z: 1 where x may move, else 0
  Vector best_;        ///< the point with the least gradient on entering a face
  FusedReduction reduction_;
  std::vector<double> rows_, multiplier_;    ///< work, k
  double f_ = 0, gradient_ = 0, energy_ = 0; ///< objective, ‖Zg‖, gᵀZ P_F M P_F Zg
  double timesImage_ = 0;                    ///< zᵀAp
  double curvature_ = 0;                     ///< pᵀAp of the last step in the face; 0: there was none
  double residual_ = 0;                      ///< ‖Bx − c‖
  long long numActive_ = 0;
  std::optional<Status> wish_; ///< what an observer or the clock asks for
  bool isLookWanted_ = false;
};

ActiveSets::ActiveSets(const ActiveSetProblem& problem, const Vector& start, const Vector* face,
                       const SmalbeTolerances& tolerances, const MprgpParameters& limits)
    : set_(*problem.set),
      objective_(problem.hessian, problem.operatorNorm, limits.maxMultiplications, counts_),
      m_(problem.preconditioner), equality_(problem.equality, objective_.map()), tolerances_(tolerances),
      interruption_(limits.timeLimit), x_(start, Teuchos::Copy), g_(objective_.map()), r_(objective_.map()),
      z_(objective_.map()), p_(objective_.map()), image_(objective_.map()), face_(objective_.map()),
      next_(objective_.map()), best_(start, Teuchos::Copy),
      reduction_(objective_.map()->getComm(), numOwnSums + equality_.numRows()),
      rows_(static_cast<std::size_t>(equality_.numRows())), multiplier_(rows_.size()) {
  objective_.setLinearTerm(*problem.linearTerm, 0);
  if (tolerances.error != nullptr)
    watch_.emplace(target_.emplace(*tolerances.error));
  set_.project(x_);
  if (face == nullptr) {
    set_.freeIndicator(x_, face_);
    return;
  }
  copy(*face, face_);
  next_.putScalar(1.0);
  addScaled(-1.0, face_, next_);
  set_.activate(next_, x_);
}

Status ActiveSets::run(Observer* observer) {
  interruption_.setObserver(observer);
  double least = std::numeric_limits<double>::infinity();
  int numIdle = 0;
  for (int faces = 0; faces < maxFaces && numIdle <= patience; ++faces) {
    if (!enterFace()) // Bx = c, g afresh
      break;
    record(faces == 0 ? StepKind::start : StepKind::expansion);
    if (isSolved())
      return Status::converged;
    numIdle = gradient_ < 0.9 * least ? 0 : numIdle + 1;
    if (gradient_ < least) {
      least = gradient_;
      copy(x_, best_);
    }
    do {
      if (const auto status = minimise()) { // on the face, as if it had no bounds
        if (*status == Status::stagnated)
          copy(best_, x_);
        return *status;
      }
    } while (!chooseFace() &&
             !isSmall(gradient_ / safety, energy_)); // where x left Ω, where multipliers are wrong
    ++counts_.expansion;
  }
  copy(best_, x_);
  return Status::stagnated;
}

/// x moves onto Bx = c within the face, and g is computed afresh; false if the face cannot hold Bx = c. One product.
bool ActiveSets::enterFace() {
  equality_.setFace(face_);
  equality_.residual(x_, rows_);
  equality_.multiplierOf(rows_, multiplier_);
  p_.putScalar(0.0);
  equality_.addTransposed(multiplier_, -1.0, p_);
  addScaled(1.0, p_, x_);
  equality_.residual(x_, rows_);
  double squared = 0;
  for (const double row : rows_)
    squared += row * row;
  residual_ = std::sqrt(squared);
  if (!rows_.empty() && !(residual_ <= tolerances_.constraint * tolerances_.constraintReference))
    return false;
  objective_.multiply(x_, image_);
  f_ = objective_.evaluate(x_, image_, x_, p_).objective;
  objective_.gradient(image_, g_);
  mask(face_, g_, r_);
  reduction_.clear();
  equality_.addLocalSums(r_, rowSums());
  reduction_.reduce();
  equality_.finish(rowSums(), rows_);
  equality_.multiplierOf(rows_, multiplier_);
  equality_.addWholeTransposed(multiplier_, -1.0, g_);
  curvature_ = 0;
  precondition();
  return true;
}

/// z = P_F M Zg, gᵀz, zᵀAp, ‖Zg‖, in one message. As Zg is in Ker B, gᵀz is that of M Zg.
void ActiveSets::precondition() {
  mask(face_, g_, r_);
  if (m_.is_null()) {
    copy(r_, z_);
  } else {
    m_->apply(r_, z_);
    mask(face_, z_, z_);
    ++counts_.preconditionerApplications;
  }
  reduction_.clear();
  const auto r = localData(r_), z = localData(z_), image = localData(image_);
  const auto sums = reduction_.sums();
  for (std::size_t i = 0; i < r.size(); ++i) {
    sums[first].add(r[i] * z[i]);
    sums[second].add(z[i] * image[i]);
    sums[third].add(r[i] * r[i]);
  }
  sums[timeIsUp] = AccurateSum(interruption_.timeIsUp() ? 1.0 : 0.0);
  sums[interrupted] = AccurateSum(interruption_.isWanted() ? 1.0 : 0.0);
  sums[look] = AccurateSum(interruption_.isLookWanted() ? 1.0 : 0.0);
  equality_.addLocalSums(z_, rowSums());
  reduction_.reduce();
  isLookWanted_ = sum(look) > 0;
  energy_ = sum(first);
  timesImage_ = sum(second);
  gradient_ = std::sqrt(sum(third));
  wish_ = sum(interrupted) > 0 ? std::optional(Status::interrupted)
          : sum(timeIsUp) > 0  ? std::optional(Status::timeLimit)
                               : std::nullopt;
  equality_.finish(rowSums(), rows_);
  equality_.multiplierOf(rows_, multiplier_);
  equality_.addTransposed(multiplier_, -1.0, z_);
}

/// Preconditioned CG on the face until ‖Zg‖ and (gᵀMg)^½ have fallen to a share of themselves, or are small enough.
std::optional<Status> ActiveSets::minimise() {
  const double goal = reduction * reduction * energy_, most = reduction * gradient_;
  for (int step = 0; (energy_ > goal || gradient_ > most) && !isNearlySmall(); ++step) {
    if (!std::isfinite(gradient_))
      return Status::notFinite;
    if (wish_)
      return wish_;
    if (objective_.isSpent())
      return Status::maxIterations;
    if (step == maxFaceSteps)
      return Status::stagnated;
    setConjugate(z_, curvature_ > 0 ? objective_.scale() * timesImage_ / curvature_ : 0.0, p_);
    objective_.multiply(p_, image_);
    mask(face_, image_, r_);
    reduction_.clear();
    const auto p = localData(p_), g = localData(g_), image = localData(image_);
    const auto sums = reduction_.sums();
    for (std::size_t i = 0; i < p.size(); ++i) {
      sums[first].add(p[i] * image[i]);
      sums[second].add(g[i] * p[i]);
      sums[third].add(p[i] * p[i]);
    }
    equality_.addLocalSums(r_, rowSums());
    reduction_.reduce();
    curvature_ = objective_.scale() * sum(first);
    if (!(curvature_ > objective_.zeroCurvature(sum(third))))
      return Status::stagnated; // the face has no minimum, or round-off allows no better one
    updateAlong(sum(second));
    precondition();
    record(StepKind::conjugateGradient);
  }
  return std::nullopt;
}

/// Whether CG has done what the tolerance asks for, with something to spare.
bool ActiveSets::isNearlySmall() const {
  return watch_ ? std::sqrt(std::max(0.0, energy_)) / objective_.scale() <= target_->limit()
                : gradient_ <= safety * enough();
}

/// x −= αp, g −= α(Ap − Bᵀη), with the η that keeps Zg in Ker B. \param slope  gᵀp
void ActiveSets::updateAlong(double slope) {
  equality_.finish(rowSums(), rows_);
  equality_.multiplierOf(rows_, multiplier_);
  equality_.addWholeTransposed(multiplier_, -1.0, image_);
  const double length = slope / curvature_;
  addScaled(-length, p_, x_);
  addScaled(-length * objective_.scale(), image_, g_);
  f_ += length * (0.5 * length * curvature_ - slope);
  ++counts_.conjugateGradient;
}

/// The next face: x is projected, and may move where no bound holds it or the multiplier of one has the wrong sign. False if that
/// is the present face.
bool ActiveSets::chooseFace() {
  copy(x_, p_);
  set_.project(p_);
  set_.freeIndicator(p_, next_);
  set_.choppedGradient(p_, g_, negligibleShare * gradient_, r_);
  reduction_.clear();
  {
    const auto on = localData(face_), wrong = localData(r_);
    const auto next = localDataNonConst(next_);
    const auto sums = reduction_.sums();
    for (std::size_t i = 0; i < next.size(); ++i) {
      if (on[i] == 0)
        next[i] = wrong[i] != 0 ? 1 : 0;
      sums[first].add(next[i] != on[i] ? 1.0 : 0.0);
      sums[second].add(1 - next[i]);
    }
  }
  reduction_.reduce();
  numActive_ = static_cast<long long>(sum(second));
  if (sum(first) == 0) {
    curvature_ = 0; // p was overwritten
    return false;
  }
  copy(p_, x_);
  copy(next_, face_);
  return true;
}

/// Whether x, with g afresh, is within Ω and its projected gradient meets the tolerance.
bool ActiveSets::isSolved() {
  copy(x_, p_);
  set_.project(p_);
  set_.choppedGradient(p_, g_, 0.0, r_);
  reduction_.clear();
  {
    const auto on = localData(face_), wrong = localData(r_), x = localData(x_), inside = localData(p_);
    const auto sums = reduction_.sums();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double chopped = (1 - on[i]) * wrong[i], out = x[i] - inside[i];
      sums[first].add(chopped * chopped);
      sums[second].add(out * out);
      sums[third].add(x[i] * x[i]);
    }
  }
  reduction_.reduce();
  if (std::sqrt(sum(second)) > roundOff * std::sqrt(sum(third)))
    return false;
  const double whole = std::hypot(gradient_, std::sqrt(sum(first)));
  const double share = gradient_ > 0 ? whole / gradient_ : 1;
  if (!isSmall(whole, share * share * energy_))
    return false;
  gradient_ = whole;
  copy(p_, x_);
  return true;
}

/// Whether the tolerance is met. \param energy  an upper bound of the squared error, of a scaled gradient. Collective.
bool ActiveSets::isSmall(double gradient, double energy) {
  return watch_ ? watch_->isSmallEnough(std::sqrt(std::max(0.0, energy)) / objective_.scale(), x_)
                : gradient <= enough();
}

void ActiveSets::record(StepKind kind) {
  Observer* const observer = interruption_.observer();
  if (observer == nullptr)
    return;
  StepRecord step;
  step.iteration = counts_.conjugateGradient + counts_.expansion;
  step.kind = kind;
  step.projectedGradient = relativeTo(tolerances_.gradientReference, gradient_ / objective_.scale());
  step.constraintResidual = relativeTo(tolerances_.constraintReference, residual_);
  step.objective = f_ / objective_.scale();
  step.activeBounds = numActive_;
  step.hessianMultiplications = counts_.hessianMultiplications;
  observer->step(step);
  if (!isLookWanted_)
    return;
  copy(x_, next_);
  set_.project(next_);
  observer->look(next_);
}

void ActiveSets::describe(SolveReport& report) const {
  report.reason = explain(report.status);
  report.counts = counts_;
  report.relativeProjectedGradient =
      relativeTo(tolerances_.gradientReference, gradient_ / objective_.scale());
  report.relativeConstraintResidual = relativeTo(tolerances_.constraintReference, residual_);
  report.objective = f_ / objective_.scale();
  report.operatorNorm = objective_.norm() / objective_.scale();
  if (report.status != Status::converged)
    return;
  report.gradient = rcp(new Vector(g_, Teuchos::Copy));
  report.gradient->scale(1.0 / objective_.scale());
}

} // namespace

SolveReport solveByActiveSets(const ActiveSetProblem& problem, Vector& x, const Vector* face,
                              const SmalbeTolerances& tolerances, const MprgpParameters& limits,
                              Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  ActiveSets method(problem, x, face, tolerances, limits);
  report.status = method.run(&recorder);
  x.assign(method.solution());
  problem.set->project(x);
  method.describe(report);
  return report;
}

} // namespace epafi::qp
