#include "epafi/fem/Cell.hpp"

namespace epafi::fem {
namespace {

using Facet = std::array<int, 4>;

constexpr std::array<Facet, 3> triangleFacets{{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}};
constexpr std::array<Facet, 4> quadrilateralFacets{
    {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}};
constexpr std::array<Facet, 4> tetrahedronFacets{
    {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}}};
constexpr std::array<Facet, 6> hexahedronFacets{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

} // namespace

int dimensionOf(CellType type) {
  return type == CellType::triangle || type == CellType::quadrilateral ? 2 : 3;
}

int numNodesOf(CellType type) {
  switch (type) {
  case CellType::triangle:
    return 3;
  case CellType::quadrilateral:
  case CellType::tetrahedron:
    return 4;
  case CellType::hexahedron:
    return 8;
  }
  return 0;
}

int nodesPerFacet(CellType type) {
  if (dimensionOf(type) == 2)
    return 2;
  return type == CellType::tetrahedron ? 3 : 4;
}

std::span<const std::array<int, 4>> facetsOf(CellType type) {
  switch (type) {
  case CellType::triangle:
    return triangleFacets;
  case CellType::quadrilateral:
    return quadrilateralFacets;
  case CellType::tetrahedron:
    return tetrahedronFacets;
  case CellType::hexahedron:
    return hexahedronFacets;
  }
  return {};
}

const char* toString(CellType type) {
  switch (type) {
  case CellType::triangle:
    return "triangle";
  case CellType::quadrilateral:
    return "quadrilateral";
  case CellType::tetrahedron:
    return "tetrahedron";
  case CellType::hexahedron:
    return "hexahedron";
  }
  return "";
}

} // namespace epafi::fem
