#pragma once

/// What acts on a body as guaranteed bounds need it: tractions on edges, and a load per area in each element
/// with what a constant leaves out of it.

#include "epafi/accuracy/BoundCells.hpp"

#include <Eigen/Core>

#include <array>
#include <map>
#include <string>
#include <vector>

namespace epafi::accuracy {

/// An edge on the boundary on which something is given.
struct BoundaryEdge {
  std::vector<GlobalOrdinal> nodes;
  std::array<bool, 2> isHeld{}; ///< components of the displacement that a support prescribes
  Eigen::MatrixXd forces;       ///< ∫ t N_a of the tractions, components × nodes
};
using BoundaryEdges = std::map<EdgeKey, BoundaryEdge>;

/// Adds forces to an edge, in the order of its nodes. Returns the edge.
BoundaryEdge& addForces(BoundaryEdges& edges, std::span<const GlobalOrdinal> nodes,
                        const Eigen::MatrixXd& forces);

struct BoundLoads {
  BoundaryEdges edges;
  Eigen::MatrixXd load;        ///< mean per area of each cell, times the thickness
  Eigen::MatrixXd volume;      ///< ∫ f N_a of each own or neighbouring cell, without tractions
  Eigen::MatrixXd whole;       ///< the same with tractions
  std::vector<double> missing; ///< ‖f − mean‖ of each own cell
};

/// Of one body. \throws InputError for loads and supports of another kind.
BoundLoads boundLoads(const BoundCells& cells);

} // namespace epafi::accuracy
