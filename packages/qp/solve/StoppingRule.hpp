#pragma once

/// When an iteration is over.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/solve/SolveReport.hpp"

#include <algorithm>
#include <span>

namespace epafi::qp {

class ErrorTarget;

/// What a solve stops at: ‖g^P‖ ≤ max(gradient · gradientReference, absolute), or the error's target if there
/// is one, and with equations ‖Bx − c‖ ≤ constraint · constraintReference.
struct Tolerances {
  double gradient = 1e-6, gradientReference = 1;
  double constraint = 1e-6, constraintReference = 1;
  ErrorTarget* error = nullptr; ///< takes the place of `gradient`; needs a preconditioner (ErrorTarget.hpp)
  double absolute = 0;          ///< of ‖g^P‖

  /// What ‖g^P‖ is to fall to.
  [[nodiscard]] double gradientLimit() const { return std::max(gradient * gradientReference, absolute); }
  /// What ‖Bx − c‖ is to fall to.
  [[nodiscard]] double constraintLimit() const { return constraint * constraintReference; }
};

/// The projected gradient in two norms.
struct GradientNorms {
  double euclidean = 0; ///< ‖g^P‖
  /// (g^Pᵀ M g^P)^½ with the preconditioner M, for rules that ask for it. Where M ≥ A⁻¹, as in FETI-DP, it
  /// bounds the error:
  ///   ‖x − x*‖_A² ≤ gᵀ(x − x*) ≤ (g^P)ᵀ(x − x*) ≤ ‖g^P‖_{A⁻¹} ‖x − x*‖_A,
  /// as g*ᵀ(x − x*) ≥ 0, and what g^P leaves out of g points out of the set. Between certificates it is
  /// estimated from what M does to the steps' directions.
  double energy = 0;
};

/// Says when an MPRGP run is over. May take part in the reduction that every step makes anyway: `numSums`
/// further numbers are summed over the ranks at no extra message.
class StoppingRule {
public:
  virtual ~StoppingRule() = default;
  [[nodiscard]] virtual int numSums() const { return 0; } ///< the same on all ranks
  /// Adds this rank's contributions for the iterate x. All ranks call it together.
  virtual void addLocalSums(const Vector& /*x*/, std::span<AccurateSum> /*sums*/) {}
  /// Whether GradientNorms::energy is wanted: one application of M at the start and one for the certificate.
  [[nodiscard]] virtual bool usesEnergy() const { return false; }
  /// \param sums  the sums over all ranks
  virtual bool isSatisfied(const GradientNorms& gradient, std::span<const AccurateSum> sums) = 0;
  /// Fills the rule's part of the record (relative quantities).
  virtual void describe(StepRecord& record) const = 0;
};

/// value/reference, or the value itself where the reference vanishes.
inline double relativeTo(double reference, double value) {
  return reference > 0 ? value / reference : value;
}

/// Stops when ‖g^P‖ ≤ limit.
class GradientRule final : public StoppingRule {
public:
  /// \param reference  what gradients are relative to in the history; 0: they are not
  GradientRule(double limit, double reference) : limit_(limit), reference_(reference) {}
  bool isSatisfied(const GradientNorms& gradient, std::span<const AccurateSum> /*sums*/) override {
    return gradient.euclidean <= limit_;
  }
  void describe(StepRecord& record) const override {
    record.projectedGradient = relativeTo(reference_, record.projectedGradient);
  }

private:
  double limit_, reference_;
};

} // namespace epafi::qp
