/// Energies of fluxes: against the stiffness, against a finer quadrature, and in blocks as one by one.

#include "epafi/fem/FluxIntegrals.hpp"

#include "support/SampleCells.hpp"

#include "epafi/fem/ElementIntegrals.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using namespace test;

Eigen::VectorXd randomValues(Eigen::Index size, std::uint32_t seed) {
  SignedRandomNumbers random(seed);
  Eigen::VectorXd values(size);
  for (double& value : values)
    value = random();
  return values;
}

/// A parallelogram or parallelepiped.
std::vector<Point> affineCell(mesh::CellType type) {
  return mapped(unitCell(type), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const bool inSpace = dimensionOf(type) == 3;
    return {2 * x[0] + 0.3 * x[1], 1.5 * x[1] - 0.2 * x[0], inSpace ? 0.8 * x[2] + 0.1 * x[0] : 0.0};
  });
}

TEST(FluxIntegralsTest, TheEnergyOfADisplacementIsThatOfTheStiffness) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : allPhysics(type)) {
      SCOPED_TRACE(std::string(toString(type)) + ", " + toString(physics));
      const std::vector<Point> points = affineCell(type);
      Eigen::MatrixXd stiffness;
      elementStiffness(type, points, physics, material, stiffness);
      const Eigen::VectorXd u = randomValues(stiffness.rows(), 3);
      const double expected = u.dot(stiffness * u);
      const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(numFluxes(physics), numNodesOf(type));
      const FluxEnergies energies = fluxEnergies(type, points, physics, material, spanOf(u), none);
      EXPECT_NEAR(energies.flux, expected, 1e-12 * expected);
      EXPECT_NEAR(energies.difference, expected, 1e-12 * expected); // of 0 − q_h
      const DisplacementNorms norms = differenceNorms(type, points, physics, material, spanOf(u), {});
      EXPECT_NEAR(norms.energy, expected, 1e-12 * expected);
    }
}

/// q* as a function of space is what differenceNorms can integrate with a rule of its own: on simplices q* is
/// linear.
TEST(FluxIntegralsTest, TheDifferenceOnASimplexIsIntegratedExactly) {
  for (const mesh::CellType type : {mesh::CellType::triangle, mesh::CellType::tetrahedron})
    for (const Physics physics : allPhysics(type)) {
      const std::vector<Point> points = affineCell(type);
      const int fluxes = numFluxes(physics), nodes = numNodesOf(type);
      const Eigen::VectorXd u = randomValues(nodes * fem::componentsOf(physics), 5);
      Eigen::MatrixXd nodal = randomValues(fluxes * nodes, 6).reshaped(fluxes, nodes);
      Eigen::MatrixXd corners(nodes, dimensionOf(type) + 1); // [1 x y z] of each node
      for (int a = 0; a < nodes; ++a)
        corners.row(a) << 1, vectorOf(points[a]).head(dimensionOf(type)).transpose();
      const Eigen::MatrixXd coefficients = corners.partialPivLu().solve(nodal.transpose());
      const auto field = [&](const Point& x) {
        Eigen::RowVectorXd place(dimensionOf(type) + 1);
        place << 1, vectorOf(x).head(dimensionOf(type)).transpose();
        const Eigen::RowVectorXd flux = place * coefficients;
        FieldValue value;
        std::copy(flux.begin(), flux.end(), value.flux.begin());
        return value;
      };
      const double expected = differenceNorms(type, points, physics, material, spanOf(u), field).energy;
      const double difference = fluxEnergies(type, points, physics, material, spanOf(u), nodal).difference;
      EXPECT_NEAR(difference, expected, 1e-12 * expected) << toString(physics);
    }
}

TEST(FluxIntegralsTest, CongruentElementsInBlocksAreAsOneByOne) {
  for (const mesh::CellType type : {mesh::CellType::quadrilateral, mesh::CellType::hexahedron,
                                    mesh::CellType::quadrilateral9, mesh::CellType::hexahedron27})
    for (const Physics physics : allPhysics(type)) {
      SCOPED_TRACE(toString(physics));
      const std::vector<Point> points = affineCell(type);
      const int fluxes = numFluxes(physics), nodes = numNodesOf(type), number = 5;
      const int unknowns = nodes * fem::componentsOf(physics);
      const Eigen::MatrixXd u = randomValues(unknowns * number, 8).reshaped(unknowns, number);
      const Eigen::MatrixXd nodal = randomValues(fluxes * nodes * number, 9).reshaped(fluxes * nodes, number);
      const CongruentFluxes together(type, points, physics, material);
      const Eigen::MatrixXd sampled = together.sampled(u);
      const Eigen::VectorXd differences = together.differences(u, nodal);
      double energy = 0;
      for (int e = 0; e < number; ++e) {
        const Eigen::VectorXd own = u.col(e);
        Eigen::MatrixXd flux;
        sampledFluxes(type, points, physics, material, spanOf(own), flux);
        EXPECT_LE((flux.reshaped() - sampled.col(e)).norm(), 1e-12 * flux.norm());
        const FluxEnergies energies = fluxEnergies(type, points, physics, material, spanOf(own),
                                                   nodal.col(e).reshaped(fluxes, nodes).eval());
        EXPECT_NEAR(differences[e], energies.difference, 1e-12 * energies.difference);
        energy += energies.flux;
      }
      EXPECT_NEAR(together.energy(u), energy, 1e-12 * energy);
    }
}

} // namespace
} // namespace epafi::fem
