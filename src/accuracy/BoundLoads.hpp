#pragma once

/// What acts on a body as guaranteed bounds need it: tractions on facets, and in each element a load per area
/// or volume with what a constant leaves out of it.

#include "epafi/accuracy/BoundCells.hpp"

#include <Eigen/Core>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace epafi::accuracy {

/// A facet on the boundary on which something is given.
struct BoundaryFacet {
  std::vector<GlobalOrdinal> nodes;
  std::array<bool, 3> isHeld{}; ///< components of the displacement that a support prescribes
  Eigen::MatrixXd forces;       ///< ∫ t N_a of the tractions, components × nodes
};
using BoundaryFacets = std::map<FacetKey, BoundaryFacet>;

/// Adds forces to a facet, in the order of its nodes. Returns the facet.
BoundaryFacet& addForces(BoundaryFacets& facets, mesh::CellType type, std::span<const GlobalOrdinal> nodes,
                         const Eigen::MatrixXd& forces);

struct BoundLoads {
  BoundaryFacets facets;
  Eigen::MatrixXd load;        ///< mean per area or volume of each cell, times the thickness
  Eigen::MatrixXd volume;      ///< ∫ f N_a of each own or neighbouring cell, without tractions
  Eigen::MatrixXd whole;       ///< the same with tractions
  std::vector<double> missing; ///< ‖f − mean‖ of each own cell
};

/// Of one body. \throws InputError for loads and supports of another kind.
BoundLoads boundLoads(const BoundCells& cells);

} // namespace epafi::accuracy
