#pragma once

/// How strongly bounds that depend on the solution feed back on it.

#include "epafi/qp/solve/QuadraticProgram.hpp"

#include <functional>

namespace epafi::qp {

/// With Ω(x) (QuadraticProgram::setAt) let T(y) be the solution within the given Ω(y), so that x = T(x). Near
/// x errors of bounds shrink by the factor q from one such solution to the next: the largest eigenvalue, in
/// size, of T′ on the face of x. T′δ is what follows δ and what the face adds to it, so that its norm in A is
/// least. A point x + e′ whose distance from its T is e has e′ = (I − T′)⁻¹e, to first order; where q ≥ 1
/// there may be other solutions.
struct BoundFeedback {
  double factor = 0;        ///< q, about; 0 where no bound moves; NaN: not known
  double amplification = 1; ///< ‖(I − T′)⁻¹e‖_A / ‖e‖_A, about
  int multiplications = 0;  ///< products with A
};

/// By Arnoldi's method in the inner product of A, from e: with three vectors and T′ roughly by CG, some
/// fifteen products; where q is more than a tenth anew with four to eight and more exact ones.
/// \param program    whose setAt is set and whose equality, if there is one, is a ReplicatedEquality
/// \param x          its solution, what is at bounds exactly so
/// \param gradient   Ax − b + Bᵀμ there
/// \param direction  e, of which what the face may move counts, of any length; what no power of T′ makes of
/// it is not seen, such as an eigenvector across a symmetry that e has
/// \param isToStop   asked before each vector, the same on all ranks: then the factor is not known
/// Collective.
BoundFeedback boundFeedback(
    const QuadraticProgram& program, const Vector& x, const Vector& gradient, const Vector& direction,
    const std::function<bool()>& isToStop = [] { return false; });

} // namespace epafi::qp
