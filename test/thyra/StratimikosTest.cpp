#include "../base/Refusal.hpp"
#include "../linear/Samples.hpp"

#include "epafi/fetidp/ThyraOperators.hpp"
#include "epafi/linear/FetiDpSolver.hpp"
#include "epafi/thyra/FetiDpSolve.hpp"
#include "epafi/thyra/Stratimikos.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

namespace epafi::thyra {
namespace {

using linear::denseOf;

/// A list as it ships with Epafi.
RCP<Teuchos::ParameterList> shippedList(const std::string& name) {
  return Teuchos::getParametersFromXmlFile(std::string(EPAFI_SOURCE_DIR) + "/xml/linear/" + name);
}

/// Both strategies under their own names.
void enable(Stratimikos::DefaultLinearSolverBuilder& builder,
            const RCP<const linear::UnassembledOperator>& k) {
  enableFetiDp(builder);
  enableBddc(builder, k);
}

/// Solves by whatever the list asks for; x, and the status. Collective.
Eigen::MatrixXd solved(const RCP<Teuchos::ParameterList>& list, const linear::LinearProblem& problem,
                       const RCP<const Operator>& forward, Thyra::SolveStatus<double>& status) {
  Stratimikos::DefaultLinearSolverBuilder builder;
  enable(builder, problem.k);
  builder.setParameterList(list);
  const auto factory = Thyra::createLinearSolveStrategy(builder);
  const auto k = fetidp::asThyra(forward);
  const auto op = Thyra::linearOpWithSolve<double>(*factory, k);
  const RCP<Vector> x = rcp(new Vector(forward->getDomainMap()));
  status = op->solve(Thyra::NOTRANS, *Thyra::createVector<double>(problem.k->load(), k->range()),
                     Thyra::createVector<double>(x, k->domain()).ptr());
  return denseOf(*x);
}

TEST(StratimikosTest, PicksFetiDpAndBddcByNameFromTheListsThatShip) {
  const linear::LinearProblem problem(linear::plate(12, decomposition::grid(3, 3)));
  const Eigen::MatrixXd expected = denseOf(*problem.k).llt().solve(denseOf(*problem.k->load()));
  Thyra::SolveStatus<double> status;
  EXPECT_LE(linear::relativeError(solved(shippedList("fetidp.xml"), problem, problem.k, status), expected),
            1e-7);
  EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_CONVERGED) << status.message;
  // BDDC of the assembled matrix, and of K itself.
  for (const RCP<const Operator>& forward :
       {RCP<const Operator>(assembled(*problem.k)), RCP<const Operator>(problem.k)}) {
    EXPECT_LE(linear::relativeError(solved(shippedList("bddc.xml"), problem, forward, status), expected),
              1e-7);
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
  solved(list, problem, problem.k, status);
  EXPECT_EQ(status.solveStatus, Thyra::SOLVE_STATUS_UNCONVERGED);
  EXPECT_EQ(status.extraParameters->get<int>("Iteration Count"), 1);
}

TEST(StratimikosTest, WrongParametersOfTheListAreRefused) {
  const linear::LinearProblem problem(linear::plate(4, decomposition::grid(2, 2)));
  const auto list = shippedList("fetidp.xml");
  list->sublist("Linear Solver Types")
      .sublist("Epafi FETI-DP")
      .sublist("Preconditioner")
      .set("Type", "neumann");
  Stratimikos::DefaultLinearSolverBuilder builder;
  enable(builder, Teuchos::null);
  test::expectSays(test::refusal([&] { builder.setParameterList(list); }),
                   {"\"Type\"", "neumann", "dirichlet"});
}

TEST(StratimikosTest, ItsValidParametersAreThoseOfTheFactories) {
  Stratimikos::DefaultLinearSolverBuilder builder;
  enable(builder, Teuchos::null);
  const auto valid = builder.getValidParameters();
  EXPECT_TRUE(
      valid->sublist("Linear Solver Types").sublist("Epafi FETI-DP").isSublist("Adaptive Constraints"));
  EXPECT_TRUE(valid->sublist("Preconditioner Types").sublist("Epafi BDDC").isParameter("Scaling"));
}

} // namespace
} // namespace epafi::thyra
