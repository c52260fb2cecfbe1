#include "epafi/fem/HookesLaw.hpp"

#include <cassert>
#include <cmath>

namespace epafi::fem {

LameConstants lameConstants(Physics physics, const Material& material) {
  assert(physics != Physics::membrane);
  const double modulus = material.youngsModulus, ratio = material.poissonsRatio;
  const double lambda = physics == Physics::planeStress ? modulus * ratio / (1 - ratio * ratio)
                                                        : modulus * ratio / ((1 + ratio) * (1 - 2 * ratio));
  return {lambda, modulus / (2 * (1 + ratio))};
}

double thicknessOf(Physics physics, const Material& material) {
  return physics == Physics::planeStrain || physics == Physics::planeStress ? material.thickness : 1;
}

SymmetricTensor stressOf(const Eigen::Matrix3d& displacementGradient, Physics physics,
                         const Material& material) {
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

double vonMisesOf(const SymmetricTensor& stress) {
  const auto& [xx, yy, zz, xy, yz, zx] = stress;
  const double a = xx - yy, b = yy - zz, c = zz - xx;
  return std::sqrt((a * a + b * b + c * c) / 2 + 3 * (xy * xy + yz * yz + zx * zx));
}

} // namespace epafi::fem
