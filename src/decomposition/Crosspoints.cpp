#include "epafi/decomposition/Crosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/Corners.hpp"
#include "epafi/decomposition/InterfaceEnds.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <string>

namespace epafi::decomposition {
namespace {

using Marks = std::vector<std::vector<char>>;

/// Whether the nodes without unknowns hold a subdomain.
bool isHeld(const Substructures& all, std::size_t s) {
  HoldingPoints points(all.components);
  if (all.subdomains[s].unknownPosition.size() < all.nodal[s].unknownOf.size())
    for (std::size_t node = 0; node < all.numNodes(s) && !points.hold(); ++node)
      if (!all.isFree(s, node))
        points.add(all.point(s, node));
  return points.hold();
}

/// Whether supports alone make each subdomain of the whole problem regular; the same on every rank.
/// Collective.
std::vector<char> findHeld(const Substructures& all) {
  std::vector<char> held;
  for (std::size_t s = 0; s < all.size(); ++s)
    held.push_back(isHeld(all, s) ? 1 : 0);
  return gatherOnAll(*all.comm, held); // subdomains are numbered rank by rank
}

CrosspointNode nodeAt(const Substructures& all, std::size_t s, std::size_t place) {
  return {all.globalNode(s, place), all.numFree(s, place)};
}

/// Marks the end points and meeting points of interfaces; the lowest subdomain lists them.
void markCorners(const Substructures& all, const SharedNodes& shared, std::size_t s,
                 std::vector<char>& isCrosspoint, std::vector<CrosspointNode>& corners) {
  const std::vector<char> isCorner = findCorners(all, shared, s);
  const std::span<const SharedNodes::Copy> copies = shared.copiesOf(s);
  for (std::size_t k = 0; k < copies.size(); ++k)
    if (isCorner[k] != 0) {
      isCrosspoint[copies[k].place] = 1;
      if (copies[k].order == 0)
        corners.push_back(nodeAt(all, s, copies[k].place));
    }
}

/// Marks and lists the nodes that a subdomain asks for, as far as no other cluster has them, and the ends of
/// its interfaces where there is no mesh.
void markChosen(const Substructures& all, const SharedNodes& inside, const SharedNodes& shared, std::size_t s,
                std::vector<char>& isCrosspoint, std::vector<CrosspointNode>& extra) {
  std::vector<std::size_t> chosen = all.nodal[s].crosspoints;
  std::erase_if(chosen, [&](std::size_t place) { return shared.find(s, place) && !inside.find(s, place); });
  if (!all.places.isBoundaryNode) {
    const std::vector<std::size_t> ends = findInterfaceEnds(all, inside, s);
    chosen.insert(chosen.end(), ends.begin(), ends.end());
  }
  for (const std::size_t place : chosen)
    if (all.isFree(s, place)) {
      isCrosspoint[place] = 1;
      extra.push_back(nodeAt(all, s, place));
    }
}

/// The free nodes that a subdomain shares with each higher one, ascending places.
std::map<int, std::vector<std::size_t>> interfacesOf(const Substructures& all, const SharedNodes& shared,
                                                     std::size_t s) {
  std::map<int, std::vector<std::size_t>> interfaces;
  for (const SharedNodes::Copy& copy : shared.copiesOf(s)) {
    const std::span<const int> numbers = shared.subdomainsAt(copy.node);
    if (all.isFree(s, copy.place))
      for (const int other : numbers.subspan(copy.order + 1))
        interfaces[other].push_back(copy.place);
  }
  return interfaces;
}

/// Further crosspoints for the interfaces of a subdomain with higher ones: where one of the two sides leans
/// on the other and the free crosspoints that join them do not hold it. The lower one's rank decides, so that
/// both sides hear of the same nodes.
void addInterfacePoints(const Substructures& all, const SharedNodes& shared, std::size_t s,
                        const std::vector<char>& isCrosspoint, const std::vector<char>& held,
                        std::vector<CrosspointNode>& extra) {
  const bool isHeldHere = held[all.subdomains[s].number] != 0;
  for (const auto& [other, nodes] : interfacesOf(all, shared, s)) {
    if (isHeldHere && held[other] != 0)
      continue;
    HoldingPoints points(all.components);
    for (const std::size_t node : nodes)
      if (isCrosspoint[node] != 0 && !points.hold())
        points.add(all.point(s, node));
    if (points.hold())
      continue;
    std::vector<Point> candidates;
    for (const std::size_t node : nodes)
      candidates.push_back(all.point(s, node));
    for (const std::size_t place : points.complete(candidates))
      extra.push_back(nodeAt(all, s, nodes[place]));
  }
}

/// Crosspoints of a floating cluster in one piece, at nodes that no other subdomain has.
void addPointsInside(const Substructures& all, const SharedNodes& shared, std::size_t s,
                     std::vector<char>& isCrosspoint, std::vector<CrosspointNode>& extra) {
  std::vector<std::size_t> free;
  std::vector<Point> candidates;
  for (std::size_t node = 0; node < all.numNodes(s); ++node)
    if (all.isFree(s, node) && !shared.find(s, node)) {
      free.push_back(node);
      candidates.push_back(all.point(s, node));
    }
  HoldingPoints points(all.components);
  for (const std::size_t place : points.complete(candidates)) {
    isCrosspoint[free[place]] = 1;
    extra.push_back(nodeAt(all, s, free[place]));
  }
  if (!points.hold())
    throw InputError("subdomain " + std::to_string(all.subdomains[s].number) +
                     " is a cluster of its own and has too few nodes that no other subdomain shares: they do "
                     "not hold it; make the subdomains or the clusters larger");
}

/// The union of all ranks' lists, sorted, on every rank. Collective.
std::vector<CrosspointNode> gatherNodes(const Comm& comm, const std::vector<CrosspointNode>& mine) {
  std::vector<CrosspointNode> nodes = gatherOnAll(comm, mine);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end(),
                          [](const CrosspointNode& a, const CrosspointNode& b) { return a.node == b.node; }),
              nodes.end());
  return nodes;
}

void unite(std::vector<CrosspointNode>& nodes, const std::vector<CrosspointNode>& others) {
  std::vector<CrosspointNode> all;
  std::set_union(nodes.begin(), nodes.end(), others.begin(), others.end(), std::back_inserter(all));
  nodes.swap(all);
}

/// Marks some crosspoints, sorted, in the subdomains that share them.
void mark(const Substructures& all, const SharedNodes& shared, const std::vector<CrosspointNode>& crosspoints,
          Marks& isCrosspoint) {
  if (crosspoints.empty())
    return;
  for (std::size_t s = 0; s < all.size(); ++s)
    for (const SharedNodes::Copy& copy : shared.copiesOf(s))
      if (std::binary_search(crosspoints.begin(), crosspoints.end(),
                             CrosspointNode{all.globalNode(s, copy.place), 0}))
        isCrosspoint[s][copy.place] = 1;
}

/// Averages along edges become coarse unknowns in the place of one node's values, the carrier's: marks and
/// lists them.
std::vector<std::vector<EdgeAverage>> markCarriers(const Substructures& all, const SharedNodes& shared,
                                                   Marks& isCrosspoint,
                                                   std::vector<CrosspointNode>& carriers) {
  std::vector<std::vector<EdgeAverage>> averages(all.size());
  for (std::size_t s = 0; s < all.size(); ++s) {
    averages[s] = findEdgeAverages(all, shared, s, isCrosspoint[s]);
    for (const EdgeAverage& average : averages[s]) {
      isCrosspoint[s][average.carrier] = 1;
      if (shared.isLowest(s, average.carrier))
        carriers.push_back(nodeAt(all, s, average.carrier));
    }
  }
  return averages;
}

} // namespace

Crosspoints::Crosspoints(const Substructures& all, const SharedNodes& inside, const SharedNodes& shared) {
  const std::vector<char> held = findHeld(all);
  std::vector<CrosspointNode> corners, extra, carriers;
  collectively(*all.comm, [&] {
    for (std::size_t s = 0; s < all.size(); ++s) {
      std::vector<char>& marks = isCrosspoint_.emplace_back(all.numNodes(s), 0);
      markCorners(all, inside, s, marks, corners);
      markChosen(all, inside, shared, s, marks, extra);
      addInterfacePoints(all, inside, s, marks, held, extra);
      if (all.subdomains[s].kernel.cols() > 0 && inside.copiesOf(s).empty())
        addPointsInside(all, shared, s, marks, extra);
    }
  });
  nodes_ = gatherNodes(*all.comm, corners);
  extra = gatherNodes(*all.comm, extra);
  mark(all, inside, extra, isCrosspoint_);
  unite(nodes_, extra);
  numCorners_ = nodes_.size();
  // Interfaces lack corners where they meet other clusters.
  const bool isSplit = holdsAnywhere(*all.comm, inside.numNodes() < shared.numNodes());
  if (isSplit || hasEdgeAverages(all))
    averages_ = markCarriers(all, inside, isCrosspoint_, carriers);
  else
    averages_.resize(all.size());
  unite(nodes_, gatherNodes(*all.comm, carriers));
  firstIndex_.reserve(nodes_.size());
  for (const CrosspointNode& node : nodes_) {
    firstIndex_.push_back(numUnknowns_);
    numUnknowns_ += node.numFree;
  }
}

CoarseNumber Crosspoints::firstIndex(NodeNumber node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), CrosspointNode{node, 0});
  return firstIndex_[found - nodes_.begin()];
}

} // namespace epafi::decomposition
