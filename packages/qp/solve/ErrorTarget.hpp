#pragma once

/// Stopping at an error instead of a gradient: in the energy norm, as small as the problem's owner asks for.

#include "epafi/qp/solve/StoppingRule.hpp"

namespace epafi::qp {

/// Says which error ‖x − x*‖_A is small enough. May look at the iterate, at a cost: it is asked once at the
/// start and again whenever its last answer has been met.
class ErrorTarget {
public:
  virtual ~ErrorTarget() = default;
  /// \param error  of the start, at most
  virtual double first(double error) = 0;
  /// \param error  of x, at most
  /// All ranks call it together and get the same answer.
  virtual double at(double error, const Vector& x) = 0;
};

/// Whether an error meets a target that is asked for anew where it was met.
class ErrorWatch {
public:
  /// Keeps the reference.
  explicit ErrorWatch(ErrorTarget& target) : target_(target) {}

  /// \param error  ‖x − x*‖_A, at most. Collective.
  bool isSmallEnough(double error, const Vector& x) {
    if (!isStarted_)
      limit_ = target_.first(error);
    isStarted_ = true;
    if (!(error <= limit_)) {
      isMet_ = false;
      return false;
    }
    if (!isMet_) { // else x is as good as the one that the limit is for: its certificate
      limit_ = target_.at(error, x);
      isMet_ = error <= limit_;
    }
    return isMet_;
  }

  /// The last answer; 0: none was asked for.
  [[nodiscard]] double limit() const { return limit_; }

private:
  ErrorTarget& target_;
  double limit_ = 0;
  bool isStarted_ = false, isMet_ = false;
};

/// Stops MPRGP at the target. Precondition: there is a preconditioner M ≥ A⁻¹.
class ErrorRule final : public StoppingRule {
public:
  /// \param reference  what gradients are relative to in the history
  ErrorRule(ErrorTarget& target, double reference) : watch_(target), reference_(reference) {}
  [[nodiscard]] bool usesEnergy() const override { return true; }
  void addLocalSums(const Vector& x, std::span<AccurateSum> /*sums*/) override { x_ = &x; }
  bool isSatisfied(const GradientNorms& gradient, std::span<const AccurateSum> /*sums*/) override {
    return watch_.isSmallEnough(gradient.energy, *x_);
  }
  void describe(StepRecord& record) const override {
    record.projectedGradient = relativeTo(reference_, record.projectedGradient);
  }

private:
  ErrorWatch watch_;
  double reference_;
  const Vector* x_ = nullptr; ///< of the measurement at hand
};

} // namespace epafi::qp
