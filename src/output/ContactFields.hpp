#pragma once

/// The fields of one contact, each rank holding a contiguous slab of its rows.

#include "epafi/base/Slab.hpp"
#include "epafi/mesh/Cell.hpp"
#include "epafi/simulation/ContactState.hpp"
#include "epafi/simulation/FrictionResults.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <optional>
#include <vector>

namespace epafi::output {

/// n rows, one a contact node, in the order of ContactLayout::ownRows; m facets.
struct ContactFields {
  GlobalOrdinal numRows = 0;  ///< n
  RowRange rows;              ///< this rank's rows
  std::vector<double> points; ///< n × 3, on the first body's surface
  std::vector<double>
      normals; ///< n × 3, direction of the other side; of membranes along z, as their deflection
  std::vector<double> areas;      ///< n, on which the multipliers act
  std::vector<double> initialGap; ///< c
  std::vector<double> gap;        ///< what remains open (ContactState)
  std::vector<double> multiplier; ///< λ_I, force that pushes the bodies apart
  std::vector<double> force;      ///< on the node (ContactState)
  std::vector<double> pressure;   ///< around the node (ContactState)
  std::vector<int> active;        ///< 1 where contact is closed
  std::optional<simulation::FrictionFields> friction;

  GlobalOrdinal numFacets =
      0; ///< m, of the first body's surface between nodes that all have a row; perhaps none
  /// Of the largest facets. Nothing where each row is a facet of its own: edges of membranes, or no facet is
  /// complete.
  std::optional<mesh::CellType> facetType;
  RowRange facets;                ///< this rank's facets
  std::vector<long long> corners; ///< m rows (Cell.hpp) of nodesPerFacet() numbers of rows, outwards

  [[nodiscard]] int nodesPerFacet() const { return facetType ? mesh::numNodesOf(*facetType) : 1; }
};

/// The other surface of a contact by mortars, which has a mesh of its own; each rank holds slabs.
struct FacingSurface {
  GlobalOrdinal numPoints = 0, numFacets = 0; ///< 0 where pairs of nodes or an obstacle face the rows
  RowRange points, facets;                    ///< this rank's
  int cornersPerFacet = 0;
  std::vector<double> places;     ///< of the points, 3 each
  std::vector<long long> corners; ///< of the facets, places among the points
};

/// Not collective.
FacingSurface facingSurface(const simulation::SolvedScene& solved, int contact);

/// Brings the rows of contact `contact` from multiplierMap to the slabs.
/// \param state  of that contact
/// Collective. Precondition: the solution's vectors lie on the problem's multiplierMap.
ContactFields gatherContactFields(const simulation::SolvedScene& solved, int contact,
                                  const simulation::ContactState& state);

} // namespace epafi::output
