#include "support/WholeRun.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using test::number;

struct Cut {
  bool isGrid;
  int number; ///< subdomains a side, or parts of METIS
};

/// A line of membranes.csv and a decomposition of each body.
class MembraneTest : public testing::TestWithParam<std::tuple<test::Row, Cut>> {};

std::vector<test::Row> rowsUpTo(double elements) {
  std::vector<test::Row> rows;
  for (const test::Row& row : test::referenceRows("membranes.csv"))
    if (number(row, "elements_per_unit_side") <= elements)
      rows.push_back(row);
  return rows;
}

TEST_P(MembraneTest, AgreesWithTheUndecomposedReference) {
  const auto& [row, cut] = GetParam();
  const scene::Scene whole =
      scene::modelProblem(row.at("problem") == "coercive", 1, std::stoi(row.at("elements_per_unit_side")));
  const scene::Scene scene =
      cut.isGrid ? test::cutInGrid(whole, cut.number) : test::cutByMetis(whole, cut.number);

  const simulation::SceneRun run = test::solve(scene, 1e-10);

  EXPECT_EQ(run.decomposition->problem.numSubdomains, 2 * cut.number * (cut.isGrid ? cut.number : 1));
  EXPECT_EQ(run.solver->report().status, qp::Status::converged);
  const double energy = number(row, "energy");
  EXPECT_NEAR(run.solution.energy, energy, 1e-8 * std::abs(energy));
  EXPECT_NEAR(run.solution.contactForce, number(row, "contact_force"), 1e-8);
  EXPECT_EQ(static_cast<double>(run.solution.activeContactNodes), number(row, "active_contact_nodes"));
  const Eigen::VectorXd left = test::deflection(run, 0), right = test::deflection(run, 1);
  EXPECT_NEAR(left.minCoeff(), number(row, "left_min"), 1e-8);
  EXPECT_NEAR(right.minCoeff(), number(row, "right_min"), 1e-8);
  EXPECT_NEAR(right.maxCoeff(), number(row, "right_max"), 1e-8);
}

/// Energies of quadratic elements against the limits of meshes of any size (Richardson).
TEST(QuadraticMembraneTest, EnergiesAreNearTheLimit) {
  struct Mesh {
    bool isCoercive;
    int elements;
    double energy, error;
  };
  for (const auto& [isCoercive, elements, energy, error] :
       {Mesh{true, 16, -0.119219355, 4e-7}, {true, 64, -0.119219355, 3e-9}, {false, 32, -0.54382078, 1e-7}})
    for (const Cut cut : {Cut{true, 4}, Cut{false, 7}}) {
      scene::Scene scene = scene::modelProblem(isCoercive, 1, elements);
      for (scene::Body& body : scene.bodies)
        body.mesh.order = 2;
      const simulation::SceneRun run = test::solve(
          cut.isGrid ? test::cutInGrid(scene, cut.number) : test::cutByMetis(scene, cut.number), 1e-10);
      EXPECT_EQ(run.solver->report().status, qp::Status::converged);
      EXPECT_NEAR(run.solution.energy, energy, error) << elements;
    }
}

struct Apart {
  bool isCoercive;
  int order;
  scene::SurfaceContact::Side side;
};

scene::Scene membranesApart(const Apart& apart, int elements) {
  scene::Scene scene = scene::modelProblem(apart.isCoercive, 1, elements);
  scene.bodies[1].mesh.elements = {elements * 3 / 2, elements * 3 / 2, 0};
  for (scene::Body& body : scene.bodies)
    body.mesh.order = apart.order;
  scene.contacts[0].multipliers = apart.side;
  return scene;
}

/// Meshed apart, membranes have energies that converge to the same limits, with order 2 at least.
TEST(MembranesApartTest, EnergiesConvergeWhicheverSideHasTheMultipliers) {
  using Side = scene::SurfaceContact::Side;
  for (const auto& [apart, first] : {std::pair(Apart{true, 1, Side::first}, 1.7e-4),
                                     {{true, 1, Side::second}, 1.7e-4},
                                     {{false, 1, Side::first}, 8.4e-4},
                                     {{false, 1, Side::second}, 8.4e-4},
                                     {{true, 2, Side::first}, 1e-6},
                                     {{false, 2, Side::second}, 4e-6}}) {
    const double limit = apart.isCoercive ? -0.119219355 : -0.543820777;
    double last = first;
    for (const int elements : {16, 32, 64}) {
      const simulation::SceneRun run =
          test::solve(test::cutInGrid(membranesApart(apart, elements), 4), 1e-10);
      EXPECT_EQ(run.solver->report().status, qp::Status::converged);
      const double error = std::abs(run.solution.energy - limit);
      EXPECT_LE(error, last) << apart.isCoercive << apart.order << ' ' << elements;
      last = apart.order == 1 ? 0.27 * error
                              : 0.5 * error + 2e-9; // of order 2 the zone's end moves from element to element
    }
  }
}

/// A membrane in two parts that are tied is one membrane: with parts meshed alike to round-off, else up to
/// the mesh's error.
TEST(MembranesApartTest, TiedPartsAreOneMembrane) {
  const auto energyOf = [](const scene::Scene& scene) {
    return test::solve(test::cutInGrid(scene, 3), 1e-11).solution.energy;
  };
  for (const bool isHeld : {true, false}) {
    scene::Scene parts = scene::modelProblem(isHeld, 1, 12);
    for (scene::Body& body : parts.bodies)
      body.loads = {fem::loadInside("weight", body.mesh.box, -1)};
    parts.contacts[0].kind = scene::SurfaceContact::Kind::tied;
    scene::Scene whole = parts;
    whole.bodies.pop_back();
    whole.contacts.clear();
    whole.bodies[0].mesh.box = mesh::rectangle(0, 2, 0, 1);
    whole.bodies[0].mesh.elements = {24, 12, 0};
    whole.bodies[0].loads = {fem::loadInside("weight", whole.bodies[0].mesh.box, -1)};
    if (isHeld)
      whole.bodies[0].supports.push_back({"end", "right", {0.0}});
    const double expected = energyOf(whole);
    EXPECT_NEAR(energyOf(parts), expected, 1e-11 * std::abs(expected));
    parts.bodies[1].mesh.elements = {8, 8, 0}; // what hangs on the joint alone floats, if not held
    const simulation::SceneRun run = test::solve(test::cutInGrid(parts, 3), 1e-11);
    EXPECT_EQ(run.decomposition->problem.kernelDimension, isHeld ? 0 : 1);
    EXPECT_EQ(run.solver->report().status, qp::Status::converged);
    EXPECT_NEAR(run.solution.energy, expected, 2e-3 * std::abs(expected));
  }
}

std::string nameOf(const testing::TestParamInfo<MembraneTest::ParamType>& info) {
  const auto& [row, cut] = info.param;
  return row.at("problem") + "_" + row.at("elements_per_unit_side") + (cut.isGrid ? "_grid" : "_metis") +
         std::to_string(cut.number);
}

INSTANTIATE_TEST_SUITE_P(AllMeshesAndCuts, MembraneTest,
                         testing::Combine(testing::ValuesIn(rowsUpTo(128)),
                                          testing::Values(Cut{true, 1}, Cut{true, 2}, Cut{true, 4},
                                                          Cut{true, 8}, Cut{false, 3}, Cut{false, 7},
                                                          Cut{false, 16})),
                         nameOf);

} // namespace
