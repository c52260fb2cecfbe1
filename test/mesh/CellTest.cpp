#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace epafi::mesh {
namespace {

using namespace test;

TEST(CellTest, FacetsLookOutwards) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    std::vector<Eigen::Vector3d> points;
    for (const Point& point : unitCell(type))
      points.push_back(vectorOf(point));
    ASSERT_EQ(points.size(), static_cast<std::size_t>(numNodesOf(type)));
    points.resize(numCornersOf(type));
    Eigen::Vector3d centre(0, 0, 0);
    for (const auto& point : points)
      centre += point / static_cast<double>(points.size());
    for (const auto& facet : facetsOf(type)) {
      const auto at = [&](std::size_t i) { return points[facet[i]]; };
      const Eigen::Vector3d along = at(1) - at(0);
      const Eigen::Vector3d normal = dimensionOf(type) == 2 ? Eigen::Vector3d(along[1], -along[0], 0)
                                                            : along.cross(at(2) - at(0)).eval();
      EXPECT_GT(normal.dot(at(0) - centre), 0);
    }
  }
}

/// Each edge between facets is run through once in both directions: the boundary is closed.
TEST(CellTest, FacetsCloseTheBoundary) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    const std::size_t n = numNodesOf(type);
    std::vector<int> balance(n * n, 0);
    for (const auto& facet : facetsOf(type)) {
      const int corners = numCornersOf(facet.type);
      if (dimensionOf(type) == 2) {
        balance[facet[0]] += 1; // ends of edges
        balance[facet[1]] -= 1;
        continue;
      }
      for (int i = 0; i < corners; ++i) {
        const auto a = static_cast<std::size_t>(facet[i]),
                   b = static_cast<std::size_t>(facet[(i + 1) % corners]);
        balance[a * n + b] += 1;
        balance[b * n + a] -= 1;
      }
    }
    for (const int value : balance)
      EXPECT_EQ(value, 0);
  }
}

/// The nodes between corners lie in the middle of the unit cell's edges and faces, in the facets as in the
/// cell.
TEST(CellTest, NodesOfOrderTwoLieBetweenTheCorners) {
  for (const CellType linear : linearCellTypes) {
    const CellType type = withOrder(linear, 2);
    SCOPED_TRACE(toString(type));
    EXPECT_EQ(withOrder(type, 1), linear);
    EXPECT_EQ(orderOf(type), 2);
    EXPECT_EQ(numCornersOf(type), numNodesOf(linear));
    const std::vector<Point> points = unitCell(type);
    const auto at = [&](int node) { return vectorOf(points[node]); };
    const auto edges = edgesOf(type);
    for (std::size_t e = 0; 2 * e < edges.size(); ++e)
      EXPECT_EQ(at(numCornersOf(type) + static_cast<int>(e)),
                0.5 * (at(edges[2 * e]) + at(edges[2 * e + 1])));
    for (std::size_t f = 0; f < facetsOf(type).size(); ++f) {
      const Facet& facet = facetsOf(type)[f];
      const std::size_t corners = numCornersOf(facet.type);
      for (std::size_t i = 0; i < corners; ++i)
        EXPECT_EQ(facet[i], facetsOf(linear)[f][i]);
      const auto between = edgesOf(facet.type);
      for (std::size_t e = 0; 2 * e < between.size(); ++e)
        EXPECT_EQ(at(facet[corners + e]), 0.5 * (at(facet[between[2 * e]]) + at(facet[between[2 * e + 1]])));
      if (facet.type == CellType::quadrilateral9) {
        EXPECT_EQ(at(facet[8]), 0.25 * (at(facet[0]) + at(facet[1]) + at(facet[2]) + at(facet[3])));
      }
    }
  }
}

} // namespace
} // namespace epafi::mesh
