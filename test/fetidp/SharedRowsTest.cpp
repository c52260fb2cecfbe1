#include "support/DataChanges.hpp"
#include "support/Reference.hpp"

#include "epafi/fetidp/operator/DualOperator.hpp"
#include "epafi/fetidp/precondition/SharedRows.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace epafi::fetidp {
namespace {

/// Row 1 of contact says what row 0 says, with a wider gap: only the narrower one can carry force.
void repeatRow(model::Decomposition& decomposition, double wider) {
  DecomposedProblem& problem = decomposition.problem;
  for (auto& subdomain : problem.subdomains) {
    auto& entries = subdomain.constraint;
    const int first = problem.multiplierGhostMap->getLocalElement(0),
              second = problem.multiplierGhostMap->getLocalElement(1);
    if (first < 0 || second < 0)
      continue;
    std::erase_if(entries, [&](const auto& entry) { return entry.multiplier == second; });
    const auto kept = entries;
    for (const auto& entry : kept)
      if (entry.multiplier == first)
        entries.push_back({second, entry.unknown, entry.coefficient});
  }
  decomposition.data = changed(decomposition.data, [&](const auto& /*subdomains*/, Vector& gap) {
    if (problem.multiplierMap->isNodeGlobalElement(1))
      gap.replaceGlobalValue(1, wider);
  });
}

/// The global indices of the shared rows, on every rank.
std::vector<GlobalOrdinal> sharedRows(const DecomposedProblem& problem) {
  Vector marks(problem.multiplierMap);
  const Import plan(problem.multiplierMap, problem.multiplierGhostMap);
  for (const LocalOrdinal row : ownEntries(problem, plan).dependent)
    marks.replaceLocalValue(row, 1.0);
  std::vector<GlobalOrdinal> rows;
  const Eigen::VectorXd all = gathered(marks);
  for (Eigen::Index row = 0; row < all.size(); ++row)
    if (all[row] > 0)
      rows.push_back(row);
  return rows;
}

TEST(SharedRowsTest, RowsAtDifferentNodesShareNothing) {
  EXPECT_TRUE(sharedRows(decompose(twoMembranes(true, 4, grid(2, 2)), world()).problem).empty());
}

TEST(SharedRowsTest, RowsOfTheSameNodesAreFoundWhicheverRankHasThem) {
  auto decomposition = decompose(twoMembranes(true, 4, grid(2, 2)), world());
  repeatRow(decomposition, 0.5);
  EXPECT_EQ(sharedRows(decomposition.problem), (std::vector<GlobalOrdinal>{0, 1}));
}

TEST(SharedRowsTest, AShiftAddsItsMultipleOnItsRowsAlone) {
  const auto decomposition = decompose(twoMembranes(true, 4, grid(2, 2)), world());
  const Eigen::MatrixXd zero =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(decomposition.problem.dualDimension()),
                            static_cast<Eigen::Index>(decomposition.problem.dualDimension()));
  std::vector<LocalOrdinal> rows;
  if (const LocalOrdinal row = decomposition.problem.multiplierMap->getLocalElement(2); row >= 0)
    rows.push_back(row);
  auto inverse = std::make_shared<GeneralizedInverse>(decomposition.problem, DirectSolvers());
  inverse->prepareDual({});
  const RCP<const Operator> f = rcp(new DualOperator(inverse));
  const ShiftedPreconditioner shifted(f, rows, 3.0);
  Eigen::MatrixXd expected = zero;
  expected(2, 2) = 3;
  EXPECT_LE((matrixOf(shifted) - matrixOf(*f) - expected).norm(), 1e-12 * matrixOf(*f).norm());
}

TEST(SharedRowsTest, OfTwoRowsThatSayTheSameTheNarrowerOneCarriesTheForce) {
  for (const bool coercive : {true, false})
    for (const double wider : {1e-3, 1e-9}) {
      scene::Scene scene = twoMembranes(coercive, 4, grid(2, 2));
      setLoad(scene.bodies[0], 1.0);
      setLoad(scene.bodies[1], -1.0);
      auto decomposition = decompose(scene, world());
      repeatRow(decomposition, wider);
      ContactSolver solver(toleranceOf(1e-10));
      solver.setup(decomposition.problem, decomposition.data);
      const ContactSolution solution = solver.solve(decomposition.data);
      ASSERT_EQ(solver.report().status, qp::Status::converged) << solver.report().reason;
      const Eigen::VectorXd forces = gathered(*solution.multiplier), slack = gathered(*solution.slack);
      EXPECT_GT(forces[0], 1e-3);
      EXPECT_LE(std::abs(slack[0]), 1e-9);
      EXPECT_EQ(forces[1], 0);
      EXPECT_NEAR(slack[1], wider, 1e-9);
    }
}

} // namespace
} // namespace epafi::fetidp
