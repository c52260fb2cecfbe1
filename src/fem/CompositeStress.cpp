#include "epafi/fem/CompositeStress.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>

namespace epafi::fem {

using mesh::CellType;

namespace {

/// D of the components that an element has; shear strains are angles.
Eigen::MatrixXd lawOf(Physics physics, const Material& material) {
  if (physics == Physics::membrane)
    return material.conductivity * Eigen::MatrixXd::Identity(2, 2);
  if (physics == Physics::elasticity3d)
    return wholeElasticity(material);
  Eigen::MatrixXd law(3, 3);
  if (material.elasticity) {
    const ElasticityMatrix whole = elasticityIn(physics, material);
    const std::array<int, 3> plane{0, 1, 3};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        law(i, j) = whole(plane.at(i), plane.at(j));
  } else {
    const LameConstants lame = lameConstants(physics, material);
    law << lame.lambda + 2 * lame.mu, lame.lambda, 0, lame.lambda, lame.lambda + 2 * lame.mu, 0, 0, 0,
        lame.mu;
  }
  return thicknessOf(physics, material) * law;
}

/// Components of F τ̂ Fᵀ/J, of a membrane F q̂/J.
Eigen::MatrixXd piolaOf(const Eigen::MatrixXd& f, int components, int numFluxes) {
  if (components == 1)
    return f / f.determinant();
  Eigen::MatrixXd piola = Eigen::MatrixXd::Zero(numFluxes, numFluxes);
  for (int a = 0; a < components; ++a)
    for (int b = a; b < components; ++b)
      for (int c = 0; c < components; ++c)
        for (int d = 0; d < components; ++d)
          piola(placeInFlux(a, b, components), placeInFlux(c, d, components)) += f(a, c) * f(b, d);
  return piola / f.determinant();
}

template <int dim>
Eigen::MatrixXd mapTo(CellType type, std::span<const Point> points, int components,
                      std::vector<Eigen::MatrixXd>& through) {
  const mesh::NodalColumns<dim> corners = mesh::relativeCorners<dim>(points);
  for (const mesh::Facet& facet : facetsOf(type)) {
    mesh::NodalColumns<dim> its(dim, facet.size());
    for (int i = 0; i < std::ssize(facet); ++i)
      its.col(i) = corners.col(facet[i]);
    through.push_back(throughFacet(
        mesh::facetNormal<dim - 1>(its, mesh::referenceShape<dim - 1>(facet.type).centreSample()),
        components));
  }
  return mesh::ElementMap<dim>(corners, mesh::referenceShape<dim>(type).centreSample()).jacobian();
}

} // namespace

CellStress::CellStress(CellType type, std::span<const Point> points, Physics physics,
                       const Material& material)
    : cell_(&CompositeCell::of(type, componentsOf(physics))), law_(lawOf(physics, material)) {
  jacobian_ = (cell_->dimension == 2 ? mapTo<2> : mapTo<3>)(type, points, cell_->components, through_);
  inverse_ = jacobian_.inverse();
}

double CellStress::measure() const {
  return jacobian_.determinant() * cell_->shares.sum();
}

/// On the reference element data are F⁻¹ times the tractions and J F⁻¹ times the load; of a membrane the same
/// and J.
const Eigen::MatrixXd& CellStress::energy() const {
  if (energy_.size() > 0)
    return energy_;
  const double determinant = jacobian_.determinant();
  const Eigen::Index numData = cell_->numData(), components = cell_->components;
  const Eigen::MatrixXd piola = piolaOf(jacobian_, cell_->components, cell_->numFluxes),
                        weights = determinant * piola.transpose() * law_.inverse() * piola;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(cell_->stresses.cols(), cell_->stresses.cols());
  for (int k = 0, pair = 0; k < cell_->numFluxes; ++k)
    for (int l = k; l < cell_->numFluxes; ++l, ++pair)
      whole += weights(k, l) * cell_->products[pair];
  const Eigen::Index numFree = whole.rows() - numData;
  energy_ = whole.topLeftCorner(numData, numData);
  if (numFree > 0)
    energy_.noalias() -= whole.topRightCorner(numData, numFree) *
                         direct::inverseOfSpd(whole.bottomRightCorner(numFree, numFree)) *
                         whole.bottomLeftCorner(numFree, numData);
  for (int side = 0; side < 2; ++side) {
    for (Eigen::Index i = 0; components > 1 && i < numData; i += components)
      energy_.middleRows(i, components) = inverse_.transpose() * energy_.middleRows(i, components).eval();
    energy_.bottomRows(components) *= determinant;
    energy_.transposeInPlace();
  }
  return energy_;
}

Eigen::VectorXd CellStress::stressOf(const Eigen::MatrixXd& gradient) const {
  Eigen::VectorXd strain = Eigen::VectorXd::Zero(cell_->numFluxes);
  for (int i = 0; i < cell_->components; ++i)
    for (int j = 0; j < cell_->dimension; ++j)
      strain[placeInFlux(i, j, cell_->components)] += gradient(i, j);
  return law_ * strain;
}

Eigen::VectorXd CellStress::tractions(const Eigen::VectorXd& displacements) const {
  const Eigen::Index dimension = cell_->dimension, perFacet = cell_->facetShares.rows();
  const Eigen::MatrixXd slopes =
      displacements.reshaped(cell_->components, cell_->shares.size()) * cell_->facetGradients.transpose();
  Eigen::MatrixXd result(cell_->components, cell_->numFacets * cell_->perFacet),
      stresses(cell_->numFluxes, perFacet);
  for (Eigen::Index k = 0; k < cell_->numFacets; ++k) {
    for (Eigen::Index g = 0; g < perFacet; ++g)
      stresses.col(g) = stressOf(slopes.middleCols((k * perFacet + g) * dimension, dimension) * inverse_);
    result.middleCols(k * cell_->perFacet, cell_->perFacet).noalias() =
        through_[k] * (stresses * cell_->facetShares);
  }
  return result.reshaped();
}

/// As the data are in balance, ∫ τ:ε(v) is their work at v, and ‖τ − σ‖² = ‖τ‖² − 2∫ τ:ε(u) + ‖σ‖².
double CellStress::difference(double energy, const Eigen::VectorXd& data,
                              const Eigen::VectorXd& displacements, const Eigen::MatrixXd& stiffness) const {
  const Eigen::Index components = cell_->components;
  const auto nodal = displacements.reshaped(components, cell_->shares.size());
  double work = data.tail(components).dot(nodal * cell_->shares) * jacobian_.determinant();
  Eigen::Index at = 0;
  for (const mesh::Facet& facet : facetsOf(cell_->type))
    for (const int node : facet) {
      work += data.segment(at, components).dot(nodal.col(node));
      at += components;
    }
  return std::max(0.0, energy - 2 * work + displacements.dot(stiffness * displacements));
}

} // namespace epafi::fem
