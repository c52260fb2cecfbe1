#pragma once

/// The last step onto Gx = 0: an iterate that meets the constraint to a tolerance is moved onto it to
/// round-off.

#include "epafi/qp/Bounds.hpp"
#include "epafi/qp/EqualityConstraint.hpp"

#include <span>

namespace epafi::qp {

/// x += δ with G(x + δ) = 0, δ = −WGᵀ(GWGᵀ)⁻¹Gx, where W holds each entry's distance to its nearer bound:
/// entries at a bound stay there, and a δ that is small beside that distance keeps the others feasible. Does
/// nothing where the free entries do not suffice or δ would cross a bound. \param gx  Gx, on every rank.
/// Cost: one message of 2k² numbers for k rows. Collective.
void restoreEquality(const EqualityConstraint& g, const Bounds& bounds, std::span<const double> gx,
                     Vector& x);

} // namespace epafi::qp
