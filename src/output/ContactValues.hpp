#pragma once

/// A contact node by node as CalculiX has it.

#include "epafi/simulation/ContactState.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <array>
#include <map>
#include <vector>

namespace epafi::output {

/// COPEN, CSLIP1, CSLIP2, CPRESS, CSHEAR1, CSHEAR2: gap, slip along CalculiX' two tangents, pressure, and
/// friction's traction along them.
using ContactValues = std::array<double, 6>;

/// A contact's values on rank 0, row by row of ContactLayout::ownRows. Collective.
std::vector<ContactValues> gatherContactValues(const simulation::SolvedScene& solved, int contact,
                                               const simulation::ContactState& state);

/// Slip as CalculiX has it: all that the sides have moved along each other, while a step's own begins with
/// the step, and has not what friction that sticks gives way by (Stick Slope).
class TotalSlip {
public:
  /// Enters the total in a step's values, on rank 0; once for each contact and step, in their order.
  void enter(const simulation::SolvedScene& solved, int contact, std::vector<ContactValues>& values);

private:
  /// By contact of the scene, body and node.
  std::map<std::array<GlobalOrdinal, 3>, std::array<double, 2>> slipped_;
};

} // namespace epafi::output
