#pragma once

/// When an iteration is over.

#include "epafi/base/AccurateSum.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <algorithm>
#include <span>

namespace epafi::qp {

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

/// Stops when ‖g^P‖ ≤ max(relative · reference, absolute). A reference of 0 (no load) asks for ‖g^P‖ ≤
/// absolute.
class GradientRule final : public StoppingRule {
public:
  /// \param relative, reference, absolute  as above
  GradientRule(double relative, double reference, double absolute = 0)
      : limit_(std::max(relative * reference, absolute)), reference_(reference) {}
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
