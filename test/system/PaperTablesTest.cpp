#include "WholeRun.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using test::number;

/// A line of paper_tables.csv.
class PaperTablesTest : public testing::TestWithParam<test::Row> {};

TEST_P(PaperTablesTest, DimensionsAreThePapersAndCgStepsAreNotMore) {
  const test::Row& row = GetParam();
  const int counts = std::stoi(row.at("H_inverse"));
  const int elements = counts * std::stoi(row.at("H_over_h"));
  const scene::Scene scene = scene::modelProblem(row.at("problem") == "coercive", counts, elements);

  const drivers::SceneRun run = test::solve(scene, 1e-6);

  const auto& problem = run.decomposition->problem;
  EXPECT_EQ(static_cast<double>(problem.primalDimension), number(row, "primal_dimension"));
  EXPECT_EQ(static_cast<double>(problem.dualDimension()), number(row, "dual_dimension"));
  EXPECT_EQ(static_cast<double>(problem.numCrosspoints), number(row, "corners"));
  EXPECT_EQ(run.solver->report().status, qp::Status::converged);
  EXPECT_LE(run.solution.relativeProjectedGradient, 1e-6);
  EXPECT_LE(run.solver->report().counts.conjugateGradient, number(row, "cg_iterations"));
}

INSTANTIATE_TEST_SUITE_P(AllCells, PaperTablesTest,
                         testing::ValuesIn(test::referenceRows("paper_tables.csv")), [](const auto& cell) {
                           return cell.param.at("problem") + "_" + cell.param.at("H_inverse") + "_" +
                                  cell.param.at("H_over_h");
                         });

} // namespace
