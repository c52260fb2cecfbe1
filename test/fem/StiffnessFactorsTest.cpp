/// Stiffness that varies from node to node inside a body.

#include "epafi/fem/BodyModel.hpp"
#include "epafi/fem/ElementIntegrals.hpp"
#include "epafi/fem/FluxIntegrals.hpp"
#include "epafi/fem/HookesLaw.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include "support/Refusal.hpp"
#include "support/SampleCells.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

using namespace test;

/// 1 + 0.3x − 0.2y + 0.1z at the nodes.
std::vector<double> gradedFactors(const std::vector<Point>& points) {
  std::vector<double> factors;
  for (const Point& point : points)
    factors.push_back(1 + 0.3 * point[0] - 0.2 * point[1] + 0.1 * point[2]);
  return factors;
}

/// u = (x, 0, 0) and its stress for a factor of 1.
struct Stretch {
  Eigen::VectorXd u;
  SymmetricTensor stress;
};

Stretch stretchOf(const std::vector<Point>& points, Physics physics) {
  const int n = componentsOf(physics);
  Stretch stretch{Eigen::VectorXd::Zero(n * std::ssize(points)), {}};
  for (std::size_t a = 0; a < points.size(); ++a)
    stretch.u[static_cast<Eigen::Index>(a) * n] = points[a][0];
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
  gradient(0, 0) = 1;
  stretch.stress = stressOf(gradient, physics, material);
  return stretch;
}

TEST(StiffnessFactorsTest, EqualFactorsMultiplyTheStiffness) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type))
      for (const Integration integration : {Integration::full, Integration::reduced}) {
        const std::vector<Point> points = distortedCell(type, 3);
        Eigen::MatrixXd one, many;
        elementStiffness(type, points, physics, material, one, integration);
        elementStiffness(type, points, physics, material, many, integration,
                         std::vector<double>(points.size(), 2.5));
        EXPECT_LT((many - 2.5 * one).norm(), 1e-13 * one.norm()) << toString(type);
      }
}

TEST(StiffnessFactorsTest, TheEnergyOfAConstantStrainIsThatOfTheMeanFactor) {
  for (const mesh::CellType type : allCellTypes)
    for (const Physics physics : elasticPhysics(type)) {
      const std::vector<Point> points = mapped(unitCell(type), [](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(2 * x[0] + 0.3 * x[1], x[1] + 0.2 * x[0], x[2]);
      });
      const std::vector<double> factors = gradedFactors(points);
      const auto [u, stress] = stretchOf(points, physics);
      Eigen::MatrixXd stiffness;
      Eigen::VectorXd shares; // t∫N_a in the first component
      elementStiffness(type, points, physics, material, stiffness, Integration::full, factors);
      bodyForceLoad(type, points, physics, material, {1, 0, 0}, shares);
      double mean = 0;
      for (std::size_t a = 0; a < points.size(); ++a)
        mean += factors[a] * shares[static_cast<Eigen::Index>(a) * componentsOf(physics)];
      EXPECT_NEAR(u.dot(stiffness * u), stress[0] * mean, 1e-11 * stress[0] * mean) << toString(type);

      const NodalState state{{}, factors};
      Eigen::MatrixXd sampled;
      sampledFluxes(type, points, physics, material, spanOf(u), sampled, state);
      for (Eigen::Index a = 0; sampled.cols() > 1 && a < sampled.cols(); ++a)
        EXPECT_NEAR(sampled(0, a), factors[static_cast<std::size_t>(a)] * stress[0], 1e-11 * stress[0])
            << toString(type);
      const FluxEnergies energies = fluxEnergies(type, points, physics, material, spanOf(u),
                                                 Eigen::MatrixXd::Zero(6, numNodesOf(type)), state);
      const double density = stress[0] * mean; // ε = 1 along x alone
      EXPECT_NEAR(energies.flux, density, 1e-11 * density) << toString(type);
      EXPECT_NEAR(differenceNorms(type, points, physics, material, spanOf(u), {}, state).energy, density,
                  1e-11 * density)
          << toString(type);
    }
}

TEST(StiffnessFactorsTest, AFreeBodyExpandsAsWithout) {
  Material expanding = material;
  expanding.expansion = 1e-3;
  for (const mesh::CellType type : {mesh::CellType::hexahedron20, mesh::CellType::tetrahedron10})
    for (const Integration integration : {Integration::full, Integration::reduced}) {
      const std::vector<Point> points = distortedCell(type, 5);
      const std::vector<double> factors = gradedFactors(points), change(points.size(), 40);
      Eigen::MatrixXd stiffness;
      Eigen::VectorXd load, u(3 * std::ssize(points));
      for (std::size_t a = 0; a < points.size(); ++a)
        u.segment<3>(3 * static_cast<Eigen::Index>(a)) = 0.04 * vectorOf(points[a]);
      elementStiffness(type, points, Physics::elasticity3d, expanding, stiffness, integration, factors);
      thermalLoad(type, points, Physics::elasticity3d, expanding, change, load, integration, factors);
      EXPECT_GT(load.norm(), 0);
      EXPECT_LT((stiffness * u - load).norm(), 1e-13 * load.norm());
    }
}

Solid gradedBody() {
  Solid solid;
  solid.name = "graded";
  solid.physics = Physics::planeStress;
  solid.material = material;
  return solid;
}

TEST(StiffnessFactorsTest, ABarWhoseStiffnessGrowsAlongItStretchesEvenlyUnderItsBodyForce) {
  // E = E₀ (1 + x/2), ν = 0, u = x: σ = E, and the force per volume is −E₀/2.
  const mesh::StructuredMesh mesh({{0, 0, 0}, {2, 1, 0}}, {1, 3, 0});
  Solid solid = gradedBody();
  solid.material.poissonsRatio = 0;
  solid.stiffnessFactors = {{"all", "left", 7}, {"left end", "left", 1}, {"right end", "right", 2}};
  SolidLoad force;
  force.value = {-material.youngsModulus / 2, 0, 0};
  solid.loads = {force};
  const BodyModel model(solid, mesh);
  std::vector<GlobalOrdinal> kinds(3);
  model.kinds(std::vector<GlobalOrdinal>{0, 1, 2}, kinds);
  EXPECT_NE(kinds[0], kinds[1]) << "elements are not alike any more";
  Eigen::MatrixXd stiffness;
  Eigen::VectorXd load, u(8);
  u << 0, 0, 2, 0, 2, 0, 0, 0;
  model.element(1, stiffness, load);
  const double end = material.thickness * material.youngsModulus / 3 / 2; // of each node of a row's ends
  Eigen::VectorXd ends = Eigen::VectorXd::Zero(8);
  ends[0] = ends[6] = -end;
  ends[2] = ends[4] = 2 * end;
  EXPECT_LT((stiffness * u - load - ends).norm(), 1e-12);
}

TEST(StiffnessFactorsTest, FactorsThatCannotBeAreRefused) {
  const mesh::StructuredMesh mesh({{0, 0, 0}, {1, 1, 0}}, {1, 1, 0}, 2);
  Solid solid = gradedBody();
  solid.stiffnessFactors = {{"soft", "left", 0.001}, {"hard", "right", 100}};
  expectSays(refusal([&] { (void)BodyModel(solid, mesh); }), {"graded", "0.001", "100", "smaller"});
  solid.stiffnessFactors = {{"soft", "nowhere", 0.5}};
  expectSays(refusal([&] { (void)BodyModel(solid, mesh); }), {"stiffness factor 'soft'", "nowhere"});
  solid.stiffnessFactors = {{"soft", "left", 0.5}};
  solid.physics = Physics::membrane;
  expectSays(refusal([&] { (void)BodyModel(solid, mesh); }), {"membranes"});
}

} // namespace
} // namespace epafi::fem
