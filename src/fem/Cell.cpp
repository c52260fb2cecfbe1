#include "epafi/fem/Cell.hpp"

#include <array>
#include <cassert>

namespace epafi::fem {
namespace {

/// Facets of one type, their nodes one after the other.
template <CellType type, std::size_t nodes, std::size_t number>
constexpr std::array<Facet, number> facetsIn(const std::array<int, nodes * number>& places) {
  std::array<Facet, number> facets{};
  for (std::size_t f = 0; f < number; ++f)
    facets[f] = {type, std::span(places).subspan(f * nodes, nodes)};
  return facets;
}

constexpr std::array<int, 6> ofTriangle{0, 1, 1, 2, 2, 0};
constexpr std::array<int, 8> ofQuadrilateral{0, 1, 1, 2, 2, 3, 3, 0};
constexpr std::array<int, 12> ofTetrahedron{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
constexpr std::array<int, 24> ofHexahedron{0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                           1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
constexpr auto triangleFacets = facetsIn<CellType::line, 2, 3>(ofTriangle);
constexpr auto quadrilateralFacets = facetsIn<CellType::line, 2, 4>(ofQuadrilateral);
constexpr auto tetrahedronFacets = facetsIn<CellType::triangle, 3, 4>(ofTetrahedron);
constexpr auto hexahedronFacets = facetsIn<CellType::quadrilateral, 4, 6>(ofHexahedron);

/// What is to be known of a type, for order 1.
struct Entry {
  const char* name;
  int dimension, numNodes;
  std::span<const Facet> facets;
};

/// In the order of CellType.
constexpr std::array<Entry, 5> table{{{"triangle", 2, 3, triangleFacets},
                                      {"quadrilateral", 2, 4, quadrilateralFacets},
                                      {"tetrahedron", 3, 4, tetrahedronFacets},
                                      {"hexahedron", 3, 8, hexahedronFacets},
                                      {"line", 1, 2, {}}}};

const Entry& entryOf(CellType type, [[maybe_unused]] int order = 1) {
  assert(order == 1);
  return table[static_cast<std::size_t>(type)];
}

} // namespace

int dimensionOf(CellType type) {
  return entryOf(type).dimension;
}

int numNodesOf(CellType type, int order) {
  return entryOf(type, order).numNodes;
}

std::span<const Facet> facetsOf(CellType type, int order) {
  return entryOf(type, order).facets;
}

CellType facetTypeOf(CellType type) {
  return entryOf(type).facets.front().type;
}

int nodesPerFacet(CellType type, int order) {
  return static_cast<int>(entryOf(type, order).facets.front().size());
}

const char* toString(CellType type) {
  return entryOf(type).name;
}

} // namespace epafi::fem
