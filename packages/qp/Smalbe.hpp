#pragma once

/// SMALBE: semimonotonic augmented Lagrangians for min ½xᵀAx − bᵀx, Bx = c, x in Ω.
/// Dostál, *Computing* 78 (2006) 311–328; Dostál, *Optimal Quadratic Programming Algorithms* (2009),
/// algorithm 6.2 (SMALBE-M, the balance M adapts) and section 6.11 (SMALBE-ρ, the penalty ρ adapts).
///
/// Outer loop on the multiplier μ of Bx = c; the inner loop is MPRGP on the augmented Lagrangian
///   L(x, μ, ρ) = ½xᵀAx − bᵀx + μᵀ(Bx − c) + ρ/2 ‖Bx − c‖²,
/// stopped at ‖g^P‖ ≤ min(M‖Bx − c‖, η). When both tolerances are met, x is moved within its face onto Bx = c
/// (to round-off, where the rows are replicated) and the gradient computed afresh must still meet its
/// tolerance.

#include "epafi/qp/ConvexSet.hpp"
#include "epafi/qp/EqualityConstraint.hpp"
#include "epafi/qp/ErrorTarget.hpp"
#include "epafi/qp/MprgpParameters.hpp"
#include "epafi/qp/SolveReport.hpp"

#include <Teuchos_ParameterList.hpp>

#include <vector>

namespace epafi::qp {

/// How multiplier, balance and penalty change.
struct SmalbeParameters {
  /// What changes when the augmented Lagrangian grew too little. `both`: the balance, and the penalty where
  /// the residual of the constraint falls slowly.
  enum class Update { both, balance, penalty };
  Update update = Update::both;
  double penalty = 1.0;          ///< ρ‖B‖² as a multiple of ‖A‖
  double balance = 0.3;          ///< M‖B‖ at the start, as a multiple of ‖A‖
  double balanceReduction = 0.5; ///< factor on M (SMALBE-M)
  double penaltyGrowth = 10;     ///< factor on ρ (SMALBE-ρ)
  int maxOuterIterations = 200;

  /// All of them with defaults, ranges and meaning.
  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static SmalbeParameters from(const Teuchos::ParameterList& list);
};

/// What to stop at: ‖g^P‖ ≤ gradient · gradientReference, or the error's target if there is one, and
/// ‖Bx − c‖ ≤ constraint · constraintReference.
struct SmalbeTolerances {
  double gradient = 1e-6, gradientReference = 1;
  double constraint = 1e-6, constraintReference = 1;
  ErrorTarget* error = nullptr; ///< takes the place of `gradient`; needs a preconditioner
};

/// The problem, as SMALBE needs it.
struct EqualityBoundProblem {
  RCP<const Operator> hessian;            ///< A, n × n, positive definite on Ker B
  RCP<const Vector> linearTerm;           ///< b
  RCP<const ConvexSet> set;               ///< Ω
  RCP<const EqualityConstraint> equality; ///< Bx = c
  RCP<const Operator> preconditioner;     ///< of A + ρBᵀB, or null
  double operatorNorm = 1;                ///< over-estimate of ‖A‖
};

/// \param x  in: start (projected onto Ω; the multiplier starts from what suits it); out: the last iterate,
/// in Ω
/// \param multiplier  out: μ, in the constraint's own entries
/// Returns converged only if a gradient computed afresh bears it out. Precondition: Ω is not empty.
/// Collective.
SolveReport solveEqualityBoundProblem(const EqualityBoundProblem& problem, Vector& x,
                                      std::vector<double>& multiplier, const SmalbeTolerances& tolerances,
                                      const SmalbeParameters& parameters, const MprgpParameters& inner,
                                      Observer* observer = nullptr);

} // namespace epafi::qp
