#include "epafi/decomposition/EdgeAverages.hpp"
#include "epafi/fem/SubdomainAssembly.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/Corners.hpp"
#include "epafi/model/Decompose.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace epafi::decomposition {
namespace {

using model::decompose;
using model::Decomposition;
using model::makeModel;

/// A body in space, cut as a grid.
scene::Scene cube(int subdomains, int elementsPerSubdomain) {
  scene::Body solid;
  solid.name = "cube";
  solid.physics = fem::Physics::elasticity3d;
  solid.mesh.box = {{0, 0, 0}, {1, 1, 1}};
  const int n = subdomains * elementsPerSubdomain;
  solid.mesh.elements = {n, n, n};
  solid.supports = {{"floor", "bottom", {0.0, 0.0, 0.0}}};
  fem::SolidLoad weight;
  weight.value = {0.5, 0.25, -1};
  solid.loads = {weight};
  solid.decomposition.counts = {subdomains, subdomains, subdomains};
  scene::Scene scene;
  scene.bodies = {solid};
  return scene;
}

Decomposition decomposed(int subdomains, int elementsPerSubdomain) {
  return decompose(cube(subdomains, elementsPerSubdomain), rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
}

TEST(EdgeAveragesTest, AGridHasCornersAtTheEndsOfItsEdges) {
  const Decomposition two = decomposed(2, 3);
  // The middle, and where the six edges end on the cube's faces; supported ones count.
  EXPECT_EQ(two.problem.numCrosspoints, 7);
  for (const Subdomain& subdomain : two.problem.subdomains)
    EXPECT_LE(subdomain.averages.size(), 9U); // three edges of two nodes, three components each
}

TEST(EdgeAveragesTest, ValuesOfNodesComeBack) {
  const Decomposition cut = decomposed(2, 4);
  for (const Subdomain& subdomain : cut.problem.subdomains) {
    ASSERT_FALSE(subdomain.averages.empty());
    const Eigen::VectorXd changed = Eigen::VectorXd::Random(subdomain.stiffness->rows());
    Eigen::VectorXd nodal = changed;
    toNodalValues(subdomain, nodal);
    for (const Average& average : subdomain.averages) {
      double sum = nodal[average.carrier];
      for (const int other : average.others) {
        sum += nodal[other];
        EXPECT_NEAR(nodal[other] - changed[average.carrier], changed[other], 1e-14);
      }
      EXPECT_NEAR(sum / static_cast<double>(average.others.size() + 1), changed[average.carrier], 1e-14);
    }
  }
}

TEST(EdgeAveragesTest, EnergyIsThatOfTheValuesOfNodes) {
  const scene::Scene scene = cube(2, 3);
  const Decomposition cut = decomposed(2, 3);
  const mesh::Mesh& mesh = *cut.bodies[0].mesh;
  const auto model = makeModel(scene.bodies[0], mesh);
  for (std::size_t s = 0; s < cut.problem.subdomains.size(); ++s) {
    const Subdomain& subdomain = cut.problem.subdomains[s];
    const fem::AssembledSubdomain plain =
        fem::assemble(*model, cut.bodies[0].partition->elementsOf(subdomain.number));
    const Eigen::VectorXd changed = Eigen::VectorXd::Random(subdomain.stiffness->rows());
    Eigen::VectorXd nodal = changed;
    toNodalValues(subdomain, nodal);
    const double energy = nodal.dot(plain.stiffness * nodal);
    EXPECT_NEAR(changed.dot(*subdomain.stiffness * changed), energy, 1e-12 * energy);
    const Eigen::VectorXd f = plain.data.rightHandSide();
    EXPECT_NEAR(cut.data.subdomains()[s].rightHandSide().dot(changed), f.dot(nodal),
                1e-13 * f.norm() * nodal.norm());
    EXPECT_EQ((*subdomain.stiffness - SparseMatrix(subdomain.stiffness->transpose())).norm(), 0);
  }
}

TEST(EdgeAveragesTest, RowsActOnTheSameValues) {
  const std::vector<Average> averages{{2, {0, 1, 4}}, {3, {6}}};
  const std::vector<RowEntry> nodalRows{{7, 0, 1.5}, {7, 2, -2.0}, {8, 3, 1.0},
                                        {8, 5, 4.0}, {9, 6, 1.0},  {9, 3, 1.0}};
  const std::vector<RowEntry> rows = inBasisOf(averages, nodalRows);
  Subdomain subdomain;
  subdomain.averages = averages;
  const Eigen::VectorXd changed = Eigen::VectorXd::Random(7);
  Eigen::VectorXd nodal = changed;
  toNodalValues(subdomain, nodal);
  for (const GlobalOrdinal row : {7, 8, 9}) {
    double expected = 0, value = 0;
    for (const RowEntry& entry : nodalRows)
      expected += entry.row == row ? entry.coefficient * nodal[entry.unknown] : 0;
    for (const RowEntry& entry : rows)
      value += entry.row == row ? entry.coefficient * changed[entry.unknown] : 0;
    EXPECT_NEAR(value, expected, 1e-14);
  }
  std::set<std::pair<GlobalOrdinal, int>> places;
  for (const RowEntry& entry : rows)
    EXPECT_TRUE(places.insert({entry.row, entry.unknown}).second);
}

TEST(EdgeAveragesTest, EqualSubdomainsStillShareTheirStiffness) {
  const Decomposition cut = decomposed(4, 3);
  std::set<const SparseMatrix*> different;
  for (const Subdomain& subdomain : cut.problem.subdomains)
    different.insert(subdomain.stiffness.get());
  EXPECT_LT(different.size(), cut.problem.subdomains.size());
}

/// Where four subdomains meet a chain of rows would not do.
TEST(EdgeAveragesTest, GluingRowsAreOrthogonalInTheStiffness) {
  for (const int parts : {8, 11}) {
    scene::Scene scene = cube(2, 3);
    if (parts != 8) {
      scene.bodies.front().decomposition.method = scene::Decomposition::Method::metis;
      scene.bodies.front().decomposition.parts = parts;
    }
    const Decomposition cut = decompose(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
    const Eigen::Index n = cut.problem.dualDimension();
    Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n); // B D⁻¹ Bᵀ
    std::size_t mostRows = 0;
    for (const Subdomain& subdomain : cut.problem.subdomains) {
      std::map<int, std::vector<const ConstraintEntry*>> entriesOf; // by unknown
      for (const ConstraintEntry& entry : subdomain.constraint)
        entriesOf[entry.unknown].push_back(&entry);
      for (const auto& [unknown, entries] : entriesOf) {
        mostRows = std::max(mostRows, entries.size());
        for (const ConstraintEntry* a : entries)
          for (const ConstraintEntry* b : entries)
            products(a->multiplier, b->multiplier) +=
                a->coefficient * b->coefficient / subdomain.stiffness->coeff(unknown, unknown);
      }
    }
    EXPECT_GE(mostRows, 3U); // there are such edges
    const Eigen::VectorXd scale = products.diagonal().cwiseSqrt().cwiseInverse();
    products = scale.asDiagonal() * products * scale.asDiagonal();
    EXPECT_LE((products - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-13) << parts;
  }
}

TEST(HoldingPointsTest, TakeAsManyPointsAsHoldABody) {
  const std::vector<Point> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  std::vector<Point> plane = line;
  plane.push_back({1, 2, 0});
  EXPECT_EQ(HoldingPoints(1).complete(line).size(), 1U);
  EXPECT_EQ(HoldingPoints(2).complete(line).size(), 2U);
  EXPECT_EQ(HoldingPoints(3).complete(line).size(), 2U); // they cannot hold it
  EXPECT_EQ(HoldingPoints(3).complete(plane).size(), 3U);
  HoldingPoints held(2);
  held.add({0, 0, 0});
  held.add({0, 0, 0});
  EXPECT_FALSE(held.hold());
  held.add({1, 0, 0});
  EXPECT_TRUE(held.hold());
  EXPECT_TRUE(held.complete(plane).empty());
}

} // namespace
} // namespace epafi::decomposition
