#include "epafi/fem/ElementIntegrals.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numbers>

namespace epafi::fem {
namespace {

/// S: products of all shape functions' derivatives, row and column node × dimension + direction. Isotropic
/// stiffnesses are sums of its entries.
template <int dim>
using GradientProducts =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, dim* static_cast<int>(mesh::mostNodes),
                  dim* static_cast<int>(mesh::mostNodes)>;

[[maybe_unused]] bool fits(mesh::CellType type, Physics physics) {
  return dimensionOf(type) == (physics == Physics::elasticity3d ? 3 : 2);
}

[[maybe_unused]] bool boundsElement(mesh::CellType facet, Physics physics) {
  return dimensionOf(facet) + 1 == dimensionOf(physics);
}

/// What a volume or area is multiplied with at a point: 2πr of a solid of revolution.
double factorAt(Physics physics, std::span<const Point> points, const mesh::NodalValues& values) {
  return physics == Physics::axisymmetric ? mesh::circumferenceAt(points, values) : 1;
}

/// What is given at the nodes, in between; 1 where nothing is given.
double factorAt(std::span<const double> factors, const mesh::NodalValues& values) {
  return factors.empty() ? 1 : values.dot(Eigen::Map<const Eigen::VectorXd>(factors.data(), values.size()));
}

/// Load of a constant force of which each node bears its share.
void shareOut(std::span<const double> shares, Physics physics, const Material& material, const Vector3& force,
              Eigen::VectorXd& load) {
  const std::size_t components = componentsOf(physics);
  const double thickness = thicknessOf(physics, material);
  load.resize(shares.size() * components);
  for (std::size_t a = 0; a < shares.size(); ++a)
    for (std::size_t i = 0; i < components; ++i)
      load[a * components + i] = thickness * shares[a] * force[i];
}

/// Of stiffnesses; of triangles of order 1 of a solid of revolution more than the one point of the plane, in
/// which a turn about it would cost no energy.
template <int dim>
const typename mesh::Shape<dim>::Samples& stiffnessSamples(const mesh::Shape<dim>& shape, Physics physics,
                                                           Integration integration) {
  if (integration == Integration::reduced)
    return shape.reducedSamples();
  return physics == Physics::axisymmetric && shape.gaussSamples().size() == 1 ? shape.revolvedSamples()
                                                                              : shape.gaussSamples();
}

/// Of loads.
template <int dim>
const typename mesh::Shape<dim>::Samples& loadSamples(const mesh::Shape<dim>& shape, Physics physics,
                                                      Integration integration) {
  return integration == Integration::reduced ? shape.reducedSamples()
         : physics == Physics::axisymmetric  ? shape.revolvedSamples()
                                             : shape.fineSamples();
}

/// S = ∫ s g gᵀ, s the factor, g = (∂N_0/∂x, ∂N_0/∂y, …, ∂N_1/∂x, …); blocks on the diagonal and above.
template <int dim>
GradientProducts<dim> gradientProducts(const mesh::Shape<dim>& shape, std::span<const Point> points,
                                       Integration integration, std::span<const double> factors) {
  const auto corners = mesh::relativeCorners<dim>(points);
  const int size = dim * shape.numNodes;
  GradientProducts<dim> products(size, size);
  products.setZero();
  for (const auto& sample : stiffnessSamples(shape, Physics::elasticity3d, integration)) {
    const mesh::ElementMap map(corners, sample);
    const mesh::NodalColumns<dim> gradients = map.gradients(sample);
    const Eigen::Map<const Eigen::VectorXd> g(gradients.data(), size);
    const double weight = sample.weight * map.determinant() * factorAt(factors, sample.values);
    for (int column = 0; column < size; ++column) {
      const int above = (column / dim + 1) * dim;
      products.col(column).head(above) += (weight * g[column]) * g.head(above);
    }
  }
  return products;
}

/// The lower triangle becomes the mirror image of the upper one.
template <class Matrix>
void mirror(Matrix& matrix) {
  for (Eigen::Index column = 0; column < matrix.cols(); ++column)
    for (Eigen::Index row = 0; row < column; ++row)
      matrix(column, row) = matrix(row, column);
}

/// K_a,b = κ Σ_k S_ak,bk
template <int dim>
void membraneStiffness(const GradientProducts<dim>& products, double conductivity,
                       Eigen::MatrixXd& stiffness) {
  for (Eigen::Index b = 0; b < stiffness.cols(); ++b)
    for (Eigen::Index a = 0; a <= b; ++a)
      stiffness(a, b) = conductivity * products.template block<dim, dim>(a * dim, b * dim).trace();
}

/// K_ai,bj = λ S_ai,bj + μ S_aj,bi + μ δ_ij Σ_k S_ak,bk
template <int dim>
void elasticStiffness(const GradientProducts<dim>& products, double lambda, double mu,
                      Eigen::MatrixXd& stiffness) {
  for (Eigen::Index b = 0; b < stiffness.cols(); b += dim)
    for (Eigen::Index a = 0; a <= b; a += dim) {
      const Eigen::Matrix<double, dim, dim> s = products.template block<dim, dim>(a, b);
      Eigen::Matrix<double, dim, dim> block = lambda * s + mu * s.transpose();
      block.diagonal().array() += mu * s.trace();
      stiffness.template block<dim, dim>(a, b) = block;
    }
}

/// K_ai,bj = Σ C_ikjl S_ak,bl
template <int dim>
void anisotropicStiffness(const GradientProducts<dim>& products, const ElasticityMatrix& elasticity,
                          Eigen::MatrixXd& stiffness) {
  using Block = Eigen::Matrix<double, dim, dim>;
  std::array<std::array<Block, dim>, dim> c; // C_ikjl of ij, kl
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          c[i][j](k, l) = elasticity(placeInTensor[i][k], placeInTensor[j][l]);
  for (Eigen::Index b = 0; b < stiffness.cols(); b += dim)
    for (Eigen::Index a = 0; a <= b; a += dim) {
      const Block s = products.template block<dim, dim>(a, b);
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          stiffness(a + i, b + j) = c[i][j].cwiseProduct(s).sum();
    }
}

/// ∫2πr BᵀCB with ε = Bu, ε in the order rr, yy, hoop, ry.
void revolvedStiffness(const mesh::Shape<2>& shape, std::span<const Point> points, const Material& material,
                       Integration integration, std::span<const double> factors, Eigen::MatrixXd& stiffness) {
  const auto corners = mesh::relativeCorners<2>(points);
  const Eigen::Matrix4d elasticity = wholeElasticity(material).topLeftCorner<4, 4>();
  stiffness.setZero(2 * shape.numNodes, 2 * shape.numNodes);
  Eigen::Matrix4Xd strain = Eigen::Matrix4Xd::Zero(4, stiffness.cols());
  for (const auto& sample : stiffnessSamples(shape, Physics::axisymmetric, integration)) {
    const mesh::ElementMap map(corners, sample);
    const mesh::NodalColumns<2> gradients = map.gradients(sample);
    const double around = mesh::circumferenceAt(points, sample.values);
    for (Eigen::Index a = 0; a < shape.numNodes; ++a) {
      strain(0, 2 * a) = strain(3, 2 * a + 1) = gradients(0, a);
      strain(1, 2 * a + 1) = strain(3, 2 * a) = gradients(1, a);
      strain(2, 2 * a) = 2 * std::numbers::pi * sample.values[a] / around;
    }
    stiffness.noalias() += (sample.weight * around * map.determinant() * factorAt(factors, sample.values)) *
                           strain.transpose() * elasticity * strain;
  }
}

} // namespace

void elementStiffness(mesh::CellType type, std::span<const Point> points, Physics physics,
                      const Material& material, Eigen::MatrixXd& stiffness, Integration integration,
                      std::span<const double> factors) {
  assert(fits(type, physics));
  if (physics == Physics::axisymmetric) {
    revolvedStiffness(mesh::referenceShape<2>(type), points, material, integration, factors, stiffness);
    mirror(stiffness);
    return;
  }
  withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const GradientProducts<dim> products = gradientProducts(shape, points, integration, factors);
    const int size = physics == Physics::membrane ? shape.numNodes : dim * shape.numNodes;
    stiffness.resize(size, size);
    if (physics == Physics::membrane) {
      membraneStiffness<dim>(products, material.conductivity, stiffness);
    } else if (material.elasticity) {
      anisotropicStiffness<dim>(products, thicknessOf(physics, material) * elasticityIn(physics, material),
                                stiffness);
    } else {
      const auto [lambda, mu] = lameConstants(physics, material);
      const double thickness = thicknessOf(physics, material);
      elasticStiffness<dim>(products, thickness * lambda, thickness * mu, stiffness);
    }
  });
  mirror(stiffness);
}

double leastFactor(mesh::CellType type, std::span<const double> factors) {
  return withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    double least = factors.front();
    for (const auto* samples : {&shape.gaussSamples(), &shape.fineSamples(), &shape.reducedSamples()})
      for (const auto& sample : *samples)
        least = std::min(least, factorAt(factors, sample.values));
    return least;
  });
}

void bodyForceLoad(mesh::CellType type, std::span<const Point> points, Physics physics,
                   const Material& material, const Vector3& force, Eigen::VectorXd& load,
                   Integration integration) {
  assert(fits(type, physics));
  withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto corners = mesh::relativeCorners<dim>(points);
    mesh::NodalValues integrals = mesh::NodalValues::Zero(shape.numNodes); // ∫N_a
    for (const auto& sample : loadSamples(shape, physics, integration))
      integrals += (factorAt(physics, points, sample.values) * sample.weight *
                    mesh::ElementMap(corners, sample).determinant()) *
                   sample.values;
    shareOut({integrals.data(), points.size()}, physics, material, force, load);
  });
}

void rotationLoad(mesh::CellType type, std::span<const Point> points, Physics physics,
                  const Material& material, const SolidLoad& rotation, Eigen::VectorXd& load,
                  Integration integration) {
  assert(fits(type, physics) && physics != Physics::membrane);
  withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto corners = mesh::relativeCorners<dim>(points);
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < dim; ++i)
      first[i] = points[0][i] - rotation.point[i];
    const Eigen::Vector3d axis = Eigen::Map<const Eigen::Vector3d>(rotation.axis.data()).normalized();
    const double factor = rotation.value[0] * thicknessOf(physics, material);
    mesh::NodalColumns<dim> forces = mesh::NodalColumns<dim>::Zero(dim, shape.numNodes);
    for (const auto& sample : loadSamples(shape, physics, integration)) {
      Eigen::Vector3d radius = first;
      radius.template head<dim>() += corners.lazyProduct(sample.values);
      radius -= radius.dot(axis) * axis;
      const double weight = factor * factorAt(physics, points, sample.values) * sample.weight *
                            mesh::ElementMap(corners, sample).determinant();
      forces += (weight * radius.template head<dim>()).lazyProduct(sample.values.transpose());
    }
    load = forces.reshaped();
  });
}

void thermalLoad(mesh::CellType type, std::span<const Point> points, Physics physics,
                 const Material& material, std::span<const double> temperatureChange, Eigen::VectorXd& load,
                 Integration integration, std::span<const double> factors) {
  assert(fits(type, physics) && physics != Physics::membrane && temperatureChange.size() == points.size());
  const SymmetricTensor perDegree = stressOf(thermalStrain(physics, material, 1), physics, material);
  withShape(type, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto corners = mesh::relativeCorners<dim>(points);
    Eigen::Matrix<double, dim, dim> stress;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        stress(i, j) = thicknessOf(physics, material) * perDegree[placeInTensor[i][j]];
    const Eigen::Map<const Eigen::VectorXd> changes(temperatureChange.data(), shape.numNodes);
    mesh::NodalColumns<dim> forces = mesh::NodalColumns<dim>::Zero(dim, shape.numNodes);
    for (const auto& sample : stiffnessSamples(shape, physics, integration)) {
      const mesh::ElementMap map(corners, sample);
      const double weight =
          sample.weight * map.determinant() * factorAt(factors, sample.values) * sample.values.dot(changes);
      forces +=
          (factorAt(physics, points, sample.values) * weight * stress).lazyProduct(map.gradients(sample));
      if (physics == Physics::axisymmetric) // the hoop strain u_r/r
        forces.row(0) += (2 * std::numbers::pi * weight * perDegree[2]) * sample.values.transpose();
    }
    load = forces.reshaped();
  });
}

void tractionLoad(mesh::CellType facet, std::span<const Point> points, Physics physics,
                  const Material& material, const Vector3& traction, Eigen::VectorXd& load,
                  Integration integration) {
  assert(boundsElement(facet, physics));
  withFacetShape(facet, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto corners = mesh::relativeCorners<dim + 1>(points);
    mesh::NodalValues shares = mesh::NodalValues::Zero(shape.numNodes);
    for (const auto& sample : loadSamples(shape, physics, integration))
      shares +=
          (factorAt(physics, points, sample.values) * sample.weight * facetNormal(corners, sample).norm()) *
          sample.values;
    shareOut({shares.data(), points.size()}, physics, material, traction, load);
  });
}

std::vector<FacetSample> facetSamples(mesh::CellType facet, std::span<const Point> points, Physics physics,
                                      const Material& material) {
  assert(boundsElement(facet, physics));
  std::vector<FacetSample> samples;
  withFacetShape(facet, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto corners = mesh::relativeCorners<dim + 1>(points);
    for (const auto& sample : shape.revolvedSamples()) {
      Eigen::Vector3d place(points[0].data());
      place.template head<dim + 1>() += corners.lazyProduct(sample.values);
      if constexpr (dim == 1)
        place.z() = 0;
      samples.push_back({thicknessOf(physics, material) * factorAt(physics, points, sample.values) *
                             sample.weight * facetNormal(corners, sample).norm(),
                         place, sample.values});
    }
  });
  return samples;
}

void pressureLoad(mesh::CellType facet, std::span<const Point> points, Physics physics,
                  const Material& material, double pressure, Eigen::VectorXd& load, Integration integration) {
  assert(boundsElement(facet, physics) && physics != Physics::membrane);
  withFacetShape(facet, [&]<int dim>(const mesh::Shape<dim>& shape) {
    const auto corners = mesh::relativeCorners<dim + 1>(points);
    mesh::NodalColumns<dim + 1> forces = mesh::NodalColumns<dim + 1>::Zero(dim + 1, shape.numNodes);
    const double factor = -pressure * thicknessOf(physics, material);
    for (const auto& sample : loadSamples(shape, physics, integration))
      forces +=
          (factor * factorAt(physics, points, sample.values) * sample.weight * facetNormal(corners, sample))
              .lazyProduct(sample.values.transpose());
    load = forces.reshaped();
  });
}

} // namespace epafi::fem
