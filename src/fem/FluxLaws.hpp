#pragma once

/// Fluxes of elements from displacements at their nodes, and the density of their energy: what the integrals
/// of FluxIntegrals.hpp are made of.

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <numbers>
#include <span>

namespace epafi::fem {

constexpr int numMembraneFluxes = 2, numStresses = 6;

/// Flux κ∇u of a membrane, and the density of its energy.
struct MembraneLaw {
  static constexpr int numFluxes = numMembraneFluxes, components = 1;
  using Flux = Eigen::Matrix<double, numFluxes, 1>;
  using Gradient = Eigen::Matrix<double, components, 2>;

  MembraneLaw(Physics /*physics*/, const Material& material, std::span<const Point> /*points*/)
      : conductivity(material.conductivity) {}
  template <class Sample, class Nodal>
  [[nodiscard]] Flux flux(const Gradient& gradient, const Sample& /*sample*/, const Nodal& /*nodal*/,
                          double /*temperatureChange*/) const {
    return conductivity * gradient.transpose();
  }
  template <class Sample>
  [[nodiscard]] double around(const Sample& /*sample*/) const {
    return 1;
  }
  [[nodiscard]] double density(const Flux& q) const { return q.squaredNorm() / conductivity; }

  double conductivity;
};

/// Stress of an elastic body. For plane strain the stress across the plane is part of the sum, with which the
/// law of space holds; for plane stress it is 0. Solids of revolution have a hoop strain across it.
template <int dim>
struct ElasticLaw {
  static constexpr int numFluxes = numStresses, components = dim;
  using Flux = Eigen::Matrix<double, numFluxes, 1>;
  using Gradient = Eigen::Matrix<double, components, dim>;

  ElasticLaw(Physics bodyPhysics, const Material& bodyMaterial, std::span<const Point> itsPoints)
      : physics(bodyPhysics), material(bodyMaterial), thickness(thicknessOf(bodyPhysics, bodyMaterial)),
        points(itsPoints) {
    if (!material.elasticity)
      return;
    elasticity = elasticityIn(physics, material);
    compliance = direct::inverseOfSpd(*material.elasticity);
  }
  /// \param nodal  displacements, a column a node
  template <class Nodal>
  [[nodiscard]] Flux flux(const Gradient& gradient, const mesh::ShapeSample<dim>& sample, const Nodal& nodal,
                          double temperatureChange) const {
    Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
    whole.template topLeftCorner<components, components>() = gradient;
    if (isOfRevolution())
      whole(2, 2) = hoopStrain(gradient, sample, nodal);
    if (temperatureChange != 0)
      whole -= thermalStrain(physics, material, temperatureChange);
    const SymmetricTensor stress =
        material.elasticity ? stressOf(whole, elasticity) : stressOf(whole, physics, material);
    return Eigen::Map<const Flux>(stress.data());
  }
  /// σ:C⁻¹:σ, if isotropic ((1 + ν) σ:σ − ν tr(σ)²)/E
  [[nodiscard]] double density(const Flux& q) const {
    if (material.elasticity)
      return thickness * q.dot(compliance * q);
    const double trace = q[0] + q[1] + q[2];
    const double square = q.template head<3>().squaredNorm() + 2 * q.template tail<3>().squaredNorm();
    const double ratio = material.poissonsRatio;
    return thickness * ((1 + ratio) * square - ratio * trace * trace) / material.youngsModulus;
  }

  [[nodiscard]] bool isOfRevolution() const { return physics == Physics::axisymmetric; }
  /// What a volume is multiplied with.
  [[nodiscard]] double around(const mesh::ShapeSample<dim>& sample) const {
    return isOfRevolution() ? mesh::circumferenceAt(points, sample.values) : 1;
  }

  /// u_r/r, on the axis ∂u_r/∂r.
  template <class Nodal>
  [[nodiscard]] double hoopStrain(const Gradient& gradient, const mesh::ShapeSample<dim>& sample,
                                  const Nodal& nodal) const {
    constexpr double onAxis = 1e-9;
    double largest = 0;
    for (const Point& point : points)
      largest = std::max(largest, point[0]);
    const double radius = around(sample) / (2 * std::numbers::pi);
    return radius > onAxis * largest ? nodal.row(0).dot(sample.values) / radius : gradient(0, 0);
  }

  Physics physics;
  const Material& material;
  double thickness;
  std::span<const Point> points;
  ElasticityMatrix elasticity, compliance; ///< of what is not isotropic
};

/// An element's displacements, a column for each node.
template <class Law>
using NodalDisplacements = Eigen::Map<const Eigen::Matrix<double, Law::components, Eigen::Dynamic>>;

template <class Law>
NodalDisplacements<Law> atNodes(std::span<const double> displacements) {
  return {displacements.data(), Law::components, std::ssize(displacements) / Law::components};
}

/// What is given at the nodes, in between.
template <class Sample>
double valueAt(const Sample& sample, std::span<const double> nodal, double otherwise) {
  if (nodal.empty())
    return otherwise;
  return sample.values.dot(Eigen::Map<const Eigen::VectorXd>(nodal.data(), sample.values.size()));
}

/// By what the law is multiplied.
template <class Sample>
double factorOf(const Sample& sample, const NodalState& state) {
  return valueAt(sample, state.stiffnessFactor, 1);
}

template <class Law, int dim>
typename Law::Flux fluxAt(const Law& law, const mesh::ElementMap<dim>& map,
                          const mesh::ShapeSample<dim>& sample, std::span<const double> displacements,
                          const NodalState& state = {}) {
  const double change = valueAt(sample, state.temperatureChange, 0);
  const NodalDisplacements<Law> nodal = atNodes<Law>(displacements);
  return factorOf(sample, state) *
         law.flux(derivatives(nodal, sample) * map.jacobian().inverse(), sample, nodal, change);
}

/// action(shape, law) for an element and a physics.
template <class Action>
decltype(auto) withLaw(mesh::CellType type, std::span<const Point> points, Physics physics,
                       const Material& material, Action&& action) {
  assert(dimensionOf(type) == (physics == Physics::elasticity3d ? 3 : 2));
  return withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    if constexpr (dim == 2)
      if (physics == Physics::membrane)
        return action(shape, MembraneLaw(physics, material, points));
    return action(shape, ElasticLaw<dim>(physics, material, points));
  });
}

} // namespace epafi::fem
