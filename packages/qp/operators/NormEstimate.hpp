#pragma once

/// Estimates of ‖A‖ = λ_max(A) of a symmetric positive semidefinite operator, safe from above.

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

namespace epafi::qp {

/// How an estimate is made, and when it is good enough.
struct NormEstimateParameters {
  int maxIterations = 30; ///< products with A at most
  double accuracy = 0.02; ///< stop when the bound is this close (relative)
  double safety = 1.05;   ///< the estimate is at least this times the largest Rayleigh quotient

  /// All of them with defaults, ranges and meaning.
  static Teuchos::ParameterList validParameters();
  /// From a validated list.
  static NormEstimateParameters from(const Teuchos::ParameterList& list);
};

struct NormEstimate {
  double norm = 0;         ///< over-estimate of ‖A‖ to use; 0 for A = 0
  double lowerBound = 0;   ///< largest Rayleigh quotient seen, certainly ≤ ‖A‖
  int multiplications = 0; ///< products with A
};

/// Lanczos: largest Ritz value θ plus the residual norm r of its Ritz vector, but at least `safety` · θ: an
/// eigenvalue lies within r of θ, yet it need not be the largest one. Stops when r ≤ `accuracy` · θ. No
/// estimate from a few products is certain; MPRGP finds out and halves its step where one was too small. The
/// start vector depends on global indices alone, so that every number of ranks gives the same estimate.
/// Precondition: A symmetric positive semidefinite on its domain map. Memory: three vectors. Collective.
/// \throws Error if A returns NaN or infinity.
NormEstimate estimateNorm(const Operator& a, const NormEstimateParameters& parameters);

} // namespace epafi::qp
