#pragma once

/// Rows of tied joints across a gap: each node of the first surface hangs on the second body as on a rigid
/// lever.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/MortarIntegrals.hpp"

namespace epafi::contact {

/// A row takes u_first − Σw u_second along d. With r from the mean place of its second side to that of its
/// first, its two forces make a couple r × d, which nothing else carries. So the second side gets e_l = ω ×
/// y_l beside, y_l from the centre of its nodes, with Σ y_l × (ω × y_l) = r × d: the least forces that add up
/// to none and balance it, and for displacements the best rigid rotation of what is around times r. Where a
/// row has too few nodes on the second side, those of the facets around count, too. Rows whose sides lie
/// along d stay as they are, and those whose sides are apart by no more than facets of a curve may be. Not
/// collective.
/// \param[in,out] tie  a tied joint
void linkRigidly(const PlacedSurface& first, const PlacedSurface& second, ContactLayout& tie);

} // namespace epafi::contact
