#include "epafi/qp/Smalbe.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/qp/BoundProblem.hpp"
#include "epafi/qp/EqualityRestoration.hpp"
#include "epafi/qp/PenalizedOperator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace epafi::qp {
namespace {

/// The inner loop's rule: ‖g^P‖ ≤ min(M‖Gx‖, η), or both final tolerances. Its sums are Gx itself.
class AdaptiveRule final : public StoppingRule {
public:
  AdaptiveRule(RCP<const EqualityConstraint> g, const SmalbeTolerances& tolerances, double balance,
               double forcing)
      : g_(std::move(g)), tolerances_(tolerances), balance_(balance), forcing_(forcing),
        gx_(static_cast<std::size_t>(g_->size())) {}

  [[nodiscard]] int numSums() const override { return g_->size(); }
  void addLocalSums(const Vector& x, std::span<AccurateSum> sums) override { g_->addLocalProduct(x, sums); }

  bool isSatisfied(double projectedGradient, std::span<const AccurateSum> sums) override {
    g_->finishProduct(sums, gx_);
    double squared = 0;
    for (const double value : gx_)
      squared += value * value;
    constraintNorm_ = std::sqrt(squared);
    isFinal_ = projectedGradient <= tolerances_.gradient * tolerances_.gradientReference &&
               constraintNorm_ <= tolerances_.constraint * tolerances_.constraintReference;
    return isFinal_ || projectedGradient <= std::min(balance_ * constraintNorm_, forcing_);
  }

  void describe(StepRecord& record) const override {
    if (tolerances_.gradientReference > 0)
      record.projectedGradient /= tolerances_.gradientReference;
    record.constraintResidual = tolerances_.constraintReference > 0
                                    ? constraintNorm_ / tolerances_.constraintReference
                                    : constraintNorm_;
  }

  [[nodiscard]] bool isFinal() const { return isFinal_; } ///< both final tolerances hold
  [[nodiscard]] double constraintNorm() const { return constraintNorm_; }
  [[nodiscard]] std::span<const double> constraintValue() const { return gx_; }
  void reduceBalance(double factor) { balance_ *= factor; }

private:
  RCP<const EqualityConstraint> g_;
  SmalbeTolerances tolerances_;
  double balance_, forcing_;
  std::vector<double> gx_;
  double constraintNorm_ = 0;
  bool isFinal_ = false;
};

/// How far μ may go along `shift` before the inner solution x notices: while every entry that the shift
/// touches is held at its bound, x stays the minimiser and L grows linearly in μ, until the first gradient
/// there changes its sign. At least 1, the paper's step. Collective.
double longestStep(const Bounds& bounds, const Vector& x, const Vector& g, const Vector& shift) {
  const auto values = localData(x), gradient = localData(g), s = localData(shift);
  const Bounds::Local local = bounds.local();
  double longest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Bounds::Interval interval = local[i];
    if (s[i] == 0 || !(interval.lower < interval.upper))
      continue;
    if (interval.isFree(values[i]))
      longest = 0;
    else if ((values[i] <= interval.lower) == (s[i] < 0)) // the gradient moves towards 0
      longest = std::min(longest, -gradient[i] / s[i]);
  }
  longest = minOverRanks(*x.getMap()->getComm(), longest);
  return std::isfinite(longest) ? std::max(1.0, longest) : 1.0;
}

/// Gives a warm start the multiplier that belongs to it; without, the first outer iterations would lead away
/// from it. Collective.
void startMultiplier(Mprgp& inner, const EqualityConstraint& g, const Bounds& bounds) {
  const std::vector<double> multiplier = estimateMultiplier(g, bounds, inner.solution(), inner.gradient());
  Vector shift(inner.solution().getMap());
  g.addTransposedProduct(multiplier, 1.0, shift);
  inner.shiftLinearTerm(shift, accurateDot(shift, inner.solution()));
}

/// The outer loop of the paper.
Status iterate(Mprgp& inner, AdaptiveRule& rule, const EqualityConstraint& g, const Bounds& bounds,
               const SmalbeParameters& parameters, double penalty, Observer* observer) {
  constexpr int maxFreshStarts = 10;
  Vector shift(inner.solution().getMap());
  double previousLagrangian = 0;
  int freshStarts = 0;
  while (inner.counts().outer < parameters.maxOuterIterations) {
    const Status status = inner.run(rule, observer); // ‖g^P‖ ≤ min(M‖Gx‖, η)
    if (status != Status::converged)
      return status;
    if (rule.isFinal() && inner.gradientIsFresh())
      return Status::converged;
    const double residual = rule.constraintNorm();
    const double lagrangian = inner.objective();
    if (inner.counts().outer > 0 && lagrangian < previousLagrangian + 0.5 * penalty * residual * residual)
      rule.reduceBalance(parameters.balanceReduction); // L grew too little: M ← βM
    previousLagrangian = lagrangian;

    shift.putScalar(0.0); // μ ← μ + ρGx, or further
    g.addTransposedProduct(rule.constraintValue(), penalty, shift);
    const double step = longestStep(bounds, inner.solution(), inner.gradient(), shift);
    shift.scale(step);
    inner.shiftLinearTerm(shift, step * penalty * residual * residual);
    ++inner.counts().outer;

    if (rule.isFinal()) { // the certificate: Gx = 0 to round-off and a fresh gradient; if it fails the
                          // iteration goes on
      if (++freshStarts > maxFreshStarts)
        return Status::stagnated;
      shift.assign(inner.solution());
      restoreEquality(g, bounds, rule.constraintValue(), shift);
      inner.moveTo(shift);
    }
  }
  return Status::maxIterations;
}

} // namespace

Teuchos::ParameterList SmalbeParameters::validParameters() {
  const SmalbeParameters defaults;
  Teuchos::ParameterList list("SMALBE");
  addReal(list, "Penalty", defaults.penalty, "ρ as a multiple of ‖PFP‖.", 0.0, 1e12, true);
  addReal(list, "Balance", defaults.balance,
          "M at the start as a multiple of ‖PFP‖: inner loops stop at ‖gᴾ‖ ≤ M‖Gλ‖.", 0.0, 1e12, true);
  addReal(list, "Balance Reduction", defaults.balanceReduction,
          "Factor on M when the augmented Lagrangian grew by less than ρ/2‖Gλ‖².", 0.0, 1.0, true, true);
  addReal(list, "Forcing", defaults.forcing, "η as a multiple of the gradient's reference.", 0.0, 1e12, true);
  addInteger(list, "Maximum Outer Iterations", defaults.maxOuterIterations,
             "Updates of the multiplier of Gλ = 0 at most.", 1);
  return list;
}

SmalbeParameters SmalbeParameters::from(const Teuchos::ParameterList& list) {
  SmalbeParameters parameters;
  parameters.penalty = list.get<double>("Penalty");
  parameters.balance = list.get<double>("Balance");
  parameters.balanceReduction = list.get<double>("Balance Reduction");
  parameters.forcing = list.get<double>("Forcing");
  parameters.maxOuterIterations = list.get<int>("Maximum Outer Iterations");
  return parameters;
}

SolveReport solveEqualityBoundProblem(const RCP<const Operator>& a, const RCP<const EqualityConstraint>& g,
                                      const Vector& b, const Bounds& bounds, Vector& x,
                                      const SmalbeTolerances& tolerances, const SmalbeParameters& parameters,
                                      const MprgpParameters& inner, double operatorNorm, Observer* observer) {
  bounds.check(*b.getMap()->getComm());
  SolveReport report;
  HistoryRecorder recorder(report.history, observer);

  const double penalty = parameters.penalty * operatorNorm;
  const RCP<const Operator> hessian = rcp(new PenalizedOperator(a, g, penalty));
  AdaptiveRule rule(g, tolerances, parameters.balance * operatorNorm,
                    parameters.forcing * tolerances.gradientReference);
  Mprgp solver(hessian, bounds, inner, std::max(operatorNorm, penalty)); // ‖A + ρGᵀG‖ where Im Gᵀ ⊂ Ker A
  solver.start(b, x);
  if (solver.solution().normInf() > 0)
    startMultiplier(solver, *g, bounds);
  report.status = iterate(solver, rule, *g, bounds, parameters, penalty, &recorder);
  x.assign(solver.solution());

  const auto relative = [](double value, double reference) {
    return reference > 0 ? value / reference : value;
  };
  report.reason =
      report.status == Status::maxIterations && solver.counts().outer >= parameters.maxOuterIterations
          ? "the limit of outer iterations was reached before the tolerance; raise 'Maximum Outer "
            "Iterations' or the tolerance"
          : explain(report.status);
  report.counts = solver.counts();
  report.relativeProjectedGradient = relative(solver.projectedGradient(), tolerances.gradientReference);
  report.relativeConstraintResidual = relative(rule.constraintNorm(), tolerances.constraintReference);
  report.objective = solver.objective();
  return report;
}

} // namespace epafi::qp
