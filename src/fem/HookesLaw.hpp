#pragma once

/// The law of the linear, isotropic, elastic material, in space and in the plane.

#include "epafi/fem/Solid.hpp"

#include <Eigen/Core>

#include <array>

namespace epafi::fem {

/// σ = λ tr(ε) I + 2μ ε, with the strain ε = (∇u + ∇uᵀ)/2.
struct LameConstants {
  double lambda = 0, mu = 0;
};

/// Those of the material; for plane stress λ is 2λμ/(λ + 2μ), with which the law holds for the components in
/// the plane. Precondition: not a membrane; E > 0, −1 < ν < ½.
LameConstants lameConstants(Physics physics, const Material& material);

/// The thickness that integrals over an element or facet are multiplied with: the material's for plane strain
/// and plane stress, otherwise 1.
double thicknessOf(Physics physics, const Material& material);

/// xx, yy, zz, xy, yz, zx.
using SymmetricTensor = std::array<double, 6>;

/// Stress from the displacement's gradient, entry (i, j) = ∂u_i/∂x_j, 0 in what the plane has not. Plane
/// strain has a stress across the plane (zz), plane stress has none. Precondition: not a membrane.
SymmetricTensor stressOf(const Eigen::Matrix3d& displacementGradient, Physics physics,
                         const Material& material);

/// √(3/2 s:s) with the stress deviator s; 0 if the stress is the same in all directions.
double vonMisesOf(const SymmetricTensor& stress);

} // namespace epafi::fem
