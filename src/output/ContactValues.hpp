#pragma once

/// A contact node by node as CalculiX has it.

#include "epafi/simulation/ContactState.hpp"
#include "epafi/simulation/SolvedScene.hpp"
#include "epafi/simulation/StepsDone.hpp"

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
  TotalSlip() = default;
  /// After load steps that are done. \param slip  simulation::StepsDone::slip
  explicit TotalSlip(const std::vector<simulation::NodeSlip>& slip);
  /// Enters the total in a step's values, on rank 0; once for each contact and step, in their order.
  void enter(const simulation::SolvedScene& solved, int contact, std::vector<ContactValues>& values);

private:
  using Key = std::array<GlobalOrdinal, 3>; ///< contact of the scene, body and node

  std::map<Key, std::array<double, 2>> slipped_;
  std::map<Key, Vector3> earlier_; ///< what of it an earlier run has left
};

} // namespace epafi::output
