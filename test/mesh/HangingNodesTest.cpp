#include "epafi/mesh/HangingNodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace epafi::mesh {
namespace {

TEST(HangingNodesTest, DistancesFromEdgesTrianglesAndWarpedPatches) {
  const std::vector<Point> edge{{1, 1, 0}, {4, 5, 0}};
  EXPECT_NEAR(distanceFrom(CellType::line, edge, {2.5, 3, 0}), 0, 1e-15);
  EXPECT_NEAR(distanceFrom(CellType::line, edge, {2.5 - 0.4, 3 + 0.3, 0}), 0.5, 1e-15);
  EXPECT_NEAR(distanceFrom(CellType::line, edge, {4 + 3, 5 + 4, 0}), 5, 1e-14); // beyond its end
  const std::vector<Point> triangle{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  EXPECT_NEAR(distanceFrom(CellType::triangle, triangle, {0.5, 0.5, 1}), 0, 1e-15);
  EXPECT_NEAR(distanceFrom(CellType::triangle, triangle, {0.8, 0.8, 1}), 0.3 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(distanceFrom(CellType::triangle, triangle, {0.2, 0.2, 1.25}), 0.25, 1e-15);
  const std::vector<Point> warped{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}; // z = x y
  EXPECT_NEAR(distanceFrom(CellType::quadrilateral, warped, {0.3, 0.9, 0.27}), 0, 1e-12);
  EXPECT_GT(distanceFrom(CellType::quadrilateral, warped, {0.3, 0.9, 0.3}), 0.01);
}

TEST(BoxTreeTest, OfPointsFindsWhatASearchOfAllFinds) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> digit(0, 9); // many equal coordinates
  std::vector<Point> points(1000);
  for (Point& point : points)
    point = {0.1 * digit(random), 1.0 * digit(random), digit(random) < 5 ? 0.0 : 1.0};
  const BoxTree tree(points);
  std::vector<std::size_t> found;
  for (int k = 0; k < 100; ++k) {
    const Point lower{0.1 * digit(random), 1.0 * digit(random), 0};
    const Point upper{lower[0] + 0.1, lower[1] + 3, k % 2 == 0 ? 0.5 : 1.0};
    tree.meeting({lower, upper}, found);
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      bool isInside = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
        isInside = isInside && points[i][axis] >= lower[axis] && points[i][axis] <= upper[axis];
      if (isInside)
        expected.push_back(i);
    }
    EXPECT_EQ(found, expected);
  }
  std::uniform_real_distribution<double> place(-2, 12);
  for (int k = 0; k < 200; ++k) {
    const Point x = k % 4 == 0 ? points[k] : Point{place(random), place(random), place(random)};
    const auto squared = [&](const Point& point) {
      return std::pow(point[0] - x[0], 2) + std::pow(point[1] - x[1], 2) + std::pow(point[2] - x[2], 2);
    };
    const auto nearest = std::min_element(points.begin(), points.end(), [&](const Point& a, const Point& b) {
      return squared(a) < squared(b);
    });
    tree.nearest(x, 1, found);
    EXPECT_DOUBLE_EQ(squared(points[found.at(0)]), squared(*nearest));
  }
  BoxTree(std::span<const Point>{}).meeting({{{0, 0, 0}, {1, 1, 1}}}, found);
  EXPECT_TRUE(found.empty());
}

} // namespace
} // namespace epafi::mesh
