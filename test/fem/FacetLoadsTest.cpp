#include "epafi/fem/ElementIntegrals.hpp"

#include "epafi/mesh/ElementGeometry.hpp"

#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace epafi::fem {
namespace {

using namespace test;

/// Σ x_a × f_a
Eigen::Vector3d moment(std::span<const Point> points, const Eigen::VectorXd& load) {
  const auto components = load.size() / static_cast<Eigen::Index>(points.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t a = 0; a < points.size(); ++a) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    force.head(components) = load.segment(static_cast<Eigen::Index>(a) * components, components);
    sum += vectorOf(points[a]).cross(force);
  }
  return sum;
}

TEST(FacetLoadsTest, TractionsOfUnitFacetsAreSharedEquallyByTheirNodes) {
  Eigen::VectorXd load;
  const std::vector<Point> edge{{0, 0, 0}, {2, 0, 0}}, triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  tractionLoad(mesh::CellType::line, edge, Physics::membrane, material, {3, 9, 9}, load);
  EXPECT_EQ(load, Eigen::Vector2d(3, 3));
  tractionLoad(mesh::CellType::line, edge, Physics::planeStrain, material, {3, -2, 9}, load);
  EXPECT_EQ(load, Eigen::Vector4d(1.5, -1, 1.5, -1)); // thickness ½
  tractionLoad(mesh::CellType::triangle, triangle, Physics::elasticity3d, material, {6, 0, 12}, load);
  ASSERT_EQ(load.size(), 9);
  EXPECT_LT((load.reshaped(3, 3).colwise() - Eigen::Vector3d(1, 0, 2)).norm(), 1e-15);
  tractionLoad(mesh::CellType::quadrilateral, square, Physics::elasticity3d, material, {4, 0, -8}, load);
  ASSERT_EQ(load.size(), 12);
  EXPECT_LT((load.reshaped(3, 4).colwise() - Eigen::Vector3d(1, 0, -2)).norm(), 1e-15);
}

TEST(FacetLoadsTest, TractionsSumToForceTimesMeasure) {
  const Vector3 traction{1, -2, 4};
  Eigen::VectorXd load;
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = distortedCell(type, 5);
      const int components = dimensionOf(type);
      const double thickness = components == 2 ? 0.5 : 1;
      for (const auto& facet : facetsOf(type)) {
        const auto corners = facetPoints(type, points, facet);
        std::vector<double> shares(corners.size());
        nodalShares(facet.type, corners, shares);
        const double measure = std::accumulate(shares.begin(), shares.end(), 0.0);
        tractionLoad(facet.type, corners, physics, material, traction, load);
        const Eigen::Vector3d sum = resultant(load, components);
        for (int i = 0; i < components; ++i)
          EXPECT_NEAR(sum[i], thickness * measure * traction[i], 1e-14);
      }
    }
}

/// The centroid of a trapezium of parallel sides 3 and 1 and height 1: (3 + 2·1)/(3(3 + 1)) above the longer
/// one.
TEST(FacetLoadsTest, TractionsActAtTheCentroidOfTheFacet) {
  const std::vector<Point> trapezium{{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}};
  const Eigen::Vector3d centroid(1.5, 5.0 / 12, 0), force(0, 0, 2 * 6);
  Eigen::VectorXd load;
  tractionLoad(mesh::CellType::quadrilateral, trapezium, Physics::elasticity3d, material, {0, 0, 6}, load);
  EXPECT_LT((resultant(load, 3) - force).norm(), 1e-14);
  EXPECT_LT((moment(trapezium, load) - centroid.cross(force)).norm(), 1e-14);
}

TEST(FacetLoadsTest, PressureActsAgainstTheNormal) {
  Eigen::VectorXd load;
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = distortedCell(type, 6);
      for (const auto& facet : facetsOf(type)) {
        const auto corners = facetPoints(type, points, facet);
        pressureLoad(facet.type, corners, physics, material, 3, load);
        const double thickness = dimensionOf(type) == 2 ? 0.5 : 1;
        EXPECT_LT(
            (resultant(load, dimensionOf(type)) + 3 * thickness * areaVector(facet.type, corners)).norm(),
            1e-14);
      }
    }
}

TEST(FacetLoadsTest, PressureOnPlaneFacetsIsTheTractionAlongTheirNormal) {
  Eigen::VectorXd pressure, traction;
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = planeFacedCell(type);
      for (const auto& facet : facetsOf(type)) {
        const auto corners = facetPoints(type, points, facet);
        pressureLoad(facet.type, corners, physics, material, 2, pressure);
        tractionLoad(facet.type, corners, physics, material,
                     pointOf(-2 * areaVector(facet.type, corners).normalized()), traction);
        EXPECT_LT((pressure - traction).norm(), 1e-14) << toString(type);
      }
    }
}

TEST(FacetLoadsTest, PressureAllAroundAnElementIsInEquilibrium) {
  Eigen::VectorXd load;
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = distortedCell(type, 7);
      Eigen::Vector3d force = Eigen::Vector3d::Zero(), turning = Eigen::Vector3d::Zero();
      for (const auto& facet : facetsOf(type)) {
        const auto corners = facetPoints(type, points, facet);
        pressureLoad(facet.type, corners, physics, material, 1.7, load);
        force += resultant(load, dimensionOf(type));
        turning += moment(corners, load);
      }
      EXPECT_LT(force.norm(), 1e-14) << toString(type);
      EXPECT_LT(turning.norm(), 1e-14) << toString(type);
    }
}

} // namespace
} // namespace epafi::fem
