#include "epafi/mesh/ElementGeometry.hpp"

#include "support/SampleCells.hpp"
#include "support/SimplexSamples.hpp"

#include <gtest/gtest.h>

namespace epafi::mesh {
namespace {

using namespace test;

using Points = std::vector<Point>;

std::vector<double> sharesOf(CellType facet, const Points& points) {
  std::vector<double> shares(points.size());
  nodalShares(facet, points, shares);
  return shares;
}

TEST(ElementGeometryTest, MeasuresOfUnitCellsAreTheKnownOnes) {
  const double expected[] = {0.5, 1, 1.0 / 6, 1, 1.0 / 3, 0.5, 1.0 / 3, 0.5, 0.5, 1, 1.0 / 6, 1, 1, 1};
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
      const Eigen::Vector3d area = areaVector(facet.type, corners);
      flux += area.dot(vectorOf(corners[0])); // the same all over a plane face
      sum += area;
      const double measure = test::sumOf(sharesOf(facet.type, corners));
      surface += measure;
      EXPECT_NEAR(area.norm(), measure, 1e-14);
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
      sum += areaVector(facet.type, facetPoints(type, points, facet));
    EXPECT_LT(sum.norm(), 1e-14) << toString(type);
  }
}

TEST(ElementGeometryTest, FacetsOfTheUnitCubeHaveTheirNormals) {
  const Points cube = unitCell(CellType::hexahedron);
  const auto facets = facetsOf(CellType::hexahedron);
  EXPECT_EQ(areaVector(facets[0].type, facetPoints(CellType::hexahedron, cube, facets[0])),
            Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(areaVector(facets[1].type, facetPoints(CellType::hexahedron, cube, facets[1])),
            Eigen::Vector3d(0, 0, 1));
  const Points edge{{0, 0, 5}, {2, 0, -7}}; // an edge below its element; z does not matter
  EXPECT_EQ(areaVector(CellType::line, edge), Eigen::Vector3d(0, -2, 0));
  EXPECT_EQ(sharesOf(CellType::line, edge), (std::vector<double>{1, 1}));
}

TEST(ElementGeometryTest, CentreIsTheMeanOfTheCorners) {
  const Points hexahedron = unitCell(CellType::hexahedron), triangle{{0, 0, 0}, {3, 0, 0}, {0, 6, 0}};
  EXPECT_EQ(centreOf(hexahedron), (Point{0.5, 0.5, 0.5}));
  EXPECT_EQ(centreOf(triangle), (Point{1, 2, 0}));
}

/// Of a trapezium of parallel sides 3 and 1 and height 1: N at the ends of the longer one falls from 1 to 0
/// with the height, and is 1/2 of what a line across it has there: ½∫(1 − y)(3 − 2y) dy = 7/12; at the
/// shorter one ½∫y(3 − 2y) dy = 5/12.
TEST(ElementGeometryTest, NodesShareAFacetAsTheirShapeFunctionsDo) {
  const Points trapezium{{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}},
      triangle{{0, 0, 0}, {3, 0, 0}, {0, 0, 2}};
  const std::vector<double> expected{7.0 / 12, 7.0 / 12, 5.0 / 12, 5.0 / 12},
      shares = sharesOf(CellType::quadrilateral, trapezium);
  for (std::size_t a = 0; a < 4; ++a)
    EXPECT_NEAR(shares[a], expected[a], 1e-15);
  EXPECT_EQ(sharesOf(CellType::triangle, triangle), (std::vector<double>{1, 1, 1}));
}

} // namespace
} // namespace epafi::mesh
