#pragma once

/// How values around and at the nodes of a contact come from those of its rows, with weights.

#include "epafi/contact/ContactLayout.hpp"

#include <cstddef>
#include <vector>

namespace epafi::simulation {

/// Rows and weights for each node that has a row; empty: each node has the value of its own row.
using RowShares = std::vector<std::vector<contact::ContactLayout::Share>>;

/// action(row, weight) for the rows of a node. Not collective.
template <class Action>
void forEachRow(const RowShares& shares, std::size_t node, const Action& action) {
  if (shares.empty())
    return action(node, 1.0);
  for (const contact::ContactLayout::Share& share : shares[node])
    action(share.node, share.weight);
}

/// What nodes give to rows, of what rows give to nodes.
inline RowShares transposed(const RowShares& shares) {
  RowShares result(shares.size());
  for (std::size_t row = 0; row < shares.size(); ++row)
    for (const contact::ContactLayout::Share& share : shares[row])
      result[share.node].push_back({row, share.weight});
  return result;
}

/// Forces whose sum over the sum of areas, taken alike, is the mean traction around a node.
inline RowShares sharesOfMeans(const contact::ContactLayout& layout) {
  return layout.isDual ? RowShares() : layout.smoothed;
}

/// Slacks that add up to the one at a node: where rows are dual to N̂, theirs are coefficients of N̂.
inline RowShares sharesOfSlacks(const contact::ContactLayout& layout) {
  return layout.isDual ? transposed(layout.smoothed) : RowShares();
}

} // namespace epafi::simulation
