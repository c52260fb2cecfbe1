#pragma once

/// Rows of contacts on six-node triangles. Of their shape functions those of the corners have no integral: an even pressure
/// puts no force there, and multipliers of single nodes would say nothing of the pressure. Other functions span the same space,
///   N̂_c = N_c + α Σ N_m  over the middles m of the edges at a corner c,   N̂_m = (1 − 2α) N_m,   α = 1/5,
/// whose integrals are all positive. Multipliers dual to them have rows in terms of the coefficients û in this basis,
///   û_c = u_c,   û_m = (u_m − α(u_c + u_c'))/(1 − 2α),
/// and likewise of the gaps: no node of a solution penetrates, and an even pressure is met exactly (Wohlmuth, Popp, Gee, Wall,
/// *Comput. Mech.* 49 (2012); Popp, Wohlmuth, Gee, Wall, *SIAM J. Sci. Comput.* 34 (2012)).

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/fem/Mesh.hpp"

namespace epafi::contact {

/// Turns the rows of a contact into those of the other basis, and their areas into ∫N̂, if the first surface has facets of
/// that type; else leaves everything as it is. A middle between corners without a row, at the rim of what contact can reach,
/// keeps its own.
/// \param surface  the first body's
void changeBasis(const fem::Mesh& mesh, const fem::Surface& surface, ContactLayout& contact);

} // namespace epafi::contact
