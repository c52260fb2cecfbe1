#include "epafi/fem/LocalNumbering.hpp"

#include <algorithm>
#include <iterator>

namespace epafi::fem {
namespace {

using Nodes = std::vector<GlobalOrdinal>;

/// The different nodes of `corners`, ascending. The k-th corners of ascending elements are usually ascending
/// themselves: these runs are merged, and only those that are not are sorted.
Nodes distinctNodes(std::span<const GlobalOrdinal> corners, std::size_t perElement) {
  Nodes nodes, run(corners.size() / perElement), merged;
  for (std::size_t k = 0; k < perElement; ++k) {
    for (std::size_t e = 0; e < run.size(); ++e)
      run[e] = corners[e * perElement + k];
    if (!std::is_sorted(run.begin(), run.end()))
      std::sort(run.begin(), run.end());
    const auto end = std::unique(run.begin(), run.end());
    merged.clear();
    std::set_union(nodes.begin(), nodes.end(), run.begin(), end, std::back_inserter(merged));
    nodes.swap(merged);
  }
  return nodes;
}

/// Place of a node that is known to be among `nodes`, searched from a place near it.
std::size_t locate(const Nodes& nodes, std::size_t near, GlobalOrdinal node) {
  if (nodes[near] > node)
    return std::lower_bound(nodes.begin(), nodes.begin() + near, node) - nodes.begin();
  std::size_t step = 1; // doubled, so that a far place is found quickly too
  while (near + step < nodes.size() && nodes[near + step] <= node)
    step *= 2;
  const auto begin = nodes.begin() + (near + step / 2);
  const auto end = nodes.begin() + std::min(near + step, nodes.size());
  return std::lower_bound(begin, end, node) - nodes.begin();
}

} // namespace

LocalNumbering::LocalNumbering(std::span<const GlobalOrdinal> corners, int nodesPerElement)
    : nodesPerElement_(nodesPerElement), offsets_(distinctNodes(corners, nodesPerElement_)),
      corners_(corners.size()), numElementsAt_(offsets_.size(), 0) {
  for (std::size_t k = 0; k < nodesPerElement_; ++k) {
    std::size_t place = 0;
    for (std::size_t c = k; c < corners.size(); c += nodesPerElement_) {
      place = locate(offsets_, place, corners[c]);
      corners_[c] = static_cast<int>(place);
    }
  }
  for (std::size_t c = 0; c < corners.size(); ++c)
    if (!isFilling(c))
      ++numElementsAt_[corners_[c]];
  const GlobalOrdinal first = offsets_.front();
  for (GlobalOrdinal& offset : offsets_)
    offset -= first;
}

std::optional<GlobalOrdinal>
LocalNumbering::firstNodeIfShifted(std::span<const GlobalOrdinal> corners) const {
  if (corners.size() != corners_.size())
    return std::nullopt;
  const GlobalOrdinal first = corners[0] - offsets_[corners_[0]];
  for (std::size_t c = 0; c < corners.size(); ++c)
    if (corners[c] != first + offsets_[corners_[c]])
      return std::nullopt;
  return first;
}

std::vector<GlobalOrdinal> LocalNumbering::nodes(GlobalOrdinal firstNode) const {
  std::vector<GlobalOrdinal> nodes(offsets_.size());
  std::transform(offsets_.begin(), offsets_.end(), nodes.begin(),
                 [firstNode](GlobalOrdinal offset) { return firstNode + offset; });
  return nodes;
}

} // namespace epafi::fem
