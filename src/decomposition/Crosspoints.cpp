#include "epafi/decomposition/Crosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/Corners.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"

#include <algorithm>
#include <iterator>
#include <span>

namespace epafi::decomposition {
namespace {

int numFree(const Piece& piece, std::size_t node, std::size_t components) {
  const auto first = piece.assembled.unknownOf.begin() + static_cast<std::ptrdiff_t>(node * components);
  return static_cast<int>(std::count_if(first, first + static_cast<std::ptrdiff_t>(components),
                                        [](int unknown) { return unknown >= 0; }));
}

/// Whether a node of a piece has unknowns.
bool isFree(const Piece& piece, std::size_t node, std::size_t components) {
  return numFree(piece, node, components) > 0;
}

const BodyOutline& bodyOf(const Outline& outline, const Piece& piece) {
  return outline.bodies[static_cast<std::size_t>(piece.body)];
}

std::size_t componentsOf(const Outline& outline, const Piece& piece) {
  return static_cast<std::size_t>(bodyOf(outline, piece).components);
}

/// Whether the nodes without unknowns hold a piece.
bool isHeld(const Outline& outline, const Piece& piece) {
  if (piece.assembled.unknownPosition.size() == piece.assembled.unknownOf.size())
    return false;
  const BodyOutline& body = bodyOf(outline, piece);
  HoldingPoints points(body.components);
  for (std::size_t node = 0; node < piece.assembled.nodes.size() && !points.hold(); ++node)
    if (!isFree(piece, node, componentsOf(outline, piece)))
      points.add(body.point(piece.assembled.nodes[node]));
  return points.hold();
}

/// Whether supports alone make each subdomain of the whole problem regular; the same on every rank.
/// Collective.
std::vector<char> findHeld(const Outline& outline, const std::vector<Piece>& pieces, const Comm& comm) {
  std::vector<double> held(static_cast<std::size_t>(outline.numSubdomains), 0.0);
  for (const Piece& piece : pieces)
    held[static_cast<std::size_t>(piece.number)] = isHeld(outline, piece) ? 1 : 0;
  sumOverRanks(comm, held);
  return {held.begin(), held.end()};
}

/// The free nodes that a piece shares with a higher part, ascending places.
struct Interface {
  int other = 0;
  std::vector<std::size_t> nodes;
};

std::vector<Interface> findInterfaces(const Piece& piece, std::size_t components) {
  std::vector<Interface> interfaces; // few: a search through all is short
  for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
    const std::size_t node = piece.sharing.node(k);
    if (piece.sharing.parts(k).back() == piece.part || !isFree(piece, node, components))
      continue;
    for (const int other : piece.sharing.parts(k)) {
      if (other <= piece.part)
        continue;
      auto interface = std::find_if(interfaces.begin(), interfaces.end(),
                                    [other](const Interface& i) { return i.other == other; });
      if (interface == interfaces.end())
        interface = interfaces.insert(interface, {other, {}});
      interface->nodes.push_back(node);
    }
  }
  return interfaces;
}

CrosspointNode nodeAt(const Outline& outline, const Piece& piece, std::size_t node) {
  return {piece.body, piece.assembled.nodes[node], numFree(piece, node, componentsOf(outline, piece))};
}

/// Marks the end points and meeting points of interfaces; the lowest part lists them.
void markCorners(const Outline& outline, Piece& piece, std::vector<CrosspointNode>& corners) {
  piece.isCrosspoint.assign(piece.assembled.nodes.size(), 0);
  const std::vector<char> isCorner = findCorners(bodyOf(outline, piece), piece);
  for (std::size_t k = 0; k < piece.sharing.size(); ++k)
    if (isCorner[k] != 0) {
      const std::size_t node = piece.sharing.node(k);
      piece.isCrosspoint[node] = 1;
      if (piece.sharing.parts(k).front() == piece.part)
        corners.push_back(nodeAt(outline, piece, node));
    }
}

/// Further crosspoints for the interfaces of a piece with higher parts: where one of the two sides leans on
/// the other and the free crosspoints that join them do not hold it. The lower part's rank decides, so that both sides
/// hear of the same nodes.
void addInterfacePoints(const Outline& outline, const Piece& piece, const std::vector<char>& held,
                        std::vector<CrosspointNode>& extra) {
  const BodyOutline& body = bodyOf(outline, piece);
  for (const Interface& interface : findInterfaces(piece, componentsOf(outline, piece))) {
    const int other = body.firstSubdomain + interface.other;
    if (held[static_cast<std::size_t>(piece.number)] != 0 && held[static_cast<std::size_t>(other)] != 0)
      continue;
    HoldingPoints points(body.components);
    std::vector<fem::Point> candidates;
    for (const std::size_t node : interface.nodes) {
      candidates.push_back(body.point(piece.assembled.nodes[node]));
      if (piece.isCrosspoint[node] != 0)
        points.add(candidates.back());
    }
    for (const std::size_t place : points.complete(candidates))
      extra.push_back(nodeAt(outline, piece, interface.nodes[place]));
  }
}

/// Crosspoints of a body in one piece that supports do not hold.
void addPointsInside(const Outline& outline, Piece& piece, std::vector<CrosspointNode>& extra) {
  const BodyOutline& body = bodyOf(outline, piece);
  std::vector<std::size_t> free;
  std::vector<fem::Point> candidates;
  for (std::size_t node = 0; node < piece.assembled.nodes.size(); ++node)
    if (isFree(piece, node, componentsOf(outline, piece))) {
      free.push_back(node);
      candidates.push_back(body.point(piece.assembled.nodes[node]));
    }
  for (const std::size_t place : HoldingPoints(body.components).complete(candidates)) {
    piece.isCrosspoint[free[place]] = 1; // no other piece has it
    extra.push_back(nodeAt(outline, piece, free[place]));
  }
}

/// The union of all ranks' lists, sorted, on every rank.
std::vector<CrosspointNode> gatherNodes(const Comm& comm, const std::vector<CrosspointNode>& mine) {
  std::vector<double> packed;
  for (const CrosspointNode& node : mine)
    packed.insert(packed.end(), {static_cast<double>(node.body), static_cast<double>(node.number),
                                 static_cast<double>(node.numFree)});
  const std::vector<double> all = gatherOnAll(comm, packed);
  std::vector<CrosspointNode> nodes;
  for (std::size_t k = 0; k < all.size(); k += 3)
    nodes.push_back(
        {static_cast<int>(all[k]), static_cast<GlobalOrdinal>(all[k + 1]), static_cast<int>(all[k + 2])});
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end(),
                          [](const auto& a, const auto& b) { return !(a < b) && !(b < a); }),
              nodes.end());
  return nodes;
}

void unite(std::vector<CrosspointNode>& nodes, const std::vector<CrosspointNode>& others) {
  std::vector<CrosspointNode> all;
  std::set_union(nodes.begin(), nodes.end(), others.begin(), others.end(), std::back_inserter(all));
  nodes.swap(all);
}

/// Marks some crosspoints, sorted, in the pieces that share them.
void mark(const std::vector<CrosspointNode>& crosspoints, std::vector<Piece>& pieces) {
  for (Piece& piece : pieces) {
    const std::vector<GlobalOrdinal>& nodes = piece.assembled.nodes;
    if (nodes.empty())
      continue;
    auto key = std::lower_bound(crosspoints.begin(), crosspoints.end(),
                                CrosspointNode{piece.body, nodes.front(), 0});
    const auto end = std::upper_bound(key, crosspoints.end(), CrosspointNode{piece.body, nodes.back(), 0});
    for (std::size_t k = 0; k < piece.sharing.size() && key != end; ++k) {
      const std::size_t node = piece.sharing.node(k);
      key = std::lower_bound(key, end, CrosspointNode{piece.body, nodes[node], 0});
      if (key != end && key->number == nodes[node])
        piece.isCrosspoint[node] = 1;
    }
  }
}

} // namespace

CrosspointNumbering::CrosspointNumbering(const Outline& outline, std::vector<Piece>& pieces,
                                         const Comm& comm) {
  const std::vector<char> held = findHeld(outline, pieces, comm);
  std::vector<CrosspointNode> corners, extra;
  for (Piece& piece : pieces) {
    markCorners(outline, piece, corners);
    for (const std::size_t node : piece.chosen) {
      piece.isCrosspoint[node] = 1;
      extra.push_back(nodeAt(outline, piece, node));
    }
    addInterfacePoints(outline, piece, held, extra);
    if (piece.assembled.kernel.cols() > 0 && piece.sharing.size() == 0)
      addPointsInside(outline, piece, extra);
  }
  nodes_ = gatherNodes(comm, corners);
  extra = gatherNodes(comm, extra);
  mark(extra, pieces);
  unite(nodes_, extra);
  numCorners_ = static_cast<GlobalOrdinal>(nodes_.size());
  addCarriers(outline, pieces, comm);

  firstIndex_.reserve(nodes_.size());
  for (const CrosspointNode& node : nodes_) {
    firstIndex_.push_back(numUnknowns_);
    numUnknowns_ += node.numFree;
  }
}

/// Averages along edges become coarse unknowns in the place of one node's values, the carrier's. Collective.
void CrosspointNumbering::addCarriers(const Outline& outline, std::vector<Piece>& pieces, const Comm& comm) {
  std::vector<CrosspointNode> carriers;
  for (Piece& piece : pieces) {
    const int dimension = bodyOf(outline, piece).dimension;
    const std::size_t components = componentsOf(outline, piece);
    if (!hasEdgeAverages(dimension, components))
      continue;
    findEdgeAverages(dimension, components, piece);
    for (const EdgeAverage& average : piece.averages) {
      piece.isCrosspoint[average.carrier] = 1;
      if (piece.sharing.isLowest(piece.part, average.carrier))
        carriers.push_back(nodeAt(outline, piece, average.carrier));
    }
  }
  unite(nodes_, gatherNodes(comm, carriers));
}

GlobalOrdinal CrosspointNumbering::firstIndex(int body, GlobalOrdinal node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), CrosspointNode{body, node, 0});
  return firstIndex_[static_cast<std::size_t>(found - nodes_.begin())];
}

} // namespace epafi::decomposition
