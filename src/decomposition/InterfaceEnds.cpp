#include "epafi/decomposition/InterfaceEnds.hpp"

#include <algorithm>
#include <map>
#include <span>

namespace epafi::decomposition {
namespace {

/// The graph of K^s among the free shared nodes of a subdomain; these are named by their places among its
/// copies.
class SharedGraph {
public:
  SharedGraph(const Substructures& all, const SharedNodes& shared, std::size_t subdomain)
      : all_(all), shared_(shared), subdomain_(subdomain), copies_(shared.copiesOf(subdomain)),
        neighbours_(copies_.size()) {
    const std::vector<int>& positions = all.subdomains[subdomain].unknownPosition;
    std::vector<int> copyAt(all.numNodes(subdomain), -1);
    for (int k = 0; k < std::ssize(copies_); ++k)
      copyAt[copies_[k].place] = k;
    const auto copyOf = [&](Eigen::Index unknown) { return copyAt[positions[unknown] / all.components]; };
    const SparseMatrix& stiffness = *all.nodal[subdomain].stiffness;
    for (int column = 0; column < stiffness.outerSize(); ++column) {
      const int k = copyOf(column);
      if (k < 0)
        continue;
      auto& list = neighbours_[k];
      for (SparseMatrix::InnerIterator entry(stiffness, column); entry; ++entry) {
        const int other = copyOf(entry.row());
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
        const std::size_t k = neighbour;
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
        if (const std::size_t other = neighbour; isSameChain(other, start))
          steps.try_emplace(other, steps[k] + 1);
      if (steps[k] > steps[farthest] ||
          (steps[k] == steps[farthest] && distance(start, k) > distance(start, farthest)))
        farthest = k;
    }
    return farthest;
  }

  /// Whether a node lies beside one that more parts share, the node's own parts among them.
  [[nodiscard]] bool isBesideCorner(std::size_t k) const {
    const std::span<const int> own = subdomainsAt(k);
    return std::any_of(neighbours_[k].begin(), neighbours_[k].end(), [&](int neighbour) {
      const std::span<const int> parts = subdomainsAt(neighbour);
      return parts.size() > own.size() && std::includes(parts.begin(), parts.end(), own.begin(), own.end());
    });
  }

private:
  [[nodiscard]] std::span<const int> subdomainsAt(std::size_t k) const {
    return shared_.subdomainsAt(copies_[k].node);
  }
  [[nodiscard]] bool isSameChain(std::size_t a, std::size_t b) const {
    return std::ranges::equal(subdomainsAt(a), subdomainsAt(b));
  }
  [[nodiscard]] double distance(std::size_t a, std::size_t b) const {
    const Point x = all_.point(subdomain_, copies_[a].place), y = all_.point(subdomain_, copies_[b].place);
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += (x[i] - y[i]) * (x[i] - y[i]);
    return sum;
  }

  const Substructures& all_;
  const SharedNodes& shared_;
  std::size_t subdomain_;
  std::span<const SharedNodes::Copy> copies_;
  std::vector<std::vector<int>> neighbours_;
};

} // namespace

std::vector<std::size_t> findInterfaceEnds(const Substructures& all, const SharedNodes& shared,
                                           std::size_t subdomain) {
  const SharedGraph graph(all, shared, subdomain);
  const std::span<const SharedNodes::Copy> copies = shared.copiesOf(subdomain);
  const bool isPlane = all.places.dimension == 2;
  std::vector<char> isDone(copies.size(), 0);
  std::vector<std::size_t> ends;
  for (std::size_t k = 0; k < copies.size(); ++k) {
    const std::size_t number = shared.subdomainsAt(copies[k].node).size();
    if (isDone[k] != 0 || copies[k].order != 0 || (isPlane ? number != 2 : number < 3) ||
        !all.isFree(subdomain, copies[k].place))
      continue;
    for (const std::size_t other : graph.chainFrom(k))
      isDone[other] = 1;
    const std::size_t first = graph.farthestFrom(k), last = graph.farthestFrom(first);
    for (const std::size_t end : {first, last})
      if (!graph.isBesideCorner(end) && std::find(ends.begin(), ends.end(), copies[end].place) == ends.end())
        ends.push_back(copies[end].place);
  }
  return ends;
}

} // namespace epafi::decomposition
