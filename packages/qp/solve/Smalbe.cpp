#include "epafi/qp/solve/Smalbe.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/qp/constraints/EqualityRestoration.hpp"
#include "epafi/qp/constraints/PenalizedOperator.hpp"
#include "epafi/qp/solve/AdaptiveRule.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace epafi::qp {
namespace {

/// Largest ρ‖B‖² as a multiple of ‖A‖: the round-off of ρBᵀ(Bx − c) limits the gradient that can be reached.
constexpr double maxPenalty = 1e4;

/// Foresees where residual after residual is the last one times q, close to 1 (rows that the free entries can
/// hardly serve): the sum of the steps to come is 1/(1 − q) of them.
class CreepingResidual {
public:
  explicit CreepingResidual(const EqualityConstraint& equality)
      : equality_(equality), last_(equality.numEntries(), 0.0) {}

  /// How many steps one is to stand for. \param weighed  W times the residual
  /// Collective.
  double factor(std::span<const double> residual, std::span<const double> weighed, double norm,
                double lastNorm) {
    constexpr int patience = 4;
    constexpr double longest = 1e8;
    const double alignment = equality_.dot(weighed, last_) / (norm * lastNorm);
    last_.assign(residual.begin(), residual.end());
    numAligned_ = norm > 0.5 * lastNorm && alignment > 0.99 ? numAligned_ + 1 : 0;
    if (numAligned_ < patience)
      return 1;
    numAligned_ = 0;
    const double ratio = norm / lastNorm;
    return ratio < 1 ? std::min(1 / (1 - ratio), longest) : 1;
  }

private:
  const EqualityConstraint& equality_;
  std::vector<double> last_;
  int numAligned_ = 0;
};

/// Whether the gradients after restorations, none of which was small enough, still become smaller.
class RestorationWatch {
public:
  [[nodiscard]] bool isWorthwhile(double gradient) {
    constexpr int maxIdle = 8;
    const bool isBetter = gradient < 0.999 * best_;
    best_ = std::min(best_, gradient);
    numIdle_ = isBetter ? 0 : numIdle_ + 1;
    return numIdle_ <= maxIdle;
  }

private:
  int numIdle_ = 0;
  double best_ = std::numeric_limits<double>::infinity();
};

/// The outer iteration with its state μ, ρ, M.
class OuterIteration {
public:
  OuterIteration(const QuadraticProgram& program, std::vector<double>& multiplier,
                 const Tolerances& tolerances, const SmalbeParameters& parameters,
                 const MprgpParameters& inner);
  /// The loop of the paper.
  Status run(const Vector& start, Observer* observer);

  [[nodiscard]] Mprgp& inner() { return inner_; }
  [[nodiscard]] const AdaptiveRule& rule() const { return rule_; }
  [[nodiscard]] double penalty() const { return penalty_; }

private:
  /// Where an inner loop ended.
  struct Progress {
    double lagrangian = 0;
    double residual = std::numeric_limits<double>::infinity();
  };
  void startMultiplier();
  bool toleratesRoundOff(const Progress& previous);
  void adapt(const Progress& previous, const Progress& now);
  void growPenalty();
  void updateMultiplier(const Progress& previous);
  void restore();
  [[nodiscard]] double normOfLagrangian() const;
  [[nodiscard]] double constantOfLagrangian() const;
  void linearTermOfLagrangian(Vector& b) const;

  const QuadraticProgram& program_;
  const SmalbeParameters& parameters_;
  const EqualityConstraint& equality_;
  double penalty_; ///< ρ
  std::vector<double>& multiplier_;
  std::vector<double> weighedRhs_; ///< Wc; empty if c = 0
  RCP<PenalizedOperator> hessian_;
  AdaptiveRule rule_;
  Mprgp inner_;
  Vector work_;
  CreepingResidual creep_;
  RestorationWatch restorations_;
  int numIdle_ = 0; ///< outer iterations in a row that hardly improved ‖Bx − c‖
  int numSlow_ = 0; ///< that did not halve it
};

OuterIteration::OuterIteration(const QuadraticProgram& program, std::vector<double>& multiplier,
                               const Tolerances& tolerances, const SmalbeParameters& parameters,
                               const MprgpParameters& inner)
    : program_(program), parameters_(parameters), equality_(*program.equality),
      penalty_(parameters.penalty * (program.operatorNorm > 0 ? program.operatorNorm : 1.0) /
               (equality_.norm() * equality_.norm())),
      multiplier_(multiplier),
      hessian_(rcp(new PenalizedOperator(program.hessian, program.hessian->getDomainMap(), program.equality,
                                         penalty_))),
      rule_(program.equality, tolerances, parameters.balance * program.operatorNorm / equality_.norm()),
      inner_(hessian_, program.set, inner, normOfLagrangian(), program.preconditioner),
      work_(program.hessian->getDomainMap()), creep_(equality_) {
  multiplier_.assign(equality_.numEntries(), 0.0);
  weighedRhs_.resize(equality_.rightHandSide().size());
  if (!equality_.isHomogeneous())
    equality_.weigh(equality_.rightHandSide(), weighedRhs_);
}

/// ‖A + ρBᵀWB‖ at most.
double OuterIteration::normOfLagrangian() const {
  return program_.operatorNorm + penalty_ * equality_.norm() * equality_.norm();
}

/// −μᵀc + ρ/2 cᵀWc.
double OuterIteration::constantOfLagrangian() const {
  const auto c = equality_.rightHandSide();
  return equality_.isHomogeneous()
             ? 0.0
             : 0.5 * penalty_ * equality_.dot(weighedRhs_, c) - equality_.dot(multiplier_, c);
}

/// b − Bᵀμ + ρBᵀWc.
void OuterIteration::linearTermOfLagrangian(Vector& b) const {
  b.assign(*program_.linearTerm);
  std::vector<double> combined(multiplier_);
  for (std::size_t i = 0; i < weighedRhs_.size(); ++i)
    combined[i] -= penalty_ * weighedRhs_[i];
  equality_.addTransposedProduct(combined, -1.0, b);
}

Status OuterIteration::run(const Vector& start, Observer* observer) {
  linearTermOfLagrangian(work_);
  inner_.start(work_, start, constantOfLagrangian());
  if (inner_.solution().normInf() > 0)
    startMultiplier();

  Progress previous;
  bool wasRestored = false;
  while (inner_.counts().outer < parameters_.maxOuterIterations) {
    rule_.startInnerLoop();
    const Status status = inner_.run(rule_, observer); // ‖g^P‖ ≤ min(M‖Bx − c‖, η)
    if (status != Status::converged && !(status == Status::stagnated && toleratesRoundOff(previous)))
      return status;
    if (rule_.isMet() && inner_.gradientIsFresh())
      return Status::converged;
    if (wasRestored && !restorations_.isWorthwhile(inner_.startGradient()))
      return Status::stagnated;
    wasRestored = rule_.isFinal() || status == Status::stagnated;
    if (rule_.isFinal() &&
        !equality_.isReplicated()) { // Bx = c cannot be made exact: only the gradient is in doubt
      restore();
      continue;
    }
    const Progress now{inner_.objective(), rule_.residualNorm()};
    updateMultiplier(previous); // μ ← μ + ρW(Bx − c), or further
    adapt(previous, now);
    previous = now;
    ++inner_.counts().outer;
    if (wasRestored)
      restore();
  }
  return Status::maxIterations;
}

/// What MPRGP cannot improve any further is good enough for the next multiplier, as long as these make
/// progress.
bool OuterIteration::toleratesRoundOff(const Progress& previous) {
  constexpr int maxIdle = 3;
  numIdle_ = rule_.residualNorm() > 0.9 * previous.residual ? numIdle_ + 1 : 0;
  return numIdle_ <= maxIdle;
}

/// M ← βM, or ρ ← βρ, when L grew by less than ρ/2‖Bx − c‖²; and where ρ may change, ρ ← βρ as well when ‖Bx
/// − c‖ has twice in a row not been halved.
void OuterIteration::adapt(const Progress& previous, const Progress& now) {
  const bool isFirst = inner_.counts().outer == 0;
  const double roundOff = 1e-14 * std::abs(now.lagrangian);
  const bool grewTooLittle =
      !isFirst &&
      now.lagrangian < previous.lagrangian + 0.5 * penalty_ * now.residual * now.residual - roundOff;
  // A residual that is round-off of Bx does not fall any more, whatever the penalty.
  const bool isRoundOff = now.residual <= 1e-13 * equality_.norm() * inner_.solutionNorm();
  numSlow_ = !isFirst && !isRoundOff && now.residual > 0.5 * previous.residual ? numSlow_ + 1 : 0;
  using Update = SmalbeParameters::Update;
  const bool mayGrow = penalty_ * equality_.norm() * equality_.norm() < maxPenalty * program_.operatorNorm;
  if (grewTooLittle && (parameters_.update != Update::penalty || !mayGrow))
    rule_.reduceBalance(parameters_.balanceReduction);
  const bool isSlow = parameters_.update != Update::balance && numSlow_ >= 2;
  if (mayGrow && (isSlow || (grewTooLittle && parameters_.update == Update::penalty))) {
    growPenalty();
    numSlow_ = 0;
  }
}

/// Gives a warm start the multiplier that belongs to it; without, the first outer iterations would lead away
/// from it.
void OuterIteration::startMultiplier() {
  if (!equality_.isReplicated())
    return;
  Vector gradient(inner_.scaledGradient(), Teuchos::Copy);
  gradient.scale(1.0 / inner_.gradientScale());
  const std::vector<double> change =
      estimateMultiplier(equality_, *program_.set, inner_.solution(), gradient);
  work_.putScalar(0.0);
  equality_.addTransposedProduct(change, 1.0, work_);
  const double constant = equality_.isHomogeneous() ? 0.0 : equality_.dot(change, equality_.rightHandSide());
  inner_.shiftLinearTerm(work_, accurateDot(work_, inner_.solution()) - constant);
  for (std::size_t i = 0; i < change.size(); ++i)
    multiplier_[i] += change[i];
}

/// ρ ← βρ at the present x and μ.
void OuterIteration::growPenalty() {
  const double growth = (parameters_.penaltyGrowth - 1) * penalty_;
  const double residual = rule_.residualNorm();
  Vector change(work_.getMap()); // of the gradient: growth · BᵀW(Bx − c)
  equality_.addTransposedProduct(rule_.weighedResidual(), growth, change);
  penalty_ += growth;
  hessian_->setPenalty(penalty_);
  linearTermOfLagrangian(work_);
  inner_.changeHessian(change, 0.5 * growth * residual * residual, work_, constantOfLagrangian(),
                       normOfLagrangian());
}

/// μ may go further than the paper's step ρW(Bx − c), to where `creep_` foresees it, as long as bounds hold
/// what they hold, or where the inner solution x does not notice: while every entry that the shift touches is
/// held at its bound, x stays the minimiser and L grows linearly in μ, until the first multiplier there
/// changes its sign.
void OuterIteration::updateMultiplier(const Progress& previous) {
  const double residual = rule_.residualNorm();
  work_.putScalar(0.0);
  equality_.addTransposedProduct(rule_.weighedResidual(), penalty_ * inner_.gradientScale(), work_);
  const double longest =
      minOverRanks(*work_.getMap()->getComm(),
                   program_.set->longestMultiplierStep(inner_.solution(), inner_.scaledGradient(), work_));
  double foreseen = creep_.factor(rule_.residual(), rule_.weighedResidual(), residual, previous.residual);
  if (foreseen > 1) { // the face serves them no better only until a bound lets go
    Vector held(work_.getMap());
    program_.set->freeIndicator(inner_.solution(), held);
    held.elementWiseMultiply(-1.0, held, work_, 0.0);
    held.update(1.0, work_, 1.0);
    foreseen = minOverRanks(*work_.getMap()->getComm(),
                            std::min(foreseen, program_.set->longestMultiplierStep(
                                                   inner_.solution(), inner_.scaledGradient(), held)));
  }
  const double step = std::max({1.0, std::isfinite(longest) ? longest : 1.0, foreseen});
  work_.scale(step / inner_.gradientScale());
  inner_.shiftLinearTerm(work_, step * penalty_ * residual * residual);
  for (std::size_t i = 0; i < multiplier_.size(); ++i)
    multiplier_[i] += step * penalty_ * rule_.weighedResidual()[i];
}

/// The certificate: Bx = c to round-off and a fresh gradient; if it fails the iteration goes on.
void OuterIteration::restore() {
  work_.assign(inner_.solution());
  if (equality_.isReplicated())
    restoreEquality(equality_, *program_.set, rule_.residual(), work_);
  Vector b(work_.getMap()); // afresh as well: many shifts have left their round-off in it
  linearTermOfLagrangian(b);
  inner_.start(b, work_, constantOfLagrangian());
}

} // namespace

SolveReport solveBySmalbe(const QuadraticProgram& program, Vector& x, const Tolerances& tolerances,
                          const SmalbeParameters& parameters, const MprgpParameters& inner,
                          Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  OuterIteration outer(program, report.multiplier, tolerances, parameters, inner);
  report.status = outer.run(x, &recorder);

  Mprgp& solver = outer.inner();
  x.assign(solver.solution());
  describeEnd(solver, report);
  if (report.status == Status::maxIterations && report.counts.outer >= parameters.maxOuterIterations)
    report.reason = "the limit of outer iterations was reached before the tolerance; raise 'Maximum Outer "
                    "Iterations' or the tolerance";
  report.relativeProjectedGradient = relativeTo(tolerances.gradientReference, solver.projectedGradient());
  for (std::size_t i = 0; i < report.multiplier.size();
       ++i) // the gradient is that of L: μ + ρW(Bx − c) is what it belongs to
    report.multiplier[i] += outer.penalty() * outer.rule().weighedResidual()[i];
  report.relativeConstraintResidual = relativeTo(tolerances.constraintReference, outer.rule().residualNorm());
  return report;
}

} // namespace epafi::qp
