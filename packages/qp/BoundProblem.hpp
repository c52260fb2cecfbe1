#pragma once

/// min ½xᵀAx − bᵀx, l ≤ x ≤ u from start to certificate.

#include "epafi/qp/Mprgp.hpp"

namespace epafi::qp {

/// Stops when ‖g^P‖ ≤ tolerance · reference. A reference of 0 (no load) asks for ‖g^P‖ = 0.
class RelativeGradientRule final : public StoppingRule {
public:
  RelativeGradientRule(double tolerance, double reference) : tolerance_(tolerance), reference_(reference) {}
  bool isSatisfied(double projectedGradient, std::span<const AccurateSum> sums) override;
  void describe(StepRecord& record) const override;

private:
  double tolerance_, reference_;
};

/// Keeps every step and passes it on.
class HistoryRecorder final : public Observer {
public:
  HistoryRecorder(History& history, Observer* next) : history_(history), next_(next) {}
  void step(const StepRecord& record) override;

private:
  History& history_;
  Observer* next_;
};

/// Runs `solver` until `rule` holds for a gradient computed afresh: when the updated gradient says
/// "converged", one further product confirms it; should it not, the iteration goes on from the fresh
/// gradient. Returns `stagnated` if five fresh gradients in turn refuse what the updated ones promised:
/// round-off allows no more. Collective.
Status runToCertificate(Mprgp& solver, StoppingRule& rule, Observer* observer);

/// Solves to ‖g^P‖ ≤ tolerance · ‖b‖, starting from the projection of x.
/// \param x  in: start; out: always the last feasible iterate
/// \param operatorNorm  over-estimate of ‖A‖ (see estimateNorm)
/// \throws InputError if the bounds cross. Collective.
SolveReport solveBoundProblem(const RCP<const Operator>& a, const Vector& b, const Bounds& bounds, Vector& x,
                              double tolerance, const MprgpParameters& parameters, double operatorNorm,
                              Observer* observer = nullptr);

} // namespace epafi::qp
