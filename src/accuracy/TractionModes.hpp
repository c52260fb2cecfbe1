#pragma once

/// Tractions between elements may change by what keeps each element in balance (ModeGroups.hpp). Of all of
/// these, conjugate gradients look for those with the least energy of the stresses.

#include "epafi/accuracy/BoundCells.hpp"
#include "epafi/accuracy/BoundLoads.hpp"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace epafi::accuracy {

struct RelaxedEnergies {
  std::vector<Eigen::VectorXd> squares; ///< ‖τ‖² of own cells of each body
  int steps = 0;                        ///< of conjugate gradients
};

/// One to eight steps, until one gains less than a twentieth of what is left; each iterate is as admissible
/// as the first. Of all bodies; facets between ranks take part.
/// \param displacements  of all cells of each body \param data  of own cells, as CellStress has them; changed
/// Collective.
RelaxedEnergies relaxTractions(const std::vector<std::unique_ptr<BoundCells>>& cells,
                               const std::vector<BoundLoads>& loads, const RCP<const Comm>& comm,
                               const std::vector<Eigen::MatrixXd>& displacements,
                               std::vector<Eigen::MatrixXd>& data);

} // namespace epafi::accuracy
