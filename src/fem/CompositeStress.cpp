#include "epafi/fem/CompositeStress.hpp"

#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <Eigen/LU>

#include <array>
#include <cassert>
#include <map>
#include <memory>
#include <utility>

namespace epafi::fem {

using mesh::CellType;

Eigen::MatrixXd throughLine(const Eigen::Vector2d& normal, int components) {
  if (components == 1)
    return normal.transpose();
  Eigen::MatrixXd through(2, 3);
  through << normal[0], 0, normal[1], 0, normal[1], normal[0];
  return through;
}

namespace {

using Along = mesh::Coordinates<1>;

/// The triangle between an edge of the reference element and its centre.
struct Part {
  Eigen::Vector2d first, second, centre;

  Part(const mesh::Shape<2>& cell, const mesh::Facet& facet)
      : first(cell.node(facet[0])), second(cell.node(facet[1])), centre(cell.centre()) {}
  [[nodiscard]] Eigen::Matrix2d jacobian() const {
    Eigen::Matrix2d columns;
    columns << second - first, centre - first;
    return columns;
  }
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& local) const { return first + jacobian() * local; }
};

Eigen::Vector2d normalOf(const Eigen::Vector2d& edge) {
  return {edge[1], -edge[0]};
}

/// Points of the unit triangle, with weights of which the sum is ½.
std::vector<std::pair<Eigen::Vector2d, double>> triangleRule(bool isSixth) {
  std::vector<std::pair<Eigen::Vector2d, double>> rule;
  if (!isSixth)
    for (const auto& sample : mesh::referenceShape<2>(CellType::triangle6).fineSamples())
      rule.emplace_back(sample.xi, sample.weight);
  else
    for (const auto& [x, a] : fourGauss)
      for (const auto& [y, b] : fourGauss)
        rule.emplace_back(Eigen::Vector2d(x, (1 - x) * y), a * b * (1 - x));
  return rule;
}

} // namespace

const CompositeCell& CompositeCell::of(CellType type, int components) {
  static std::map<std::pair<CellType, int>, std::unique_ptr<const CompositeCell>> made;
  auto& cell = made[{type, components}];
  if (!cell)
    cell.reset(new CompositeCell(type, components));
  return *cell;
}

CompositeCell::CompositeCell(CellType cellType, int numComponents)
    : type(cellType), components(numComponents), numFluxes(numComponents + 1),
      numFacets(static_cast<int>(facetsOf(cellType).size())), perFacet(mesh::nodesPerFacet(cellType)) {
  solve();
  integrate();
}

/// All conditions on a stress: tractions on edges, those between parts, balance in each part.
void CompositeCell::solve() {
  const mesh::Shape<2>& cell = mesh::referenceShape<2>(type);
  const int order = cell.order;
  const mesh::Shape<2>& part = mesh::referenceShape<2>(withOrder(CellType::triangle, order));
  const mesh::Shape<1>& edge = mesh::referenceShape<1>(withOrder(CellType::line, order));
  const std::vector<double> between = order == 1 ? std::vector<double>{0, 1} : std::vector<double>{0, 0.5, 1};
  const int perPart = part.numNodes * numFluxes, inside = order == 1 ? 1 : 3; // points of a divergence
  const Eigen::Index rowsAPart = (perFacet + static_cast<Eigen::Index>(between.size()) + inside) * components;
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(numFacets * rowsAPart, numFacets * perPart);
  Eigen::MatrixXd given = Eigen::MatrixXd::Zero(conditions.rows(), numData());
  const auto add = [&](Eigen::Index row, int k, const Eigen::VectorXd& values,
                       const Eigen::MatrixXd& through) {
    for (int j = 0; j < part.numNodes; ++j)
      conditions.block(row, k * perPart + j * numFluxes, components, numFluxes) += values[j] * through;
  };
  Eigen::Index row = 0;
  for (int k = 0; k < numFacets; ++k) {
    const Part own(cell, facetsOf(type)[k]);
    for (int i = 0; i < perFacet; ++i, row += components) {
      for (const auto& [along, weight] : fourGauss)
        add(row, k, weight * edge.values(Along(along))[i] * part.values(Eigen::Vector2d(along, 0)),
            throughLine(normalOf(own.second - own.first), components));
      given.block(row, (k * perFacet + i) * components, components, components).setIdentity();
    }
    const Eigen::MatrixXd through = throughLine(normalOf(own.centre - own.second), components);
    for (const double s : between) {
      add(row, k, part.values(Eigen::Vector2d(1 - s, s)), through);
      add(row, (k + 1) % numFacets, part.values(Eigen::Vector2d(0, s)), -through);
      row += components;
    }
    const Eigen::Matrix2d inverse = own.jacobian().inverse().transpose();
    for (int at = 0; at < inside; ++at, row += components) {
      const Eigen::Matrix2Xd slopes = inverse * part.gradients(part.node(at));
      for (int j = 0; j < part.numNodes; ++j)
        conditions.block(row, k * perPart + j * numFluxes, components, numFluxes) +=
            throughLine(slopes.col(j), components);
      given.block(row, numTractions(), components, components) =
          -Eigen::MatrixXd::Identity(components, components);
    }
  }
  const direct::RightSingular singular = direct::rightSingularOf(conditions);
  const auto rank = (singular.values.array() > 1e-10 * singular.values[0]).count();
  const Eigen::Index numFree = conditions.cols() - rank;
  stresses.resize(conditions.cols(), numData() + numFree);
  const auto determined = singular.vectors.leftCols(rank);
  stresses << determined * direct::leastSquares(conditions * determined, given),
      singular.vectors.rightCols(numFree);
}

void CompositeCell::integrate() {
  const mesh::Shape<2>& cell = mesh::referenceShape<2>(type);
  const mesh::Shape<2>& part = mesh::referenceShape<2>(withOrder(CellType::triangle, cell.order));
  const mesh::Shape<1>& edge = mesh::referenceShape<1>(withOrder(CellType::line, cell.order));
  const auto rule = triangleRule(!cell.isSimplex && cell.order == 2);
  const Eigen::Index number = std::ssize(rule) * numFacets,
                     numEdgePoints = static_cast<Eigen::Index>(fourGauss.size());
  sampled.setZero(numFluxes * number, stresses.cols());
  gradients.resize(2 * number, cell.numNodes);
  weights.resize(number);
  edgeGradients.resize(2 * numFacets * numEdgePoints, cell.numNodes);
  edgeShares.resize(numEdgePoints, perFacet);
  Eigen::Index at = 0, onEdge = 0;
  for (int k = 0; k < numFacets; ++k) {
    const Part own(cell, facetsOf(type)[k]);
    for (const auto& [point, weight] : rule) {
      const mesh::NodalValues values = part.values(point);
      for (int j = 0; j < part.numNodes; ++j)
        sampled.middleRows(at * numFluxes, numFluxes) +=
            values[j] *
            stresses.middleRows((static_cast<Eigen::Index>(k) * part.numNodes + j) * numFluxes, numFluxes);
      gradients.middleRows<2>(2 * at) = cell.gradients(own.at(point));
      weights[at++] = weight * own.jacobian().determinant();
    }
    for (Eigen::Index g = 0; g < numEdgePoints; ++g) {
      const auto& [along, weight] = fourGauss.at(static_cast<std::size_t>(g));
      edgeGradients.middleRows<2>(2 * onEdge++) = cell.gradients(own.at({along, 0}));
      edgeShares.row(g) = weight * edge.values(Along(along)).transpose();
    }
  }
  for (int k = 0; k < numFluxes; ++k)
    for (int l = k; l < numFluxes; ++l) {
      const auto of = [&](int flux) -> Eigen::MatrixXd {
        return Eigen::Map<const Eigen::MatrixXd, 0, Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>>(
            sampled.data() + flux, number, sampled.cols(),
            Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>(sampled.rows(), numFluxes));
      };
      const Eigen::MatrixXd product = of(k).transpose() * weights.asDiagonal() * of(l);
      products.push_back(k == l ? product : Eigen::MatrixXd(product + product.transpose()));
    }
}

namespace {

/// D of the components xx, yy, xy (shear strains are angles), or x, y of a membrane.
Eigen::MatrixXd lawOf(Physics physics, const Material& material) {
  if (physics == Physics::membrane)
    return material.conductivity * Eigen::MatrixXd::Identity(2, 2);
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
Eigen::MatrixXd piolaOf(const Eigen::Matrix2d& f, int components) {
  if (components == 1)
    return f / f.determinant();
  Eigen::MatrixXd piola(3, 3);
  const std::array<std::array<int, 2>, 3> places{{{0, 0}, {1, 1}, {0, 1}}};
  for (int i = 0; i < 3; ++i) {
    const auto [a, b] = places.at(i);
    piola.row(i) << f(a, 0) * f(b, 0), f(a, 1) * f(b, 1), f(a, 0) * f(b, 1) + f(a, 1) * f(b, 0);
  }
  return piola / f.determinant();
}

} // namespace

CellStress::CellStress(CellType type, std::span<const Point> points, Physics physics,
                       const Material& material)
    : cell_(&CompositeCell::of(type, componentsOf(physics))), law_(lawOf(physics, material)),
      compliance_(law_.inverse()) {
  const mesh::Shape<2>& shape = mesh::referenceShape<2>(type);
  jacobian_ = mesh::ElementMap<2>(mesh::relativeCorners<2>(points), shape.centreSample()).jacobian();
  inverse_ = jacobian_.inverse();
  piola_ = piolaOf(jacobian_, cell_->components);
}

double CellStress::measure() const {
  return jacobian_.determinant() * mesh::referenceShape<2>(cell_->type).measure;
}

void CellStress::integrate() const {
  if (whole_.size() > 0)
    return;
  const Small weights = jacobian_.determinant() * piola_.transpose() * compliance_ * piola_;
  whole_.setZero(cell_->stresses.cols(), cell_->stresses.cols());
  for (int k = 0, pair = 0; k < cell_->numFluxes; ++k)
    for (int l = k; l < cell_->numFluxes; ++l, ++pair)
      whole_ += weights(k, l) * cell_->products[pair];
  const Eigen::Index numFree = whole_.rows() - numData();
  least_.resize(numFree, numData());
  if (numFree > 0)
    least_.noalias() = -direct::inverseOfSpd(whole_.bottomRightCorner(numFree, numFree)) *
                       whole_.bottomLeftCorner(numFree, numData());
}

namespace {

/// Data on the reference element of those in space, rows of a matrix: F⁻¹ times tractions, J F⁻¹ times the
/// load; of a membrane the same and J.
template <class Rows>
void toReference(const Eigen::Matrix2d& inverse, int components, Rows&& rows) {
  const Eigen::Index numTractions = rows.rows() - components;
  for (Eigen::Index i = 0; components == 2 && i < rows.rows(); i += 2)
    rows.template middleRows<2>(i) = (inverse * rows.template middleRows<2>(i)).eval();
  rows.bottomRows(rows.rows() - numTractions) /= inverse.determinant();
}

} // namespace

const Eigen::MatrixXd& CellStress::energy() const {
  integrate();
  if (energy_.size() > 0)
    return energy_;
  Eigen::MatrixXd transform = Eigen::MatrixXd::Identity(numData(), numData());
  toReference(inverse_, cell_->components, transform);
  const Eigen::MatrixXd ofData =
      whole_.topLeftCorner(numData(), numData()) + whole_.topRightCorner(numData(), least_.rows()) * least_;
  energy_.noalias() = transform.transpose() * (ofData * transform);
  return energy_;
}

/// A column for each point. \param gradients  of the shape functions
template <int numFluxes>
Eigen::Matrix<double, numFluxes, Eigen::Dynamic>
CellStress::stressesAt(const Eigen::MatrixXd& gradients, const Eigen::VectorXd& displacements) const {
  constexpr int components = numFluxes - 1;
  using Nodal = Eigen::Matrix<double, components, Eigen::Dynamic>;
  const Eigen::Map<const Nodal> nodal(displacements.data(), components, gradients.cols());
  const Eigen::Matrix<double, components, Eigen::Dynamic> all = nodal * gradients.transpose();
  const Eigen::Matrix<double, numFluxes, numFluxes> law = law_;
  Eigen::Matrix<double, numFluxes, Eigen::Dynamic> stresses(numFluxes, gradients.rows() / 2);
  for (Eigen::Index at = 0; at < stresses.cols(); ++at) {
    const Eigen::Matrix<double, components, 2> gradient = all.template middleCols<2>(2 * at) * inverse_;
    Eigen::Matrix<double, numFluxes, 1> strain;
    if constexpr (components == 1)
      strain = gradient.transpose();
    else
      strain << gradient(0, 0), gradient(1, 1), gradient(0, 1) + gradient(1, 0);
    stresses.col(at) = law * strain;
  }
  return stresses;
}

Eigen::VectorXd CellStress::tractions(const Eigen::VectorXd& displacements) const {
  const mesh::Shape<2>& shape = mesh::referenceShape<2>(cell_->type);
  const Eigen::MatrixXd stresses = cell_->components == 1
                                       ? Eigen::MatrixXd(stressesAt<2>(cell_->edgeGradients, displacements))
                                       : Eigen::MatrixXd(stressesAt<3>(cell_->edgeGradients, displacements));
  Eigen::VectorXd result(numTractions());
  const Eigen::Index perEdge = cell_->edgeShares.rows(), block = result.size() / cell_->numFacets;
  for (int k = 0; k < cell_->numFacets; ++k) {
    const mesh::Facet& facet = facetsOf(cell_->type)[k];
    const Eigen::Vector2d edge = jacobian_ * (shape.node(facet[1]) - shape.node(facet[0]));
    const Small through = throughLine(normalOf(edge), cell_->components);
    Eigen::Map<Eigen::MatrixXd>(result.data() + k * block, cell_->components, cell_->perFacet).noalias() =
        through * (stresses.middleCols(k * perEdge, perEdge) * cell_->edgeShares);
  }
  return result;
}

template <int numFluxes>
double CellStress::differenceOf(const Eigen::VectorXd& data, const Eigen::VectorXd& displacements) const {
  integrate();
  Eigen::VectorXd of(cell_->stresses.cols());
  of.head(numData()) = data;
  toReference(inverse_, cell_->components, of.head(numData()));
  of.tail(least_.rows()).noalias() = least_ * of.head(numData());
  const Eigen::VectorXd reference = cell_->sampled * of;
  const auto stresses = stressesAt<numFluxes>(cell_->gradients, displacements);
  const Eigen::Matrix<double, numFluxes, numFluxes> piola = piola_, compliance = compliance_;
  double sum = 0;
  for (Eigen::Index at = 0; at < stresses.cols(); ++at) {
    const Eigen::Matrix<double, numFluxes, 1> rest =
        piola * reference.template segment<numFluxes>(at * numFluxes) - stresses.col(at);
    sum += cell_->weights[at] * rest.dot(compliance * rest);
  }
  return sum * jacobian_.determinant();
}

double CellStress::difference(const Eigen::VectorXd& data, const Eigen::VectorXd& displacements) const {
  return cell_->components == 1 ? differenceOf<2>(data, displacements) : differenceOf<3>(data, displacements);
}

} // namespace epafi::fem
