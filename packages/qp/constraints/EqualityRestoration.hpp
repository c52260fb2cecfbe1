#pragma once

/// What SMALBE does at its ends. The last step onto Bx = c: an iterate that meets the constraint to a
/// tolerance is moved onto it to round-off. And the multiplier to begin with where the start is no zero
/// vector. Both for constraints whose few rows are known on every rank (ReplicatedEquality).

#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include <span>
#include <vector>

namespace epafi::qp {

/// x += δ with B(x + δ) = c, δ = −WBᵀ(BWBᵀ)⁻¹(Bx − c), where W holds each entry's distance to its nearer
/// bound: entries at a bound stay there, and a δ that is small beside that distance keeps the others
/// feasible. Does nothing where the free entries do not suffice or δ would cross a bound.
/// \param residual  Bx − c, on every rank.
/// Cost: k messages of 2k numbers for k rows. Collective.
void restoreEquality(const EqualityConstraint& equality, const ConvexSet& set,
                     std::span<const double> residual, Vector& x);

/// The multiplier μ that suits a start near the solution: ‖φ + (Bᵀμ)_F‖ smallest over the free entries F; 0
/// where these do not determine it.
/// \param gradient  Ax − b.
/// Cost: k + 1 messages. Collective.
std::vector<double> estimateMultiplier(const EqualityConstraint& equality, const ConvexSet& set,
                                       const Vector& x, const Vector& gradient);

} // namespace epafi::qp
