#pragma once

/// Where bodies may touch, before any of it is a matrix row.

#include "epafi/base/Types.hpp"

#include <string>
#include <vector>

namespace epafi::contact {

/// A node, and how much of it counts.
struct NodeShare {
  GlobalOrdinal node;
  double weight;
};

/// A contact: one inequality, a *row*, for each of some nodes of the first body's surface,
///   dᵀ(u_first − u_second) ≤ gap,
/// d the direction in which the second body, or an obstacle, lies (1 for membranes). It is whole on every rank: of the size
/// of the surfaces that may touch.
struct ContactLayout {
  std::string name;
  GlobalOrdinal firstRow = 0; ///< multiplier index of its first row
  int firstBody = 0;          ///< the one whose nodes have the rows
  std::string firstSurface;   ///< the surface of it
  int secondBody = -1;        ///< −1: an obstacle, which does not move
  std::vector<GlobalOrdinal> firstNodes;
  std::vector<std::vector<NodeShare>>
      secondNodes; ///< what the same rows face, one node or a point between some; empty for an obstacle
  std::vector<double> directions; ///< d, `components` numbers a row
  std::vector<double> gaps;       ///< before supports are taken into account
  std::vector<double>
      areas; ///< share of the first surface (in the plane: of its length) on which a row's force acts
  /// Places of rows, with weights.
  struct Share {
    std::size_t node;
    double weight;
  };
  /// Of order 2, for each row k, W_kb: N̂_k = Σ W_kb N_b, the functions with which pressures and gaps are looked at
  /// (QuadraticFaces.hpp); empty of order 1, whose own functions serve.
  std::vector<std::vector<Share>> smoothed;
  /// Rows that are combinations of those of several nodes, Σ weight · (dᵀ(u_first − u_second) ≤ gap)_node: dual to N̂;
  /// empty: each row is that of its own node.
  std::vector<std::vector<Share>> combinations;

  /// Number of inequalities.
  [[nodiscard]] GlobalOrdinal numRows() const { return static_cast<GlobalOrdinal>(firstNodes.size()); }
  /// action(place of a node, weight) for all nodes of a row.
  template <class Action>
  void forEachShare(std::size_t row, const Action& action) const {
    if (combinations.empty())
      return action(row, 1.0);
    for (const Share& share : combinations[row])
      action(share.node, share.weight);
  }
};

} // namespace epafi::contact
