#pragma once

/// A contact node by node as CalculiX has it.

#include "epafi/simulation/ContactState.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <vector>

namespace epafi::output {

/// COPEN, CSLIP1, CSLIP2, CPRESS, CSHEAR1, CSHEAR2: gap, slip along CalculiX' two tangents, pressure, and
/// friction's traction along them.
using ContactValues = std::array<double, 6>;

/// A contact's values on rank 0, row by row of ContactLayout::ownRows. Collective.
std::vector<ContactValues> gatherContactValues(const simulation::SolvedScene& solved, int contact,
                                               const simulation::ContactState& state);

} // namespace epafi::output
