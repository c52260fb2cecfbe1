#include "epafi/fem/HookesLaw.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace epafi::fem {
namespace {

const Material steel{.conductivity = 1, .youngsModulus = 210e3, .poissonsRatio = 0.3, .thickness = 2};

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

TEST(HookesLawTest, ABarUnderTensionBecomesThinner) {
  const double strain = 1e-3;
  const SymmetricTensor inSpace =
      stressOf(diagonal(strain, -0.3 * strain, -0.3 * strain), Physics::elasticity3d, steel);
  const SymmetricTensor inThePlane =
      stressOf(diagonal(strain, -0.3 * strain, 0), Physics::planeStress, steel);
  for (const auto& stress : {inSpace, inThePlane}) {
    EXPECT_NEAR(stress[0], 210, 1e-11);
    for (std::size_t i = 1; i < 6; ++i)
      EXPECT_NEAR(stress[i], 0, 1e-11);
  }
}

TEST(HookesLawTest, PlaneStrainIsElasticityInSpaceWithoutStrainAcross) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient.topLeftCorner<2, 2>() << 1e-3, 2e-3, -5e-4, 4e-3;
  const SymmetricTensor stress = stressOf(gradient, Physics::planeStrain, steel);
  EXPECT_EQ(stress, stressOf(gradient, Physics::elasticity3d, steel));
  EXPECT_NEAR(stress[2], 0.3 * (stress[0] + stress[1]), 1e-11);
}

TEST(HookesLawTest, PlaneStressIsElasticityInSpaceWithoutStressAcross) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient.topLeftCorner<2, 2>() << 1e-3, 2e-3, -5e-4, 4e-3;
  const SymmetricTensor inThePlane = stressOf(gradient, Physics::planeStress, steel);
  gradient(2, 2) = -0.3 / 0.7 * (gradient(0, 0) + gradient(1, 1)); // the strain across that makes σ_zz = 0
  const SymmetricTensor inSpace = stressOf(gradient, Physics::elasticity3d, steel);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(inThePlane[i], inSpace[i], 1e-11);
}

TEST(HookesLawTest, ShearIsTheShearModulusTimesTheAngleAndRotationIsNoStrain) {
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero(), spin;
  shear(2, 0) = 1e-3;
  EXPECT_NEAR(stressOf(shear, Physics::elasticity3d, steel)[5], 210e3 / 2.6 * 1e-3, 1e-12);
  spin << 0, -1, 2, 1, 0, -3, -2, 3, 0;
  EXPECT_EQ(stressOf(spin, Physics::elasticity3d, steel), (SymmetricTensor{}));
}

TEST(HookesLawTest, OnlyPlaneElasticBodiesHaveAThickness) {
  EXPECT_EQ(thicknessOf(Physics::planeStrain, steel), 2);
  EXPECT_EQ(thicknessOf(Physics::planeStress, steel), 2);
  EXPECT_EQ(thicknessOf(Physics::elasticity3d, steel), 1);
  EXPECT_EQ(thicknessOf(Physics::membrane, steel), 1);
}

TEST(VonMisesTest, IsZeroForHydrostaticStressAndUnmovedByIt) {
  EXPECT_EQ(vonMisesOf({-7, -7, -7, 0, 0, 0}), 0);
  const SymmetricTensor stress{1, 2, -4, 0.5, 3, -2};
  EXPECT_NEAR(vonMisesOf({11, 12, 6, 0.5, 3, -2}), vonMisesOf(stress), 1e-14);
}

TEST(VonMisesTest, IsTheStressOfABarAndRootThreeTimesAShear) {
  EXPECT_EQ(vonMisesOf({0, -5, 0, 0, 0, 0}), 5);
  for (std::size_t i = 3; i < 6; ++i) {
    SymmetricTensor shear{};
    shear[i] = -2;
    EXPECT_NEAR(vonMisesOf(shear), 2 * std::sqrt(3.0), 1e-15);
  }
}

} // namespace
} // namespace epafi::fem
