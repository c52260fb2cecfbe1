#pragma once

/// The extreme eigenvalues of MA, and with them the condition number that rules conjugate gradients for A
/// preconditioned by M ≈ A⁻¹: Lanczos in the inner product of M (Saad, *Iterative Methods for Sparse Linear
/// Systems*, section 6.7).

#include "epafi/base/Types.hpp"

namespace epafi::qp {

/// When an estimate is good enough.
struct SpectrumEstimateParameters {
  int maxIterations = 300; ///< products with A at most
  double accuracy = 0.01;  ///< stop when both error bounds are this small, relative to their eigenvalues
};

struct SpectrumEstimate {
  double smallest = 0, largest = 0; ///< Ritz values: within the spectrum but for round-off; 0 for A = 0
  double smallestError = 0, largestError = 0; ///< an eigenvalue is within this distance
  int multiplications = 0;                    ///< products with A

  /// Whether an end is known to this relative accuracy.
  [[nodiscard]] bool smallestIsAccurate(double accuracy) const {
    return smallest > 0 && smallestError <= accuracy * smallest;
  }
  /// Likewise.
  [[nodiscard]] bool largestIsAccurate(double accuracy) const {
    return largest > 0 && largestError <= accuracy * largest;
  }
  /// κ, approached from below; 1 for A = 0.
  [[nodiscard]] double condition() const { return smallest > 0 ? largest / smallest : 1.0; }
};

/// Eigenvalues of MA that are not zero, smallest and largest. The start A x, x pseudo-random and dependent on
/// global indices alone, lies in the range of A, where the iteration stays. A kernel comes in by round-off in
/// the end, and is told by its size: eigenvalues below 10⁻¹⁰ of the largest are not seen. An eigenvector that
/// the start misses is not seen either.
/// \param a  symmetric positive semidefinite, n × n
/// \param m  symmetric positive definite on the range of A, n × n; null for the spectrum of A itself Memory:
/// five vectors. Collective. \throws Error if A or M returns NaN or infinity, or if M is not positive
/// definite.
SpectrumEstimate estimateSpectrum(const Operator& a, const RCP<const Operator>& m,
                                  const SpectrumEstimateParameters& parameters = {});

} // namespace epafi::qp
