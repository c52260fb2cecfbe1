// Stresses inside elements: balance by virtual work, exactness where the stress is one of theirs.

#include "epafi/fem/CompositeStress.hpp"

#include "support/SampleCells.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fem/ElementIntegrals.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using namespace epafi::test;
using mesh::CellType;

constexpr std::array planeTypes{CellType::triangle, CellType::quadrilateral, CellType::triangle6,
                                CellType::quadrilateral9, CellType::quadrilateral8};

std::vector<Point> slantedCell(CellType type) {
  return mapped(unitCell(type), [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {2 * x[0] + 0.3 * x[1] - 5, 1.5 * x[1] - 0.4 * x[0], 0};
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
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
  motions.push_back(linearField(points, components, turn)); // (1, −2)
  if (components == 2) {
    motions.push_back(motions[0]);
    for (Eigen::Index i = 0; i < motions[1].size(); i += 2)
      motions[1].segment<2>(i) << 2, 1;
    turn(0, 1) = -1;
    turn(1, 0) = 1;
    motions.push_back(linearField(points, components, turn));
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

/// ‖τ − σ‖² = ‖τ‖² − 2 (the work of the data) + ‖u‖²: only if τ balances them.
TEST(CompositeStressTest, BalancesAllDataThatAreInBalance) {
  for (const CellType type : planeTypes)
    for (const Physics physics : allPhysics(type)) {
      const std::vector<Point> points = slantedCell(type);
      const CellStress stress(type, points, physics, material);
      const Eigen::VectorXd data = balancedData(type, points, physics, stress.numData());
      SignedRandomNumbers random(3);
      Eigen::MatrixXd stiffness;
      elementStiffness(type, points, physics, material, stiffness);
      Eigen::VectorXd u(stiffness.rows());
      for (double& value : u)
        value = random();
      const double expected = data.dot(stress.energy() * data) -
                              2 * workOf(type, points, physics, data).dot(u) + u.dot(stiffness * u);
      EXPECT_NEAR(stress.difference(data, u), expected, 1e-9 * expected)
          << toString(type) << ", " << toString(physics);
    }
}

TEST(CompositeStressTest, FindsAnEvenStress) {
  Eigen::Matrix3d gradient;
  gradient << 0.3, -0.5, 0, 0.2, 0.7, 0, 0, 0, 0;
  for (const CellType type : planeTypes)
    for (const Physics physics : allPhysics(type)) {
      const std::vector<Point> points = slantedCell(type);
      const CellStress stress(type, points, physics, material);
      const Eigen::VectorXd u = linearField(points, componentsOf(physics), gradient);
      Eigen::VectorXd data = Eigen::VectorXd::Zero(stress.numData());
      data.head(data.size() - componentsOf(physics)) = stress.tractions(u);
      const double energy = data.dot(stress.energy() * data);
      EXPECT_GT(energy, 1e-2);
      EXPECT_LE(stress.difference(data, u), 1e-12 * energy) << toString(type) << ", " << toString(physics);
    }
}

} // namespace
} // namespace epafi::fem
