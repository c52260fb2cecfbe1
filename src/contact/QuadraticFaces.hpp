#pragma once

/// Contact on facets of order 2. The forces of an even pressure on their nodes are uneven, and forces that
/// follow a pressure with curvature are so in another way at corners than between them: divided by ∫N_a they
/// alternate. Other functions span the same space,
///   N̂_c = N_c + α Σ N_m  over the middles m of the edges at a corner c,   N̂_m = (1 − 2α) N_m,
/// of quadrilaterals their products along both axes; N̂ = W N. All have a positive integral, and α makes the
/// second moments of N̂_c and N̂_m about their nodes agree on even meshes, as shares of the integrals: a
/// pressure ∫pN̂_k/∫N̂_k is then p + O(h²) with the same O(h²) everywhere, and has no wiggle where p has
/// none. α = 3/20 for three-node edges and quadrilaterals, 1/6 for triangles, 13/40 for quadrilaterals
/// without a node in their middle.
///
/// *Edges and quadrilaterals* keep the rows of their nodes, whose ∫N_a are positive; N̂ serves to look at the
/// pressure. *Triangles and quadrilaterals of eight nodes*: of N_c the integral is 0 or less, and multipliers
/// of single nodes would say nothing of the pressure. Their multipliers are dual to N̂, with rows in terms of
/// the coefficients û in that basis,
///   û_c = u_c,   û_m = (u_m − α(u_c + u_c'))/(1 − 2α),
/// and likewise of the gaps: no node of a solution penetrates, and an even pressure is met exactly (Wohlmuth,
/// Popp, Gee, Wall, *Comput. Mech.* 49 (2012); Popp, Wohlmuth, Gee, Wall, *SIAM J. Sci. Comput.* 34 (2012),
/// with α = 1/5). Where both stand side by side, α is that of the quadrilaterals.

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <map>

namespace epafi::contact {

/// Whether rows of facets of a type are dual to N̂: six-node triangles, eight-node quadrilaterals.
bool haveDualRows(mesh::CellType facet);

/// N̂ = T N on the facets of a surface for which rows are dual to N̂; of others the identity. By the number
/// of a facet's nodes.
std::map<std::size_t, Eigen::MatrixXd> dualBases(const mesh::Surface& surface);

/// Finds W of a contact whose first surface has facets of order 2; else leaves everything as it is.
/// \param surface  the first body's
void smoothRows(const mesh::Surface& surface, ContactLayout& contact);

/// Finds W of a contact whose first surface has facets of order 2, and turns rows that are to be dual into
/// those of N̂ and their areas into ∫N̂; else leaves everything as it is. A middle between corners that have
/// no row, at the rim of what contact can reach, keeps its own.
/// \param surface  the first body's
void adaptRows(const mesh::Surface& surface, ContactLayout& contact);

} // namespace epafi::contact
