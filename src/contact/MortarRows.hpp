#pragma once

/// Rows between surfaces meshed apart, by mortars with dual multipliers.
///
/// The jump u¹ − u² is weighed by functions ψ_k of the first surface that are dual to its own N̂_k,
///   ∫ψ_k N̂_l = δ_kl ∫N̂_k   over what is covered,
/// facet by facet ψ = A N̂, A = D̂ M̂⁻¹ with D̂ = diag ∫N̂, M̂ = ∫N̂N̂ᵀ (Wohlmuth, *Acta Numerica* 20 (2011);
/// consistent on partly covered facets: Cichosz, Bischoff, *Comput. Methods Appl. Mech. Engrg* 200 (2011)).
/// N̂ = N but on six-node triangles (QuadraticFaces.hpp). A row is divided by ∫N̂_k, so that its multiplier
/// is a nodal force, and an even pressure p has the multipliers p∫N̂_k, the right forces on both sides.
///
/// *Rims.* A node that the other surface does not lie across, beyond its rim, or which supports hold where
/// bodies are tied (what they hold on both sides would be tied once more), has no multiplier: dual functions
/// of a part of a facet extrapolate. Its N̂ is added to that of a neighbour that has one, so that constants
/// stay among the ψ, and with them balance of forces. On slivers of facets ψ is constant, with the same
/// integrals.
///
/// *Moments.* Forces along d_k balance if what a row takes of either side lies on a line along d_k: the
/// shares of the second side are changed as little as that takes (a change of the size of the gap times that
/// of a facet's curvature; none on plane surfaces).

#include "epafi/contact/ContactLayout.hpp"
#include "epafi/contact/ContactSearch.hpp"
#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/contact/SurfaceNodes.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <functional>

namespace epafi::contact {

/// Whether supports hold a node of the first surface in a direction.
using HeldNodes = std::function<bool(GlobalOrdinal node, const Eigen::Vector3d& direction)>;

/// The rows u¹ − u² along the first surface's normals; bodies and `firstRow` are left to the caller. \throws
/// InputError as mortarIntegrals() does, or if no node is left to have a row. Not collective.
/// \param isTied  nodes of the first surface that a tied joint holds to the second body; they get no
/// multiplier
ContactLayout meetByMortar(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second,
                           const std::function<bool(GlobalOrdinal)>& isTied = {});

/// The rows u¹ − u² = 0, `components` for each node, along axes (columns) that are the same for all, best
/// such that supports hold nodes along them; of a joint that gives way along the normal, then the tangents,
/// of each node, those that are held too; likewise.
ContactLayout tieByMortar(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second,
                          const HeldNodes& isHeld, const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

} // namespace epafi::contact
