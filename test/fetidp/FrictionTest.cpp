// Friction, Tresca's and Coulomb's, as an application hands it over.

#include "support/DenseProblem.hpp"
#include "support/HandedOver.hpp"
#include "support/Refusal.hpp"
#include "support/SolidScenes.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/FrictionRows.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace epafi::fetidp {
namespace {

using namespace decomposition;

/// A square or cube of E = 1, ν = 0.3 and n elements of order 2 a side that stands on a floor, pressed by
/// 0.01 on its top and sheared there; nothing else holds it.
scene::Scene blockOnFloor(int dimension, int n, const Vector3& shear, const scene::Decomposition& cut) {
  scene::Scene scene;
  scene::Body block = test::block("block", {{0, 0, 0}, {1, 1, 1}}, {n, n, dimension == 3 ? n : 0}, cut);
  block.material.youngsModulus = 1;
  block.material.poissonsRatio = 0.3;
  block.mesh.order = 2;
  block.loads.push_back(test::loadOn("top", shear));
  block.loads[0].value[static_cast<std::size_t>(dimension - 1)] = -0.01;
  scene.bodies.push_back(block);
  Vector3 up{0, 0, 0};
  up[static_cast<std::size_t>(dimension - 1)] = 1;
  scene.contacts.push_back(test::onPlane("floor", 0, "bottom", {0, 0, 0}, up));
  return scene;
}

/// What a node of the floor takes of an integral over it, from its place: Simpson's rule along each axis.
double areaOf(const Eigen::VectorXd& place, int n) {
  double area = 1;
  for (Eigen::Index axis = 0; axis + 1 < place.size(); ++axis) {
    const int i = static_cast<int>(std::lround(2 * n * place[axis]));
    area *= (i % 2 == 1 ? 4.0 : i == 0 || i == 2 * n ? 1.0 : 2.0) / (6 * n);
  }
  return area;
}

/// The block as an application's problem with friction everywhere on its floor.
struct Handed {
  /// \param traction  Tresca's bound \param coefficient Coulomb's
  Handed(const scene::Scene& scene, int elements, double traction, double coefficient = 0) : n(elements) {
    matrices = matricesOf(scene, Supports::prescribed);
    for (const SubdomainMatrix& matrix : matrices)
      loads.push_back(matrix.load);
    std::map<GlobalOrdinal, double> areas; // by node
    const int components = static_cast<int>(matrices.empty() ? 2 : matrices.front().coordinates.cols());
    for (const SubdomainMatrix& matrix : matrices)
      for (std::size_t i = 0; i < matrix.unknowns.size(); ++i)
        areas[matrix.unknowns[i] / components] =
            areaOf(matrix.coordinates.row(static_cast<Eigen::Index>(i)), n);
    struct NodeArea {
      GlobalOrdinal node;
      double area;
    };
    std::vector<NodeArea> all;
    for (const auto& [node, area] : areas)
      all.push_back({node, area});
    for (const NodeArea& each : gatherOnAll(*world(), all))
      areas[each.node] = each.area;
    const model::Decomposition direct = model::decompose(scene, world());
    const ConstraintMatrix contact = contactOf(scene, direct, Supports::prescribed);
    problem = handOver(scene, std::move(matrices));
    const int numComponents = direct.problem.components;
    const FrictionRows friction = frictionAlong(contact, numComponents);
    problem->setContact(contact);
    problem->setFriction(friction);
    problem->complete();
    std::vector<double> bounds;
    for (const FrictionNode& node : problem->problem().frictionNodes) {
      const GlobalOrdinal row = problem->problem().numberOf(node.contact);
      CrsMatrix::local_inds_host_view_type columns;
      CrsMatrix::values_host_view_type values;
      contact.rows->getLocalRowView(contact.rows->getRowMap()->getLocalElement(row), columns, values);
      const GlobalOrdinal unknown = contact.rows->getColMap()->getGlobalElement(columns(0));
      bounds.push_back(traction * areas.at(unknown / numComponents));
    }
    data = problem->data();
    data.setFrictionBounds(problem->problem(), bounds);
    data.setFrictionCoefficients(problem->problem(), std::vector<double>(bounds.size(), coefficient));
  }

  void solve(double tolerance = 1e-10, const std::string& algorithm = "auto") {
    solver = std::make_unique<ContactSolver>(Teuchos::ParameterList()
                                                 .set("Tolerance", tolerance)
                                                 .set("Equilibrium Tolerance", tolerance)
                                                 .set("Algorithm", algorithm));
    solver->setup(problem->problem(), data);
    solution = solver->solve(data);
  }
  [[nodiscard]] double loadWork() const {
    double work = 0;
    for (std::size_t s = 0; s < loads.size(); ++s)
      work += loads[s].dot(problem->unknowns(s, solution.displacement));
    return sumOverRanks(*world(), work);
  }
  [[nodiscard]] double strainEnergy() const { return solution.energy + loadWork(); }

  int n;
  std::vector<SubdomainMatrix> matrices;
  std::vector<Eigen::VectorXd> loads;
  std::unique_ptr<UnassembledProblem> problem;
  ProblemData data;
  std::unique_ptr<ContactSolver> solver;
  ContactSolution solution;
};

/// Values of an independent solver (whole bodies by one factor, exact Newton), the same meshes and rows.
struct Reference {
  int dimension, n;
  Vector3 shear;
  double traction, coefficient, strainEnergy, loadWork;
};
const Vector3 inPlane{0.002, 0, 0}, inSpace{0.0018, 0.0009, 0};
const std::vector<Reference> references{{2, 16, inPlane, 0.003, 0, 5.80514928e-5, 1.17344228e-4},
                                        {2, 16, inPlane, 0, 0.3, 5.76169527e-5, 1.15260975e-4},
                                        {3, 2, inSpace, 0.003, 0, 6.29551509e-5, 1.27857219e-4},
                                        {3, 2, inSpace, 0, 0.3, 6.20447136e-5, 1.24847535e-4},
                                        {3, 4, inSpace, 0.003, 0, 6.30634101e-5, 1.27869984e-4},
                                        {3, 4, inSpace, 0, 0.3, 6.23291032e-5, 1.24960894e-4}};

TEST(FrictionTest, ABlockSlipsAsFarAsAnIndependentSolverSays) {
  for (const Reference& reference : references)
    for (const int parts : {2, 4}) {
      SCOPED_TRACE(std::to_string(reference.dimension) + "-D, n = " + std::to_string(reference.n) + ", " +
                   std::to_string(parts) + " parts a side, " +
                   (reference.coefficient > 0 ? "Coulomb" : "Tresca"));
      if (parts > reference.n || (reference.dimension == 3 && parts > 2))
        continue;
      Handed handed(blockOnFloor(reference.dimension, reference.n, reference.shear,
                                 test::cutInGrid({parts, parts, reference.dimension == 3 ? parts : 1})),
                    reference.n, reference.traction, reference.coefficient);

      handed.solve();

      EXPECT_EQ(handed.solver->report().status, qp::Status::converged) << handed.solver->report().reason;
      EXPECT_NEAR(handed.strainEnergy() / reference.strainEnergy, 1, 1e-8);
      EXPECT_NEAR(handed.loadWork() / reference.loadWork, 1, 1e-8);
      // from rest, in proportion: f'u = 2E + D
      EXPECT_NEAR(handed.loadWork(), 2 * handed.strainEnergy() + handed.solution.dissipation,
                  1e-8 * handed.loadWork());
      EXPECT_GT(handed.solution.dissipation, 0);
      EXPECT_LE(handed.solver->report().counts.hessianMultiplications, 120);
    }
}

TEST(FrictionTest, AFixedPointOfGivenBoundsEndsWhereAnIndependentSolverDoes) {
  for (const Reference& reference : references) {
    SCOPED_TRACE(std::to_string(reference.dimension) + "-D");
    Handed handed(blockOnFloor(reference.dimension, reference.n, reference.shear,
                               test::cutInGrid({2, 2, reference.dimension == 3 ? 2 : 1})),
                  reference.n, reference.traction, reference.coefficient);
    handed.solve();
    const int products = handed.solver->report().counts.hessianMultiplications;

    handed.solve(1e-10, "fixed point");

    EXPECT_EQ(handed.solver->report().status, qp::Status::converged) << handed.solver->report().reason;
    EXPECT_NEAR(handed.strainEnergy() / reference.strainEnergy, 1, 1e-8);
    EXPECT_NEAR(handed.loadWork() / reference.loadWork, 1, 1e-8);
    const int more = handed.solver->report().counts.hessianMultiplications - products;
    EXPECT_TRUE(reference.coefficient > 0 ? more > 0 : more == 0) << more;
  }
}

TEST(FrictionTest, WhereTheBoundIsHighTheFloorHoldsLikeATie) {
  for (const int dimension : {2, 3}) {
    const int n = dimension == 2 ? 8 : 2;
    const scene::Decomposition cut = test::cutInGrid({2, 2, dimension == 3 ? 2 : 1});
    scene::Scene scene = blockOnFloor(dimension, n, {0.0005, 0, 0}, cut);
    Handed handed(scene, n, 1e3);
    handed.solve();
    ASSERT_EQ(handed.solver->report().status, qp::Status::converged) << handed.solver->report().reason;

    scene.contacts.clear();
    scene.bodies[0].supports.push_back({"foot", "bottom", {0.0, 0.0, 0.0}});
    const test::SolidRun held(scene);

    if (handed.solution.activeContactNodes == handed.problem->problem().numInequalities)
      EXPECT_NEAR(handed.solution.energy, held.solution.energy, 1e-8 * std::abs(held.solution.energy));
    else // corners lift
      EXPECT_LE(handed.solution.energy, held.solution.energy);
    EXPECT_NEAR(handed.solution.dissipation, 0, 1e-9 * std::abs(held.solution.energy));
  }
}

TEST(FrictionTest, ALoadBeyondWhatFrictionHoldsIsRefused) {
  for (const int dimension : {2, 3}) {
    Handed handed(blockOnFloor(dimension, 2, {0.004, 0, 0}, test::cutInGrid({2, 2, dimension == 3 ? 2 : 1})),
                  2, 0.003);
    test::expectSays(test::unsolvable(SolvabilityError::Kind::noSolution, [&] { handed.solve(); }),
                     {"friction"});
  }
}

TEST(FrictionTest, WithoutABoundThereIsNoFriction) {
  for (const int dimension : {2, 3}) {
    scene::Scene scene =
        blockOnFloor(dimension, 2, {0, 0, 0}, test::cutInGrid({2, 2, dimension == 3 ? 2 : 1}));
    scene.bodies[0].supports.push_back(test::slide("left"));
    if (dimension == 3)
      scene.bodies[0].supports.push_back(test::slide("front"));
    Handed handed(scene, 2, 0.0);
    handed.solve();
    const test::SolidRun smooth(scene);

    EXPECT_EQ(handed.solver->report().status, qp::Status::converged) << handed.solver->report().reason;
    EXPECT_NEAR(handed.solution.energy, smooth.solution.energy, 1e-9 * std::abs(smooth.solution.energy));
  }
}

TEST(FrictionTest, TangentsAreARightHandedFrame) {
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 2, 3).normalized()}) {
    const auto [first, second] = tangentsOf(normal);
    Eigen::Matrix3d axes;
    axes << first, second, normal;
    EXPECT_LE((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(FrictionTest, BoundsBelowZeroAreRefused) {
  Handed handed(blockOnFloor(2, 2, {0, 0, 0}, test::cutInGrid({1, 1, 1})), 2, 0.003);
  const std::vector<double> bounds(handed.problem->problem().frictionNodes.size(), -1.0);
  if (!bounds.empty()) {
    EXPECT_THROW(handed.data.setFrictionBounds(handed.problem->problem(), bounds), InputError);
  }
}

} // namespace
} // namespace epafi::fetidp
