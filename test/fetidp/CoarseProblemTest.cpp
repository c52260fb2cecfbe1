#include "Reference.hpp"

#include "epafi/fetidp/DualOperator.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_Comm.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

TEST(CoarseProblemTest, LiesOnOneRankWhereItIsTooLargeForAll) {
  const auto decomposition = decompose(twoMembranes(true, 8, grid(4, 4)), world());
  DirectSolvers solvers;
  solvers.maxReplicated = 3;
  const GeneralizedInverse onFirst(decomposition.problem, solvers);
  const GeneralizedInverse onAll(decomposition.problem, DirectSolvers());

  EXPECT_TRUE(onAll.coarseProblem().isReplicated());
  EXPECT_EQ(onFirst.coarseProblem().isReplicated(), world()->getSize() == 1);
  const bool hasFactor = world()->getSize() == 1 || world()->getRank() == 0;
  EXPECT_EQ(onFirst.coarseProblem().factorBytes() > 0, hasFactor);
}

TEST(CoarseProblemTest, TakesManyColumnsOnOneRankAsOnAll) {
  const auto decomposition = decompose(twoMembranes(false, 8, grid(4, 4)), world());
  const auto matrixWith = [&](int maxReplicated) {
    DirectSolvers solvers;
    solvers.maxReplicated = maxReplicated;
    return matrixOf(DualOperator(std::make_shared<GeneralizedInverse>(decomposition.problem, solvers)));
  };
  const Eigen::MatrixXd onAll = matrixWith(1000);
  EXPECT_LE(relativeError(matrixWith(0), onAll), 1e-13);
}

TEST(CoarseProblemTest, GivesTheSameSolutionOnOneRankAsOnAll) {
  for (const bool coercive : {true, false})
    for (const auto& cut : {grid(3, 3), metis(7)}) {
      SCOPED_TRACE(testing::Message() << coercive << ' ' << cut.parts);
      scene::Scene scene = twoMembranes(coercive, 9, cut);
      setHalves(scene.bodies[0], 4.0, -5.0);
      setHalves(scene.bodies[1], -3.0, 2.0);
      Solved onAll(scene, 1e-10);
      Teuchos::ParameterList parameters = toleranceOf(1e-10);
      parameters.sublist("Direct Solvers").set("Maximum Replicated Size", 0);
      ContactSolver solver(parameters);
      solver.setup(onAll.decomposition.problem);
      const ContactSolution solution = solver.solve();

      EXPECT_EQ(solver.report().status, qp::Status::converged);
      EXPECT_LE(
          fieldError(fieldOf(onAll.decomposition, solution), fieldOf(onAll.decomposition, onAll.solution)),
          1e-8);
      EXPECT_NEAR(solution.energy, onAll.solution.energy, 1e-9 * std::abs(onAll.solution.energy));
    }
}

} // namespace
} // namespace epafi::fetidp
