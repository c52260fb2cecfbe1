#include "epafi/base/ArrayIndex.hpp"
#include "epafi/mesh/SimplexMesh.hpp"

#include <algorithm>
#include <deque>
#include <numeric>
#include <utility>

namespace epafi::mesh {
namespace {

using Edge = SimplexMesh::Edge;

class Bisection {
public:
  Bisection(SimplexMesh& mesh, std::vector<int> times)
      : mesh_(mesh), numCorners_(index(mesh.dimension) + 1), times_(std::move(times)),
        ancestors_(mesh.elements.size()), elementsAt_(mesh.points.size()) {
    std::iota(ancestors_.begin(), ancestors_.end(), 0);
    for (LocalOrdinal e = 0; e < std::ssize(mesh.elements); ++e) {
      for (std::size_t i = 0; i < numCorners_; ++i)
        elementsAt_[index(mesh.elements[e].corners[i])].push_back(e);
      if (times_[e] > 0)
        queue_.push_back(e);
    }
  }

  /// A longest edge is cut after all that are longer, wherever they are: the chain of elements that wait for
  /// each other ends.
  std::vector<LocalOrdinal> run() {
    while (!queue_.empty()) {
      const LocalOrdinal element = queue_.front();
      queue_.pop_front();
      if (times_[element] > 0 || hasCutEdge(element))
        split(element);
    }
    return std::move(ancestors_);
  }

private:
  [[nodiscard]] bool hasCutEdge(LocalOrdinal element) const {
    const auto& corners = mesh_.elements[element].corners;
    for (std::size_t i = 1; i < numCorners_; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (middles_.contains(SimplexMesh::edgeBetween(corners[i], corners[j])))
          return true;
    return false;
  }

  /// Of the chord, rounded: the same from every element, and of edges that differ in round-off alone.
  [[nodiscard]] float squaredLength(LocalOrdinal low, LocalOrdinal high) const {
    const Point &a = mesh_.points[index(low)], &b = mesh_.points[index(high)];
    double sum = 0;
    for (std::size_t d = 0; d < 3; ++d)
      sum += (b[d] - a[d]) * (b[d] - a[d]);
    return static_cast<float>(sum);
  }

  /// Places of its ends among the corners. Edges are in one order, whichever element asks: by length, then by
  /// name.
  [[nodiscard]] std::pair<std::size_t, std::size_t> longestEdge(LocalOrdinal element) const {
    const auto& corners = mesh_.elements[element].corners;
    std::pair<std::size_t, std::size_t> longest;
    std::pair<float, Edge> key{0.0F, 0};
    for (std::size_t i = 1; i < numCorners_; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const auto [low, high] = std::minmax(corners[i], corners[j]);
        const std::pair here{squaredLength(low, high), SimplexMesh::edgeBetween(low, high)};
        if (here > key) {
          longest = {i, j};
          key = here;
        }
      }
    return longest;
  }

  [[nodiscard]] Point bendOf(LocalOrdinal a, LocalOrdinal b) const {
    const auto found = mesh_.bends.find(SimplexMesh::edgeBetween(a, b));
    return found == mesh_.bends.end() ? Point{} : found->second;
  }
  void setBend(LocalOrdinal a, LocalOrdinal b, const Point& bend) {
    if (bend != Point{})
      mesh_.bends[SimplexMesh::edgeBetween(a, b)] = bend;
  }

  /// The node in the middle of an edge, a new one at first.
  LocalOrdinal middleOf(LocalOrdinal a, LocalOrdinal b) {
    const auto [place, isNew] =
        middles_.try_emplace(SimplexMesh::edgeBetween(a, b), static_cast<LocalOrdinal>(mesh_.points.size()));
    const LocalOrdinal middle = place->second;
    if (!isNew)
      return middle;
    const Point bend = bendOf(a, b);
    Point point{}, part{};
    for (std::size_t d = 0; d < 3; ++d) {
      point[d] = 0.5 * (mesh_.points[index(a)][d] + mesh_.points[index(b)][d]) + bend[d];
      part[d] = 0.25 * bend[d];
    }
    mesh_.points.push_back(point);
    elementsAt_.emplace_back();
    setBend(a, middle, part);
    setBend(middle, b, part);
    for (const LocalOrdinal element : elementsAt_[index(a)])
      if (const auto& corners = mesh_.elements[index(element)].corners;
          std::find(corners.begin(), corners.begin() + mesh_.dimension + 1, b) !=
          corners.begin() + mesh_.dimension + 1)
        queue_.push_back(element);
    return middle;
  }

  /// Of the edge from the middle of an edge (a, b) to a corner c: the triangle's quadratic map in the middle
  /// of that line.
  void bendAcross(LocalOrdinal a, LocalOrdinal b, LocalOrdinal middle, LocalOrdinal c) {
    const Point ab = bendOf(a, b), bc = bendOf(b, c), ca = bendOf(c, a);
    Point bend{};
    for (std::size_t d = 0; d < 3; ++d)
      bend[d] = -0.25 * ab[d] + 0.5 * (bc[d] + ca[d]);
    setBend(middle, c, bend);
  }

  void split(LocalOrdinal element) {
    const auto [at, bt] = longestEdge(element);
    SimplexMesh::Element first = mesh_.elements[element];
    const LocalOrdinal a = first.corners[at], b = first.corners[bt], middle = middleOf(a, b);
    for (std::size_t i = 0; !mesh_.bends.empty() && i < numCorners_; ++i)
      if (i != at && i != bt)
        bendAcross(a, b, middle, first.corners[i]);
    SimplexMesh::Element second = first;
    first.corners[bt] = middle; // and lies on the side of a: its facet opposite to a is the cut
    first.facets[at] = 0;
    second.corners[at] = middle;
    second.facets[bt] = 0;
    const auto other = static_cast<LocalOrdinal>(mesh_.elements.size());
    mesh_.elements[element] = first;
    mesh_.elements.push_back(second);
    times_[element] = std::max(0, times_[element] - 1);
    times_.push_back(times_[element]);
    ancestors_.push_back(ancestors_[element]);
    auto& around = elementsAt_[index(b)];
    *std::find(around.begin(), around.end(), element) = other;
    elementsAt_[index(middle)].push_back(element);
    for (std::size_t i = 0; i < numCorners_; ++i)
      if (i != bt)
        elementsAt_[index(second.corners[i])].push_back(other);
    queue_.push_back(element);
    queue_.push_back(other);
  }

  SimplexMesh& mesh_;
  std::size_t numCorners_;
  std::vector<int> times_; ///< that are to come
  std::vector<LocalOrdinal> ancestors_;
  std::vector<std::vector<LocalOrdinal>> elementsAt_; ///< each node
  std::unordered_map<Edge, LocalOrdinal> middles_;    ///< of edges that are cut
  std::deque<LocalOrdinal> queue_;
};

} // namespace

std::vector<LocalOrdinal> bisect(SimplexMesh& mesh, std::vector<int> times) {
  return Bisection(mesh, std::move(times)).run();
}

} // namespace epafi::mesh
