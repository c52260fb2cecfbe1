#include "Builder.hpp"
#include "support/LinearSamples.hpp"
#include "support/Refusal.hpp"

#include "epafi/adapters/Stratimikos.hpp"
#include "epafi/adapters/ThyraOperators.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::adapters {
namespace {

using linear::denseOf;

/// A list as it ships with Epafi.
RCP<Teuchos::ParameterList> shippedList(const std::string& name) {
  return Teuchos::getParametersFromXmlFile(std::string(EPAFI_SOURCE_DIR) + "/xml/linear/" + name);
}

/// Solves with K as `forward` by a strategy; x, and the status. Collective.
Eigen::MatrixXd solved(const LinearSolveStrategy& strategy, const linear::LinearProblem& problem,
                       const RCP<const Operator>& forward, Thyra::SolveStatus<double>& status) {
  const auto k = adapters::asThyra(forward);
  const auto op = Thyra::linearOpWithSolve<double>(strategy, k);
  const RCP<Vector> x = rcp(new Vector(forward->getDomainMap()));
  status = op->solve(Thyra::NOTRANS, *Thyra::createVector<double>(problem.load(), k->range()),
                     Thyra::createVector<double>(x, k->domain()).ptr());
  return denseOf(*x);
}

TEST(StratimikosTest, PicksFetiDpAndBddcByNameFromTheListsThatShip) {
  const linear::LinearProblem problem(linear::plate(12, decomposition::grid(3, 3)));
  const Eigen::MatrixXd expected = direct::solvedSymmetric(denseOf(*problem.k), denseOf(*problem.load()));
  Thyra::SolveStatus<double> status;
  const auto fetiDp = linearSolveStrategy(shippedList("fetidp.xml"));
  EXPECT_LE(linear::relativeError(solved(*fetiDp, problem, problem.k, status), expected), 1e-7);
  EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_CONVERGED) << status.message;
  // BDDC of the assembled matrix, and of K itself.
  const auto bddc = linearSolveStrategy(shippedList("bddc.xml"), problem.k);
  for (const RCP<const Operator>& forward :
       {RCP<const Operator>(assembled(*problem.k)), RCP<const Operator>(problem.k)}) {
    EXPECT_LE(linear::relativeError(solved(*bddc, problem, forward, status), expected), 1e-7);
    EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_CONVERGED) << status.message;
    EXPECT_LE(status.extraParameters->get<int>("Iteration Count"), 20);
  }
}

TEST(StratimikosTest, ParametersOfTheListReachTheSolver) {
  const linear::LinearProblem problem(linear::plate(8, decomposition::grid(2, 2)));
  const auto list = shippedList("fetidp.xml");
  Teuchos::ParameterList& ours = list->sublist("Linear Solver Types").sublist("Epafi FETI-DP");
  ours.set("Maximum Iterations", 1);
  Thyra::SolveStatus<double> status;
  solved(*linearSolveStrategy(list), problem, problem.k, status);
  EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_UNCONVERGED);
  EXPECT_EQ(status.extraParameters->get<int>("Iteration Count"), 1);
}

TEST(StratimikosTest, WrongParametersOfTheListAreRefused) {
  const auto list = shippedList("fetidp.xml");
  list->sublist("Linear Solver Types")
      .sublist("Epafi FETI-DP")
      .sublist("Preconditioner")
      .set("Type", "neumann");
  test::expectSays(test::refusal([&] { linearSolveStrategy(list); }), {"\"Type\"", "neumann", "dirichlet"});
}

TEST(StratimikosTest, AnApplicationsOwnBuilderTakesThemUnderAnyNames) {
  const linear::LinearProblem problem(linear::plate(8, decomposition::grid(2, 2)));
  const Eigen::MatrixXd expected = direct::solvedSymmetric(denseOf(*problem.k), denseOf(*problem.load()));
  const auto list = Teuchos::parameterList();
  list->set("Linear Solver Type", "Tearing");
  Thyra::SolveStatus<double> status;
  EXPECT_LE(linear::relativeError(solved(*strategyOfOwnBuilder(list, problem.k), problem, problem.k, status),
                                  expected),
            1e-7);
  list->set("Linear Solver Type", "Belos");
  list->set("Preconditioner Type", "Balancing");
  EXPECT_LE(linear::relativeError(solved(*strategyOfOwnBuilder(list, problem.k), problem,
                                         RCP<const Operator>(assembled(*problem.k)), status),
                                  expected),
            1e-4);
}

TEST(StratimikosTest, ItsValidParametersAreThoseOfTheFactories) {
  const auto valid = validParametersOfBuilder();
  EXPECT_TRUE(valid->sublist("Preconditioner Types").sublist("Epafi BDDC").isParameter("Scaling"));
}

} // namespace
} // namespace epafi::adapters
