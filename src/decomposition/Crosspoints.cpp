#include "epafi/decomposition/Crosspoints.hpp"

#include "epafi/base/Collective.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace epafi::decomposition {
namespace {

using Key = std::pair<int, GlobalOrdinal>;

bool isFree(const fem::BodyModel& model, GlobalOrdinal node) {
  for (int component = 0; component < model.components(); ++component)
    if (!model.prescribed(node, component))
      return true;
  return false;
}

bool isHeld(const fem::BodyModel& model, GlobalOrdinal node) {
  for (int component = 0; component < model.components(); ++component)
    if (!model.prescribed(node, component))
      return false;
  return true;
}

/// Points that hold a body's rigid modes: one for a scalar field, two in the plane, three in space.
std::size_t pointsNeeded(const fem::BodyModel& model) {
  return static_cast<std::size_t>(model.components());
}

/// Whether supports alone make each subdomain of the whole problem regular; the same on every rank.
/// Collective.
std::vector<char> findHeld(const Layout& layout, const std::vector<Piece>& pieces, const Comm& comm) {
  std::vector<double> heldNodes(static_cast<std::size_t>(layout.numSubdomains), 0.0);
  for (const Piece& piece : pieces)
    for (const GlobalOrdinal node : piece.assembled.nodes)
      if (isHeld(*layout.models[static_cast<std::size_t>(piece.body)], node))
        heldNodes[static_cast<std::size_t>(piece.number)] += 1;
  sumOverRanks(comm, heldNodes);
  std::vector<char> held;
  for (int number = 0; number < layout.numSubdomains; ++number) {
    const auto& model = *layout.models[static_cast<std::size_t>(bodyOf(layout, number))];
    held.push_back(heldNodes[held.size()] >= static_cast<double>(pointsNeeded(model)) ? 1 : 0);
  }
  return held;
}

/// The free nodes that a piece shares with one other part.
struct Interface {
  std::size_t numCrosspoints = 0;
  std::vector<GlobalOrdinal> nodes;
};

/// The interfaces of a piece with higher parts, by part.
std::map<int, Interface> findInterfaces(const fem::BodyModel& model, const Piece& piece) {
  std::map<int, Interface> interfaces;
  for (std::size_t i = 0; i < piece.sharing.size(); ++i) {
    const GlobalOrdinal node = piece.assembled.nodes[i];
    if (piece.sharing[i].size() < 2 || !isFree(model, node))
      continue;
    for (const int other : piece.sharing[i])
      if (other > piece.part) {
        Interface& interface = interfaces[other];
        interface.nodes.push_back(node);
        interface.numCrosspoints += piece.isCrosspoint[i] != 0 ? 1 : 0;
      }
  }
  return interfaces;
}

/// Marks the end points and meeting points of interfaces.
void markCorners(const fem::Mesh& mesh, Piece& piece, std::vector<Key>& corners) {
  piece.isCrosspoint.assign(piece.assembled.nodes.size(), 0);
  for (std::size_t i = 0; i < piece.sharing.size(); ++i) {
    const std::size_t copies = piece.sharing[i].size();
    if (copies >= 3 || (copies == 2 && mesh.isBoundaryNode(piece.assembled.nodes[i]))) {
      piece.isCrosspoint[i] = 1;
      corners.emplace_back(piece.body, piece.assembled.nodes[i]);
    }
  }
}

/// Further crosspoints for the interfaces of a piece with higher parts: where one of the two sides leans on
/// the other and too few free crosspoints join them, free nodes evenly spaced among the shared ones (a single
/// one: in the middle). The lower part's rank decides, so that both sides hear of the same nodes.
void addInterfacePoints(const Layout& layout, const Piece& piece, const std::vector<char>& held,
                        std::vector<Key>& extra) {
  const auto b = static_cast<std::size_t>(piece.body);
  const int firstSubdomain = layout.bodies[b].firstSubdomain;
  const std::size_t needed = pointsNeeded(*layout.models[b]);
  for (const auto& [other, interface] : findInterfaces(*layout.models[b], piece)) {
    const bool bothHeld =
        held[static_cast<std::size_t>(piece.number)] != 0 &&
        held[static_cast<std::size_t>(firstSubdomain) + static_cast<std::size_t>(other)] != 0;
    if (bothHeld || interface.numCrosspoints >= needed)
      continue;
    const std::size_t missing = needed - interface.numCrosspoints, available = interface.nodes.size();
    for (std::size_t k = 0; k < missing; ++k)
      extra.emplace_back(piece.body, interface.nodes[(2 * k + 1) * available / (2 * missing)]);
  }
}

/// Node nearest to the centre of the points of a piece.
GlobalOrdinal middleNode(const fem::Mesh& mesh, const Piece& piece) {
  fem::Point centre{0, 0, 0};
  for (const GlobalOrdinal node : piece.assembled.nodes) {
    const fem::Point point = mesh.point(node);
    for (std::size_t d = 0; d < 3; ++d)
      centre[d] += point[d] / static_cast<double>(piece.assembled.nodes.size());
  }
  GlobalOrdinal best = piece.assembled.nodes.front();
  double nearest = std::numeric_limits<double>::infinity();
  for (const GlobalOrdinal node : piece.assembled.nodes) {
    const fem::Point point = mesh.point(node);
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

} // namespace

CrosspointNumbering::CrosspointNumbering(const Layout& layout, std::vector<Piece>& pieces, const Comm& comm) {
  const std::vector<char> held = findHeld(layout, pieces, comm);
  std::vector<Key> mine;
  for (Piece& piece : pieces) {
    const auto b = static_cast<std::size_t>(piece.body);
    markCorners(*layout.bodies[b].mesh, piece, mine);
    addInterfacePoints(layout, piece, held, mine);
    if (layout.models[b]->kernelDimension() > 0 && layout.bodies[b].partition->numParts() == 1)
      mine.emplace_back(piece.body, middleNode(*layout.bodies[b].mesh, piece));
  }
  nodes_ = gatherKeys(comm, mine);

  for (Piece& piece : pieces)
    for (std::size_t i = 0; i < piece.isCrosspoint.size(); ++i)
      if (std::binary_search(nodes_.begin(), nodes_.end(), Key(piece.body, piece.assembled.nodes[i])))
        piece.isCrosspoint[i] = 1;
  for (const auto& [body, node] : nodes_) {
    firstIndex_.push_back(numUnknowns_);
    const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(body)];
    for (int component = 0; component < model.components(); ++component)
      if (!model.prescribed(node, component))
        ++numUnknowns_;
  }
}

GlobalOrdinal CrosspointNumbering::index(int body, GlobalOrdinal node, const fem::BodyModel& model,
                                         int component) const {
  const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), Key(body, node));
  GlobalOrdinal result = firstIndex_[static_cast<std::size_t>(found - nodes_.begin())];
  for (int c = 0; c < component; ++c)
    if (!model.prescribed(node, c))
      ++result;
  return result;
}

} // namespace epafi::decomposition
