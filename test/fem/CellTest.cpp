#include "SampleCells.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace epafi::fem {
namespace {

TEST(CellTest, FacetsLookOutwards) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    std::vector<Eigen::Vector3d> points;
    for (const Point& point : unitCell(type))
      points.push_back(vectorOf(point));
    ASSERT_EQ(points.size(), static_cast<std::size_t>(numNodesOf(type)));
    Eigen::Vector3d centre(0, 0, 0);
    for (const auto& point : points)
      centre += point / static_cast<double>(points.size());
    for (const auto& facet : facetsOf(type)) {
      const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(facet[i])]; };
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
    const auto n = static_cast<std::size_t>(numNodesOf(type));
    std::vector<int> balance(n * n, 0);
    for (const auto& facet : facetsOf(type)) {
      const int corners = nodesPerFacet(type);
      if (dimensionOf(type) == 2) {
        balance[static_cast<std::size_t>(facet[0])] += 1; // ends of edges
        balance[static_cast<std::size_t>(facet[1])] -= 1;
        continue;
      }
      for (int i = 0; i < corners; ++i) {
        const auto a = static_cast<std::size_t>(facet[static_cast<std::size_t>(i)]),
                   b = static_cast<std::size_t>(facet[static_cast<std::size_t>((i + 1) % corners)]);
        balance[a * n + b] += 1;
        balance[b * n + a] -= 1;
      }
    }
    for (const int value : balance)
      EXPECT_EQ(value, 0);
  }
}

} // namespace
} // namespace epafi::fem
