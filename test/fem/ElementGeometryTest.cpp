#include "epafi/fem/ElementGeometry.hpp"

#include "SampleCells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace epafi::fem {
namespace {

using Points = std::vector<Point>;

/// The cell inside out: two neighbouring nodes exchanged, or below and above.
Points inverted(CellType type, Points points) {
  if (type == CellType::hexahedron)
    std::swap_ranges(points.begin(), points.begin() + 4, points.begin() + 4);
  else if (type == CellType::quadrilateral)
    std::reverse(points.begin(), points.end());
  else
    std::swap(points[0], points[1]);
  return points;
}

TEST(ElementGeometryTest, MeasuresOfUnitCellsAreTheKnownOnes) {
  const double expected[] = {0.5, 1, 1.0 / 6, 1};
  for (std::size_t i = 0; i < allCellTypes.size(); ++i) {
    const CellType type = allCellTypes[i];
    EXPECT_NEAR(measureOf(type, unitCell(type)), expected[i], 1e-15) << toString(type);
    EXPECT_NEAR(measureOf(type, inverted(type, unitCell(type))), -expected[i], 1e-15) << toString(type);
  }
}

/// Gauss's theorem: ∮x·n = dimension · measure; ∮n = 0.
TEST(ElementGeometryTest, BoundaryEnclosesTheMeasure) {
  for (const CellType type : allCellTypes) {
    SCOPED_TRACE(toString(type));
    const Points points = planeFacedCell(type);
    double flux = 0, surface = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& facet : facetsOf(type)) {
      const Points corners = facetPoints(type, points, facet);
      const Eigen::Vector3d area = areaVector(corners);
      flux += area.dot(vectorOf(corners[0])); // the same all over a plane face
      sum += area;
      surface += facetMeasure(corners);
      EXPECT_NEAR(area.norm(), facetMeasure(corners), 1e-14);
    }
    EXPECT_NEAR(flux, dimensionOf(type) * measureOf(type, points), 1e-14);
    EXPECT_LT(sum.norm(), 1e-14 * surface);
  }
}

TEST(ElementGeometryTest, AreaVectorsCloseTheBoundaryEvenIfFacesAreWarped) {
  for (const CellType type : allCellTypes) {
    const Points points = distortedCell(type, 2);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& facet : facetsOf(type))
      sum += areaVector(facetPoints(type, points, facet));
    EXPECT_LT(sum.norm(), 1e-14) << toString(type);
  }
}

TEST(ElementGeometryTest, FacetsOfTheUnitCubeHaveTheirNormals) {
  const Points cube = unitCell(CellType::hexahedron);
  const auto facets = facetsOf(CellType::hexahedron);
  EXPECT_EQ(areaVector(facetPoints(CellType::hexahedron, cube, facets[0])), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(areaVector(facetPoints(CellType::hexahedron, cube, facets[1])), Eigen::Vector3d(0, 0, 1));
  const Points edge{{0, 0, 5}, {2, 0, -7}}; // an edge below its element; z does not matter
  EXPECT_EQ(areaVector(edge), Eigen::Vector3d(0, -2, 0));
  EXPECT_EQ(facetMeasure(edge), 2);
}

TEST(ElementGeometryTest, CentreIsTheMeanOfTheCorners) {
  const Points hexahedron = unitCell(CellType::hexahedron), triangle{{0, 0, 0}, {3, 0, 0}, {0, 6, 0}};
  EXPECT_EQ(centreOf(hexahedron), (Point{0.5, 0.5, 0.5}));
  EXPECT_EQ(centreOf(triangle), (Point{1, 2, 0}));
}

TEST(ElementGeometryTest, ScaledJacobianIsOneForTheBestForms) {
  const double h = std::sqrt(3.0) / 2;
  const Points triangle{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}};
  const Points tetrahedron{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(scaledJacobian(CellType::triangle, triangle), 1, 1e-15);
  EXPECT_NEAR(std::abs(scaledJacobian(CellType::tetrahedron, tetrahedron)), 1, 1e-15);
  for (const CellType type : {CellType::quadrilateral, CellType::hexahedron}) {
    const Points box = mapped(unitCell(type), [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return {1e-3 * x[0], 50 * x[1], 3 * x[2]};
    });
    EXPECT_NEAR(scaledJacobian(type, box), 1, 1e-14);
  }
}

TEST(ElementGeometryTest, ScaledJacobianKnowsNeitherUnitsNorPlace) {
  for (const CellType type : allCellTypes) {
    const Points points = distortedCell(type, 3);
    const double here = scaledJacobian(type, points);
    EXPECT_GT(here, 0.1) << toString(type);
    EXPECT_LT(here, 1) << toString(type);
    const Eigen::Matrix3d turn = rotation(type, 1);
    const Points there = mapped(points, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return 1e-6 * turn * x + Eigen::Vector3d(1e-3, 2e-3, 0);
    });
    EXPECT_NEAR(scaledJacobian(type, there), here, 1e-10) << toString(type);
  }
}

TEST(ElementGeometryTest, JacobiansOfInvertedElementsAreNegative) {
  for (const CellType type : allCellTypes) {
    const Points good = distortedCell(type, 4), bad = inverted(type, good);
    EXPECT_GT(smallestJacobian(type, good), 0) << toString(type);
    EXPECT_LT(smallestJacobian(type, bad), 0) << toString(type);
    EXPECT_LT(scaledJacobian(type, bad), 0) << toString(type);
  }
}

TEST(ElementGeometryTest, OneReentrantCornerIsFound) {
  const Points dart{{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}; // of positive area
  EXPECT_GT(measureOf(CellType::quadrilateral, dart), 0);
  EXPECT_NEAR(smallestJacobian(CellType::quadrilateral, dart), (0.2 * 0.2 - 0.8 * 0.8) / 4, 1e-15);
  Points pushed = unitCell(CellType::hexahedron);
  pushed[6] = {0.3, 0.3, 0.3};
  EXPECT_GT(measureOf(CellType::hexahedron, pushed), 0);
  EXPECT_LT(smallestJacobian(CellType::hexahedron, pushed), 0);
  EXPECT_LT(scaledJacobian(CellType::hexahedron, pushed), 0);
}

TEST(ElementGeometryTest, FlatAndCollapsedElementsHaveNoJacobian) {
  for (const CellType type : allCellTypes) {
    const Points flat = mapped(unitCell(type), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return dimensionOf(type) == 2 ? Eigen::Vector3d(x[0], 0, 0) : Eigen::Vector3d(x[0], x[1], 0);
    });
    Points collapsed = unitCell(type), point(flat.size(), Point{1, 2, 3});
    collapsed[1] = collapsed[0];
    for (const Points& points : {flat, collapsed, point}) {
      EXPECT_EQ(smallestJacobian(type, points), 0) << toString(type);
      EXPECT_EQ(scaledJacobian(type, points), 0) << toString(type);
    }
  }
}

} // namespace
} // namespace epafi::fem
