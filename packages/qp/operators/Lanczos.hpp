#pragma once

/// Lanczos' iteration for the eigenvalues of MA in the inner product of M (Saad, *Iterative Methods for
/// Sparse Linear Systems*, section 6.7); without M those of A.

#include "epafi/base/Types.hpp"

#include <Tpetra_Vector.hpp>

#include <vector>

namespace epafi::qp {

/// A symmetric positive semidefinite, n × n; M symmetric positive definite on the range of A. Four vectors,
/// five with M.
class Lanczos {
public:
  /// An eigenvalue of the tridiagonal matrix; one of MA is within the distance `error`.
  struct RitzValue {
    double value = 0, error = 0;
  };

  /// Keeps references. \param m      null for none
  /// \param start  of the Krylov space of AM, on A's range map; pseudo-random. Collective.
  Lanczos(const Operator& a, const Operator* m, const Vector& start);

  /// Whether the space is exhausted but for round-off: no further step.
  [[nodiscard]] bool isExhausted() const { return !(beta_ > 1e-13 * largest_); }
  /// One product with A, one with M. \throws Error if one of them returns NaN or infinity, or if M is not
  /// positive definite. Collective.
  void step();
  /// Of the steps so far, in ascending order. Precondition: there was one. Not collective.
  [[nodiscard]] std::vector<RitzValue> ritzValues() const;

private:
  void measure();
  [[nodiscard]] const Vector& preconditioned() const { return m_ != nullptr ? z_ : v_; }

  const Operator& a_;
  const Operator* m_;
  Vector v_, previous_, w_; ///< v_k, v_(k−1), the next direction before it is made of length 1
  Vector z_;                ///< M v_k, then M w; empty without M
  double beta_ = 0;         ///< ‖w‖ in the inner product of M
  double largest_ = 0;      ///< entry of the tridiagonal matrix
  std::vector<double> diagonal_, offDiagonal_;
};

} // namespace epafi::qp
