/// What changes of temperature do to elements that are free, and to those that are held.

#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include "support/Refusal.hpp"
#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace epafi::fem {
namespace {

using namespace test;

constexpr double degrees = 40;

Material expanding() {
  Material result = material;
  result.expansion = 1e-3;
  return result;
}

/// One that is stiffer along some axes than along others.
Material anisotropic() {
  Material result = expanding();
  result.elasticity = elasticityOf(std::array<double, 9>{12, 3, 9, 2, 1, 7, 2, 3, 1.5},
                                   axesAt({false, {1, 2, 0}, {-2, 1, 0}}, {}));
  return result;
}

/// By which a free body is strained in each direction of its elements; of plane strain more, since it cannot
/// expand across the plane.
double freeStrain(Physics physics, double change) {
  return (physics == Physics::planeStrain ? 1 + material.poissonsRatio : 1) * expanding().expansion * change;
}

bool isSerendipityType(mesh::CellType type) {
  return type == mesh::CellType::quadrilateral8 || type == mesh::CellType::hexahedron20;
}

std::vector<Integration> integrations(mesh::CellType type) {
  if (isSerendipityType(type))
    return {Integration::full, Integration::reduced};
  return {Integration::full};
}

/// Forces at the nodes that displacements leave unbalanced, relative to those of the temperatures.
double unbalanced(mesh::CellType type, std::span<const Point> points, Physics physics, const Material& of,
                  const Eigen::VectorXd& displacements, std::span<const double> change,
                  Integration integration) {
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load;
  elementStiffness(type, points, physics, of, stiffness, integration);
  thermalLoad(type, points, physics, of, change, load, integration);
  EXPECT_GT(load.norm(), 0);
  return (stiffness * displacements - load).norm() / load.norm();
}

/// The stress across the plane of plane strain, all others 0.
Eigen::VectorXd freeStress(Physics physics, double change) {
  Eigen::VectorXd stress = Eigen::VectorXd::Zero(6);
  if (physics == Physics::planeStrain)
    stress[2] = -material.youngsModulus * expanding().expansion * change;
  return stress;
}

TEST(ThermalStrainTest, AFreeElementExpandsWithoutStress) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(std::string(toString(type)) + ", " + toString(physics));
      const auto points = distortedCell(type, 50);
      const Eigen::VectorXd u =
          linearField(points, dimensionOf(type), freeStrain(physics, degrees) * Eigen::Matrix3d::Identity());
      const std::vector<double> change(points.size(), degrees);
      for (const Integration integration : integrations(type))
        EXPECT_LT(unbalanced(type, points, physics, expanding(), u, change, integration), 1e-12);
      Eigen::MatrixXd sampled;
      sampledFluxes(type, points, physics, expanding(), spanOf(u), sampled, {change, {}});
      for (const auto& stress : sampled.colwise())
        EXPECT_LT((stress - freeStress(physics, degrees)).norm(), 1e-12);
      const double across = freeStress(physics, degrees)[2];
      const FluxEnergies energies = fluxEnergies(type, points, physics, expanding(), spanOf(u),
                                                 Eigen::MatrixXd::Zero(6, numNodesOf(type)), {change, {}});
      const double expected =
          across * across / material.youngsModulus * material.thickness * measureOf(type, points);
      EXPECT_NEAR(energies.flux, expected, 1e-12);
      EXPECT_NEAR(energies.difference, expected, 1e-12);
    }
}

TEST(ThermalStrainTest, AnAnisotropicElementExpandsWithoutStressToo) {
  for (const mesh::CellType type : allCellTypes) {
    const Physics physics = dimensionOf(type) == 3 ? Physics::elasticity3d : Physics::planeStress;
    const auto points = distortedCell(type, 51);
    const Eigen::VectorXd u =
        linearField(points, dimensionOf(type), freeStrain(physics, degrees) * Eigen::Matrix3d::Identity());
    const std::vector<double> change(points.size(), degrees);
    EXPECT_LT(unbalanced(type, points, physics, anisotropic(), u, change, Integration::full), 1e-12);
    Eigen::MatrixXd sampled;
    sampledFluxes(type, points, physics, anisotropic(), spanOf(u), sampled, {change, {}});
    EXPECT_LT(sampled.norm(), 1e-12);
  }
}

/// −EαΔT/(1 − 2ν) in all directions, and of plane stress −EαΔT/(1 − ν) in the plane.
TEST(ThermalStrainTest, AHeldElementHasTheStressOfTheTextbooks) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = distortedCell(type, 52);
      const Eigen::VectorXd u = Eigen::VectorXd::Zero(std::ssize(points) * dimensionOf(type));
      const std::vector<double> change(points.size(), degrees);
      const double ratio = material.poissonsRatio, isolated = material.youngsModulus * 1e-3 * degrees;
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(6);
      if (physics == Physics::planeStress)
        expected.head(2).setConstant(-isolated / (1 - ratio));
      else
        expected.head(3).setConstant(-isolated / (1 - 2 * ratio));
      Eigen::MatrixXd sampled;
      sampledFluxes(type, points, physics, expanding(), spanOf(u), sampled, {change, {}});
      for (const auto& stress : sampled.colwise())
        EXPECT_LT((stress - expected).norm(), 1e-12);
    }
}

/// u = α (x (b·x) − b |x|²/2) has the strain α b·x in all directions.
TEST(ThermalStrainTest, ALinearChangeBendsAFreeElementOfOrder2WithoutStress) {
  const Eigen::Vector3d slope(3, -2, 5);
  for (const mesh::CellType type : allCellTypes) {
    if (orderOf(type) == 1)
      continue;
    const bool inSpace = dimensionOf(type) == 3;
    const auto points = mapped(unitCell(type), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return {2 * x[0] + 0.3 * x[1], 1.5 * x[1] - 0.2 * x[0], inSpace ? 0.8 * x[2] + 0.1 * x[0] : 0.0};
    });
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(std::string(toString(type)) + ", " + toString(physics));
      const int n = dimensionOf(type);
      Eigen::VectorXd u(std::ssize(points) * n);
      std::vector<double> change;
      for (Eigen::Index a = 0; a < std::ssize(points); ++a) {
        const Eigen::VectorXd x = vectorOf(points[static_cast<std::size_t>(a)]).head(n), b = slope.head(n);
        change.push_back(b.dot(x));
        u.segment(n * a, n) = freeStrain(physics, 1) * (b.dot(x) * x - 0.5 * x.squaredNorm() * b);
      }
      for (const Integration integration : integrations(type))
        EXPECT_LT(unbalanced(type, points, physics, expanding(), u, change, integration), 1e-12);
      Eigen::MatrixXd sampled;
      sampledFluxes(type, points, physics, expanding(), spanOf(u), sampled, {change, {}});
      for (Eigen::Index a = 0; a < sampled.cols(); ++a)
        EXPECT_LT((sampled.col(a) - freeStress(physics, change[static_cast<std::size_t>(a)])).norm(), 1e-12);
    }
  }
}

SolidLoad heated(const std::string& where, double change) {
  return {"heat " + where, SolidLoad::Kind::temperature, {}, where, {}, {change, 0, 0}};
}

TEST(ThermalStrainTest, ChangesAddUpNodeByNode) {
  const mesh::StructuredMesh mesh({{0, 0, 0}, {2, 1, 0}}, {2, 1, 0});
  Solid solid;
  solid.physics = Physics::planeStress;
  solid.material = expanding();
  solid.loads = {heated("", 5), heated("left", 2), heated("left", 1)};
  std::vector<double> change;
  const BodyModel model(solid, mesh);
  model.temperatureChange(0, change);
  EXPECT_EQ(change, (std::vector<double>{8, 5, 5, 8}));
  model.temperatureChange(1, change);
  EXPECT_EQ(change, std::vector<double>(4, 5));
  solid.loads = {heated("", 0), heated("left", 0)};
  BodyModel(solid, mesh).temperatureChange(0, change);
  EXPECT_TRUE(change.empty()) << "no temperature changes";
}

TEST(ThermalStrainTest, EachRegionExpandsByItself) {
  const mesh::StructuredMesh mesh({{0, 0, 0}, {2, 1, 0}}, {2, 1, 0});
  Solid solid;
  solid.physics = Physics::planeStrain;
  solid.material = expanding();
  Material twice = expanding();
  twice.expansion *= 2;
  solid.regions = {{"twice", {{1, 0, 0}, {2, 1, 0}}, "", twice}};
  solid.loads = {heated("", degrees)};
  const BodyModel model(solid, mesh);
  Eigen::MatrixXd loads;
  model.loads(std::array<GlobalOrdinal, 2>{0, 1}, loads);
  EXPECT_GT(loads.col(0).norm(), 0);
  EXPECT_LT((loads.col(1) - 2 * loads.col(0)).norm(), 1e-14 * loads.norm());
}

TEST(ThermalStrainTest, AMembraneIsNotHeated) {
  const mesh::StructuredMesh mesh({{0, 0, 0}, {1, 1, 0}}, {1, 1, 0});
  Solid solid;
  solid.loads = {heated("", 1)};
  EXPECT_NE(refusal([&] { const BodyModel model(solid, mesh); }).find("membrane"), std::string::npos);
}

} // namespace
} // namespace epafi::fem
