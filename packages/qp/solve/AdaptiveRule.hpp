#pragma once

/// When an inner loop of SMALBE is over.

#include "epafi/qp/constraints/EqualityConstraint.hpp"
#include "epafi/qp/solve/ErrorTarget.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace epafi::qp {

/// With an error's target: ‖Bx − c‖ relative to its reference at which x is worth being moved onto Bx = c,
/// where the rows allow that. Whether the error is small enough shows there.
inline constexpr double worthRestoring = 1e-2;

/// η as a multiple of the gradient's reference.
inline constexpr double forcing = 0.1;

/// The inner loop's rule: ‖g^P‖ ≤ min(M‖Bx − c‖, η), or both final tolerances.
class AdaptiveRule final : public StoppingRule {
public:
  AdaptiveRule(RCP<const EqualityConstraint> equality, const Tolerances& tolerances, double balance)
      : equality_(std::move(equality)), tolerances_(tolerances), balance_(balance),
        residual_(equality_->numEntries()), weighed_(residual_.size()) {
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
    residualNorm_ = equality_->finishResidual(sums, residual_, weighed_);
    const bool isRough = watch_ && equality_->isReplicated();
    const double constraint =
        isRough ? std::max(worthRestoring, tolerances_.constraint) : tolerances_.constraint;
    isFinal_ = residualNorm_ <= constraint * tolerances_.constraintReference &&
               (watch_ ? watch_->isSmallEnough(gradient.energy, *x_)
                       : projectedGradient <= tolerances_.gradientLimit());
    // After a thousand steps it is time for another multiplier, if only the gradient is small enough for the
    // end.
    const bool isLong = ++steps_ > 1000;
    const double enough = isLong ? 0.1 * tolerances_.gradientLimit() : 0.0;
    return isFinal_ ||
           projectedGradient <=
               std::max(std::min(balance_ * residualNorm_, forcing * tolerances_.gradientReference), enough);
  }

  void describe(StepRecord& record) const override {
    record.projectedGradient = relativeTo(tolerances_.gradientReference, record.projectedGradient);
    record.constraintResidual = relativeTo(tolerances_.constraintReference, residualNorm_);
  }

  /// Both final tolerances hold, that of Bx = c as far as a restoration needs it.
  [[nodiscard]] bool isFinal() const { return isFinal_; }
  /// They hold as asked for.
  [[nodiscard]] bool isMet() const { return isFinal_ && residualNorm_ <= tolerances_.constraintLimit(); }
  [[nodiscard]] double residualNorm() const { return residualNorm_; }
  [[nodiscard]] std::span<const double> residual() const { return residual_; }
  /// Of W(Bx − c), what it adds to multipliers.
  [[nodiscard]] std::span<const double> weighedResidual() const { return weighed_; }
  void reduceBalance(double factor) { balance_ *= factor; }
  void startInnerLoop() { steps_ = 0; }

private:
  RCP<const EqualityConstraint> equality_;
  Tolerances tolerances_;
  double balance_;
  std::vector<double> residual_, weighed_;
  double residualNorm_ = 0;
  std::optional<ErrorWatch> watch_;
  const Vector* x_ = nullptr; ///< of the measurement at hand
  int steps_ = 0;             ///< of the inner loop
  bool isFinal_ = false;
};

} // namespace epafi::qp
