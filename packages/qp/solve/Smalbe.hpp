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

#include "epafi/qp/solve/MprgpParameters.hpp"
#include "epafi/qp/solve/QuadraticProgram.hpp"
#include "epafi/qp/solve/SolveReport.hpp"
#include "epafi/qp/solve/StoppingRule.hpp"

#include <Teuchos_ParameterList.hpp>

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

/// M, where there is one, is of A + ρBᵀB.
/// \param x  in: start (projected onto Ω; the multiplier starts from what suits it); out: the last iterate,
/// in Ω
/// Returns converged only if a gradient computed afresh bears it out. Precondition: Ω is not empty.
/// Collective.
SolveReport solveBySmalbe(const QuadraticProgram& program, Vector& x, const Tolerances& tolerances,
                          const SmalbeParameters& parameters, const MprgpParameters& inner,
                          Observer* observer = nullptr);

} // namespace epafi::qp
