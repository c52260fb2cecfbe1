#pragma once

/// Does the objective fall without end? It does exactly if there is a direction d with Ad = 0, Bd = 0, bᵀd >
/// 0 along which the set has no end.

#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

namespace epafi::qp {

struct RecessionDirection {
  RCP<Vector> direction;   ///< d, of length 1; null if none was found
  int multiplications = 0; ///< products with A
};

/// Looks for d as the nearest point to b in the recession cone K of the set, with deviations from Ad = 0 and
/// Bd = 0 penalised: min ½dᵀ(I + τ(A/‖A‖ + BᵀB/‖B‖²))d − bᵀd over K, τ = 1e2, 1e3 … 1e12, by MPRGP,
/// extrapolated to τ = ∞. What it finds is believed if ‖Ad‖ ≤ 1e-7‖A‖, ‖Bd‖ ≤ 1e-7‖B‖ and bᵀd ≥ 1e-6‖b‖ hold
/// for ‖d‖ = 1; it goes on to 1e-10 if it can.
/// \param equality  null if there is none
/// \param maxMultiplications  products with A at most
/// Collective.
RecessionDirection findRecessionDirection(const RCP<const Operator>& a, double operatorNorm, const Vector& b,
                                          const ConvexSet& set, const RCP<const EqualityConstraint>& equality,
                                          int maxMultiplications);

} // namespace epafi::qp
