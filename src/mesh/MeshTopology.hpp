#pragma once

/// Which elements touch a node, and which element lies across a facet. Made in O(n) from the elements' nodes;
/// one million hexahedra take about 70 MB, and 100 MB more while it is made.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Cell.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace epafi::mesh {

class MeshTopology {
public:
  /// Three of the elements that share one facet, ascending.
  using Crowd = std::array<LocalOrdinal, 3>;

  /// \param largest  type of the largest elements
  /// \param cells nodes of the elements, in rows (Cell.hpp) of numNodesOf(largest) each, all in [0,
  /// numNodes).
  MeshTopology(CellType largest, LocalOrdinal numNodes, std::span<const LocalOrdinal> cells);

  /// Elements that touch a node, ascending.
  [[nodiscard]] std::span<const LocalOrdinal> elementsOf(std::size_t node) const;
  /// The element across the facet facetsOf(its type)[facet]; −1: none, the facet lies on the boundary.
  [[nodiscard]] LocalOrdinal across(std::size_t element, std::size_t facet) const {
    return across_[element * facetsPerElement_ + facet];
  }
  /// Whether a node belongs to a facet on the boundary.
  [[nodiscard]] bool isOnBoundary(std::size_t node) const { return isOnBoundary_[node] != 0; }
  /// One facet that more than two elements share, if there is any: then across() is not to be used.
  [[nodiscard]] const std::optional<Crowd>& crowdedFacet() const { return crowdedFacet_; }

private:
  void findElementsOfNodes(LocalOrdinal numNodes, std::span<const LocalOrdinal> cells);
  void pairFacets(LocalOrdinal numNodes, std::span<const LocalOrdinal> cells);
  void markBoundary(std::span<const LocalOrdinal> cells);

  CellType largest_;
  std::size_t facetsPerElement_;          ///< of the largest
  std::vector<std::size_t> firstElement_; ///< of each node in elements_, and the end
  std::vector<LocalOrdinal> elements_;
  std::vector<LocalOrdinal> across_; ///< facets of an element one after the other, −1 behind them
  std::vector<std::uint8_t> isOnBoundary_;
  std::optional<Crowd> crowdedFacet_;
};

} // namespace epafi::mesh
