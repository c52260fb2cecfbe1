#pragma once

/// Energies below and above the exact one of a solved scene.

#include "epafi/ContactSolver.hpp"
#include "epafi/accuracy/EnergyBound.hpp"
#include "epafi/simulation/SolvedScene.hpp"

namespace epafi::simulation {

/// Forces of contact are replaced by those of pressures, and the displacements that are in balance with them
/// are found by one solve of the subdomains. \param solver  of which the solution is. Collective.
accuracy::EnergyBound guaranteedBound(accuracy::EnergyBounds& bounds, const ContactSolver& solver,
                                      const SolvedScene& solved);

} // namespace epafi::simulation
