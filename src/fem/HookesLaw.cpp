#include "epafi/fem/HookesLaw.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include <cassert>
#include <cmath>

namespace epafi::fem {
namespace {

/// C_ijkl turned into the axes of space: Σ R_ip R_jq R_kr R_ls C_pqrs.
ElasticityMatrix turned(const ElasticityMatrix& elasticity, const Eigen::Matrix3d& axes) {
  ElasticityMatrix strains; // what each component of a strain in space is along the axes
  for (int p = 0; p < 3; ++p)
    for (int q = p; q < 3; ++q)
      for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) {
          const double product = axes(i, p) * axes(j, q) + (i == j ? 0.0 : axes(j, p) * axes(i, q));
          const double ofAngles = (p == q ? 1.0 : 2.0) * (i == j ? 1.0 : 0.5);
          strains(placeInTensor[p][q], placeInTensor[i][j]) = ofAngles * product;
        }
  return strains.transpose() * elasticity * strains;
}

} // namespace

LameConstants lameConstants(Physics physics, const Material& material) {
  assert(physics != Physics::membrane && !material.elasticity);
  const double modulus = material.youngsModulus, ratio = material.poissonsRatio;
  const double lambda = physics == Physics::planeStress ? modulus * ratio / (1 - ratio * ratio)
                                                        : modulus * ratio / ((1 + ratio) * (1 - 2 * ratio));
  return {lambda, modulus / (2 * (1 + ratio))};
}

ElasticityMatrix elasticityOf(std::span<const double> constants, const Eigen::Matrix3d& axes) {
  constexpr std::array<int, 6> place{0, 1, 2, 3, 5, 4}; // of 11, 22, 33, 12, 13, 23
  constexpr std::size_t orthotropic = 9;
  assert(constants.size() == orthotropic || constants.size() == 21);
  ElasticityMatrix elasticity = ElasticityMatrix::Zero();
  auto next = constants.begin();
  for (std::size_t column = 0; column < place.size(); ++column)
    for (std::size_t row = constants.size() == orthotropic && column > 2 ? column : 0; row <= column; ++row)
      elasticity(place[row], place[column]) = elasticity(place[column], place[row]) = *next++;
  const ElasticityMatrix result = turned(elasticity, axes);
  return 0.5 * (result + result.transpose());
}

bool isPositiveDefinite(const ElasticityMatrix& elasticity) {
  constexpr double roundOff = 1e-10;
  const Eigen::VectorXd values = direct::eigenOf(elasticity).values;
  return values[0] > roundOff * values[values.size() - 1];
}

ElasticityMatrix elasticityIn(Physics physics, const Material& material) {
  const ElasticityMatrix& all = material.elasticity.value();
  if (physics != Physics::planeStress)
    return all;
  const std::array inside{0, 1, 3}, across{2, 4, 5};
  const Eigen::Matrix3d between = all(inside, across);
  ElasticityMatrix result = ElasticityMatrix::Zero();
  result(inside, inside) =
      all(inside, inside) - between * direct::inverseOfSpd(all(across, across)) * between.transpose();
  return result;
}

ElasticityMatrix wholeElasticity(const Material& material) {
  if (material.elasticity)
    return *material.elasticity;
  const auto [lambda, mu] = lameConstants(Physics::elasticity3d, material);
  ElasticityMatrix result = ElasticityMatrix::Zero();
  result.topLeftCorner<3, 3>().setConstant(lambda);
  result.diagonal().array() += mu;
  result.diagonal().head<3>().array() += mu;
  return result;
}

MeanModuli meanModuli(const Material& material) {
  if (!material.elasticity)
    return {material.youngsModulus, material.poissonsRatio};
  const ElasticityMatrix& c = *material.elasticity;
  const double normal = c.diagonal().head<3>().sum(), coupled = c(0, 1) + c(1, 2) + c(2, 0);
  const double bulk = (normal + 2 * coupled) / 9,
               shear = (normal - coupled + 3 * c.diagonal().tail<3>().sum()) / 15;
  return {9 * bulk * shear / (3 * bulk + shear), (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))};
}

double thicknessOf(Physics physics, const Material& material) {
  return physics == Physics::planeStrain || physics == Physics::planeStress ? material.thickness : 1;
}

SymmetricTensor stressOf(const Eigen::Matrix3d& displacementGradient, Physics physics,
                         const Material& material) {
  if (material.elasticity)
    return stressOf(displacementGradient, elasticityIn(physics, material));
  const auto [lambda, mu] = lameConstants(physics, material);
  const Eigen::Matrix3d& g = displacementGradient;
  const double volumetric = lambda * g.trace();
  return {volumetric + 2 * mu * g(0, 0),
          volumetric + 2 * mu * g(1, 1),
          physics == Physics::planeStress ? 0 : volumetric + 2 * mu * g(2, 2),
          mu * (g(0, 1) + g(1, 0)),
          mu * (g(1, 2) + g(2, 1)),
          mu * (g(2, 0) + g(0, 2))};
}

SymmetricTensor stressOf(const Eigen::Matrix3d& displacementGradient, const ElasticityMatrix& elasticity) {
  const Eigen::Matrix3d& g = displacementGradient;
  Eigen::Matrix<double, 6, 1> strain;
  strain << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(1, 2) + g(2, 1), g(2, 0) + g(0, 2);
  SymmetricTensor stress{};
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(stress.data()) = elasticity * strain;
  return stress;
}

Eigen::Matrix3d thermalStrain(Physics physics, const Material& material, double temperatureChange) {
  const double strain = material.expansion * temperatureChange;
  return Eigen::Vector3d(strain, strain, physics == Physics::planeStress ? 0 : strain).asDiagonal();
}

double vonMisesOf(const SymmetricTensor& stress) {
  const auto& [xx, yy, zz, xy, yz, zx] = stress;
  const double a = xx - yy, b = yy - zz, c = zz - xx;
  return std::sqrt((a * a + b * b + c * c) / 2 + 3 * (xy * xy + yz * yz + zx * zx));
}

} // namespace epafi::fem
