#include "epafi/fem/ElementIntegrals.hpp"

#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <array>
#include <cassert>

namespace epafi::fem {
namespace {

using scene::Physics;

template <class Shape>
constexpr int numGradients = Shape::numNodes* Shape::dimension;

/// S: products of all shape functions' derivatives, row and column node × dimension + direction. Isotropic stiffnesses are
/// sums of its entries.
template <class Shape>
using GradientProducts = Eigen::Matrix<double, numGradients<Shape>, numGradients<Shape>>;

[[maybe_unused]] bool fits(CellType type, Physics physics) {
  return dimensionOf(type) == (physics == Physics::elasticity3d ? 3 : 2);
}

[[maybe_unused]] bool boundsElement(CellType facet, Physics physics) {
  return dimensionOf(facet) + 1 == scene::dimensionOf(physics);
}

/// Load of a constant force of which each node bears its share.
void shareOut(std::span<const double> shares, Physics physics, const scene::Material& material,
              const scene::Vector3& force, Eigen::VectorXd& load) {
  const auto components = static_cast<std::size_t>(componentsOf(physics));
  const double thickness = thicknessOf(physics, material);
  load.resize(static_cast<Eigen::Index>(shares.size() * components));
  for (std::size_t a = 0; a < shares.size(); ++a)
    for (std::size_t i = 0; i < components; ++i)
      load[static_cast<Eigen::Index>(a * components + i)] = thickness * shares[a] * force[i];
}

/// S = ∫ g gᵀ, g = (∂N_0/∂x, ∂N_0/∂y, …, ∂N_1/∂x, …); of its upper triangle.
template <class Shape>
GradientProducts<Shape> gradientProducts(std::span<const Point> points) {
  const auto corners = relativeCorners<Shape>(points);
  GradientProducts<Shape> products = GradientProducts<Shape>::Zero();
  for (const auto& sample : gaussSamples<Shape>()) {
    const ElementMap<Shape> map(corners, sample);
    const typename Shape::Gradients gradients = map.gradients(sample);
    const Eigen::Map<const Eigen::Matrix<double, numGradients<Shape>, 1>> g(gradients.data());
    const double weight = sample.weight * map.determinant();
    for (int column = 0; column < numGradients<Shape>; ++column)
      products.col(column) += (weight * g[column]) * g;
  }
  return products;
}

/// ∫∇N_a·∇N_b
template <class Shape>
double gradientsDot(const GradientProducts<Shape>& products, int a, int b) {
  return products
      .template block<Shape::dimension, Shape::dimension>(a * Shape::dimension, b * Shape::dimension)
      .trace();
}

/// The lower triangle becomes the mirror image of the upper one.
template <class Matrix>
void mirror(Matrix& matrix) {
  for (Eigen::Index column = 0; column < matrix.cols(); ++column)
    for (Eigen::Index row = 0; row < column; ++row)
      matrix(column, row) = matrix(row, column);
}

template <class Shape>
void membraneStiffness(std::span<const Point> points, double conductivity, Eigen::MatrixXd& stiffness) {
  const GradientProducts<Shape> products = gradientProducts<Shape>(points);
  for (int b = 0; b < Shape::numNodes; ++b)
    for (int a = 0; a <= b; ++a)
      stiffness(a, b) = conductivity * gradientsDot<Shape>(products, a, b);
}

/// K_ai,bj = λ S_ai,bj + μ S_aj,bi + μ δ_ij Σ_k S_ak,bk
template <class Shape>
void elasticStiffness(std::span<const Point> points, double lambda, double mu, Eigen::MatrixXd& stiffness) {
  constexpr int dim = Shape::dimension;
  const GradientProducts<Shape> products = gradientProducts<Shape>(points);
  for (int b = 0; b < Shape::numNodes; ++b)
    for (int a = 0; a <= b; ++a) {
      const Eigen::Matrix<double, dim, dim> s = products.template block<dim, dim>(a * dim, b * dim);
      Eigen::Matrix<double, dim, dim> block = lambda * s + mu * s.transpose();
      block.diagonal().array() += mu * s.trace();
      stiffness.template block<dim, dim>(a * dim, b * dim) = block;
    }
}

} // namespace

void elementStiffness(CellType type, std::span<const Point> points, Physics physics,
                      const scene::Material& material, Eigen::MatrixXd& stiffness) {
  assert(fits(type, physics));
  withShape(type, [&](auto shape) {
    using Shape = decltype(shape);
    const int size = physics == Physics::membrane ? Shape::numNodes : numGradients<Shape>;
    stiffness.resize(size, size);
    if (physics == Physics::membrane) {
      membraneStiffness<Shape>(points, material.conductivity, stiffness);
    } else {
      const auto [lambda, mu] = lameConstants(physics, material);
      const double thickness = thicknessOf(physics, material);
      elasticStiffness<Shape>(points, thickness * lambda, thickness * mu, stiffness);
    }
  });
  mirror(stiffness);
}

void bodyForceLoad(CellType type, std::span<const Point> points, Physics physics,
                   const scene::Material& material, const scene::Vector3& force, Eigen::VectorXd& load) {
  assert(fits(type, physics));
  withShape(type, [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape>(points);
    typename Shape::Values integrals = Shape::Values::Zero(); // ∫N_a
    for (const auto& sample : fineSamples<Shape>())
      integrals += (sample.weight * ElementMap<Shape>(corners, sample).determinant()) * sample.values;
    shareOut({integrals.data(), Shape::numNodes}, physics, material, force, load);
  });
}

void tractionLoad(CellType facet, std::span<const Point> points, Physics physics,
                  const scene::Material& material, const scene::Vector3& traction, Eigen::VectorXd& load) {
  assert(boundsElement(facet, physics));
  std::array<double, mostFacetNodes> shares{};
  const auto own = std::span(shares).first(points.size());
  nodalShares(facet, points, own);
  shareOut(own, physics, material, traction, load);
}

void pressureLoad(CellType facet, std::span<const Point> points, Physics physics,
                  const scene::Material& material, double pressure, Eigen::VectorXd& load) {
  assert(boundsElement(facet, physics) && physics != Physics::membrane);
  withFacetShape(facet, [&](auto shape) {
    using Shape = decltype(shape);
    constexpr int components = Shape::dimension + 1;
    const auto corners = relativeCorners<Shape, components>(points);
    Eigen::Matrix<double, components, Shape::numNodes> forces;
    forces.setZero();
    const double factor = -pressure * thicknessOf(physics, material);
    for (const auto& sample : fineSamples<Shape>())
      forces += (factor * sample.weight * facetNormal<Shape>(corners, sample)) * sample.values.transpose();
    load = forces.reshaped();
  });
}

} // namespace epafi::fem
