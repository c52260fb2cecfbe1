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

/// Middle node of every interface of this piece with a higher part that has no free crosspoint.
void addInterfacePoints(const Layout& layout, const Piece& piece, std::vector<Key>& extra) {
  struct Interface {
    bool hasCrosspoint = false;
    std::vector<GlobalOrdinal> freeNodes;
  };
  const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(piece.body)];
  std::map<int, Interface> interfaces; // by the other part
  for (std::size_t i = 0; i < piece.sharing.size(); ++i) {
    const GlobalOrdinal node = piece.assembled.nodes[i];
    if (piece.sharing[i].size() < 2 || !isFree(model, node))
      continue;
    for (const int other : piece.sharing[i])
      if (other > piece.part) {
        Interface& interface = interfaces[other];
        interface.freeNodes.push_back(node);
        interface.hasCrosspoint = interface.hasCrosspoint || piece.isCrosspoint[i] != 0;
      }
  }
  for (const auto& [other, interface] : interfaces)
    if (!interface.hasCrosspoint)
      extra.emplace_back(piece.body, interface.freeNodes[interface.freeNodes.size() / 2]);
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
  std::vector<Key> mine;
  for (Piece& piece : pieces) {
    const BodyLayout& body = layout.bodies[static_cast<std::size_t>(piece.body)];
    piece.isCrosspoint.assign(piece.assembled.nodes.size(), 0);
    for (std::size_t i = 0; i < piece.sharing.size(); ++i) {
      const std::size_t copies = piece.sharing[i].size();
      if (copies >= 3 || (copies == 2 && body.mesh->isBoundaryNode(piece.assembled.nodes[i]))) {
        piece.isCrosspoint[i] = 1;
        mine.emplace_back(piece.body, piece.assembled.nodes[i]);
      }
    }
    addInterfacePoints(layout, piece, mine);
    const bool floats = layout.models[static_cast<std::size_t>(piece.body)]->kernelDimension() > 0;
    if (floats && body.partition->numParts() == 1)
      mine.emplace_back(piece.body, middleNode(*body.mesh, piece));
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
