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
/// d the direction in which the second body, or an obstacle, lies (1 for membranes), u_first and u_second values at nodes or
/// means of some. Of a tied joint = takes the place of ≤, and a node has a row for each component. It is whole on every rank: of the size
/// of the surfaces that may touch.
struct ContactLayout {
  std::string name;
  int number = 0;             ///< of the contact, as the caller counts
  std::string means;          ///< how its sides are coupled, in some words
  GlobalOrdinal firstRow = 0; ///< multiplier index of its first row
  int firstBody = 0;          ///< the one whose nodes have the rows
  std::string firstSurface;   ///< the surface of it
  int secondBody = -1;        ///< −1: an obstacle, which does not move
  std::vector<GlobalOrdinal> firstNodes;
  /// What moves a row on the first surface: by mortars nodes around; empty: its own node alone.
  std::vector<std::vector<NodeShare>> firstShares;
  std::vector<std::vector<NodeShare>>
      secondNodes;                ///< what the same rows face, one node or more; empty for an obstacle
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
  /// Whether rows are dual to N̂, and so their gaps are coefficients of N̂ instead of values at nodes.
  bool isDual = false;

  /// Number of inequalities.
  [[nodiscard]] GlobalOrdinal numRows() const { return static_cast<GlobalOrdinal>(firstNodes.size()); }
  /// action(node of the first surface, weight) for what moves the row of a place.
  template <class Action>
  void forEachFirst(std::size_t place, const Action& action) const {
    if (firstShares.empty())
      return action(NodeShare{firstNodes[place], 1.0});
    for (const NodeShare& share : firstShares[place])
      action(share);
  }
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
