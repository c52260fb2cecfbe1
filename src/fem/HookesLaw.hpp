#pragma once

/// The law of linear elastic materials, isotropic or not, in space and in the plane.

#include "epafi/fem/Solid.hpp"

#include <Eigen/Core>

#include <array>
#include <span>

namespace epafi::fem {

/// σ = λ tr(ε) I + 2μ ε, with the strain ε = (∇u + ∇uᵀ)/2.
struct LameConstants {
  double lambda = 0, mu = 0;
};

/// Those of the material; for plane stress λ is 2λμ/(λ + 2μ), with which the law holds for the components in
/// the plane. Precondition: not a membrane; isotropic; E > 0, −1 < ν < ½.
LameConstants lameConstants(Physics physics, const Material& material);

/// C of constants in the order of Abaqus, in which indices go 11, 22, 33, 12, 13, 23: of an orthotropic
/// material 9, D1111 D1122 D2222 D1133 D2233 D3333 D1212 D1313 D2323; of any other 21, the upper triangle
/// column by column. \param axes  those in which the constants hold, columns 1, 2, 3: a rotation
ElasticityMatrix elasticityOf(std::span<const double> constants, const Eigen::Matrix3d& axes);

/// Whether C stores energy in every strain, far from round-off.
bool isPositiveDefinite(const ElasticityMatrix& elasticity);

/// C of a material that has one, for a physics: for plane stress that of the components in the plane if the
/// others, which have no stress, are left to themselves; those are 0 in it. Precondition: not isotropic.
ElasticityMatrix elasticityIn(Physics physics, const Material& material);

/// C of any elastic material with strain in all directions, isotropic ones too.
ElasticityMatrix wholeElasticity(const Material& material);

/// E and ν of an isotropic material; of others those of the isotropic one that has the same energy on the
/// mean of all directions (Voigt).
struct MeanModuli {
  double youngsModulus = 0, poissonsRatio = 0;
};
/// Of elastic bodies.
MeanModuli meanModuli(const Material& material);

/// The thickness that integrals over an element or facet are multiplied with: the material's for plane strain
/// and plane stress, otherwise 1.
double thicknessOf(Physics physics, const Material& material);

/// xx, yy, zz, xy, yz, zx.
using SymmetricTensor = std::array<double, 6>;

/// Place of the component ij of a symmetric tensor.
constexpr std::array<std::array<int, 3>, 3> placeInTensor{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

/// Stress from the displacement's gradient, entry (i, j) = ∂u_i/∂x_j, 0 in what the plane has not. Plane
/// strain has a stress across the plane (zz), plane stress has none; of solids of revolution that is the hoop
/// stress, from the strain u_x/x in the gradient's entry zz. Precondition: not a membrane.
SymmetricTensor stressOf(const Eigen::Matrix3d& displacementGradient, Physics physics,
                         const Material& material);

/// The same with C of the physics.
SymmetricTensor stressOf(const Eigen::Matrix3d& displacementGradient, const ElasticityMatrix& elasticity);

/// The strain of a change of temperature that nothing hinders, as a displacement's gradient without which the
/// law holds: of plane stress, where what is across the plane has no stress, in the plane alone.
/// Precondition: not a membrane.
Eigen::Matrix3d thermalStrain(Physics physics, const Material& material, double temperatureChange);

/// √(3/2 s:s) with the stress deviator s; 0 if the stress is the same in all directions.
double vonMisesOf(const SymmetricTensor& stress);

} // namespace epafi::fem
