#pragma once

/// Contact and ties between two surfaces of an application, meshed alike or apart, as matrices for
/// decomposition::UnassembledProblem:
///
///     const mesh::Surface ring{mesh::CellType::line, ringNodes, ringElements}, shaft{…};
///     const contact::CoupledSurfaces joint = contact::contactBetween(terms, {ring, points}, {shaft, points},
///     comm);
///     problem.setContact(joint.matrix);
///
/// Nodes are numbered through all bodies, as UnassembledProblem has them: the unknown of a node's component
/// is node × components + component.

#include "epafi/contact/ContactMatrix.hpp"
#include "epafi/contact/MortarRows.hpp"

#include <vector>

namespace epafi::contact {

/// B and c with what rows stand for.
struct CoupledSurfaces {
  /// Each row's force acts along its direction, in the unit of the loads
  decomposition::ConstraintMatrix matrix;
  ContactLayout rows; ///< all of them, on every rank: nodes, directions, areas
};

/// dᵀ(u_first − u_second) ≤ c by mortars: the first surface, best the finer and softer one, carries the
/// multipliers.
/// \param first, second  whole and the same on all ranks; facets' nodes in an order that makes the normals
/// point outwards
/// Collective. \throws InputError, the same on all ranks, as meetByMortar() does.
CoupledSurfaces contactBetween(const ContactTerms& terms, const PlacedSurface& first,
                               const PlacedSurface& second, const RCP<const Comm>& comm);

/// u_first = u_second likewise, for UnassembledProblem::setTies.
/// \param isHeld  which nodes of the first one supports hold in a direction; they get no multiplier there
CoupledSurfaces tieBetween(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second,
                           const RCP<const Comm>& comm, const HeldNodes& isHeld = {});

} // namespace epafi::contact
