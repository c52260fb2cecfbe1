#include "support/Refusal.hpp"
#include "support/SolidScenes.hpp"
#include "support/Twice.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/contact/SurfaceContact.hpp"
#include "epafi/decomposition/ElementMatrices.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace epafi::fetidp {
namespace {

using namespace decomposition;
using test::expectSays;
using test::refusal;

TEST(UnassembledProblemTest, ClustersMayBeAskedForOfSomeBodies) {
  for (const std::vector<int>& sizes : {std::vector{1, 1}, {0, 1}, {2, 0}}) {
    SCOPED_TRACE(testing::Message() << sizes[0] << ' ' << sizes[1]);
    scene::Scene membranes = twoMembranes(false, 12, grid(2, 2));
    setHalves(membranes.bodies[0], 4.0, -5.0);
    setHalves(membranes.bodies[1], -3.0, 2.0);
    scene::Scene blocks = twoBlocks(2, test::cutInGrid({2, 2, 1}));
    for (scene::Body& body : blocks.bodies)
      body.mesh.elements = {8, 8, 0};
    for (const scene::Scene& scene : {membranes, blocks}) {
      const Supports supports = Supports::prescribed;
      const Twice twice(scene, supports, [&](Twice& both) {
        both.handed->setClusterSizes(sizes);
        both.handed->setContact(contactOf(scene, both.direct.decomposition, supports));
      });
      const DecomposedProblem& problem = twice.handed->problem();
      for (std::size_t b = 0; b < 2; ++b)
        EXPECT_EQ(std::count_if(problem.clusters.begin(), problem.clusters.end(),
                                [b](const Cluster& cluster) { return cluster.body == static_cast<int>(b); }),
                  sizes[b] == 0 ? 1 : 4 / sizes[b]);
      EXPECT_LE(twice.difference(), 1e-9);
    }
  }
  const auto problem = handOver(twoMembranes(false, 8, grid(2, 2)), {});
  expectSays(refusal([&] { problem->setClusterSizes({1}); }), {"1 sizes", "2 bodies"});
  expectSays(refusal([&] { problem->setClusterSizes({1, -1}); }), {"-1 subdomains"});
}

TEST(UnassembledProblemTest, AHandedOverSceneHasTheSameAnswer) {
  for (const Case& c : handedCases())
    for (const Supports supports : {Supports::eliminated, Supports::prescribed}) {
      SCOPED_TRACE(c.name + (supports == Supports::prescribed ? ", prescribed" : ", eliminated"));
      const Twice twice(c.scene, supports);
      EXPECT_LE(twice.difference(), 1e-10);
      if (supports == Supports::prescribed) { // else what prescribed values alone contribute is not known
        EXPECT_NEAR(twice.solution.energy, twice.direct.solution.energy,
                    1e-10 * std::abs(twice.direct.solution.energy));
      }
      EXPECT_EQ(twice.solution.activeContactNodes, twice.direct.solution.activeContactNodes);
      EXPECT_EQ(twice.handed->problem().kernelDimension, twice.direct.decomposition.problem.kernelDimension);
    }
}

/// As an application would: facets, and where nodes lie, numbered through both bodies.
TEST(UnassembledProblemTest, SurfacesMeshedApartAreCoupledAsInAScene) {
  for (const int dimension : {2, 3})
    for (const auto kind : {scene::SurfaceContact::Kind::contact, scene::SurfaceContact::Kind::tied}) {
      scene::Scene scene = twoBlocks(dimension, test::cutInGrid({2, 2, dimension == 3 ? 2 : 1}));
      scene.bodies[1].mesh.elements = {3, 3, dimension == 3 ? 5 : 0};
      scene.contacts[0].kind = kind;
      scene.contacts[0].multipliers = scene::SurfaceContact::Side::first;
      const Twice twice(scene, Supports::prescribed, [&](Twice& both) {
        const std::vector<model::BodyLayout>& bodies = both.direct.decomposition.bodies;
        const GlobalOrdinal second = firstNodes(both.direct.decomposition)[1];
        const contact::NodePoints points = [&](GlobalOrdinal node) {
          return node < second ? bodies[0].mesh->point(node) : bodies[1].mesh->point(node - second);
        };
        const mesh::Surface right = bodies[0].mesh->surface("right");
        mesh::Surface left = bodies[1].mesh->surface("left");
        for (GlobalOrdinal& node : left.facetNodes)
          node += second;
        contact::ContactTerms terms{"joint", "right"};
        terms.dimension = terms.components = dimension;
        const contact::HeldNodes isHeld = [&](GlobalOrdinal node, const Eigen::Vector3d& direction) {
          const Point x = points(node); // by the floor and, in space, the front
          return (x[1] == 0 && std::abs(direction[1]) == 1) ||
                 (dimension == 3 && x[2] == 0 && std::abs(direction[2]) == 1);
        };
        if (kind == scene::SurfaceContact::Kind::tied)
          both.handed->setTies(tieBetween(terms, {right, points}, {left, points}, world(), isHeld).matrix);
        else
          both.handed->setContact(contactBetween(terms, {right, points}, {left, points}, world()).matrix);
      });
      EXPECT_GT(twice.handed->problem().numTies + twice.handed->problem().numInequalities, dimension);
      EXPECT_LE(twice.difference(), 1e-10) << dimension;
      EXPECT_EQ(twice.solution.activeContactNodes, twice.direct.solution.activeContactNodes);
    }
}

/// What `complete` says of a problem whose first subdomain was changed, on whatever rank that is.
template <class Change>
std::string refusalAfter(const Change& change) {
  const scene::Scene scene = twoMembranes(true, 4, grid(2, 1));
  std::vector<SubdomainMatrix> matrices = matricesOf(scene, Supports::prescribed);
  if (world()->getRank() == 0)
    change(matrices.front());
  return refusal([&] { handOver(scene, matrices)->complete(); });
}

TEST(UnassembledProblemTest, WrongInputIsRefusedOnAllRanks) {
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.unknowns[1] = m.unknowns[0]; }),
             {"subdomain 0", "twice"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.unknowns[0] = -3; }), {"subdomain 0", "-3"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.load.conservativeResize(3); }), {"load", "3 x 1"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.coordinates(0, 0) = NAN; }), {"coordinates", "finite"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.stiffness.coeffRef(0, 0) = NAN; }),
             {"stiffness of subdomain 0", "finite"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.body = 2; }), {"body 2", "2 bodies"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.body = 1; }), {"share nodes"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.stiffness.coeffRef(0, 1) += 1; }), {"symmetric"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.crosspoints = {12345}; }), {"12345", "crosspoint"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.prescribed.emplace_back(99999, 0.0); }), {"99999"});
  expectSays(refusalAfter([](SubdomainMatrix& m) { m.prescribed.emplace_back(m.unknowns.back(), 0.0); }),
             {"same free unknowns"});
  expectSays(refusal([] { UnassembledProblem(world(), 4, 1); }), {"4", "2 or 3"});
  expectSays(refusal([] { UnassembledProblem(world(), 2, 0); }), {"0 unknowns"});
}

TEST(UnassembledProblemTest, WrongContactIsRefusedOnAllRanks) {
  const scene::Scene scene = twoMembranes(true, 4, grid(2, 1));
  const Decomposition decomposition = decompose(scene, world());
  const ConstraintMatrix contact = contactOf(scene, decomposition, Supports::prescribed);
  const auto completed = [&](const ConstraintMatrix& given) {
    const auto problem = handOver(scene, matricesOf(scene, Supports::prescribed));
    problem->setContact(given);
    problem->complete();
  };
  const RCP<const Map> rows = contact.rows->getRowMap();
  const auto withColumn = [&](GlobalOrdinal column, double value) {
    const RCP<const Map> domain = rcp(new Map(100000, 0, world()));
    const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(rows, 1));
    for (std::size_t i = 0; i < numLocal(*rows); ++i)
      matrix->insertGlobalValues(rows->getGlobalElement(static_cast<LocalOrdinal>(i)), Teuchos::tuple(column),
                                 Teuchos::tuple(value));
    matrix->fillComplete(domain, rows);
    return ConstraintMatrix{matrix, contact.gap};
  };
  expectSays(refusal([&] { completed(withColumn(77777, 1.0)); }), {"77777", "no subdomain"});
  expectSays(refusal([&] { completed(withColumn(3, 0.0)); }), {"row", "empty"});
  expectSays(refusal([&] { completed(withColumn(3, NAN)); }), {"not finite"});
  const RCP<const Map> longer = rcp(new Map(rows->getGlobalNumElements() + 3, 0, world()));
  expectSays(refusal([&] { completed({contact.rows, rcp(new Vector(longer))}); }), {"gaps", "row map"});
}

TEST(UnassembledProblemTest, CompressedRowsAndTpetraMatricesGiveTheSameSubdomain) {
  const std::vector<int> starts{0, 2, 3, 5}, columns{1, 0, 1, 2, 0};
  const std::vector<double> values{-1, 2, 3, 5, 7};
  const SparseMatrix matrix = fromCompressedRows(starts, columns, values);
  EXPECT_EQ(matrix.coeff(0, 1), -1);
  EXPECT_EQ(matrix.coeff(2, 0), 7);
  EXPECT_EQ(matrix.nonZeros(), 5);
  EXPECT_THROW(fromCompressedRows(starts, std::vector<int>{1, 0, 1, 3, 0}, values), InputError);
  EXPECT_THROW(fromCompressedRows(std::vector<int>{0, 2, 1, 5}, columns, values), InputError);

  const std::vector<GlobalOrdinal> numbers{12, 7, 30};
  const RCP<const Comm> self = rcp(new Teuchos::SerialComm<int>());
  const RCP<const Map> map = rcp(new Map(3, Teuchos::arrayViewFromVector(numbers), 0, self));
  CrsMatrix local(map, 3);
  for (int row = 0; row < 3; ++row)
    for (int k = starts[row]; k < starts[static_cast<std::size_t>(row) + 1]; ++k)
      local.insertGlobalValues(numbers[row], Teuchos::tuple(numbers[columns[k]]), Teuchos::tuple(values[k]));
  local.fillComplete();
  const SubdomainMatrix subdomain = subdomainMatrix(local);
  EXPECT_EQ(subdomain.unknowns, numbers);
  EXPECT_EQ(SparseMatrix(subdomain.stiffness - matrix).norm(), 0);
}

TEST(UnassembledProblemTest, ElementsAddUpToSubdomains) {
  ElementMatrices elements(2);
  Eigen::MatrixXd k(2, 2), points(2, 2);
  k << 2, -1, -1, 3;
  points << 0, 0, 1, 0;
  const Eigen::VectorXd f = Eigen::Vector2d(1, 10);
  const std::vector<GlobalOrdinal> first{4, 9}, second{9, 2};
  elements.add(7, {first, points, k, f});
  elements.add(7, {second, points, k, f});
  elements.add(3, {first, points, k, f}, 1);
  EXPECT_THROW(elements.add(3, {first, points, k, f}, 0), InputError);
  EXPECT_THROW(elements.add(3, {first, points, k, Eigen::VectorXd::Zero(3)}, 1), InputError);
  const std::vector<SubdomainMatrix> matrices = elements.take();
  ASSERT_EQ(matrices.size(), 2u);
  EXPECT_EQ(matrices[0].body, 1);
  EXPECT_EQ(matrices[1].unknowns, (std::vector<GlobalOrdinal>{4, 9, 2}));
  EXPECT_EQ(matrices[1].stiffness.coeff(1, 1), 3 + 2);
  EXPECT_EQ(matrices[1].stiffness.coeff(0, 2), 0);
  EXPECT_EQ(matrices[1].load, Eigen::Vector3d(1, 10 + 1, 10));
  EXPECT_EQ(matrices[1].coordinates.row(1), points.row(1)); // the first one counts
}

} // namespace
} // namespace epafi::fetidp
