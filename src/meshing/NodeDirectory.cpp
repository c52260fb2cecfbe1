#include "epafi/meshing/NodeDirectory.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/PointToPoint.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace epafi::meshing {
NodeDirectory::NodeDirectory(const Comm& comm, std::vector<Node> nodes) : comm_(comm) {
  GlobalOrdinal first = std::numeric_limits<GlobalOrdinal>::max(), last = 0;
  for (const Node& node : nodes) {
    first = std::min(first, node.key);
    last = std::max(last, node.key);
  }
  firstKey_ = minOverRanks(comm, first);
  keysEach_ = (maxOverRanks(comm, last) - firstKey_) / comm.getSize() + 1;
  std::map<int, std::vector<Node>> outgoing;
  for (const Node& node : nodes)
    outgoing[homeOf(node.key)].push_back(node);
  nodes = {};
  std::vector<Node> kept;
  for (auto& [rank, some] : deliver(comm, std::move(outgoing))) {
    kept.insert(kept.end(), some.begin(), some.end());
    some = {};
  }
  collectively(comm, [&] { keep(std::move(kept)); });
  number();
}

void NodeDirectory::keep(std::vector<Node> nodes) {
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.key < b.key; });
  for (const Node& node : nodes) {
    if (keys_.empty() || keys_.back() != node.key) {
      keys_.push_back(node.key);
      entries_.push_back({.point = node.point});
    } else if (entries_.back().point != node.point) {
      throw InputError("the mesh files give node " + std::to_string(node.key) +
                       " different places; they are not parts of one mesh, so save them all anew");
    }
    if (node.isCorner)
      entries_.back().corner = 0; // number() numbers them
  }
}

void NodeDirectory::number() {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  box_ = {Point{infinity, infinity, infinity}, Point{-infinity, -infinity, -infinity}};
  GlobalOrdinal corners = 0;
  for (const Entry& entry : entries_) {
    corners += entry.corner == 0 ? 1 : 0;
    for (std::size_t d = 0; d < 3; ++d) {
      box_[0][d] = std::min(box_[0][d], entry.point[d]);
      box_[1][d] = std::max(box_[1][d], entry.point[d]);
    }
  }
  const GlobalOrdinal own = entries_.size();
  GlobalOrdinal next = sumBefore(comm_, own), nextCorner = sumBefore(comm_, corners);
  numNodes_ = sumOverRanks(comm_, own);
  numCorners_ = sumOverRanks(comm_, corners);
  for (std::size_t d = 0; d < 3; ++d) {
    box_[0][d] = minOverRanks(comm_, box_[0][d]);
    box_[1][d] = maxOverRanks(comm_, box_[1][d]);
  }
  for (Entry& entry : entries_) {
    entry.number = next++;
    if (entry.corner == 0)
      entry.corner = nextCorner++;
  }
}

NodeDirectory::Keys NodeDirectory::byHome(const std::vector<GlobalOrdinal>& keys) const {
  Keys messages;
  for (const GlobalOrdinal key : keys)
    messages[homeOf(key)].push_back(key);
  return messages;
}

std::size_t NodeDirectory::placeOf(GlobalOrdinal key) const {
  return std::lower_bound(keys_.begin(), keys_.end(), key) - keys_.begin();
}

NodeDirectory::Keys NodeDirectory::shared(const std::vector<GlobalOrdinal>& keys) const {
  const Keys asked = byHome(keys), asking = deliver(comm_, asked);
  std::vector<std::vector<int>> ranks(keys_.size()); // that ask for each kept node
  for (const auto& [rank, some] : asking)
    for (const GlobalOrdinal key : some)
      ranks[placeOf(key)].push_back(rank);
  struct Pair {
    GlobalOrdinal key;
    int rank;
  };
  std::map<int, std::vector<Pair>> answers;
  for (const auto& [rank, some] : asking) {
    std::vector<Pair>& answer = answers[rank];
    for (const GlobalOrdinal key : some)
      for (const int other : ranks[placeOf(key)])
        if (other != rank)
          answer.push_back({key, other});
  }
  Keys shared;
  for (const auto& [home, pairs] : exchange(comm_, answers, ranksOf(asked)))
    for (const Pair& pair : pairs)
      shared[pair.rank].push_back(pair.key);
  return shared;
}

void NodeDirectory::markBoundary(const std::vector<GlobalOrdinal>& keys) {
  for (const auto& [rank, some] : deliver(comm_, byHome(keys)))
    for (const GlobalOrdinal key : some)
      entries_[placeOf(key)].isOnBoundary = true;
}

std::vector<NodeDirectory::Entry> NodeDirectory::find(const std::vector<GlobalOrdinal>& keys) const {
  const Keys asked = byHome(keys);
  std::map<int, std::vector<Entry>> answers;
  for (const auto& [rank, some] : deliver(comm_, asked))
    for (const GlobalOrdinal key : some)
      answers[rank].push_back(entries_[placeOf(key)]);
  std::vector<Entry> found; // ranks keep ascending keys
  for (const auto& [home, some] : exchange(comm_, answers, ranksOf(asked)))
    found.insert(found.end(), some.begin(), some.end());
  return found;
}

} // namespace epafi::meshing
