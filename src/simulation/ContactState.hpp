#pragma once

/// Pressure, gap and penetration of a contact, from the multipliers and slacks of its rows.

#include "epafi/mesh/Mesh.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <vector>

namespace epafi::simulation {

/// What a contact has come to. Force, pressure and gap are those of nodes, of this rank's slab of
/// ContactLayout::ownRows (evenShare). Of rows that contacts share it has its part of force and area; the
/// pressure is that of all of them together.
struct ContactState {
  std::vector<double> areas; ///< of all rows, as far as they are its own
  std::vector<double> force; ///< on a node, ∫pN_a; of six-node triangles another thing than the multiplier
  /// Mean of the contact pressure around a node. Elements of order 1: λ/area; of order 2: ∫pN̂/∫N̂
  /// (contact/QuadraticFaces.hpp).
  std::vector<double> pressure;
  std::vector<double> gap;    ///< what remains open at a node
  double largestPressure = 0; ///< over all ranks, and at least 0
  /// Deepest overlap over all ranks, between nodes too: of the gap as the facets interpolate it, at a lattice
  /// of points on each. Facets of order 1 have their deepest overlap at nodes.
  double penetration = 0;
};

/// Collective. Precondition: the solution's vectors lie on the problem's multiplierMap.
ContactState contactState(const SolvedScene& solved, int contact);

/// The facets of the first surface whose nodes all have rows, as places of rows, nodesPerFacet() each. Not
/// collective.
std::vector<long long> completeFacets(const contact::ContactLayout& layout, const mesh::Surface& surface);

} // namespace epafi::simulation
