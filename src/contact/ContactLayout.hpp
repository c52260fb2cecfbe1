#pragma once

/// Where bodies may touch, before any of it is a matrix row.

#include "epafi/base/Types.hpp"

#include <string>
#include <vector>

namespace epafi::contact {

/// A contact: one inequality for each of some nodes of the first body's surface,
///   dᵀ(u_first − u_second) ≤ gap,
/// d the direction in which the second body, or an obstacle, lies (1 for membranes). It is whole on every rank: of the size
/// of the surfaces that may touch.
struct ContactLayout {
  std::string name;
  GlobalOrdinal firstRow = 0; ///< multiplier index of its first row
  int firstBody = 0;
  int secondBody = -1; ///< −1: an obstacle, which does not move
  std::vector<GlobalOrdinal> firstNodes;
  std::vector<GlobalOrdinal> secondNodes; ///< of the same rows; empty for an obstacle
  std::vector<double> directions;         ///< d, `components` numbers a row
  std::vector<double> gaps;               ///< before supports are taken into account
  std::vector<double> areas; ///< share of the first surface (in the plane: of its length) that a node has

  /// Number of inequalities.
  [[nodiscard]] GlobalOrdinal numRows() const { return static_cast<GlobalOrdinal>(firstNodes.size()); }
};

} // namespace epafi::contact
