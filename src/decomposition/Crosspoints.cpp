#include "epafi/decomposition/Crosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/Corners.hpp"
#include "epafi/decomposition/EdgeAverages.hpp"

#include <algorithm>
#include <iterator>
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

/// Whether the nodes without unknowns hold a piece.
bool isHeld(const Layout& layout, const Piece& piece) {
  if (piece.assembled.unknownPosition.size() == piece.assembled.unknownOf.size())
    return false;
  HoldingPoints points(static_cast<int>(componentsOf(layout, piece.body)));
  const fem::Mesh& mesh = *layout.bodies[static_cast<std::size_t>(piece.body)].mesh;
  for (std::size_t node = 0; node < piece.assembled.nodes.size() && !points.hold(); ++node)
    if (!isFree(piece, node, componentsOf(layout, piece.body)))
      points.add(mesh.point(piece.assembled.nodes[node]));
  return points.hold();
}

/// Whether supports alone make each subdomain of the whole problem regular; the same on every rank.
/// Collective.
std::vector<char> findHeld(const Layout& layout, const std::vector<Piece>& pieces, const Comm& comm) {
  std::vector<double> held(static_cast<std::size_t>(layout.numSubdomains), 0.0);
  for (const Piece& piece : pieces)
    held[static_cast<std::size_t>(piece.number)] = isHeld(layout, piece) ? 1 : 0;
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

/// Marks the end points and meeting points of interfaces; the lowest part lists them.
void markCorners(const fem::Mesh& mesh, Piece& piece, std::vector<Key>& corners) {
  piece.isCrosspoint.assign(piece.assembled.nodes.size(), 0);
  const std::vector<char> isCorner = findCorners(mesh, piece);
  for (std::size_t k = 0; k < piece.sharing.size(); ++k)
    if (isCorner[k] != 0) {
      const std::size_t node = piece.sharing.node(k);
      piece.isCrosspoint[node] = 1;
      if (piece.sharing.parts(k).front() == piece.part)
        corners.emplace_back(piece.body, piece.assembled.nodes[node]);
    }
}

/// Further crosspoints for the interfaces of a piece with higher parts: where one of the two sides leans on
/// the other and the free crosspoints that join them do not hold it. The lower part's rank decides, so that both sides
/// hear of the same nodes.
void addInterfacePoints(const Layout& layout, const Piece& piece, const std::vector<char>& held,
                        std::vector<Key>& extra) {
  const auto b = static_cast<std::size_t>(piece.body);
  const fem::Mesh& mesh = *layout.bodies[b].mesh;
  const std::size_t components = componentsOf(layout, piece.body);
  for (const Interface& interface : findInterfaces(piece, components)) {
    const int other = layout.bodies[b].firstSubdomain + interface.other;
    if (held[static_cast<std::size_t>(piece.number)] != 0 && held[static_cast<std::size_t>(other)] != 0)
      continue;
    HoldingPoints points(static_cast<int>(components));
    std::vector<fem::Point> candidates;
    for (const std::size_t node : interface.nodes) {
      candidates.push_back(mesh.point(piece.assembled.nodes[node]));
      if (piece.isCrosspoint[node] != 0)
        points.add(candidates.back());
    }
    for (const std::size_t place : points.complete(candidates))
      extra.emplace_back(piece.body, piece.assembled.nodes[interface.nodes[place]]);
  }
}

/// Crosspoints of a body in one piece that supports do not hold.
void addPointsInside(const fem::Mesh& mesh, int components, Piece& piece, std::vector<Key>& extra) {
  std::vector<std::size_t> free;
  std::vector<fem::Point> candidates;
  for (std::size_t node = 0; node < piece.assembled.nodes.size(); ++node)
    if (isFree(piece, node, static_cast<std::size_t>(components))) {
      free.push_back(node);
      candidates.push_back(mesh.point(piece.assembled.nodes[node]));
    }
  for (const std::size_t place : HoldingPoints(components).complete(candidates)) {
    piece.isCrosspoint[free[place]] = 1; // no other piece has it
    extra.emplace_back(piece.body, piece.assembled.nodes[free[place]]);
  }
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
    if (layout.models[b]->kernelDimension() > 0 && layout.bodies[b].partition->numParts() == 1)
      addPointsInside(*layout.bodies[b].mesh, layout.models[b]->components(), piece, extra);
  }
  nodes_ = gatherKeys(comm, corners);
  extra = gatherKeys(comm, extra);
  if (!extra.empty()) {
    mark(extra, pieces);
    std::vector<Key> all;
    std::set_union(nodes_.begin(), nodes_.end(), extra.begin(), extra.end(), std::back_inserter(all));
    nodes_.swap(all);
  }
  numCorners_ = static_cast<GlobalOrdinal>(nodes_.size());
  addCarriers(layout, pieces, comm);

  firstIndex_.reserve(nodes_.size());
  for (const auto& [body, node] : nodes_) {
    firstIndex_.push_back(numUnknowns_);
    const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(body)];
    for (int component = 0; component < model.components(); ++component)
      if (!model.prescribed(node, component))
        ++numUnknowns_;
  }
}

/// Averages along edges become coarse unknowns in the place of one node's values, the carrier's. Collective.
void CrosspointNumbering::addCarriers(const Layout& layout, std::vector<Piece>& pieces, const Comm& comm) {
  std::vector<Key> carriers;
  for (Piece& piece : pieces) {
    const int dimension =
        fem::dimensionOf(layout.bodies[static_cast<std::size_t>(piece.body)].mesh->cellType());
    const std::size_t components = componentsOf(layout, piece.body);
    if (!hasEdgeAverages(dimension, components))
      continue;
    findEdgeAverages(dimension, components, piece);
    for (const EdgeAverage& average : piece.averages) {
      piece.isCrosspoint[average.carrier] = 1;
      if (piece.sharing.isLowest(piece.part, average.carrier))
        carriers.emplace_back(piece.body, piece.assembled.nodes[average.carrier]);
    }
  }
  carriers = gatherKeys(comm, carriers);
  std::vector<Key> all;
  std::set_union(nodes_.begin(), nodes_.end(), carriers.begin(), carriers.end(), std::back_inserter(all));
  nodes_.swap(all);
}

GlobalOrdinal CrosspointNumbering::firstIndex(int body, GlobalOrdinal node) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), Key(body, node));
  return firstIndex_[static_cast<std::size_t>(found - nodes_.begin())];
}

} // namespace epafi::decomposition
