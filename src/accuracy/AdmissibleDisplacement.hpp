#pragma once

/// A displacement that jumps nowhere, has the prescribed values and penetrates nowhere, near to one that does
/// so up to tolerances and between nodes.

#include "epafi/accuracy/BoundCells.hpp"
#include "epafi/accuracy/ContactPressure.hpp"

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

namespace epafi::accuracy {

struct AdmissibleDisplacement {
  std::vector<Eigen::MatrixXd> values; ///< at the nodes of each body's own cells
  std::vector<Eigen::MatrixXd> means;  ///< the same before penetrations were mended
  std::vector<double> slack;           ///< what it leaves of the gap at each row of contact, on all ranks
  std::string failure;                 ///< why there is none; most often empty
};

/// \param displacements  at the nodes of all cells, as displacementsOf() gives them
/// Collective.
AdmissibleDisplacement admissibleDisplacement(const std::vector<std::unique_ptr<BoundCells>>& cells,
                                              const ContactPressure& contact, const RCP<const Comm>& comm,
                                              const std::vector<Eigen::MatrixXd>& displacements);

} // namespace epafi::accuracy
