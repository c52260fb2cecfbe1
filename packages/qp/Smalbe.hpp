#pragma once

/// SMALBE-M: semimonotonic augmented Lagrangians for min ½xᵀAx − bᵀx, Gx = 0, l ≤ x ≤ u, with GGᵀ = I.
/// Dostál, *Computing* 78 (2006) 311–328; Dostál, *Optimal Quadratic Programming Algorithms* (2009),
/// algorithm 6.2.
///
/// Outer loop on the multiplier μ of Gx = 0 with the penalty ρ fixed; the inner loop is MPRGP on the
/// augmented Lagrangian
///   L(x, μ, ρ) = ½xᵀ(A + ρGᵀG)x − bᵀx + μᵀGx,
/// stopped at ‖g^P‖ ≤ min(M‖Gx‖, η). When both tolerances are met, x is moved within its face onto Gx = 0 (to
/// round-off) and the gradient computed afresh must still meet its tolerance.

#include "epafi/qp/EqualityConstraint.hpp"
#include "epafi/qp/Mprgp.hpp"

namespace epafi::qp {

struct SmalbeParameters {
  double penalty = 7.0;          ///< ρ as a multiple of ‖A‖
  double balance = 1.0;          ///< M at the start, as a multiple of ‖A‖
  double balanceReduction = 0.5; ///< factor on M when L grew too little
  double forcing = 0.1;          ///< η as a multiple of ‖b‖
  int maxOuterIterations = 200;

  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static SmalbeParameters from(const Teuchos::ParameterList& list);
};

/// What to stop at: ‖g^P‖ ≤ gradient · gradientReference and ‖Gx‖ ≤ constraint · constraintReference.
struct SmalbeTolerances {
  double gradient = 1e-6, gradientReference = 1;
  double constraint = 1e-6, constraintReference = 1;
};

/// Precondition: A symmetric positive semidefinite, positive definite on Ker G; G as EqualityConstraint says.
/// \param x  in: start (projected onto the bounds; the multiplier starts from what suits it); out: the last
///        iterate, feasible for the bounds
/// \param operatorNorm  over-estimate of ‖A‖
/// Returns converged only if a gradient computed afresh bears it out.
/// \throws InputError if the bounds cross.
/// Collective.
SolveReport solveEqualityBoundProblem(const RCP<const Operator>& a, const RCP<const EqualityConstraint>& g,
                                      const Vector& b, const Bounds& bounds, Vector& x,
                                      const SmalbeTolerances& tolerances, const SmalbeParameters& parameters,
                                      const MprgpParameters& inner, double operatorNorm,
                                      Observer* observer = nullptr);

} // namespace epafi::qp
