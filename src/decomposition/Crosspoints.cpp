#include "epafi/decomposition/Crosspoints.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>

namespace epafi::decomposition {
namespace {

using Key = std::pair<int, GlobalOrdinal>;

/// Whether a node of a piece has unknowns.
bool isFree(const Piece& piece, std::size_t node, std::size_t components) {
  const auto first = piece.assembled.unknownOf.begin() + static_cast<std::ptrdiff_t>(node * components);
  return std::any_of(first, first + static_cast<std::ptrdiff_t>(components),
                     [](int unknown) { return unknown >= 0; });
}

std::size_t componentsOf(const Layout& layout, int body) {
  return static_cast<std::size_t>(layout.models[static_cast<std::size_t>(body)]->components());
}

/// Points that hold a body's rigid modes: one for a scalar field, two in the plane, three in space.
std::size_t pointsNeeded(const fem::BodyModel& model) {
  return static_cast<std::size_t>(model.components());
}

/// Nodes without unknowns.
std::size_t countHeld(const Piece& piece, std::size_t components) {
  if (piece.assembled.unknownPosition.size() == piece.assembled.unknownOf.size())
    return 0;
  std::size_t held = 0;
  for (std::size_t node = 0; node < piece.assembled.nodes.size(); ++node)
    held += isFree(piece, node, components) ? 0 : 1;
  return held;
}

/// Whether supports alone make each subdomain of the whole problem regular; the same on every rank.
/// Collective.
std::vector<char> findHeld(const Layout& layout, const std::vector<Piece>& pieces, const Comm& comm) {
  std::vector<double> heldNodes(static_cast<std::size_t>(layout.numSubdomains), 0.0);
  for (const Piece& piece : pieces)
    heldNodes[static_cast<std::size_t>(piece.number)] =
        static_cast<double>(countHeld(piece, componentsOf(layout, piece.body)));
  sumOverRanks(comm, heldNodes);
  std::vector<char> held;
  held.reserve(heldNodes.size());
  for (std::size_t b = 0; b < layout.bodies.size(); ++b) {
    const auto needed = static_cast<double>(pointsNeeded(*layout.models[b]));
    for (int part = 0; part < layout.bodies[b].partition->numParts(); ++part)
      held.push_back(heldNodes[held.size()] >= needed ? 1 : 0);
  }
  return held;
}

/// Number of free nodes and of free crosspoints that a piece shares with another part.
struct Interface {
  int other = 0;
  std::size_t numNodes = 0, numCrosspoints = 0;
};

/// The interfaces of a piece with higher parts.
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
        interface = interfaces.insert(interface, {other, 0, 0});
      ++interface->numNodes;
      interface->numCrosspoints += piece.isCrosspoint[node] != 0 ? 1 : 0;
    }
  }
  return interfaces;
}

/// The free nodes of an interface, ascending.
std::vector<GlobalOrdinal> nodesOf(const Interface& interface, const Piece& piece, std::size_t components) {
  std::vector<GlobalOrdinal> nodes;
  nodes.reserve(interface.numNodes);
  for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
    const std::span<const int> parts = piece.sharing.parts(k);
    if (isFree(piece, piece.sharing.node(k), components) &&
        std::find(parts.begin(), parts.end(), interface.other) != parts.end())
      nodes.push_back(piece.assembled.nodes[piece.sharing.node(k)]);
  }
  return nodes;
}

/// Marks the end points and meeting points of interfaces; the lowest part lists them.
void markCorners(const fem::Mesh& mesh, Piece& piece, std::vector<Key>& corners) {
  piece.isCrosspoint.assign(piece.assembled.nodes.size(), 0);
  for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
    const std::size_t node = piece.sharing.node(k), copies = piece.sharing.parts(k).size();
    if (copies >= 3 || (copies == 2 && mesh.isBoundaryNode(piece.assembled.nodes[node]))) {
      piece.isCrosspoint[node] = 1;
      if (piece.sharing.parts(k).front() == piece.part)
        corners.emplace_back(piece.body, piece.assembled.nodes[node]);
    }
  }
}

/// Further crosspoints for the interfaces of a piece with higher parts: where one of the two sides leans on
/// the other and too few free crosspoints join them, free nodes evenly spaced among the shared ones (a single
/// one: in the middle). The lower part's rank decides, so that both sides hear of the same nodes.
void addInterfacePoints(const Layout& layout, const Piece& piece, const std::vector<char>& held,
                        std::vector<Key>& extra) {
  const auto b = static_cast<std::size_t>(piece.body);
  const std::size_t components = componentsOf(layout, piece.body), needed = pointsNeeded(*layout.models[b]);
  for (const Interface& interface : findInterfaces(piece, components)) {
    const int other = layout.bodies[b].firstSubdomain + interface.other;
    const bool bothHeld =
        held[static_cast<std::size_t>(piece.number)] != 0 && held[static_cast<std::size_t>(other)] != 0;
    if (bothHeld || interface.numCrosspoints >= needed)
      continue;
    const std::vector<GlobalOrdinal> nodes = nodesOf(interface, piece, components);
    const std::size_t missing = needed - interface.numCrosspoints;
    for (std::size_t k = 0; k < missing; ++k)
      extra.emplace_back(piece.body, nodes[(2 * k + 1) * nodes.size() / (2 * missing)]);
  }
}

/// Place of the node nearest to the centre of the points of a piece.
std::size_t middleNode(const fem::Mesh& mesh, const Piece& piece) {
  fem::Point centre{0, 0, 0};
  for (const GlobalOrdinal node : piece.assembled.nodes) {
    const fem::Point point = mesh.point(node);
    for (std::size_t d = 0; d < 3; ++d)
      centre[d] += point[d] / static_cast<double>(piece.assembled.nodes.size());
  }
  std::size_t best = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t node = 0; node < piece.assembled.nodes.size(); ++node) {
    const fem::Point point = mesh.point(piece.assembled.nodes[node]);
    double distance = 0;
    for (std::size_t d = 0; d < 3; ++d)
      distance += (point[d] - centre[d]) * (point[d] - centre[d]);
    if (distance < nearest * (1 - 1e-12)) {
      nearest = distance;
      best = node;
    }
  }
  return best;
}

/// The union of all ranks' lists, sorted, on every rank.
std::vector<Key> gatherKeys(const Comm& comm, const std::vector<Key>& mine) {
  std::vector<double> packed;
  for (const auto& [body, node] : mine)
    packed.insert(packed.end(), {static_cast<double>(body), static_cast<double>(node)});
  const std::vector<double> all = gatherOnAll(comm, packed);
  std::vector<Key> keys;
  for (std::size_t k = 0; k < all.size(); k += 2)
    keys.emplace_back(static_cast<int>(all[k]), static_cast<GlobalOrdinal>(all[k + 1]));
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

/// Marks some crosspoints, sorted, in the pieces that share them.
void mark(const std::vector<Key>& crosspoints, std::vector<Piece>& pieces) {
  for (Piece& piece : pieces) {
    const std::vector<GlobalOrdinal>& nodes = piece.assembled.nodes;
    auto key = std::lower_bound(crosspoints.begin(), crosspoints.end(), Key(piece.body, nodes.front()));
    const auto end = std::upper_bound(key, crosspoints.end(), Key(piece.body, nodes.back()));
    for (std::size_t k = 0; k < piece.sharing.size() && key != end; ++k) {
      const std::size_t node = piece.sharing.node(k);
      key = std::lower_bound(key, end, Key(piece.body, nodes[node]));
      if (key != end && key->second == nodes[node])
        piece.isCrosspoint[node] = 1;
    }
  }
}

} // namespace

CrosspointNumbering::CrosspointNumbering(const Layout& layout, std::vector<Piece>& pieces, const Comm& comm) {
  const std::vector<char> held = findHeld(layout, pieces, comm);
  std::vector<Key> corners, extra;
  for (Piece& piece : pieces) {
    const auto b = static_cast<std::size_t>(piece.body);
    markCorners(*layout.bodies[b].mesh, piece, corners);
    addInterfacePoints(layout, piece, held, extra);
    if (layout.models[b]->kernelDimension() > 0 && layout.bodies[b].partition->numParts() == 1) {
      const std::size_t middle = middleNode(*layout.bodies[b].mesh, piece);
      piece.isCrosspoint[middle] = 1; // no other piece has it
      extra.emplace_back(piece.body, piece.assembled.nodes[middle]);
    }
  }
  nodes_ = gatherKeys(comm, corners);
  extra = gatherKeys(comm, extra);
  if (!extra.empty()) {
    mark(extra, pieces);
    std::vector<Key> all;
    std::set_union(nodes_.begin(), nodes_.end(), extra.begin(), extra.end(), std::back_inserter(all));
    nodes_.swap(all);
  }

  firstIndex_.reserve(nodes_.size());
  for (const auto& [body, node] : nodes_) {
    firstIndex_.push_back(numUnknowns_);
    const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(body)];
    for (int component = 0; component < model.components(); ++component)
      if (!model.prescribed(node, component))
        ++numUnknowns_;
  }
}

GlobalOrdinal CrosspointNumbering::firstIndex(int body, GlobalOrdinal node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), Key(body, node));
  return firstIndex_[static_cast<std::size_t>(found - nodes_.begin())];
}

} // namespace epafi::decomposition
