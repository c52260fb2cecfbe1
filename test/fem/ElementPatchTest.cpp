/// Elements in a state of constant stress: what the stiffness, the stresses and the loads on facets say must
/// agree.

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"

#include "epafi/mesh/ElementGeometry.hpp"

#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using namespace test;

/// The displacement's gradient in these tests, 0 where the plane has no component.
Eigen::Matrix3d gradientIn(mesh::CellType type) {
  Eigen::Matrix3d gradient;
  gradient << 1, 2, -3, 0.5, -1, 4, 2, 1.5, 0.25;
  if (dimensionOf(type) == 2) {
    gradient.row(2).setZero();
    gradient.col(2).setZero();
  }
  return gradient;
}

/// Hooke's law as the textbooks write it, E ε = (1 + ν) σ − ν tr(σ) I, solved for σ; in the plane by the 3 ×
/// 3 matrices.
Eigen::Matrix3d hooke(const Eigen::Matrix3d& gradient, Physics physics) {
  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  const double modulus = material.youngsModulus, ratio = material.poissonsRatio;
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
  if (physics == Physics::planeStress) {
    const double factor = modulus / (1 - ratio * ratio);
    stress(0, 0) = factor * (strain(0, 0) + ratio * strain(1, 1));
    stress(1, 1) = factor * (strain(1, 1) + ratio * strain(0, 0));
    stress(0, 1) = stress(1, 0) = factor * (1 - ratio) * strain(0, 1);
    return stress;
  }
  const double pressure = modulus / (1 - 2 * ratio) * strain.trace(); // tr σ
  return (modulus * strain + ratio * pressure * Eigen::Matrix3d::Identity()) / (1 + ratio);
}

Eigen::VectorXd nodalForces(mesh::CellType type, std::span<const Point> points, Physics physics,
                            const Eigen::VectorXd& displacements) {
  Eigen::MatrixXd stiffness;
  elementStiffness(type, points, physics, material, stiffness);
  return stiffness * displacements;
}

TEST(ElementPatchTest, LinearDisplacementsGiveHookesStress) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(toString(type));
      const auto points = distortedCell(type, 40);
      const Eigen::VectorXd displacements = linearField(points, dimensionOf(type), gradientIn(type));
      Eigen::MatrixXd sampled;
      sampledFluxes(type, points, physics, material, spanOf(displacements), sampled);
      ASSERT_EQ(sampled.cols(), numSampledFluxes(type));
      const Eigen::Matrix3d expected = hooke(gradientIn(type), physics);
      const std::array<std::array<int, 2>, 6> places{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};
      for (const auto& stress : sampled.colwise()) {
        for (std::size_t i = 0; i < 6; ++i)
          EXPECT_NEAR(stress[i], expected(places[i][0], places[i][1]), 1e-12);
        EXPECT_EQ(stress[2] == 0, physics == Physics::planeStress);
      }
    }
}

TEST(ElementPatchTest, LinearFieldsGiveAMembranesFlux) {
  for (const mesh::CellType type : {mesh::CellType::triangle, mesh::CellType::quadrilateral,
                                    mesh::CellType::triangle6, mesh::CellType::quadrilateral9}) {
    const auto points = distortedCell(type, 41);
    const Eigen::VectorXd field = linearField(points, 1, gradientIn(type));
    Eigen::MatrixXd sampled;
    sampledFluxes(type, points, Physics::membrane, material, spanOf(field), sampled);
    for (const auto& flux : sampled.colwise())
      EXPECT_LT((flux - Eigen::Vector2d(3, 6)).norm(), 1e-12);
  }
}

/// K u = Σ ∫N σn over the facets: the patch test of one element.
TEST(ElementPatchTest, ConstantStressIsInEquilibriumWithItsTractions) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(toString(type));
      const auto points = planeFacedCell(type);
      const Eigen::VectorXd displacements = linearField(points, dimensionOf(type), gradientIn(type));
      const Eigen::VectorXd forces = nodalForces(type, points, physics, displacements);
      const Eigen::Matrix3d stress = hooke(gradientIn(type), physics);
      Eigen::VectorXd tractions = Eigen::VectorXd::Zero(forces.size()), load;
      for (const auto& facet : facetsOf(type)) {
        const auto corners = facetPoints(type, points, facet);
        tractionLoad(facet.type, corners, physics, material,
                     pointOf(stress * areaVector(facet.type, corners).normalized()), load);
        addFacetLoad(type, facet, load, tractions);
      }
      EXPECT_GT(forces.norm(), 1);
      EXPECT_LT((forces - tractions).norm(), 1e-13 * forces.norm());
    }
}

TEST(ElementPatchTest, ConstantFluxOfAMembraneIsInEquilibriumWithItsTractions) {
  for (const mesh::CellType type : {mesh::CellType::triangle, mesh::CellType::quadrilateral}) {
    const auto points = distortedCell(type, 42);
    const Eigen::VectorXd forces =
        nodalForces(type, points, Physics::membrane, linearField(points, 1, gradientIn(type)));
    Eigen::VectorXd tractions = Eigen::VectorXd::Zero(forces.size()), load;
    for (const auto& facet : facetsOf(type)) {
      const auto corners = facetPoints(type, points, facet);
      const double flux = Eigen::Vector3d(3, 6, 0).dot(areaVector(facet.type, corners).normalized());
      tractionLoad(facet.type, corners, Physics::membrane, material, {flux, 0, 0}, load);
      addFacetLoad(type, facet, load, tractions);
    }
    EXPECT_LT((forces - tractions).norm(), 1e-13 * forces.norm());
  }
}

/// The same with warped faces, where a stress of −p in all directions is the pressure p at every point.
TEST(ElementPatchTest, HydrostaticStressIsInEquilibriumWithItsPressure) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(toString(type));
      Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
      gradient.diagonal().head(dimensionOf(type)).setConstant(-0.1);
      const double pressure = -hooke(gradient, physics)(0, 0);
      const auto points = distortedCell(type, 43);
      const Eigen::VectorXd forces =
          nodalForces(type, points, physics, linearField(points, dimensionOf(type), gradient));
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(forces.size()), load;
      for (const auto& facet : facetsOf(type)) {
        pressureLoad(facet.type, facetPoints(type, points, facet), physics, material, pressure, load);
        addFacetLoad(type, facet, load, expected);
      }
      EXPECT_LT((forces - expected).norm(), 1e-13 * forces.norm());
    }
}

/// Energy of a linear field: stress times strain times volume.
TEST(ElementPatchTest, EnergyIsThatOfTheConstantStress) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = distortedCell(type, 44);
      const Eigen::VectorXd displacements = linearField(points, dimensionOf(type), gradientIn(type));
      const double energy = displacements.dot(nodalForces(type, points, physics, displacements));
      const double density = hooke(gradientIn(type), physics).cwiseProduct(gradientIn(type)).sum();
      const double thickness = dimensionOf(type) == 2 ? material.thickness : 1;
      EXPECT_NEAR(energy, density * thickness * measureOf(type, points), 1e-13 * energy) << toString(type);
    }
}

} // namespace
} // namespace epafi::fem
