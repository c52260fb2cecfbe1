/// Materials that are not isotropic.

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"

#include "support/SampleCells.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace epafi::fem {
namespace {

using namespace test;

/// The isotropic sample as 21 constants in any axes.
Material isotropic() {
  const auto [lambda, mu] = lameConstants(Physics::elasticity3d, material);
  const double all = lambda + 2 * mu;
  const std::vector<double> constants{all, lambda, all, lambda, lambda, all, 0, 0, 0, mu, 0,
                                      0,   0,      0,   mu,     0,      0,   0, 0, 0, mu};
  Material result = material;
  result.elasticity = elasticityOf(constants, rotation(mesh::CellType::hexahedron, 0.8));
  return result;
}

/// Wood: of E1 … G23 the compliance is simple. Stiff along axis 1.
struct Orthotropic {
  double e1 = 12, e2 = 0.9, e3 = 0.5, nu12 = 0.4, nu13 = 0.35, nu23 = 0.6, g12 = 0.75, g13 = 0.7, g23 = 0.05;

  [[nodiscard]] std::vector<double> constants() const {
    Eigen::Matrix3d s;
    s << 1 / e1, -nu12 / e1, -nu13 / e1, -nu12 / e1, 1 / e2, -nu23 / e2, -nu13 / e1, -nu23 / e2, 1 / e3;
    const Eigen::Matrix3d d = s.inverse();
    return {d(0, 0), d(0, 1), d(1, 1), d(0, 2), d(1, 2), d(2, 2), g12, g13, g23};
  }
  [[nodiscard]] Material turned(double angle) const {
    Material result = material;
    result.elasticity =
        elasticityOf(constants(), Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    return result;
  }
  /// Of a bar at an angle to the grain, in the plane of axes 1 and 2.
  [[nodiscard]] double modulusAt(double angle) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return 1 / (std::pow(c, 4) / e1 + (1 / g12 - 2 * nu12 / e1) * c * c * s * s + std::pow(s, 4) / e2);
  }
};

TEST(AnisotropyTest, IsotropicConstantsAreTheIsotropicMaterialInAnyAxes) {
  const Material general = isotropic();
  EXPECT_NEAR(meanModuli(general).youngsModulus, material.youngsModulus, 1e-13);
  EXPECT_NEAR(meanModuli(general).poissonsRatio, material.poissonsRatio, 1e-14);
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      SCOPED_TRACE(std::string(toString(type)) + ", " + toString(physics));
      const auto points = distortedCell(type, 50);
      Eigen::MatrixXd stiffness, expected, stress, sampled;
      elementStiffness(type, points, physics, material, expected);
      elementStiffness(type, points, physics, general, stiffness);
      EXPECT_EQ(stiffness, stiffness.transpose());
      EXPECT_LT((stiffness - expected).norm(), 1e-13 * expected.norm());
      SignedRandomNumbers random(5);
      Eigen::VectorXd u(expected.rows());
      for (double& value : u)
        value = random();
      sampledFluxes(type, points, physics, material, spanOf(u), sampled);
      sampledFluxes(type, points, physics, general, spanOf(u), stress);
      EXPECT_LT((stress - sampled).norm(), 1e-13 * sampled.norm());
      const Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(6, numNodesOf(type));
      const double energy = fluxEnergies(type, points, physics, material, spanOf(u), nodal).flux;
      EXPECT_NEAR(fluxEnergies(type, points, physics, general, spanOf(u), nodal).flux, energy,
                  1e-12 * energy);
    }
}

TEST(AnisotropyTest, TheEnergyOfADisplacementIsThatOfTheStiffness) {
  const Material wood = Orthotropic().turned(0.6);
  for (const mesh::CellType type : {mesh::CellType::quadrilateral8, mesh::CellType::hexahedron})
    for (const Physics physics : elasticPhysics(type)) {
      const auto points = unitCell(type);
      Eigen::MatrixXd stiffness;
      elementStiffness(type, points, physics, wood, stiffness);
      SignedRandomNumbers random(6);
      Eigen::VectorXd u(stiffness.rows());
      for (double& value : u)
        value = random();
      const double expected = u.dot(stiffness * u);
      const FluxEnergies energies =
          fluxEnergies(type, points, physics, wood, spanOf(u), Eigen::MatrixXd::Zero(6, numNodesOf(type)));
      EXPECT_NEAR(energies.flux, expected, 1e-12 * expected) << toString(physics);
    }
}

/// Stretched along x without other forces, in space and in plane stress.
TEST(AnisotropyTest, ABarAtAnAngleToTheGrainHasTheModulusOfTheTextbooks) {
  const Orthotropic wood;
  for (const double angle : {0.0, 0.3, 0.785, 1.2, 1.5707963267948966}) {
    const Material turned = wood.turned(angle);
    EXPECT_NEAR(turned.elasticity->inverse()(0, 0), 1 / wood.modulusAt(angle), 1e-13);
    const ElasticityMatrix plane = elasticityIn(Physics::planeStress, turned);
    const std::array inside{0, 1, 3};
    const Eigen::Matrix3d compliance = Eigen::Matrix3d(plane(inside, inside)).inverse();
    EXPECT_NEAR(compliance(0, 0), 1 / wood.modulusAt(angle), 1e-13);
  }
}

TEST(AnisotropyTest, TurningMaterialAndElementTogetherTurnsTheStiffness) {
  const mesh::CellType type = mesh::CellType::hexahedron;
  const Eigen::Matrix3d turn = rotation(type, 0.9);
  const auto points = distortedCell(type, 51),
             turned = mapped(points, [&](const Eigen::Vector3d&x) -> Eigen::Vector3d { return turn * x; });
  Material wood = material, there = material;
  wood.elasticity = elasticityOf(Orthotropic().constants(), Eigen::Matrix3d::Identity());
  there.elasticity = elasticityOf(Orthotropic().constants(), turn);
  Eigen::MatrixXd own, other;
  elementStiffness(type, points, Physics::elasticity3d, wood, own);
  elementStiffness(type, turned, Physics::elasticity3d, there, other);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(24, 24);
  for (int a = 0; a < 24; a += 3)
    all.block<3, 3>(a, a) = turn;
  EXPECT_LT((all * own * all.transpose() - other).norm(), 1e-13 * own.norm());
}

TEST(AnisotropyTest, ConstantsThatStoreNoEnergyAreFound) {
  EXPECT_TRUE(isPositiveDefinite(elasticityOf(Orthotropic().constants(), Eigen::Matrix3d::Identity())));
  std::vector<double> soft = Orthotropic().constants();
  soft[8] = 0; // no stiffness in one shear
  EXPECT_FALSE(isPositiveDefinite(elasticityOf(soft, Eigen::Matrix3d::Identity())));
  soft = Orthotropic().constants();
  soft[1] *= -100;
  EXPECT_FALSE(isPositiveDefinite(elasticityOf(soft, Eigen::Matrix3d::Identity())));
}

} // namespace
} // namespace epafi::fem
