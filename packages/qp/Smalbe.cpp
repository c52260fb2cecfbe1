#include "epafi/qp/Smalbe.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/EqualityRestoration.hpp"
#include "epafi/qp/PenalizedOperator.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace epafi::qp {
namespace {

/// Largest ρ‖B‖² as a multiple of ‖A‖: the round-off of ρBᵀ(Bx − c) limits the gradient that can be reached.
constexpr double maxPenalty = 1e4;

/// With an error's target: ‖Bx − c‖ relative to its reference at which x is worth being moved onto Bx = c, where the rows
/// allow that. Whether the error is small enough shows there.
constexpr double worthRestoring = 1e-2;

/// The inner loop's rule: ‖g^P‖ ≤ min(M‖Bx − c‖, η), or both final tolerances.
class AdaptiveRule final : public StoppingRule {
public:
  AdaptiveRule(RCP<const EqualityConstraint> equality, const SmalbeTolerances& tolerances, double balance,
               double forcing)
      : equality_(std::move(equality)), tolerances_(tolerances), balance_(balance), forcing_(forcing),
        residual_(equality_->numEntries()) {
    if (tolerances.error != nullptr)
      watch_.emplace(*tolerances.error);
  }

  [[nodiscard]] int numSums() const override { return equality_->numSums(); }
  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) override {
    x_ = &x;
    equality_->addLocalSums(x, sums);
  }
  [[nodiscard]] bool usesEnergy() const override { return watch_.has_value(); }

  bool isSatisfied(const GradientNorms& gradient, std::span<const AccurateSum> sums) override {
    const double projectedGradient = gradient.euclidean;
    residualNorm_ = equality_->finishResidual(sums, residual_);
    const bool isRough = watch_ && equality_->isReplicated();
    const double constraint =
        isRough ? std::max(worthRestoring, tolerances_.constraint) : tolerances_.constraint;
    isFinal_ = residualNorm_ <= constraint * tolerances_.constraintReference &&
               (watch_ ? watch_->isSmallEnough(gradient.energy, *x_)
                       : projectedGradient <= tolerances_.gradient * tolerances_.gradientReference);
    // After a thousand steps it is time for another multiplier, if only the gradient is small enough for the end.
    const bool isLong = ++steps_ > 1000;
    const double enough = isLong ? 0.1 * tolerances_.gradient * tolerances_.gradientReference : 0.0;
    return isFinal_ || projectedGradient <= std::max(std::min(balance_ * residualNorm_, forcing_), enough);
  }

  void describe(StepRecord& record) const override {
    record.projectedGradient = relativeTo(tolerances_.gradientReference, record.projectedGradient);
    record.constraintResidual = relativeTo(tolerances_.constraintReference, residualNorm_);
  }

  /// Both final tolerances hold, that of Bx = c as far as a restoration needs it.
  [[nodiscard]] bool isFinal() const { return isFinal_; }
  /// They hold as asked for.
  [[nodiscard]] bool isMet() const {
    return isFinal_ && residualNorm_ <= tolerances_.constraint * tolerances_.constraintReference;
  }
  [[nodiscard]] double residualNorm() const { return residualNorm_; }
  [[nodiscard]] std::span<const double> residual() const { return residual_; }
  void reduceBalance(double factor) { balance_ *= factor; }
  void startInnerLoop() { steps_ = 0; }

private:
  RCP<const EqualityConstraint> equality_;
  SmalbeTolerances tolerances_;
  double balance_, forcing_;
  std::vector<double> residual_;
  double residualNorm_ = 0;
  std::optional<ErrorWatch> watch_;
  const Vector* x_ = nullptr; ///< of the measurement at hand
  int steps_ = 0;             ///< of the inner loop
  bool isFinal_ = false;
};

/// The outer iteration with its state μ, ρ, M.
class OuterIteration {
public:
  OuterIteration(const EqualityBoundProblem& problem, std::vector<double>& multiplier,
                 const SmalbeTolerances& tolerances, const SmalbeParameters& parameters,
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
  double extrapolation(const Progress& previous);
  void restore();
  bool restorationsHelp();
  [[nodiscard]] double normOfLagrangian() const;
  [[nodiscard]] double constantOfLagrangian() const;
  void linearTermOfLagrangian(Vector& b) const;

  const EqualityBoundProblem& problem_;
  const SmalbeParameters& parameters_;
  const EqualityConstraint& equality_;
  double penalty_; ///< ρ
  std::vector<double>& multiplier_;
  RCP<PenalizedOperator> hessian_;
  AdaptiveRule rule_;
  Mprgp inner_;
  Vector work_;
  std::vector<double> lastResidual_;
  int idle_ = 0, slow_ = 0, aligned_ = 0, idleRestorations_ = 0;
  bool wasRestored_ = false;
  double bestRestored_ = std::numeric_limits<double>::infinity();
};

OuterIteration::OuterIteration(const EqualityBoundProblem& problem, std::vector<double>& multiplier,
                               const SmalbeTolerances& tolerances, const SmalbeParameters& parameters,
                               const MprgpParameters& inner)
    : problem_(problem), parameters_(parameters), equality_(*problem.equality),
      penalty_(parameters.penalty * (problem.operatorNorm > 0 ? problem.operatorNorm : 1.0) /
               (equality_.norm() * equality_.norm())),
      multiplier_(multiplier),
      hessian_(rcp(new PenalizedOperator(problem.hessian, problem.hessian->getDomainMap(), problem.equality,
                                         penalty_))),
      rule_(problem.equality, tolerances, parameters.balance * problem.operatorNorm / equality_.norm(),
            parameters.forcing * tolerances.gradientReference),
      inner_(hessian_, problem.set, inner, normOfLagrangian(), problem.preconditioner),
      work_(problem.hessian->getDomainMap()) {
  multiplier_.assign(equality_.numEntries(), 0.0);
  lastResidual_.assign(equality_.numEntries(), 0.0);
}

/// ‖A + ρBᵀB‖ at most.
double OuterIteration::normOfLagrangian() const {
  return problem_.operatorNorm + penalty_ * equality_.norm() * equality_.norm();
}

/// −μᵀc + ρ/2‖c‖².
double OuterIteration::constantOfLagrangian() const {
  const auto c = equality_.rightHandSide();
  return equality_.isHomogeneous() ? 0.0
                                   : 0.5 * penalty_ * equality_.dot(c, c) - equality_.dot(multiplier_, c);
}

/// b − Bᵀμ + ρBᵀc.
void OuterIteration::linearTermOfLagrangian(Vector& b) const {
  b.assign(*problem_.linearTerm);
  std::vector<double> combined(multiplier_);
  const auto c = equality_.rightHandSide();
  for (std::size_t i = 0; i < c.size(); ++i)
    combined[i] -= penalty_ * c[i];
  equality_.addTransposedProduct(combined, -1.0, b);
}

Status OuterIteration::run(const Vector& start, Observer* observer) {
  linearTermOfLagrangian(work_);
  inner_.start(work_, start, constantOfLagrangian());
  if (inner_.solution().normInf() > 0)
    startMultiplier();

  Progress previous;
  while (inner_.counts().outer < parameters_.maxOuterIterations) {
    rule_.startInnerLoop();
    const Status status = inner_.run(rule_, observer); // ‖g^P‖ ≤ min(M‖Bx − c‖, η)
    if (status != Status::converged && !(status == Status::stagnated && toleratesRoundOff(previous)))
      return status;
    if (rule_.isMet() && inner_.gradientIsFresh())
      return Status::converged;
    if (!restorationsHelp())
      return Status::stagnated;
    wasRestored_ = rule_.isFinal() || status == Status::stagnated;
    if (rule_.isFinal() &&
        !equality_.isReplicated()) { // Bx = c cannot be made exact: only the gradient is in doubt
      restore();
      continue;
    }
    const Progress now{inner_.objective(), rule_.residualNorm()};
    updateMultiplier(previous); // μ ← μ + ρ(Bx − c), or further
    adapt(previous, now);
    previous = now;
    ++inner_.counts().outer;
    if (wasRestored_)
      restore();
  }
  return Status::maxIterations;
}

/// What MPRGP cannot improve any further is good enough for the next multiplier, as long as these make progress.
bool OuterIteration::toleratesRoundOff(const Progress& previous) {
  constexpr int maxIdle = 3;
  idle_ = rule_.residualNorm() > 0.9 * previous.residual ? idle_ + 1 : 0;
  return idle_ <= maxIdle;
}

/// M ← βM, or ρ ← βρ, when L grew by less than ρ/2‖Bx − c‖²; and where ρ may change, ρ ← βρ as well when ‖Bx − c‖ has
/// twice in a row not been halved.
void OuterIteration::adapt(const Progress& previous, const Progress& now) {
  const bool isFirst = inner_.counts().outer == 0;
  const double roundOff = 1e-14 * std::abs(now.lagrangian);
  const bool grewTooLittle =
      !isFirst &&
      now.lagrangian < previous.lagrangian + 0.5 * penalty_ * now.residual * now.residual - roundOff;
  // A residual that is round-off of Bx does not fall any more, whatever the penalty.
  const bool isRoundOff = now.residual <= 1e-13 * equality_.norm() * inner_.solutionNorm();
  slow_ = !isFirst && !isRoundOff && now.residual > 0.5 * previous.residual ? slow_ + 1 : 0;
  using Update = SmalbeParameters::Update;
  const bool mayGrow = penalty_ * equality_.norm() * equality_.norm() < maxPenalty * problem_.operatorNorm;
  if (grewTooLittle && (parameters_.update != Update::penalty || !mayGrow))
    rule_.reduceBalance(parameters_.balanceReduction);
  const bool isSlow = parameters_.update != Update::balance && slow_ >= 2;
  if (mayGrow && (isSlow || (grewTooLittle && parameters_.update == Update::penalty))) {
    growPenalty();
    slow_ = 0;
  }
}

/// Gives a warm start the multiplier that belongs to it; without, the first outer iterations would lead away from it.
void OuterIteration::startMultiplier() {
  if (!equality_.isReplicated())
    return;
  Vector gradient(inner_.scaledGradient(), Teuchos::Copy);
  gradient.scale(1.0 / inner_.gradientScale());
  const std::vector<double> change =
      estimateMultiplier(equality_, *problem_.set, inner_.solution(), gradient);
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
  Vector change(work_.getMap()); // of the gradient: growth · Bᵀ(Bx − c)
  equality_.addTransposedProduct(rule_.residual(), growth, change);
  penalty_ += growth;
  hessian_->setPenalty(penalty_);
  linearTermOfLagrangian(work_);
  inner_.changeHessian(change, 0.5 * growth * residual * residual, work_, constantOfLagrangian(),
                       normOfLagrangian());
}

/// μ may go further than the paper's step ρ(Bx − c), to `extrapolation()` or where the inner solution x does not notice:
/// while every entry that the shift touches is held at its bound, x stays the minimiser and L grows linearly in μ, until
/// the first multiplier there changes its sign.
void OuterIteration::updateMultiplier(const Progress& previous) {
  work_.putScalar(0.0);
  equality_.addTransposedProduct(rule_.residual(), penalty_ * inner_.gradientScale(), work_);
  const double longest =
      minOverRanks(*work_.getMap()->getComm(),
                   problem_.set->longestMultiplierStep(inner_.solution(), inner_.scaledGradient(), work_));
  const double step = std::max({1.0, std::isfinite(longest) ? longest : 1.0, extrapolation(previous)});
  work_.scale(step / inner_.gradientScale());
  const double residual = rule_.residualNorm();
  inner_.shiftLinearTerm(work_, step * penalty_ * residual * residual);
  for (std::size_t i = 0; i < multiplier_.size(); ++i)
    multiplier_[i] += step * penalty_ * rule_.residual()[i];
}

/// Where residual after residual is the last one times q, close to 1 (rows that the free entries can hardly serve), the sum
/// of the steps to come is 1/(1 − q) of them.
double OuterIteration::extrapolation(const Progress& previous) {
  constexpr int patience = 4;
  constexpr double longest = 1e8;
  const double residual = rule_.residualNorm();
  const double alignment = equality_.dot(rule_.residual(), lastResidual_) / (residual * previous.residual);
  lastResidual_.assign(rule_.residual().begin(), rule_.residual().end());
  aligned_ = residual > 0.5 * previous.residual && alignment > 0.99 ? aligned_ + 1 : 0;
  if (aligned_ < patience)
    return 1;
  aligned_ = 0;
  const double ratio = residual / previous.residual;
  return ratio < 1 ? std::min(1 / (1 - ratio), longest) : 1;
}

/// The certificate: Bx = c to round-off and a fresh gradient; if it fails the iteration goes on.
void OuterIteration::restore() {
  work_.assign(inner_.solution());
  if (equality_.isReplicated())
    restoreEquality(equality_, *problem_.set, rule_.residual(), work_);
  Vector b(work_.getMap()); // afresh as well: many shifts have left their round-off in it
  linearTermOfLagrangian(b);
  inner_.start(b, work_, constantOfLagrangian());
}

/// Whether the gradients after restorations, none of which was small enough, still become smaller.
bool OuterIteration::restorationsHelp() {
  constexpr int maxIdle = 8;
  if (!wasRestored_)
    return true;
  const bool isBetter = inner_.startGradient() < 0.999 * bestRestored_;
  bestRestored_ = std::min(bestRestored_, inner_.startGradient());
  idleRestorations_ = isBetter ? 0 : idleRestorations_ + 1;
  return idleRestorations_ <= maxIdle;
}

} // namespace

Teuchos::ParameterList SmalbeParameters::validParameters() {
  const SmalbeParameters defaults;
  Teuchos::ParameterList list("SMALBE");
  addChoice(list, "Update", "both",
            "What changes when the augmented Lagrangian grew by less than ρ/2‖Bx − c‖²: the balance M "
            "(SMALBE-M) or the "
            "penalty ρ (SMALBE-ρ). 'both' is 'balance', and ρ grows where ‖Bx − c‖ falls slowly.",
            {"both", "balance", "penalty"});
  addReal(list, "Penalty", defaults.penalty, "ρ‖B‖² as a multiple of ‖A‖ (in FETI-DP: ρ of ‖PFP‖).", 0.0,
          1e12, true);
  addReal(list, "Balance", defaults.balance,
          "M‖B‖ at the start as a multiple of ‖A‖: inner loops stop at ‖gᴾ‖ ≤ M‖Bx − c‖.", 0.0, 1e12, true);
  addReal(list, "Balance Reduction", defaults.balanceReduction,
          "Factor on M, with Update 'balance' or 'both'.", 0.0, 1.0, true, true);
  addReal(list, "Penalty Growth", defaults.penaltyGrowth, "Factor on ρ, with Update 'penalty' or 'both'.",
          1.0, 1e6, true);
  addReal(list, "Forcing", defaults.forcing, "η as a multiple of the gradient's reference.", 0.0, 1e12, true);
  addInteger(list, "Maximum Outer Iterations", defaults.maxOuterIterations,
             "Updates of the multiplier of the equality constraints at most.", 1);
  return list;
}

SmalbeParameters SmalbeParameters::from(const Teuchos::ParameterList& list) {
  SmalbeParameters parameters;
  const auto& update = list.get<std::string>("Update");
  parameters.update = update == "both"      ? Update::both
                      : update == "penalty" ? Update::penalty
                                            : Update::balance;
  parameters.penalty = list.get<double>("Penalty");
  parameters.balance = list.get<double>("Balance");
  parameters.balanceReduction = list.get<double>("Balance Reduction");
  parameters.penaltyGrowth = list.get<double>("Penalty Growth");
  parameters.forcing = list.get<double>("Forcing");
  parameters.maxOuterIterations = list.get<int>("Maximum Outer Iterations");
  return parameters;
}

SolveReport solveEqualityBoundProblem(const EqualityBoundProblem& problem, Vector& x,
                                      std::vector<double>& multiplier, const SmalbeTolerances& tolerances,
                                      const SmalbeParameters& parameters, const MprgpParameters& inner,
                                      Observer* observer) {
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);
  OuterIteration outer(problem, multiplier, tolerances, parameters, inner);
  report.status = outer.run(x, &recorder);

  Mprgp& solver = outer.inner();
  x.assign(solver.solution());
  describeEnd(solver, report);
  if (report.status == Status::maxIterations && report.counts.outer >= parameters.maxOuterIterations)
    report.reason =
        "the limit of outer iterations was reached before the tolerance; raise 'Maximum Outer Iterations' or "
        "the tolerance";
  report.relativeProjectedGradient = relativeTo(tolerances.gradientReference, solver.projectedGradient());
  for (std::size_t i = 0; i < multiplier.size();
       ++i) // the gradient is that of L: μ + ρ(Bx − c) is what it belongs to
    multiplier[i] += outer.penalty() * outer.rule().residual()[i];
  report.relativeConstraintResidual = relativeTo(tolerances.constraintReference, outer.rule().residualNorm());
  return report;
}

} // namespace epafi::qp
