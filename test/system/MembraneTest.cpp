#include "WholeRun.hpp"

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

  const drivers::SceneRun run = test::solve(scene, 1e-10);

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
      const drivers::SceneRun run = test::solve(
          cut.isGrid ? test::cutInGrid(scene, cut.number) : test::cutByMetis(scene, cut.number), 1e-10);
      EXPECT_EQ(run.solver->report().status, qp::Status::converged);
      EXPECT_NEAR(run.solution.energy, energy, error) << elements;
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
