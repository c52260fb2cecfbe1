#include "epafi/fem/FluxIntegrals.hpp"

#include "epafi/fem/FluxLaws.hpp"
#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/mesh/ElementMap.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <type_traits>
#include <vector>

namespace epafi::fem {
namespace {

/// The flux is constant, so that w = q* − q_h is linear: ∫ w:C⁻¹:w = |T|/((d+1)(d+2)) (Σ Q(w_a) + Q(Σ w_a)).
template <class Law, int dim, class Nodal>
FluxEnergies simplexEnergies(const Law& law, const mesh::Shape<dim>& shape, std::span<const Point> points,
                             std::span<const double> displacements, const Nodal& nodalFluxes) {
  const auto& sample = shape.centreSample();
  const mesh::ElementMap map(mesh::relativeCorners<dim>(points), sample);
  const typename Law::Flux flux = fluxAt(law, map, sample, displacements);
  const double measure = sample.weight * map.determinant();
  double sum = 0;
  typename Law::Flux total = Law::Flux::Zero();
  for (int a = 0; a <= dim; ++a) {
    const typename Law::Flux difference = nodalFluxes.col(a) - flux;
    sum += law.density(difference);
    total += difference;
  }
  return {measure * (sum + law.density(total)) / ((dim + 1) * (dim + 2)), measure * law.density(flux)};
}

/// By the fine rule: w is of the shape functions' kind, but where the element map is not affine, and but for
/// hoop strains.
template <class Law, int dim, class Nodal>
FluxEnergies energiesByRule(const Law& law, Physics physics, const mesh::Shape<dim>& shape,
                            std::span<const Point> points, std::span<const double> displacements,
                            const Nodal& nodalFluxes, const NodalState& state) {
  const auto corners = mesh::relativeCorners<dim>(points);
  const auto& samples = physics == Physics::axisymmetric ? shape.revolvedSamples() : shape.fineSamples();
  FluxEnergies energies;
  for (const auto& sample : samples) {
    const mesh::ElementMap map(corners, sample);
    const typename Law::Flux flux = fluxAt(law, map, sample, displacements, state);
    const double weight = sample.weight * law.around(sample) * map.determinant() / factorOf(sample, state);
    energies.difference += weight * law.density(nodalFluxes.lazyProduct(sample.values) - flux);
    energies.flux += weight * law.density(flux);
  }
  return energies;
}

/// The flux as a function of one order less than the displacements: its values at the points where it is most
/// accurate (Barlow, *Int. J. Numer. Meth. Engng* 10 (1976)), carried on to the nodes. Order 1: a constant,
/// one column. Of simplices of order 2 with straight edges the flux is such a function itself.
template <class Law, int dim>
void sampleFlux(const Law& law, const mesh::Shape<dim>& shape, std::span<const Point> points,
                std::span<const double> displacements, Eigen::MatrixXd& fluxes,
                const NodalState& state = {}) {
  const auto corners = mesh::relativeCorners<dim>(points);
  const auto at = [&](const mesh::ShapeSample<dim>& sample) {
    return fluxAt(law, mesh::ElementMap(corners, sample), sample, displacements, state);
  };
  if (shape.order == 1) {
    fluxes = at(shape.centreSample());
  } else if (shape.isSimplex) {
    for (int a = 0; a < shape.numNodes; ++a)
      fluxes.col(a) = at(shape.nodeSamples()[a]);
  } else if (!shape.isBrick) {
    Eigen::Matrix<double, Law::numFluxes, Eigen::Dynamic> sampled(Law::numFluxes,
                                                                  std::ssize(shape.gaussSamples()));
    for (Eigen::Index g = 0; g < sampled.cols(); ++g)
      sampled.col(g) = at(shape.gaussSamples()[g]);
    fluxes = sampled * shape.fromGaussToNodes().transpose();
  } else {
    const mesh::Shape<dim>& linear = referenceShape<dim>(withOrder(shape.type, 1));
    Eigen::Matrix<double, Law::numFluxes, 1 << dim> sampled;
    for (int g = 0; g < linear.numNodes; ++g)
      sampled.col(g) = at(shape.sampleAt(linear.gaussSamples()[g].xi));
    for (int a = 0; a < shape.numNodes; ++a)
      fluxes.col(a) = sampled.lazyProduct(linear.values(std::sqrt(3.0) * shape.node(a)));
  }
}

/// The columns that a linear map takes unit vectors to. \param apply  from a vector to a vector
template <class Apply>
Eigen::MatrixXd columnsOf(Eigen::Index rows, Eigen::Index columns, const Apply& apply) {
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    std::vector<double> unit(columns, 0.0);
    unit[j] = 1;
    matrix.col(j) = apply(std::span<const double>(unit));
  }
  return matrix;
}

/// D with density(q) = ‖Dq‖². The stress across the plane, which the others determine or which is 0, makes
/// the form singular in no direction.
template <class Law>
Eigen::MatrixXd rootOfDensity(const Law& law) {
  constexpr int n = Law::numFluxes;
  Eigen::MatrixXd form(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      form(i, j) = (law.density(Law::Flux::Unit(i) + Law::Flux::Unit(j)) -
                    law.density(Law::Flux::Unit(i) - Law::Flux::Unit(j))) /
                   4;
  return direct::choleskyFactor(form).value().transpose();
}

/// Gauss points of [0, 1] and their weights: exact for degree 5.
constexpr std::array<std::array<double, 2>, 3> gauss{
    {{0.11270166537925831, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074169, 5.0 / 18}}};

/// A point of the unit square or cube in the reference element; returns the factor of the weight. Of all but
/// bricks the cube's top, or its edge, shrinks to a point (Duffy).
template <int dim>
double carry(const mesh::Shape<dim>& shape, mesh::Coordinates<dim>& place) {
  if constexpr (dim == 3)
    if (!shape.isSimplex && !shape.isBrick) {
      if (numCornersOf(shape.type) == 6) {
        place = {place[0] * (1 - place[1]), place[1], 2 * place[2] - 1};
        return 2 * (1 - place[1]);
      }
      const double r = 1 - place[2];
      place = {r * (2 * place[0] - 1), r * (2 * place[1] - 1), place[2]};
      return 4 * r * r;
    }
  if (!shape.isSimplex) {
    place = 2 * place - mesh::Coordinates<dim>::Ones();
    return 1 << dim;
  }
  double rest = 1, factor = 1;
  for (int i = 0; i < dim; ++i) {
    place[i] *= rest;
    for (int k = i + 1; k < dim; ++k)
      factor *= rest - place[i] > 0 ? (rest - place[i]) / rest : 0;
    rest -= place[i];
  }
  return factor;
}

template <class Law, int dim>
DisplacementNorms normsOf(const Law& law, const mesh::Shape<dim>& shape, std::span<const Point> points,
                          std::span<const double> displacements,
                          const std::function<FieldValue(const Point&)>& exact, const NodalState& state) {
  constexpr int numPoints = dim == 2 ? 9 : 27;
  const auto corners = mesh::relativeCorners<dim>(points);
  const NodalDisplacements<Law> nodal = atNodes<Law>(displacements);
  DisplacementNorms norms;
  for (int k = 0; k < numPoints; ++k) {
    mesh::Coordinates<dim> place;
    double weight = 1;
    for (int i = 0, rest = k; i < dim; ++i, rest /= 3) {
      const auto& [at, share] = gauss[rest % 3];
      place[i] = at;
      weight *= share;
    }
    weight *= carry(shape, place);
    const mesh::ShapeSample<dim> sample = shape.sampleAt(place);
    const mesh::ElementMap map(corners, sample);
    const NodalState unheated{{}, state.stiffnessFactor};
    typename Law::Flux flux = fluxAt(law, map, sample, displacements, unheated);
    Eigen::Matrix<double, Law::components, 1> value = nodal.lazyProduct(sample.values);
    if (exact) {
      const mesh::Coordinates<dim> relative = corners.lazyProduct(sample.values);
      Point point = points[0];
      for (int i = 0; i < dim; ++i)
        point[i] += relative[i];
      const FieldValue given = exact(point);
      flux -= Eigen::Map<const typename Law::Flux>(given.flux.data());
      value -= Eigen::Map<const Eigen::Matrix<double, Law::components, 1>>(given.displacement.data());
    }
    weight *= law.around(sample) * map.determinant();
    norms.energy += weight * law.density(flux) / factorOf(sample, state);
    norms.square += weight * value.squaredNorm();
  }
  return norms;
}

} // namespace

int numFluxes(Physics physics) {
  return physics == Physics::membrane ? numMembraneFluxes : numStresses;
}

int numSampledFluxes(mesh::CellType type) {
  return orderOf(type) == 1 ? 1 : numNodesOf(type);
}

void sampledFluxes(mesh::CellType type, std::span<const Point> points, Physics physics,
                   const Material& material, std::span<const double> displacements, Eigen::MatrixXd& fluxes,
                   const NodalState& state) {
  fluxes.resize(numFluxes(physics), numSampledFluxes(type));
  withLaw(type, points, physics, material, [&](const auto& shape, const auto& law) {
    sampleFlux(law, shape, points, displacements, fluxes, state);
  });
}

void innerFluxes(mesh::CellType type, std::span<const Point> points, Physics physics,
                 const Material& material, std::span<const double> displacements, InnerFluxes& inner,
                 const NodalState& state) {
  withLaw(type, points, physics, material, [&]<int dim>(const mesh::Shape<dim>& shape, const auto& law) {
    const auto corners = mesh::relativeCorners<dim>(points);
    const auto& samples = shape.reducedSamples();
    inner.places.setZero(3, samples.size());
    inner.fluxes.resize(std::decay_t<decltype(law)>::numFluxes, samples.size());
    for (Eigen::Index k = 0; k < std::ssize(samples); ++k) {
      inner.places.col(k).template head<dim>() = corners.lazyProduct(samples[k].values);
      inner.fluxes.col(k) =
          fluxAt(law, mesh::ElementMap(corners, samples[k]), samples[k], displacements, state);
    }
  });
}

double quadraticEnergy(mesh::CellType type, std::span<const Point> points, Physics physics,
                       const Material& material, std::span<const double> displacements,
                       std::span<const double> stiffnessFactor) {
  return withLaw(type, points, physics, material,
                 [&]<int dim>(const mesh::Shape<dim>& shape, const auto& law) {
                   using Law = std::decay_t<decltype(law)>;
                   const auto corners = mesh::relativeCorners<dim>(points);
                   const Eigen::MatrixXd& shares = mesh::cornerShares(type);
                   Eigen::Matrix<double, Law::components, Eigen::Dynamic> part = atNodes<Law>(displacements);
                   part -= (part.leftCols(shares.cols()) * shares.transpose()).eval();
                   const std::span<const double> values(part.data(), static_cast<std::size_t>(part.size()));
                   const NodalState state{{}, stiffnessFactor};
                   double energy = 0;
                   for (const auto& sample : shape.gaussSamples()) {
                     const mesh::ElementMap map(corners, sample);
                     energy += sample.weight * law.around(sample) * map.determinant() *
                               law.density(fluxAt(law, map, sample, values, state)) / factorOf(sample, state);
                   }
                   return energy;
                 });
}

FluxEnergies fluxEnergies(mesh::CellType type, std::span<const Point> points, Physics physics,
                          const Material& material, std::span<const double> displacements,
                          const Eigen::Ref<const Eigen::MatrixXd>& nodalFluxes, const NodalState& state) {
  return withLaw(type, points, physics, material, [&](const auto& shape, const auto& law) {
    using Law = std::decay_t<decltype(law)>;
    assert(nodalFluxes.rows() == Law::numFluxes && nodalFluxes.cols() == shape.numNodes);
    const Eigen::Map<const Eigen::Matrix<double, Law::numFluxes, Eigen::Dynamic>, 0, Eigen::OuterStride<>>
        fluxes(nodalFluxes.data(), Law::numFluxes, nodalFluxes.cols(),
               Eigen::OuterStride<>(nodalFluxes.outerStride()));
    return shape.isSimplex && shape.order == 1 && physics != Physics::axisymmetric &&
                   state.temperatureChange.empty() && state.stiffnessFactor.empty()
               ? simplexEnergies(law, shape, points, displacements, fluxes)
               : energiesByRule(law, physics, shape, points, displacements, fluxes, state);
  });
}

CongruentFluxes::CongruentFluxes(mesh::CellType type, std::span<const Point> points, Physics physics,
                                 const Material& material) {
  elementStiffness(type, points, physics, material, stiffness_);
  const Eigen::Index unknowns = stiffness_.rows();
  withLaw(type, points, physics, material, [&]<int dim>(const mesh::Shape<dim>& shape, const auto& law) {
    constexpr int numFluxes = std::decay_t<decltype(law)>::numFluxes;
    const auto corners = mesh::relativeCorners<dim>(points);
    const Eigen::MatrixXd root = rootOfDensity(law);
    const Eigen::Index numSampled = numSampledFluxes(type), components = unknowns / shape.numNodes;
    const Eigen::MatrixXd& shares = mesh::cornerShares(type);
    linear_.setZero(unknowns, unknowns);
    for (Eigen::Index a = 0; a < shares.rows(); ++a)
      for (Eigen::Index b = 0; b < shares.cols(); ++b)
        linear_.block(a * components, b * components, components, components)
            .diagonal()
            .setConstant(shares(a, b));
    sampled_ = columnsOf(numFluxes * numSampled, unknowns, [&](std::span<const double> u) {
      Eigen::MatrixXd fluxes(numFluxes, numSampled);
      sampleFlux(law, shape, points, u, fluxes);
      return Eigen::VectorXd(fluxes.reshaped());
    });
    const Eigen::Index numSamples = shape.fineSamples().size();
    ofFluxes_.resize(numFluxes * numSamples, numFluxes * shape.numNodes);
    ofDisplacement_.resize(numFluxes * numSamples, unknowns);
    Eigen::Index row = 0;
    for (const auto& sample : shape.fineSamples()) {
      const mesh::ElementMap map(corners, sample);
      const double size = std::sqrt(sample.weight * map.determinant());
      for (int a = 0; a < shape.numNodes; ++a)
        ofFluxes_.block(row, a * numFluxes, numFluxes, numFluxes) = size * sample.values[a] * root;
      ofDisplacement_.middleRows(row, numFluxes) =
          size * root * columnsOf(numFluxes, unknowns, [&](std::span<const double> u) {
            return fluxAt(law, map, sample, u);
          });
      row += numFluxes;
    }
  });
}

Eigen::VectorXd CongruentFluxes::differences(const Eigen::MatrixXd& displacements,
                                             const Eigen::MatrixXd& nodalFluxes) const {
  Eigen::MatrixXd weighted = ofFluxes_ * nodalFluxes;
  weighted.noalias() -= ofDisplacement_ * displacements;
  return weighted.colwise().squaredNorm().transpose();
}

Eigen::VectorXd CongruentFluxes::quadraticEnergies(const Eigen::MatrixXd& displacements) const {
  const Eigen::MatrixXd part = displacements - linear_ * displacements;
  return part.cwiseProduct(stiffness_ * part).colwise().sum().transpose();
}

DisplacementNorms differenceNorms(mesh::CellType type, std::span<const Point> points, Physics physics,
                                  const Material& material, std::span<const double> displacements,
                                  const std::function<FieldValue(const Point&)>& exact,
                                  const NodalState& state) {
  return withLaw(type, points, physics, material, [&](const auto& shape, const auto& law) {
    return normsOf(law, shape, points, displacements, exact, state);
  });
}

} // namespace epafi::fem
