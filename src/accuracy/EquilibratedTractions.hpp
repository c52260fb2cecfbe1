#pragma once

/// Tractions between elements that are in balance with the loads on each of them, forces and moments, from
/// displacements that balance at nodes alone: the moments ∫ t N_a of the tractions on the facets at a node
/// follow from one small least-squares problem around it (P. Ladevèze, D. Leguillon, *SIAM J. Numer. Anal.*
/// 20 (1983)), as near to the means of both sides' stresses as balance allows.

#include "epafi/accuracy/BoundCells.hpp"
#include "epafi/accuracy/BoundLoads.hpp"

#include <Eigen/Core>

namespace epafi::accuracy {

struct EquilibratedTractions {
  Eigen::MatrixXd data;    ///< of each own cell, as CellStress has them
  double imbalance = 0;    ///< largest force that is left over at a node of this rank
  double largestForce = 0; ///< of an element at a node
};

/// \param displacements  of the cells of one body; they may jump between subdomains
/// Not collective.
EquilibratedTractions equilibratedTractions(const BoundCells& cells, const BoundLoads& loads,
                                            const Eigen::MatrixXd& displacements);

} // namespace epafi::accuracy
