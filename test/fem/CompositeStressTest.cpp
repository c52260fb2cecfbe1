// Stresses inside elements: balance by virtual work, exactness where the stress is one of theirs.

#include "epafi/fem/CompositeStress.hpp"

#include "support/SampleCells.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/mesh/ElementMap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace epafi::fem {
namespace {

using namespace epafi::test;
using mesh::CellType;

constexpr std::array types{CellType::triangle,       CellType::quadrilateral,  CellType::triangle6,
                           CellType::quadrilateral9, CellType::quadrilateral8, CellType::tetrahedron,
                           CellType::tetrahedron10,  CellType::hexahedron,     CellType::hexahedron27};

std::vector<Point> slantedCell(CellType type) {
  return mapped(unitCell(type), [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {2 * x[0] + 0.3 * x[1] - 5, 1.5 * x[1] - 0.4 * x[0] + 0.2 * x[2], 0.8 * x[2]};
  });
}

/// Work of data at displacements of the nodes.
Eigen::VectorXd workOf(CellType type, const std::vector<Point>& points, Physics physics,
                       const Eigen::VectorXd& data) {
  const Eigen::Index components = componentsOf(physics);
  Vector3 load{0, 0, 0};
  for (Eigen::Index c = 0; c < components; ++c)
    load.at(static_cast<std::size_t>(c)) =
        data[data.size() - components + c] / thicknessOf(physics, material);
  Eigen::VectorXd work;
  bodyForceLoad(type, points, physics, material, load, work);
  Eigen::Index moment = 0;
  for (const mesh::Facet& facet : facetsOf(type))
    for (std::size_t i = 0; i < facet.size(); ++i, moment += components)
      work.segment(facet[i] * components, components) += data.segment(moment, components);
  return work;
}

/// Numbers of any kind less what is out of balance with rigid motions.
Eigen::VectorXd balancedData(CellType type, const std::vector<Point>& points, Physics physics, int size) {
  SignedRandomNumbers random(7);
  Eigen::VectorXd data(size);
  for (double& value : data)
    value = random();
  std::vector<Eigen::VectorXd> motions;
  const int components = componentsOf(physics);
  for (int i = 0; i < components; ++i) {
    motions.emplace_back(Eigen::VectorXd::Zero(std::ssize(points) * components))
        .reshaped(components, std::ssize(points))
        .row(i)
        .setOnes();
    for (int j = 0; j < i; ++j) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
      turn(i, j) = 1;
      turn(j, i) = -1;
      motions.push_back(linearField(points, components, turn));
    }
  }
  Eigen::MatrixXd resultants(motions.size(), size);
  for (int j = 0; j < size; ++j) {
    const Eigen::VectorXd work = workOf(type, points, physics, Eigen::VectorXd::Unit(size, j));
    for (std::size_t m = 0; m < motions.size(); ++m)
      resultants(static_cast<Eigen::Index>(m), j) = work.dot(motions[m]);
  }
  return data - resultants.transpose() *
                    direct::solvedSymmetric(resultants * resultants.transpose(), resultants * data);
}

/// The nodes of the reference element.
template <int dim>
std::vector<Point> referenceCell(CellType type) {
  std::vector<Point> points(numNodesOf(type), Point{0, 0, 0});
  for (int a = 0; a < std::ssize(points); ++a)
    for (int d = 0; d < dim; ++d)
      points[a][d] = mesh::referenceShape<dim>(type).node(a)[d];
  return points;
}

/// Where the stresses of a part are known.
template <int dim>
class StressPart {
public:
  using Local = mesh::Coordinates<dim>;
  StressPart(const CompositeCell& cell, std::size_t number)
      : shape_(mesh::referenceShape<dim>(
            withOrder(dim == 2 ? CellType::triangle : CellType::tetrahedron, orderOf(cell.type)))),
        origin_(cell.parts[number].col(0)),
        jacobian_(cell.parts[number].rightCols(dim).colwise() - cell.parts[number].col(0)) {}
  [[nodiscard]] const mesh::Shape<dim>& shape() const { return shape_; }
  [[nodiscard]] Local at(int node) const { return origin_ + jacobian_ * shape_.node(node); }
  /// Of nodes that lie on the element's facet, which the last corner is opposite to.
  [[nodiscard]] bool isOnFacet(int node) const { return std::abs(shape_.node(node)[dim - 1]) < 1e-9; }
  /// ∫ (τ through grad N_a) and ∫N_a for each node of the part.
  [[nodiscard]] std::pair<Eigen::MatrixXd, Eigen::VectorXd> forces(const Eigen::MatrixXd& fluxes,
                                                                   int components) const {
    Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(components, fluxes.cols());
    Eigen::VectorXd shares = Eigen::VectorXd::Zero(fluxes.cols());
    const Eigen::Matrix<double, dim, dim> inverse = jacobian_.inverse().transpose();
    for (const auto& sample : mesh::referenceShape<dim>(withOrder(shape_.type, 2)).fineSamples()) {
      const double weight = sample.weight * std::abs(jacobian_.determinant());
      const Eigen::VectorXd values = shape_.values(sample.xi);
      const Eigen::MatrixXd slopes = inverse * shape_.gradients(sample.xi);
      shares += weight * values;
      for (Eigen::Index a = 0; a < fluxes.cols(); ++a)
        forces.col(a) += weight * throughFacet(slopes.col(a), components) * (fluxes * values);
    }
    return {forces, shares};
  }

private:
  const mesh::Shape<dim>& shape_;
  Local origin_;
  Eigen::Matrix<double, dim, dim> jacobian_;
};

/// Balance by virtual work of all continuous functions of the parts that vanish on the element's facets, and
/// tractions that are what the data of their facet alone say.
template <int dim>
void expectBalance(CellType type, Physics physics) {
  const int components = componentsOf(physics);
  const CompositeCell& cell = CompositeCell::of(type, components);
  const std::vector<Point> points = referenceCell<dim>(type);
  Eigen::VectorXd data = balancedData(type, points, physics, cell.numData());
  const Eigen::VectorXd load = data.tail(components);
  const Eigen::VectorXd stress = cell.stresses.leftCols(cell.numData()) * data;
  const mesh::Shape<dim - 1>& facetShape = mesh::referenceShape<dim - 1>(facetTypeOf(type));
  const FacetFunctions& functions = FacetFunctions::of(facetTypeOf(type));
  std::map<std::array<long, dim>, Eigen::VectorXd> left; // at inner nodes
  std::set<std::array<long, dim>> outside;
  for (std::size_t p = 0; p < cell.parts.size(); ++p) {
    const StressPart<dim> part(cell, p);
    const Eigen::Index nodes = part.shape().numNodes;
    const Eigen::MatrixXd fluxes =
        stress.segment(static_cast<Eigen::Index>(p) * nodes * cell.numFluxes, nodes * cell.numFluxes)
            .reshaped(cell.numFluxes, nodes);
    const auto [forces, shares] = part.forces(fluxes, components);
    const Eigen::Index k = p / functions.pieces.size();
    const mesh::Facet& facet = facetsOf(type)[k];
    mesh::NodalColumns<dim> corners(dim, facet.size());
    for (int i = 0; i < std::ssize(facet); ++i)
      corners.col(i) = mesh::referenceShape<dim>(type).node(facet[i]);
    const Eigen::MatrixXd through = throughFacet(
                              mesh::facetNormal<dim - 1>(corners, facetShape.centreSample()), components),
                          coefficients =
                              data.segment(k * cell.perFacet * components, cell.perFacet * components)
                                  .reshaped(components, cell.perFacet) *
                              (functions.moments * facetShape.measure).inverse().transpose();
    Eigen::Index onFacet = 0;
    for (int a = 0; a < nodes; ++a) {
      std::array<long, dim> place{};
      for (int d = 0; d < dim; ++d)
        place.at(d) = std::lround(1e6 * part.at(a)[d]);
      auto& rest = left.try_emplace(place, Eigen::VectorXd::Zero(components)).first->second;
      rest += forces.col(a) - shares[a] * load;
      if (!part.isOnFacet(a))
        continue;
      outside.insert(place);
      const Eigen::VectorXd traction =
          coefficients * functions.pieces[p % functions.pieces.size()].values.row(onFacet++).transpose();
      EXPECT_NEAR((through * fluxes.col(a) - traction).norm(), 0, 1e-9) << toString(type);
    }
  }
  for (const auto& [place, rest] : left)
    EXPECT_TRUE(outside.contains(place) || rest.norm() <= 1e-9)
        << toString(type) << ", " << toString(physics);
}

TEST(CompositeStressTest, BalancesAllDataThatAreInBalance) {
  for (const CellType type : types)
    for (const Physics physics : allPhysics(type))
      (dimensionOf(type) == 2 ? expectBalance<2> : expectBalance<3>)(type, physics);
}

/// The stress of a quadratic displacement is linear, and by Prager and Synge the one of least energy among
/// those that balance its divergence.
TEST(CompositeStressTest, FindsTheStressOfAQuadraticDisplacement) {
  for (const CellType type : types)
    for (const Physics physics : allPhysics(type)) {
      if (orderOf(type) == 1)
        continue;
      const std::vector<Point> points = slantedCell(type);
      const CellStress stress(type, points, physics, material);
      const int components = componentsOf(physics);
      Eigen::MatrixXd stiffness;
      elementStiffness(type, points, physics, material, stiffness);
      Eigen::VectorXd u(stiffness.rows()), data(stress.numData());
      for (std::size_t a = 0; a < points.size(); ++a)
        for (int c = 0; c < components; ++c) {
          const auto& [x, y, z] = points[a];
          u[static_cast<Eigen::Index>(a) * components + c] = 0.3 * x * x - (0.4 + c) * x * y +
                                                             0.2 * c * y * y + 0.7 * y * z - 0.1 * z * z +
                                                             0.5 * c * z * x - x;
        }
      data << stress.tractions(u), Eigen::VectorXd::Zero(components);
      for (Eigen::Index i = 0; i < stress.numTractions(); i += components)
        data.tail(components) -= data.segment(i, components) / stress.measure();
      const double energy = u.dot(stiffness * u);
      EXPECT_NEAR(data.dot(stress.energy() * data), energy, 1e-9 * energy) << toString(type);
      EXPECT_LE(stress.difference(data.dot(stress.energy() * data), data, u, stiffness), 1e-9 * energy)
          << toString(type);
    }
}

TEST(CompositeStressTest, FindsAnEvenStress) {
  Eigen::Matrix3d gradient;
  gradient << 0.3, -0.5, 0.1, 0.2, 0.7, -0.4, 0.6, 0.2, -0.8;
  for (const CellType type : types)
    for (const Physics physics : allPhysics(type)) {
      const std::vector<Point> points = slantedCell(type);
      const CellStress stress(type, points, physics, material);
      const Eigen::VectorXd u = linearField(points, componentsOf(physics), gradient);
      Eigen::VectorXd data = Eigen::VectorXd::Zero(stress.numData());
      data.head(data.size() - componentsOf(physics)) = stress.tractions(u);
      Eigen::MatrixXd stiffness;
      elementStiffness(type, points, physics, material, stiffness);
      const double energy = data.dot(stress.energy() * data);
      EXPECT_GT(energy, 1e-2);
      EXPECT_LE(stress.difference(data.dot(stress.energy() * data), data, u, stiffness), 1e-12 * energy)
          << toString(type) << ", " << toString(physics);
    }
}

} // namespace
} // namespace epafi::fem
