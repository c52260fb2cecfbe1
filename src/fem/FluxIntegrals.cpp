#include "epafi/fem/FluxIntegrals.hpp"

#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <Eigen/Cholesky>

#include <array>
#include <cassert>
#include <cmath>
#include <type_traits>

namespace epafi::fem {
namespace {

using scene::Physics;

constexpr int numMembraneFluxes = 2, numStresses = 6;

/// Flux κ∇u of a membrane on elements of a shape, and the density of its energy.
template <class Shape>
struct MembraneLaw {
  static constexpr int numFluxes = numMembraneFluxes, components = 1;
  using Flux = Eigen::Matrix<double, numFluxes, 1>;
  using Gradient = Eigen::Matrix<double, components, Shape::dimension>;

  MembraneLaw(Physics /*physics*/, const scene::Material& material) : conductivity(material.conductivity) {}
  [[nodiscard]] Flux flux(const Gradient& gradient) const { return conductivity * gradient.transpose(); }
  [[nodiscard]] double density(const Flux& q) const { return q.squaredNorm() / conductivity; }

  double conductivity;
};

/// Stress of an elastic body. For plane strain the stress across the plane is part of the sum, with which the law of
/// space holds; for plane stress it is 0.
template <class Shape>
struct ElasticLaw {
  static constexpr int numFluxes = numStresses, components = Shape::dimension;
  using Flux = Eigen::Matrix<double, numFluxes, 1>;
  using Gradient = Eigen::Matrix<double, components, Shape::dimension>;

  ElasticLaw(Physics bodyPhysics, const scene::Material& bodyMaterial)
      : physics(bodyPhysics), material(bodyMaterial), thickness(thicknessOf(bodyPhysics, bodyMaterial)) {}
  [[nodiscard]] Flux flux(const Gradient& gradient) const {
    Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
    whole.template topLeftCorner<components, components>() = gradient;
    const SymmetricTensor stress = stressOf(whole, physics, material);
    return Eigen::Map<const Flux>(stress.data());
  }
  /// σ:C⁻¹:σ = ((1 + ν) σ:σ − ν tr(σ)²)/E
  [[nodiscard]] double density(const Flux& q) const {
    const double trace = q[0] + q[1] + q[2];
    const double square = q.template head<3>().squaredNorm() + 2 * q.template tail<3>().squaredNorm();
    const double ratio = material.poissonsRatio;
    return thickness * ((1 + ratio) * square - ratio * trace * trace) / material.youngsModulus;
  }

  Physics physics;
  const scene::Material& material;
  double thickness;
};

template <class Shape, class Law>
typename Law::Gradient gradientAt(const ElementMap<Shape>& map, const ShapeSample<Shape>& sample,
                                  std::span<const double> displacements) {
  const Eigen::Map<const Eigen::Matrix<double, Law::components, Shape::numNodes>> nodal(displacements.data());
  const typename Law::Gradient inReference = nodal * sample.gradients.transpose();
  return inReference * map.jacobian().inverse();
}

/// The flux is constant, so that w = q* − q_h is linear: ∫ w:C⁻¹:w = |T|/((d+1)(d+2)) (Σ Q(w_a) + Q(Σ w_a)).
template <class Shape, class Law, class Nodal>
FluxEnergies simplexEnergies(const Law& law, std::span<const Point> points,
                             std::span<const double> displacements, const Nodal& nodalFluxes) {
  const auto& sample = centreSample<Shape>();
  const ElementMap<Shape> map(relativeCorners<Shape>(points), sample);
  const typename Law::Flux flux = law.flux(gradientAt<Shape, Law>(map, sample, displacements));
  const double measure = sample.weight * map.determinant();
  double sum = 0;
  typename Law::Flux total = Law::Flux::Zero();
  for (int a = 0; a < Shape::numNodes; ++a) {
    const typename Law::Flux difference = nodalFluxes.col(a) - flux;
    sum += law.density(difference);
    total += difference;
  }
  return {measure * (sum + law.density(total)) / (Shape::numNodes * (Shape::numNodes + 1)),
          measure * law.density(flux)};
}

/// By the fine rule: w is of the shape functions' kind, but where the element map is not affine.
template <class Shape, class Law, class Nodal>
FluxEnergies energiesByRule(const Law& law, std::span<const Point> points,
                            std::span<const double> displacements, const Nodal& nodalFluxes) {
  const auto corners = relativeCorners<Shape>(points);
  FluxEnergies energies;
  for (const auto& sample : fineSamples<Shape>()) {
    const ElementMap<Shape> map(corners, sample);
    const typename Law::Flux flux = law.flux(gradientAt<Shape, Law>(map, sample, displacements));
    const double weight = sample.weight * map.determinant();
    energies.difference += weight * law.density(nodalFluxes * sample.values - flux);
    energies.flux += weight * law.density(flux);
  }
  return energies;
}

/// The flux as a function of one order less than the displacements: its values at the points where it is most accurate
/// (Barlow, *Int. J. Numer. Meth. Engng* 10 (1976)), carried on to the nodes. Order 1: a constant, one column. Of simplices of
/// order 2 with straight edges the flux is such a function itself.
template <class Shape, class Law, class Fluxes>
void sampleFlux(const Law& law, std::span<const Point> points, std::span<const double> displacements,
                Fluxes& fluxes) {
  const auto corners = relativeCorners<Shape>(points);
  const auto at = [&](const ShapeSample<Shape>& sample) -> typename Law::Flux {
    return law.flux(gradientAt<Shape, Law>(ElementMap<Shape>(corners, sample), sample, displacements));
  };
  if constexpr (Shape::order == 1) {
    fluxes = at(centreSample<Shape>());
  } else if constexpr (Shape::isSimplex) {
    for (Eigen::Index a = 0; a < Shape::numNodes; ++a)
      fluxes.col(a) = at(nodeSamples<Shape>()[static_cast<std::size_t>(a)]);
  } else {
    using Linear = Brick<Shape::dimension>;
    static const auto samples = [] {
      std::array<ShapeSample<Shape>, static_cast<std::size_t>(Linear::numNodes)> all;
      for (std::size_t g = 0; g < all.size(); ++g)
        all[g] = sampleAt<Shape>(Linear::gaussPoints()[g].xi);
      return all;
    }();
    Eigen::Matrix<double, Law::numFluxes, Linear::numNodes> sampled;
    for (std::size_t g = 0; g < samples.size(); ++g)
      sampled.col(static_cast<Eigen::Index>(g)) = at(samples[g]);
    for (int a = 0; a < Shape::numNodes; ++a)
      fluxes.col(a) = sampled * Linear::values(std::sqrt(3.0) * Shape::node(a));
  }
}

/// The columns that a linear map takes unit vectors to. \param apply  from a vector to a vector
template <class Apply>
Eigen::MatrixXd columnsOf(Eigen::Index rows, Eigen::Index columns, const Apply& apply) {
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    matrix.col(j) = apply(Eigen::VectorXd(Eigen::VectorXd::Unit(columns, j)));
  return matrix;
}

/// D with density(q) = ‖Dq‖². The stress across the plane, which the others determine or which is 0, makes the form
/// singular in no direction.
template <class Law>
Eigen::MatrixXd rootOfDensity(const Law& law) {
  constexpr int n = Law::numFluxes;
  Eigen::Matrix<double, n, n> form;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      form(i, j) = (law.density(Law::Flux::Unit(i) + Law::Flux::Unit(j)) -
                    law.density(Law::Flux::Unit(i) - Law::Flux::Unit(j))) /
                   4;
  return form.llt().matrixU();
}

/// Gauss points of [0, 1] and their weights: exact for degree 5.
constexpr std::array<std::array<double, 2>, 3> gauss{
    {{0.11270166537925831, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074169, 5.0 / 18}}};

template <int dim>
using Place = Eigen::Matrix<double, dim, 1>;

/// A point of the unit square or cube in the reference element; returns the factor of the weight.
template <int dim, int order>
double carry(Brick<dim, order> /*shape*/, Place<dim>& place) {
  place = 2 * place - Place<dim>::Ones();
  return 1 << dim;
}

/// The cube's top shrinks to a point (Duffy).
template <int dim, int order>
double carry(Simplex<dim, order> /*shape*/, Place<dim>& place) {
  double rest = 1, factor = 1;
  for (int i = 0; i < dim; ++i) {
    place[i] *= rest;
    for (int k = i + 1; k < dim; ++k)
      factor *= rest - place[i] > 0 ? (rest - place[i]) / rest : 0;
    rest -= place[i];
  }
  return factor;
}

template <class Shape, class Law>
DisplacementNorms normsOf(const Law& law, std::span<const Point> points,
                          std::span<const double> displacements,
                          const std::function<FieldValue(const Point&)>& exact) {
  constexpr int dim = Shape::dimension, numPoints = dim == 2 ? 9 : 27;
  const auto corners = relativeCorners<Shape>(points);
  const Eigen::Map<const Eigen::Matrix<double, Law::components, Shape::numNodes>> nodal(displacements.data());
  DisplacementNorms norms;
  for (int k = 0; k < numPoints; ++k) {
    Place<dim> place;
    double weight = 1;
    for (int i = 0, rest = k; i < dim; ++i, rest /= 3) {
      const auto& [at, share] = gauss[static_cast<std::size_t>(rest % 3)];
      place[i] = at;
      weight *= share;
    }
    weight *= carry(Shape{}, place);
    const ShapeSample<Shape> sample = sampleAt<Shape>(place);
    const ElementMap<Shape> map(corners, sample);
    typename Law::Flux flux = law.flux(gradientAt<Shape, Law>(map, sample, displacements));
    Eigen::Matrix<double, Law::components, 1> value = nodal * sample.values;
    if (exact) {
      const Place<dim> relative = corners * sample.values;
      Point point = points[0];
      for (int i = 0; i < dim; ++i)
        point[static_cast<std::size_t>(i)] += relative[i];
      const FieldValue given = exact(point);
      flux -= Eigen::Map<const typename Law::Flux>(given.flux.data());
      value -= Eigen::Map<const Eigen::Matrix<double, Law::components, 1>>(given.displacement.data());
    }
    weight *= map.determinant();
    norms.energy += weight * law.density(flux);
    norms.square += weight * value.squaredNorm();
  }
  return norms;
}

/// action(shape, law) for a type of cell and a physics.
template <class Action>
decltype(auto) withLaw(CellType type, Physics physics, const scene::Material& material, Action&& action) {
  assert(dimensionOf(type) == (physics == Physics::elasticity3d ? 3 : 2));
  return withShape(type, [&](auto shape) {
    using Shape = decltype(shape);
    if constexpr (Shape::dimension == 2)
      if (physics == Physics::membrane)
        return action(shape, MembraneLaw<Shape>(physics, material));
    return action(shape, ElasticLaw<Shape>(physics, material));
  });
}

} // namespace

int numFluxes(Physics physics) {
  return physics == Physics::membrane ? numMembraneFluxes : numStresses;
}

int numSampledFluxes(CellType type) {
  return orderOf(type) == 1 ? 1 : numNodesOf(type);
}

void sampledFluxes(CellType type, std::span<const Point> points, Physics physics,
                   const scene::Material& material, std::span<const double> displacements,
                   Eigen::MatrixXd& fluxes) {
  fluxes.resize(numFluxes(physics), numSampledFluxes(type));
  withLaw(type, physics, material, [&](auto shape, const auto& law) {
    sampleFlux<decltype(shape)>(law, points, displacements, fluxes);
  });
}

FluxEnergies fluxEnergies(CellType type, std::span<const Point> points, Physics physics,
                          const scene::Material& material, std::span<const double> displacements,
                          const Eigen::Ref<const Eigen::MatrixXd>& nodalFluxes) {
  return withLaw(type, physics, material, [&](auto shape, const auto& law) {
    using Shape = decltype(shape);
    using Law = std::decay_t<decltype(law)>;
    assert(nodalFluxes.rows() == Law::numFluxes && nodalFluxes.cols() == Shape::numNodes);
    const Eigen::Map<const Eigen::Matrix<double, Law::numFluxes, Shape::numNodes>, 0, Eigen::OuterStride<>>
        fluxes(nodalFluxes.data(), Eigen::OuterStride<>(nodalFluxes.outerStride()));
    if constexpr (Shape::isSimplex && Shape::order == 1)
      return simplexEnergies<Shape>(law, points, displacements, fluxes);
    else
      return energiesByRule<Shape>(law, points, displacements, fluxes);
  });
}

CongruentFluxes::CongruentFluxes(CellType type, std::span<const Point> points, Physics physics,
                                 const scene::Material& material) {
  elementStiffness(type, points, physics, material, stiffness_);
  const Eigen::Index unknowns = stiffness_.rows();
  withLaw(type, physics, material, [&](auto shape, const auto& law) {
    using Shape = decltype(shape);
    using Law = std::decay_t<decltype(law)>;
    const auto corners = relativeCorners<Shape>(points);
    const Eigen::MatrixXd root = rootOfDensity(law);
    const auto fluxAt = [&](const ShapeSample<Shape>& sample, const Eigen::VectorXd& u) {
      return law.flux(gradientAt<Shape, Law>(ElementMap<Shape>(corners, sample), sample,
                                             {u.data(), static_cast<std::size_t>(u.size())}));
    };
    const Eigen::Index numSampled = numSampledFluxes(type);
    sampled_ = columnsOf(Law::numFluxes * numSampled, unknowns, [&](const Eigen::VectorXd& u) {
      Eigen::MatrixXd fluxes(Law::numFluxes, numSampled);
      sampleFlux<Shape>(law, points, {u.data(), static_cast<std::size_t>(u.size())}, fluxes);
      return Eigen::VectorXd(fluxes.reshaped());
    });
    const auto add = [&](const ShapeSample<Shape>& sample, double weight) {
      const Eigen::Index row = ofFluxes_.rows();
      ofFluxes_.conservativeResize(row + Law::numFluxes, Law::numFluxes * Shape::numNodes);
      ofDisplacement_.conservativeResize(row + Law::numFluxes, unknowns);
      for (int a = 0; a < Shape::numNodes; ++a)
        ofFluxes_.block(row, a * Law::numFluxes, Law::numFluxes, Law::numFluxes) =
            std::sqrt(weight) * sample.values[a] * root;
      ofDisplacement_.bottomRows(Law::numFluxes) =
          std::sqrt(weight) * root *
          columnsOf(Law::numFluxes, unknowns, [&](const Eigen::VectorXd& u) { return fluxAt(sample, u); });
    };
    for (const auto& sample : fineSamples<Shape>())
      add(sample, sample.weight * ElementMap<Shape>(corners, sample).determinant());
  });
}

Eigen::VectorXd CongruentFluxes::differences(const Eigen::MatrixXd& displacements,
                                             const Eigen::MatrixXd& nodalFluxes) const {
  Eigen::MatrixXd weighted = ofFluxes_ * nodalFluxes;
  weighted.noalias() -= ofDisplacement_ * displacements;
  return weighted.colwise().squaredNorm().transpose();
}

DisplacementNorms differenceNorms(CellType type, std::span<const Point> points, Physics physics,
                                  const scene::Material& material, std::span<const double> displacements,
                                  const std::function<FieldValue(const Point&)>& exact) {
  return withLaw(type, physics, material, [&](auto shape, const auto& law) {
    return normsOf<decltype(shape)>(law, points, displacements, exact);
  });
}

} // namespace epafi::fem
