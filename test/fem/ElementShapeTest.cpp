#include "epafi/fem/ElementShape.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace epafi::fem {
namespace {

TEST(ElementShapeTest, MeasuresAreExactAndChangeSignWithTheNumbering) {
  const std::vector<Point> triangle{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  EXPECT_DOUBLE_EQ(shapeOf(CellType::triangle, triangle).measure, 1);
  EXPECT_DOUBLE_EQ(shapeOf(CellType::triangle, triangle).diameter, std::sqrt(5.0));
  const std::vector<Point> trapezium{{0, 0, 0}, {4, 0, 0}, {3, 2, 0}, {1, 2, 0}};
  const ElementShape shape = shapeOf(CellType::quadrilateral, trapezium);
  EXPECT_DOUBLE_EQ(shape.measure, 6);
  EXPECT_DOUBLE_EQ(shape.leastJacobian, 4); // at the short side: 2 · 2
  const std::vector<Point> tetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 3}};
  EXPECT_DOUBLE_EQ(shapeOf(CellType::tetrahedron, tetrahedron).measure, 0.5);
  const std::vector<Point> mirrored{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 3}};
  EXPECT_DOUBLE_EQ(shapeOf(CellType::tetrahedron, mirrored).measure, -0.5);
}

TEST(ElementShapeTest, HexahedraMayBeFrusta) {
  std::vector<Point> frustum{{0, 0, 0},     {2, 0, 0},     {2, 2, 0},     {0, 2, 0},
                             {0.5, 0.5, 3}, {1.5, 0.5, 3}, {1.5, 1.5, 3}, {0.5, 1.5, 3}};
  const ElementShape shape = shapeOf(CellType::hexahedron, frustum);
  EXPECT_NEAR(shape.measure, 7, 1e-14); // h (A + √(A a) + a) / 3
  EXPECT_NEAR(shape.leastJacobian, 3, 1e-14);
  EXPECT_GE(shape.corner, 4);
  frustum[6] = {0.4, 0.4, 3}; // its top has a corner turned inwards
  EXPECT_EQ(shapeOf(CellType::hexahedron, frustum).corner, 6);
  EXPECT_LT(shapeOf(CellType::hexahedron, frustum).leastJacobian, 0);
}

} // namespace
} // namespace epafi::fem
