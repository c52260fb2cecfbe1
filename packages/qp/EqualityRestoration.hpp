#pragma once

/// What SMALBE does at its ends. The last step onto Gx = 0: an iterate that meets the constraint to a
/// tolerance is moved onto it to round-off. And the multiplier to begin with where the start is no zero
/// vector.

#include "epafi/qp/Bounds.hpp"
#include "epafi/qp/EqualityConstraint.hpp"

#include <span>
#include <vector>

namespace epafi::qp {

/// x += δ with G(x + δ) = 0, δ = −WGᵀ(GWGᵀ)⁻¹Gx, where W holds each entry's distance to its nearer bound:
/// entries at a bound stay there, and a δ that is small beside that distance keeps the others feasible. Does
/// nothing where the free entries do not suffice or δ would cross a bound.
/// \param gx  Gx, on every rank.
/// Cost: one message of 2k² numbers for k rows. Collective.
void restoreEquality(const EqualityConstraint& g, const Bounds& bounds, std::span<const double> gx,
                     Vector& x);

/// The multiplier μ that suits a start near the solution: ‖φ + (Gᵀμ)_F‖ smallest over the free entries F; 0
/// where these do not determine it.
/// \param gradient  Ax − b.
/// Two small messages. Collective.
std::vector<double> estimateMultiplier(const EqualityConstraint& g, const Bounds& bounds, const Vector& x,
                                       const Vector& gradient);

} // namespace epafi::qp
