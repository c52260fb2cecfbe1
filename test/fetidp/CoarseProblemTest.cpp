#include "support/Preconditioned.hpp"
#include "support/Reference.hpp"

#include "epafi/fetidp/operator/DualOperator.hpp"

#include "epafi/base/Collective.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

TEST(CoarseProblemTest, LiesOnOneRankWhereItIsTooLargeForAll) {
  const auto decomposition = decompose(twoMembranes(true, 8, grid(4, 4)), world());
  DirectSolvers solvers;
  solvers.maxReplicated = 3;
  const GeneralizedInverse onFirst(decomposition.problem, solvers);
  const GeneralizedInverse onAll(decomposition.problem, DirectSolvers());

  const int ranks = world()->getSize();
  EXPECT_TRUE(onAll.coarseProblem().isReplicated());
  EXPECT_EQ(onFirst.coarseProblem().isReplicated(), ranks == 1);
  const bool hasFactor = ranks == 1 || world()->getRank() == 0;
  EXPECT_EQ(onFirst.coarseProblem().factorBytes() > 0, hasFactor);
}

TEST(CoarseProblemTest, EachRankHasThePartOfItsClusters) {
  const scene::Decomposition cut =
      clustered(grid(4, 4), 4); // four clusters a body, which no rank begins in the middle of
  const auto decomposition = decompose(twoMembranes(false, 12, cut), world());
  const GeneralizedInverse inverse(decomposition.problem, DirectSolvers());
  const int ranks = world()->getSize();
  EXPECT_EQ(inverse.coarseProblem().isSplit(), ranks > 1);
  EXPECT_EQ(inverse.coarseProblem().team()->getSize(), 1);
  EXPECT_EQ(inverse.coarseProblem().isReplicated(), !inverse.coarseProblem().isSplit());
  // F of one rank, which has it all.
  const auto alone = decompose(twoMembranes(false, 12, cut), rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
  const auto f = [](const model::Decomposition& d) {
    return matrixOf(DualOperator(std::make_shared<GeneralizedInverse>(d.problem, DirectSolvers())));
  };
  EXPECT_LE(relativeError(f(decomposition), f(alone)), 1e-13);
}

/// A body that is one cluster beside one of four: on three and four ranks two share the first.
TEST(CoarseProblemTest, RanksThatShareAClusterAreATeam) {
  const int ranks = world()->getSize(), rank = world()->getRank();
  for (const bool coercive : {true, false}) {
    scene::Scene scene = twoMembranes(coercive, 12, grid(4, 4));
    scene.bodies[1].decomposition.cluster = 4;
    const Preconditioned together(scene), alone(scene, {}, thisRankOnly());
    const CoarseProblem& coarse = together.inverse->coarseProblem();
    if (ranks <= 4) {
      EXPECT_EQ(coarse.team()->getSize(), ranks > 2 && rank < 2 ? 2 : 1);
    }
    EXPECT_EQ(coarse.isSplit(), ranks > 1);
    EXPECT_LE(relativeError(matrixOf(together.f), matrixOf(alone.f)), 1e-13);
    EXPECT_LE(relativeError(matrixOf(together.m), matrixOf(alone.m)), 1e-12);
    for (const int maxReplicated : {0, 1000}) { // on the team's first rank, or on each
      DirectSolvers solvers;
      solvers.maxReplicated = maxReplicated;
      const auto inverse = std::make_shared<GeneralizedInverse>(together.problem, solvers);
      EXPECT_LE(relativeError(matrixOf(DualOperator(inverse)), matrixOf(alone.f)), 1e-13);
      EXPECT_EQ(inverse->coarseProblem().factorBytes() > 0,
                maxReplicated > 0 || coarse.team()->getRank() == 0);
    }
  }
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
      solver.setup(onAll.decomposition.problem, onAll.decomposition.data);
      const ContactSolution solution = solver.solve(onAll.decomposition.data);

      EXPECT_EQ(solver.report().status, qp::Status::converged);
      EXPECT_LE(
          fieldError(fieldOf(onAll.decomposition, solution), fieldOf(onAll.decomposition, onAll.solution)),
          1e-8);
      EXPECT_NEAR(solution.energy, onAll.solution.energy, 1e-9 * std::abs(onAll.solution.energy));
    }
}

} // namespace
} // namespace epafi::fetidp
