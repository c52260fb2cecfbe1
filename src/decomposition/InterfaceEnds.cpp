#include "epafi/decomposition/InterfaceEnds.hpp"

#include <algorithm>
#include <map>
#include <span>

namespace epafi::decomposition {
namespace {

/// The graph of K^s among the free shared nodes of a piece; these are named by their places in its Sharing.
class SharedGraph {
public:
  SharedGraph(const BodyOutline& body, const Piece& piece) : body_(body), piece_(piece) {
    const auto components = static_cast<std::size_t>(body.components);
    const std::vector<int>& positions = piece.assembled.unknownPosition;
    neighbours_.resize(piece.sharing.size());
    std::vector<int> sharedAt(piece.assembled.nodes.size(), -1);
    for (std::size_t k = 0; k < piece.sharing.size(); ++k)
      sharedAt[piece.sharing.node(k)] = static_cast<int>(k);
    const SparseMatrix& stiffness = *piece.stiffness;
    for (int column = 0; column < stiffness.outerSize(); ++column) {
      const int k =
          sharedAt[static_cast<std::size_t>(positions[static_cast<std::size_t>(column)]) / components];
      if (k < 0)
        continue;
      auto& list = neighbours_[static_cast<std::size_t>(k)];
      for (SparseMatrix::InnerIterator entry(stiffness, column); entry; ++entry) {
        const int other =
            sharedAt[static_cast<std::size_t>(positions[static_cast<std::size_t>(entry.row())]) / components];
        if (other >= 0 && other != k && std::find(list.begin(), list.end(), other) == list.end())
          list.push_back(other);
      }
    }
  }

  /// The nodes of the chain that `start` lies on, in the order in which a search from there reaches them.
  [[nodiscard]] std::vector<std::size_t> chainFrom(std::size_t start) const {
    std::vector<std::size_t> reached{start};
    for (std::size_t next = 0; next < reached.size(); ++next)
      for (const int neighbour : neighbours_[reached[next]]) {
        const auto k = static_cast<std::size_t>(neighbour);
        if (isSameChain(k, start) && std::find(reached.begin(), reached.end(), k) == reached.end())
          reached.push_back(k);
      }
    return reached;
  }

  /// The last node that a search from `start` reaches; of those in as many steps the most distant one.
  [[nodiscard]] std::size_t farthestFrom(std::size_t start) const {
    std::map<std::size_t, int> steps{{start, 0}};
    std::size_t farthest = start;
    for (const std::size_t k : chainFrom(start)) {
      for (const int neighbour : neighbours_[k])
        if (const auto other = static_cast<std::size_t>(neighbour); isSameChain(other, start))
          steps.try_emplace(other, steps[k] + 1);
      if (steps[k] > steps[farthest] ||
          (steps[k] == steps[farthest] && distance(start, k) > distance(start, farthest)))
        farthest = k;
    }
    return farthest;
  }

  /// Whether a node lies beside one that more parts share, the node's own parts among them.
  [[nodiscard]] bool isBesideCorner(std::size_t k) const {
    const std::span<const int> own = piece_.sharing.parts(k);
    return std::any_of(neighbours_[k].begin(), neighbours_[k].end(), [&](int neighbour) {
      const std::span<const int> parts = piece_.sharing.parts(static_cast<std::size_t>(neighbour));
      return parts.size() > own.size() && std::includes(parts.begin(), parts.end(), own.begin(), own.end());
    });
  }

private:
  [[nodiscard]] bool isSameChain(std::size_t a, std::size_t b) const {
    const std::span<const int> first = piece_.sharing.parts(a), second = piece_.sharing.parts(b);
    return std::equal(first.begin(), first.end(), second.begin(), second.end());
  }
  [[nodiscard]] double distance(std::size_t a, std::size_t b) const {
    const fem::Point x = body_.point(piece_.assembled.nodes[piece_.sharing.node(a)]);
    const fem::Point y = body_.point(piece_.assembled.nodes[piece_.sharing.node(b)]);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (x[i] - y[i]) * (x[i] - y[i]);
    return sum;
  }

  const BodyOutline& body_;
  const Piece& piece_;
  std::vector<std::vector<int>> neighbours_;
};

} // namespace

std::vector<std::size_t> findInterfaceEnds(const BodyOutline& body, const Piece& piece) {
  const SharedGraph graph(body, piece);
  const std::size_t fewest = body.dimension == 2 ? 2 : 3, most = body.dimension == 2 ? 2 : 64;
  std::vector<char> isDone(piece.sharing.size(), 0);
  std::vector<std::size_t> ends;
  const auto components = static_cast<std::size_t>(body.components);
  for (std::size_t k = 0; k < piece.sharing.size(); ++k) {
    const std::span<const int> parts = piece.sharing.parts(k);
    const auto unknowns =
        std::span(piece.assembled.unknownOf).subspan(piece.sharing.node(k) * components, components);
    if (isDone[k] != 0 || parts.size() < fewest || parts.size() > most || parts.front() != piece.part ||
        std::all_of(unknowns.begin(), unknowns.end(), [](int unknown) { return unknown < 0; }))
      continue;
    for (const std::size_t other : graph.chainFrom(k))
      isDone[other] = 1;
    const std::size_t first = graph.farthestFrom(k), last = graph.farthestFrom(first);
    for (const std::size_t end : {first, last})
      if (!graph.isBesideCorner(end) &&
          std::find(ends.begin(), ends.end(), piece.sharing.node(end)) == ends.end())
        ends.push_back(piece.sharing.node(end));
  }
  return ends;
}

} // namespace epafi::decomposition
