#pragma once

/// min ½xᵀAx − bᵀx over a convex set, from start to certificate.

#include "epafi/qp/Mprgp.hpp"

namespace epafi::qp {

struct BoundProblem {
  RCP<const Operator> hessian;        ///< A, n × n
  RCP<const Vector> linearTerm;       ///< b
  RCP<const ConvexSet> set;           ///< Ω
  RCP<const Operator> preconditioner; ///< M ≈ A⁻¹, or null
  double operatorNorm = 1;            ///< over-estimate of ‖A‖ (see estimateNorm)
};

/// Stop at ‖g^P‖ ≤ max(relative · reference, absolute).
struct GradientTolerance {
  double relative = 1e-6, reference = 1, absolute = 0;
};

/// Runs `solver` until `rule` holds for a gradient computed afresh: when the updated gradient says
/// "converged", one further product confirms it; should it not, the iteration goes on from the fresh
/// gradient. Returns `stagnated` if five fresh gradients in turn refuse what the updated ones promised:
/// round-off allows no more. Collective.
Status runToCertificate(Mprgp& solver, StoppingRule& rule, Observer* observer);

/// Solves by MPRGP until the rule holds, starting from the projection of x.
/// \param x          in: start; out: always the last feasible iterate
/// \param reference  what the report's gradient is relative to
/// Precondition: the set is not empty. Collective.
SolveReport solveBoundProblem(const BoundProblem& problem, Vector& x, StoppingRule& rule, double reference,
                              const MprgpParameters& parameters, Observer* observer = nullptr);
/// The same until the gradient is small enough.
SolveReport solveBoundProblem(const BoundProblem& problem, Vector& x, const GradientTolerance& tolerance,
                              const MprgpParameters& parameters, Observer* observer = nullptr);

/// Fills what MPRGP and SMALBE report alike: the reason, the norm, a fresh gradient, a certificate. Not
/// collective but for the certificate.
void describeEnd(Mprgp& solver, SolveReport& report);

} // namespace epafi::qp
