#include "epafi/mesh/MeshTopology.hpp"

#include "epafi/mesh/MeshArrays.hpp"

#include <algorithm>

namespace epafi::mesh {
namespace {

CellType typeOfRow(CellType largest, std::span<const LocalOrdinal> row) {
  return cellOf(largest, withoutFilling(row).size());
}

/// A facet in the bucket of its lowest corner: its other corners, ascending (those that it lacks: −1), and
/// its place among the facets of all elements.
struct BucketEntry {
  std::array<LocalOrdinal, mostFacetCorners - 1> others;
  std::uint32_t place;
};

/// Calls `visit(place, corners)` for every facet of every element; the corners ascend.
template <class Visit>
void forEachFacet(CellType largest, std::span<const LocalOrdinal> cells, const Visit& visit) {
  const std::size_t perElement = numNodesOf(largest);
  const auto most = static_cast<std::uint32_t>(facetsOf(largest).size());
  std::array<LocalOrdinal, mostFacetCorners> nodes{};
  std::uint32_t begin = 0;
  for (std::size_t first = 0; first < cells.size(); first += perElement, begin += most) {
    std::uint32_t number = begin;
    for (const Facet& facet : facetsOf(typeOfRow(largest, cells.subspan(first, perElement)))) {
      const std::size_t perFacet = numCornersOf(facet.type);
      for (std::size_t i = 0; i < perFacet; ++i) { // sorted by insertion
        const LocalOrdinal node = cells[first + facet[i]];
        std::size_t place = i;
        for (; place > 0 && nodes[place - 1] > node; --place)
          nodes[place] = nodes[place - 1];
        nodes[place] = node;
      }
      visit(number++, std::span<const LocalOrdinal>(nodes.data(), perFacet));
    }
  }
}

/// Turns counts, of which that of bucket n stands at n + 1, into the places where the buckets begin.
void accumulate(std::vector<std::size_t>& counts) {
  for (std::size_t i = 1; i < counts.size(); ++i)
    counts[i] += counts[i - 1];
}

} // namespace

MeshTopology::MeshTopology(CellType largest, LocalOrdinal numNodes, std::span<const LocalOrdinal> cells)
    : largest_(largest), facetsPerElement_(facetsOf(largest).size()) {
  findElementsOfNodes(numNodes, cells);
  pairFacets(numNodes, cells);
  markBoundary(cells);
}

std::span<const LocalOrdinal> MeshTopology::elementsOf(std::size_t node) const {
  return std::span(elements_).subspan(firstElement_[node], firstElement_[node + 1] - firstElement_[node]);
}

void MeshTopology::findElementsOfNodes(LocalOrdinal numNodes, std::span<const LocalOrdinal> cells) {
  firstElement_.assign(std::size_t{1} + numNodes, 0);
  const std::size_t perElement = numNodesOf(largest_);
  const auto isFilling = [&](std::size_t i) {
    return i > 0 && cells[i] == cells[i - 1] && i % perElement > 0;
  };
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (!isFilling(i))
      ++firstElement_[cells[i] + 1];
  accumulate(firstElement_);
  elements_.resize(firstElement_.back());
  std::vector<std::size_t> next(firstElement_.begin(), firstElement_.end() - 1);
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (!isFilling(i))
      elements_[next[cells[i]]++] = static_cast<LocalOrdinal>(i / perElement);
}

void MeshTopology::pairFacets(LocalOrdinal numNodes, std::span<const LocalOrdinal> cells) {
  // Buckets by lowest node: each holds a few dozen facets, whatever the mesh's size.
  std::vector<std::size_t> first(std::size_t{1} + numNodes, 0);
  forEachFacet(largest_, cells,
               [&](std::uint32_t, std::span<const LocalOrdinal> nodes) { ++first[nodes[0] + 1]; });
  accumulate(first);
  std::vector<BucketEntry> facets(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  forEachFacet(largest_, cells, [&](std::uint32_t place, std::span<const LocalOrdinal> nodes) {
    BucketEntry& facet = facets[next[nodes[0]]++];
    facet = {{-1, -1, -1}, place};
    std::copy(nodes.begin() + 1, nodes.end(), facet.others.begin());
  });

  across_.assign(cells.size() / numNodesOf(largest_) * facetsPerElement_, -1);
  const auto elementOf = [&](const BucketEntry& facet) {
    return static_cast<LocalOrdinal>(facet.place / facetsPerElement_);
  };
  const auto at = [&](std::size_t i) { return facets.begin() + i; };
  for (std::size_t node = 0; node + 1 < first.size(); ++node) {
    const auto end = at(first[node + 1]);
    std::sort(at(first[node]), end, [](const BucketEntry& a, const BucketEntry& b) {
      return a.others != b.others ? a.others < b.others : a.place < b.place;
    });
    for (auto facet = at(first[node]); facet != end;) {
      const auto other = std::find_if(
          facet, end, [&](const BucketEntry& candidate) { return candidate.others != facet->others; });
      if (other - facet == 2) {
        across_[facet[0].place] = elementOf(facet[1]);
        across_[facet[1].place] = elementOf(facet[0]);
      } else if (other - facet > 2 && !crowdedFacet_) {
        crowdedFacet_ = {elementOf(facet[0]), elementOf(facet[1]), elementOf(facet[2])};
      }
      facet = other;
    }
  }
}

void MeshTopology::markBoundary(std::span<const LocalOrdinal> cells) {
  isOnBoundary_.assign(firstElement_.size() - 1, 0);
  const std::size_t perElement = numNodesOf(largest_);
  for (std::size_t e = 0; e * perElement < cells.size(); ++e) {
    const auto row = cells.subspan(e * perElement, perElement);
    const auto facets = facetsOf(typeOfRow(largest_, row));
    for (std::size_t f = 0; f < facets.size(); ++f)
      if (across(e, f) < 0)
        for (const int node : facets[f])
          isOnBoundary_[row[node]] = 1;
  }
}

} // namespace epafi::mesh
