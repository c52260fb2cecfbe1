#include "epafi/mesh/Cell.hpp"

#include <algorithm>
#include <array>

namespace epafi::mesh {
namespace {

/// Facets of one type, their nodes one after the other.
template <CellType type, std::size_t nodes, std::size_t total>
constexpr std::array<Facet, total / nodes> facetsIn(const std::array<int, total>& places) {
  std::array<Facet, total / nodes> facets{};
  for (std::size_t f = 0; f < facets.size(); ++f)
    facets[f] = {type, std::span(places).subspan(f * nodes, nodes)};
  return facets;
}

/// Facets of two types, the larger ones last.
template <std::size_t smaller, std::size_t larger>
constexpr std::array<Facet, smaller + larger> joined(const std::array<Facet, smaller>& first,
                                                     const std::array<Facet, larger>& second) {
  std::array<Facet, smaller + larger> facets{};
  for (std::size_t f = 0; f < facets.size(); ++f)
    facets[f] = f < smaller ? first[f] : second[f - smaller];
  return facets;
}

/// Where the node on an edge is among the nodes of a cell.
template <std::size_t total>
constexpr int nodeBetween(int a, int b, const std::array<int, total>& edges, int corners) {
  for (int e = 0; 2 * e < std::ssize(edges); ++e)
    if ((edges[2 * e] == a && edges[2 * e + 1] == b) || (edges[2 * e] == b && edges[2 * e + 1] == a))
      return corners + e;
  return -1;
}

/// The facets of a cell of order 2: corners, nodes between them, and `centres` of faces with four corners.
template <std::size_t nodes, std::size_t corners, std::size_t total, std::size_t pairs>
constexpr std::array<int, total / corners * nodes>
withMiddles(const std::array<int, total>& linear, const std::array<int, pairs>& edges, int cornersOfCell,
            const std::array<int, total / corners>& centres) {
  constexpr std::size_t middles = corners == 2 ? 1 : corners;
  std::array<int, total / corners * nodes> places{};
  for (std::size_t f = 0; f < centres.size(); ++f) {
    for (std::size_t i = 0; i < corners; ++i)
      places[f * nodes + i] = linear[f * corners + i];
    for (std::size_t i = 0; i < middles; ++i)
      places[f * nodes + corners + i] =
          nodeBetween(linear[f * corners + i], linear[f * corners + (i + 1) % corners], edges, cornersOfCell);
    if (corners + middles < nodes)
      places[(f + 1) * nodes - 1] = centres[f];
  }
  return places;
}

constexpr std::array<int, 2> lineEdges{0, 1};
constexpr std::array<int, 6> triangleEdges{0, 1, 1, 2, 2, 0};
constexpr std::array<int, 8> quadrilateralEdges{0, 1, 1, 2, 2, 3, 3, 0};
constexpr std::array<int, 12> tetrahedronEdges{0, 1, 1, 2, 2, 0, 0, 3, 1, 3, 2, 3};
constexpr std::array<int, 16> pyramidEdges{0, 1, 1, 2, 2, 3, 3, 0, 0, 4, 1, 4, 2, 4, 3, 4};
constexpr std::array<int, 18> prismEdges{0, 1, 1, 2, 2, 0, 3, 4, 4, 5, 5, 3, 0, 3, 1, 4, 2, 5};
constexpr std::array<int, 24> hexahedronEdges{0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6,
                                              6, 7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7};

constexpr std::array<int, 12> ofTetrahedron{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
constexpr std::array<int, 12> trianglesOfPyramid{0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
constexpr std::array<int, 4> baseOfPyramid{0, 3, 2, 1};
constexpr std::array<int, 6> trianglesOfPrism{0, 2, 1, 3, 4, 5};
constexpr std::array<int, 12> sidesOfPrism{0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
constexpr std::array<int, 24> ofHexahedron{0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                           1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
constexpr auto ofTriangle6 = withMiddles<3, 2>(triangleEdges, triangleEdges, 3, {});
constexpr auto ofQuadrilateral9 = withMiddles<3, 2>(quadrilateralEdges, quadrilateralEdges, 4, {});
constexpr auto ofTetrahedron10 = withMiddles<6, 3>(ofTetrahedron, tetrahedronEdges, 4, {});
constexpr auto ofHexahedron27 = withMiddles<9, 4>(ofHexahedron, hexahedronEdges, 8, {24, 25, 22, 21, 23, 20});
constexpr auto ofHexahedron20 = withMiddles<8, 4>(ofHexahedron, hexahedronEdges, 8, {});
constexpr auto trianglesOfPyramid13 = withMiddles<6, 3>(trianglesOfPyramid, pyramidEdges, 5, {});
constexpr auto baseOfPyramid13 = withMiddles<8, 4>(baseOfPyramid, pyramidEdges, 5, {});
constexpr auto trianglesOfPrism15 = withMiddles<6, 3>(trianglesOfPrism, prismEdges, 6, {});
constexpr auto sidesOfPrism15 = withMiddles<8, 4>(sidesOfPrism, prismEdges, 6, {});

constexpr auto triangleFacets = facetsIn<CellType::line, 2>(triangleEdges);
constexpr auto quadrilateralFacets = facetsIn<CellType::line, 2>(quadrilateralEdges);
constexpr auto tetrahedronFacets = facetsIn<CellType::triangle, 3>(ofTetrahedron);
constexpr auto hexahedronFacets = facetsIn<CellType::quadrilateral, 4>(ofHexahedron);
constexpr auto pyramidFacets = joined(facetsIn<CellType::triangle, 3>(trianglesOfPyramid),
                                      facetsIn<CellType::quadrilateral, 4>(baseOfPyramid));
constexpr auto prismFacets = joined(facetsIn<CellType::triangle, 3>(trianglesOfPrism),
                                    facetsIn<CellType::quadrilateral, 4>(sidesOfPrism));
constexpr auto triangle6Facets = facetsIn<CellType::line3, 3>(ofTriangle6);
constexpr auto quadrilateral9Facets = facetsIn<CellType::line3, 3>(ofQuadrilateral9);
constexpr auto tetrahedron10Facets = facetsIn<CellType::triangle6, 6>(ofTetrahedron10);
constexpr auto hexahedron27Facets = facetsIn<CellType::quadrilateral9, 9>(ofHexahedron27);
constexpr auto hexahedron20Facets = facetsIn<CellType::quadrilateral8, 8>(ofHexahedron20);
constexpr auto pyramid13Facets = joined(facetsIn<CellType::triangle6, 6>(trianglesOfPyramid13),
                                        facetsIn<CellType::quadrilateral8, 8>(baseOfPyramid13));
constexpr auto prism15Facets = joined(facetsIn<CellType::triangle6, 6>(trianglesOfPrism15),
                                      facetsIn<CellType::quadrilateral8, 8>(sidesOfPrism15));

/// What is to be known of a type.
struct Entry {
  const char* name;
  int dimension, order, numNodes, numCorners;
  std::span<const Facet> facets; ///< the largest last
  std::span<const int> edges;
};

constexpr int numShapes = 7, numSerendipity = 2;
/// In the order of CellType.
constexpr std::array<Entry, std::size_t{2} * numShapes + numSerendipity> table{
    {{"triangle", 2, 1, 3, 3, triangleFacets, triangleEdges},
     {"quadrilateral", 2, 1, 4, 4, quadrilateralFacets, quadrilateralEdges},
     {"tetrahedron", 3, 1, 4, 4, tetrahedronFacets, tetrahedronEdges},
     {"pyramid", 3, 1, 5, 5, pyramidFacets, pyramidEdges},
     {"prism", 3, 1, 6, 6, prismFacets, prismEdges},
     {"hexahedron", 3, 1, 8, 8, hexahedronFacets, hexahedronEdges},
     {"line", 1, 1, 2, 2, {}, lineEdges},
     {"quadratic triangle", 2, 2, 6, 3, triangle6Facets, triangleEdges},
     {"quadratic quadrilateral", 2, 2, 9, 4, quadrilateral9Facets, quadrilateralEdges},
     {"quadratic tetrahedron", 3, 2, 10, 4, tetrahedron10Facets, tetrahedronEdges},
     {"quadratic pyramid", 3, 2, 13, 5, pyramid13Facets, pyramidEdges},
     {"quadratic prism", 3, 2, 15, 6, prism15Facets, prismEdges},
     {"quadratic hexahedron", 3, 2, 27, 8, hexahedron27Facets, hexahedronEdges},
     {"quadratic line", 1, 2, 3, 2, {}, lineEdges},
     {"serendipity quadrilateral", 2, 2, 8, 4, quadrilateral9Facets, quadrilateralEdges},
     {"serendipity hexahedron", 3, 2, 20, 8, hexahedron20Facets, hexahedronEdges}}};

const Entry& entryOf(CellType type) {
  return table[static_cast<std::size_t>(type)];
}

} // namespace

int dimensionOf(CellType type) {
  return entryOf(type).dimension;
}

int orderOf(CellType type) {
  return entryOf(type).order;
}

int numNodesOf(CellType type) {
  return entryOf(type).numNodes;
}

int numCornersOf(CellType type) {
  return entryOf(type).numCorners;
}

CellType withOrder(CellType type, int order) {
  if (isSerendipity(type) && order == 2)
    return type;
  return static_cast<CellType>(static_cast<int>(withInnerNodes(type)) % numShapes + (order - 1) * numShapes);
}

bool isSerendipity(CellType type) {
  return type == CellType::quadrilateral8 || type == CellType::hexahedron20;
}

bool hasReducedRule(CellType type) {
  return isSerendipity(type) || type == CellType::prism || type == CellType::prism15;
}

CellType withInnerNodes(CellType type) {
  return type == CellType::quadrilateral8 ? CellType::quadrilateral9
         : type == CellType::hexahedron20 ? CellType::hexahedron27
                                          : type;
}

CellType withoutInnerNodes(CellType type) {
  return type == CellType::quadrilateral9 ? CellType::quadrilateral8
         : type == CellType::hexahedron27 ? CellType::hexahedron20
                                          : type;
}

std::span<const Facet> facetsOf(CellType type) {
  return entryOf(type).facets;
}

CellType facetTypeOf(CellType type) {
  return entryOf(type).facets.back().type;
}

int nodesPerFacet(CellType type) {
  return static_cast<int>(entryOf(type).facets.back().size());
}

std::span<const int> edgesOf(CellType type) {
  return entryOf(type).edges;
}

CellType cellOf(CellType largest, std::size_t numNodes) {
  const Entry& own = entryOf(largest);
  if (numNodes == static_cast<std::size_t>(own.numNodes) || largest == CellType::hexahedron27)
    return largest;
  const auto found = std::find_if(table.begin(), table.end(), [&](const Entry& entry) {
    return entry.dimension == own.dimension && entry.order == own.order &&
           static_cast<std::size_t>(entry.numNodes) == numNodes && entry.numCorners < own.numCorners;
  });
  return found == table.end() ? largest : static_cast<CellType>(found - table.begin());
}

const char* toString(CellType type) {
  return entryOf(type).name;
}

} // namespace epafi::mesh
