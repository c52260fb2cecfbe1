#include "epafi/mesh/ElementGeometry.hpp"

#include "support/SampleCells.hpp"

#include "epafi/mesh/ElementMap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace epafi::mesh {
namespace {

using namespace test;

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

TEST(ElementShapeTest, JacobiansOfInvertedElementsAreNegative) {
  for (const CellType type : allCellTypes) {
    const std::vector<Point> good = distortedCell(type, 4);
    EXPECT_GT(shapeOf(type, good).leastJacobian, 0) << toString(type);
    EXPECT_LT(shapeOf(type, inverted(type, good)).leastJacobian, 0) << toString(type);
  }
}

TEST(ElementShapeTest, OneReentrantCornerIsFound) {
  const std::vector<Point> dart{{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}; // of positive area
  EXPECT_GT(shapeOf(CellType::quadrilateral, dart).measure, 0);
  EXPECT_NEAR(shapeOf(CellType::quadrilateral, dart).leastJacobian, 0.2 * 0.2 - 0.8 * 0.8, 1e-15);
  EXPECT_EQ(shapeOf(CellType::quadrilateral, dart).corner, 2);
  std::vector<Point> pushed = unitCell(CellType::hexahedron);
  pushed[6] = {0.3, 0.3, 0.3};
  EXPECT_GT(shapeOf(CellType::hexahedron, pushed).measure, 0);
  EXPECT_LT(shapeOf(CellType::hexahedron, pushed).leastJacobian, 0);
}

TEST(ElementShapeTest, FlatAndCollapsedElementsHaveNoJacobian) {
  for (const CellType type : allCellTypes) {
    const std::vector<Point> flat = mapped(unitCell(type), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return dimensionOf(type) == 2 ? Eigen::Vector3d(x[0], 0, 0) : Eigen::Vector3d(x[0], x[1], 0);
    });
    std::vector<Point> collapsed = unitCell(withOrder(type, 1));
    collapsed[1] = collapsed[0];
    collapsed = withAllNodes(type, collapsed);
    for (const std::vector<Point>& points : {flat, collapsed, std::vector<Point>(flat.size(), {1, 2, 3})})
      EXPECT_NEAR(shapeOf(type, points).leastJacobian, 0, 1e-15) << toString(type);
  }
}

/// The least of many values of det ∂x/∂ξ, times the measure of the reference element.
template <int dim>
double leastSampled(const Shape<dim>& shape, const std::vector<Point>& points) {
  constexpr int n = 12;
  const auto corners = relativeCorners<dim>(points);
  double least = std::numeric_limits<double>::infinity();
  for (int code = 0; code < power(n + 1, dim); ++code) {
    Coordinates<dim> xi;
    for (int i = 0, rest = code; i < dim; ++i, rest /= n + 1)
      xi[i] = (rest % (n + 1)) / static_cast<double>(n);
    if (shape.isSimplex && xi.sum() > 1)
      continue;
    if (!shape.isSimplex && numCornersOf(shape.type) == 6 && xi[0] + xi[1] > 1)
      continue;
    if (shape.isBrick) {
      xi = 2 * xi - Coordinates<dim>::Ones();
    } else if (numCornersOf(shape.type) == 6) {
      xi[dim - 1] = 2 * xi[dim - 1] - 1;
    } else if (!shape.isSimplex) { // a pyramid; its top depends on where one comes from
      const double r = std::max(1 - xi[dim - 1], 0x1p-20);
      xi = r * (2 * xi - Coordinates<dim>::Ones());
      xi[dim - 1] = 1 - r;
    }
    least = std::min(least, shape.measure * ElementMap<dim>(corners, shape.sampleAt(xi)).determinant());
  }
  return least;
}

/// A bound from below on the whole element, and no bound so poor that sound elements would be refused.
TEST(ElementShapeTest, TheJacobianOfCurvedElementsIsBoundedEverywhere) {
  int folded = 0, sound = 0;
  for (const CellType type : allCellTypes)
    for (std::uint32_t seed = 0; seed < 40 && orderOf(type) == 2; ++seed) {
      SignedRandomNumbers random(seed);
      const auto points = mapped(distortedCell(type, seed), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
        return x + 0.004 * seed * random.vector();
      });
      const double least = withShape(type, [&](const auto& shape) { return leastSampled(shape, points); });
      const double bound = shapeOf(type, points).leastJacobian;
      const double scale = std::abs(shapeOf(type, points).measure);
      if (least > 0) {
        EXPECT_LE(bound, least + 1e-12 * scale) << toString(type) << seed;
      }
      EXPECT_EQ(bound > 0, least > 0) << toString(type) << seed << ' ' << least;
      (least > 0 ? sound : folded) += 1;
    }
  EXPECT_GT(sound, 30);
  EXPECT_GT(folded, 15);
}

/// Corners, nodes and Gauss points are fine; between them the edge turns back.
TEST(ElementShapeTest, FoldsBetweenTheNodesAreFound) {
  std::vector<Point> triangle = unitCell(CellType::triangle6);
  triangle[3] = {0.5, 0.53, 0};
  EXPECT_GT(shapeOf(CellType::triangle6, triangle).measure, 0);
  EXPECT_LT(shapeOf(CellType::triangle6, triangle).leastJacobian, 0);
}

} // namespace
} // namespace epafi::mesh
