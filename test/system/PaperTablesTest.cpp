#include "support/WholeRun.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace {

using namespace epafi;
using test::number;

/// A line of paper_tables.csv. plain_method.csv holds the products with F that a dense implementation of the
/// plain method needs (fixed expansion steps of 1.9/‖F‖, release along the chopped gradient, penalty
/// 10‖PFP‖).
class PaperTablesTest : public testing::TestWithParam<test::Row> {
protected:
  static void TearDownTestSuite() {
    if (numCells == 18) { // not a part of them
      EXPECT_LE(numProducts, 0.85 * numPlainProducts) << numPlainProducts;
      EXPECT_LE(numPreconditionedProducts, 0.8 * numProducts) << numProducts;
    }
  }
  static int productsOfPlainMethod(const test::Row& cell) {
    for (const test::Row& row : test::referenceRows("plain_method.csv"))
      if (row.at("problem") == cell.at("problem") && row.at("H_inverse") == cell.at("H_inverse") &&
          row.at("H_over_h") == cell.at("H_over_h"))
        return std::stoi(row.at("hessian_multiplications"));
    return 0;
  }

  static inline int numCells = 0, numProducts = 0, numPlainProducts = 0, numPreconditionedProducts = 0;
};

TEST_P(PaperTablesTest, DimensionsAreThePapersAndTheWorkIsLess) {
  const test::Row& row = GetParam();
  const int counts = std::stoi(row.at("H_inverse"));
  const int elements = counts * std::stoi(row.at("H_over_h"));
  const scene::Scene scene = scene::modelProblem(row.at("problem") == "coercive", counts, elements);

  Teuchos::ParameterList plain; // the paper's method
  plain.sublist("Preconditioner").set("Type", "none");

  const simulation::SceneRun run = test::solve(scene, 1e-6, Tpetra::getDefaultComm(), plain);

  const auto& problem = run.decomposition->problem;
  EXPECT_EQ(static_cast<double>(problem.primalDimension), number(row, "primal_dimension"));
  EXPECT_EQ(static_cast<double>(problem.dualDimension()), number(row, "dual_dimension"));
  EXPECT_EQ(static_cast<double>(problem.numCrosspoints), number(row, "corners"));
  EXPECT_EQ(run.solver->report().status, qp::Status::converged);
  EXPECT_LE(run.solution.relativeProjectedGradient, 1e-6);
  EXPECT_LE(run.solver->report().counts.conjugateGradient, number(row, "cg_iterations"));
  const int products = run.solver->report().counts.hessianMultiplications;
  EXPECT_LE(products, productsOfPlainMethod(row));
  const int preconditioned = test::solve(scene, 1e-6).solver->report().counts.hessianMultiplications;
  numPreconditionedProducts += preconditioned;
  ++numCells;
  numProducts += products;
  numPlainProducts += productsOfPlainMethod(row);
}

INSTANTIATE_TEST_SUITE_P(AllCells, PaperTablesTest,
                         testing::ValuesIn(test::referenceRows("paper_tables.csv")), [](const auto& cell) {
                           return cell.param.at("problem") + "_" + cell.param.at("H_inverse") + "_" +
                                  cell.param.at("H_over_h");
                         });

} // namespace
