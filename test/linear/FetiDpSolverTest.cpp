#include "support/LinearSamples.hpp"

#include "support/Refusal.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/linear/BddcPreconditioner.hpp"
#include "epafi/linear/FetiDpSolver.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace epafi::linear {
namespace {

/// Three right-hand sides: the problem's own loads, zero, and another one.
Eigen::MatrixXd threeLoads(const LinearProblem& problem) {
  Eigen::MatrixXd b = denseOf(*problem.load()).replicate(1, 3);
  b.col(1).setZero();
  for (Eigen::Index i = 0; i < b.rows(); ++i)
    b(i, 2) = std::sin(static_cast<double>(3 * i + 1));
  return b;
}

/// ‖b − Kx‖ relative to ‖b‖, column by column, by dense algebra.
Eigen::VectorXd residuals(const Eigen::MatrixXd& k, const Eigen::MatrixXd& b, const Eigen::MatrixXd& x) {
  Eigen::VectorXd sizes = b.colwise().norm();
  for (double& size : sizes)
    size = size > 0 ? size : 1;
  return (b - k * x).colwise().norm().transpose().cwiseQuotient(sizes);
}

TEST(FetiDpSolverTest, SolvesSeveralRightHandSidesAtOnce) {
  for (const LinearCase& c : linearCases()) {
    SCOPED_TRACE(c.name);
    const LinearProblem problem(c.scene);
    const Eigen::MatrixXd k = denseOf(*problem.k), b = threeLoads(problem);
    FetiDpSolver solver(problem.k, {});
    const RCP<MultiVector> x = rcp(new MultiVector(problem.k->getDomainMap(), 3));
    const LinearReport report = solver.solve(*spreadOn(problem.k->getRangeMap(), b), *x);
    EXPECT_TRUE(report.converged) << report.reason;
    const Eigen::MatrixXd found = denseOf(*x);
    const Eigen::VectorXd recomputed = residuals(k, b, found);
    EXPECT_LE(recomputed.maxCoeff(), 1.001e-8);
    EXPECT_EQ(found.col(1).cwiseAbs().maxCoeff(), 0);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(report.relativeResiduals[j], recomputed[j], 1e-13);
    EXPECT_LE(relativeError(found, direct::solvedSymmetric(k, b)), 1e-6);
  }
}

TEST(FetiDpSolverTest, EachColumnIsSolvedAsIfItWereAlone) {
  const LinearProblem problem(plate(12, decomposition::grid(3, 3)));
  const Eigen::MatrixXd b = threeLoads(problem);
  FetiDpSolver solver(problem.k, {});
  const RCP<MultiVector> together = rcp(new MultiVector(problem.k->getDomainMap(), 3)),
                         alone = rcp(new MultiVector(*together, Teuchos::Copy));
  const LinearReport report = solver.solve(*spreadOn(problem.k->getRangeMap(), b), *together, 1e-10);
  int most = 0;
  for (Eigen::Index j = 0; j < 3; ++j) {
    const auto column = alone->getVectorNonConst(static_cast<std::size_t>(j));
    most = std::max(most,
                    solver.solve(*spreadOn(problem.k->getRangeMap(), b.col(j)), *column, 1e-10).iterations);
  }
  EXPECT_LE(relativeError(denseOf(*together), denseOf(*alone)), 1e-8);
  EXPECT_LE(report.iterations, most + 3); // looked at together, so that some go a little further
}

TEST(FetiDpSolverTest, HonoursTheToleranceAskedForAndNoMore) {
  const LinearProblem problem(plate(16, decomposition::grid(4, 4)));
  const RCP<const Vector> b = problem.load();
  FetiDpSolver solver(problem.k, {});
  int before = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    Vector x(problem.k->getDomainMap());
    const LinearReport report = solver.solve(*b, x, tolerance);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.largestResidual(), tolerance);
    EXPECT_GE(report.largestResidual(), 1e-4 * tolerance); // it does not iterate for nothing
    EXPECT_GE(report.iterations, before);
    before = report.iterations;
  }
}

TEST(FetiDpSolverTest, StartsFromTheVectorThatItIsGiven) {
  const LinearProblem problem(plate(16, decomposition::grid(4, 4)));
  const RCP<const Vector> b = problem.load();
  FetiDpSolver solver(problem.k, {});
  Vector x(problem.k->getDomainMap());
  const LinearReport cold = solver.solve(*b, x, 1e-10);
  EXPECT_EQ(solver.solve(*b, x, 1e-10).iterations, 0); // solved already
  x.scale(1 + 1e-6);
  const LinearReport warm = solver.solve(*b, x, 1e-10);
  EXPECT_LE(warm.largestResidual(), 1e-10);
  EXPECT_LT(warm.iterations, cold.iterations);
  // Relative to the start residual the start vector is of no help.
  const LinearReport relative = solver.solve(*b, x, 1e-3, ResidualReference::startResidual);
  EXPECT_TRUE(relative.converged);
  EXPECT_GT(relative.iterations, 0);
}

TEST(FetiDpSolverTest, PrescribedValuesInTheMapAreTakenFromTheRightHandSide) {
  const LinearProblem free(plate(6, decomposition::grid(2, 2)));
  const RCP<const Map> map = rcp(new Map(49, 0, world())); // all nodes
  const RCP<const UnassembledOperator> k =
      rcp(new UnassembledOperator(free.k->sharedProblem(), globalUnknowns(*free.decomposition), map));
  const Eigen::VectorXd loads = Eigen::VectorXd::LinSpaced(49, -3, 5);
  Vector x(map);
  EXPECT_TRUE(FetiDpSolver(k, {}).solve(*spreadOn(map, loads), x, 1e-11).converged);
  EXPECT_LE(relativeError(denseOf(x), direct::solvedSymmetric(denseOf(*k), loads)), 1e-9);
  const Eigen::MatrixXd bddc = denseOf(BddcPreconditioner(k, {}));
  EXPECT_LE((bddc.col(0) - Eigen::VectorXd::Unit(49, 0)).norm(), 0); // of a supported node
}

TEST(FetiDpSolverTest, FollowsAChangeOfTheMatrices) {
  const LinearProblem problem(patchwork(8, 10));
  FetiDpSolver solver(problem.k, {});
  for (decomposition::Subdomain& subdomain : problem.decomposition->problem.subdomains)
    if (subdomain.number % 2 == 0)
      decomposition::changeStiffness(subdomain, [](decomposition::SparseMatrix& k) { k *= 7; });
  solver.update();
  const Eigen::MatrixXd load = denseOf(*problem.load());
  Vector x(problem.k->getDomainMap());
  EXPECT_TRUE(solver.solve(*problem.load(), x, 1e-11).converged);
  EXPECT_LE(relativeError(denseOf(x), direct::solvedSymmetric(denseOf(*problem.k), load)), 1e-9);
}

TEST(FetiDpSolverTest, AfterAnUpdateThatFailedAnotherOneHelps) {
  const LinearProblem problem(patchwork(8, 10));
  FetiDpSolver solver(problem.k, {});
  const auto scaleAll = [&](double factor) {
    for (decomposition::Subdomain& subdomain : problem.decomposition->problem.subdomains)
      decomposition::changeStiffness(subdomain, [&](decomposition::SparseMatrix& k) { k *= factor; });
  };
  scaleAll(-1);
  EXPECT_THROW(solver.update(), Error);
  Vector x(problem.k->getDomainMap());
  EXPECT_THROW(solver.solve(*problem.load(), x), Error);
  scaleAll(-3);
  solver.update();
  EXPECT_TRUE(solver.solve(*problem.load(), x, 1e-11).converged);
  const Eigen::MatrixXd load = denseOf(*problem.load());
  EXPECT_LE(relativeError(denseOf(x), direct::solvedSymmetric(denseOf(*problem.k), load)), 1e-9);
}

TEST(FetiDpSolverTest, SaysWhyItStopped) {
  const LinearProblem problem(plate(16, decomposition::grid(4, 4)));
  const RCP<const Vector> b = problem.load();
  FetiDpParameters parameters;
  parameters.maxIterations = 2;
  Vector x(problem.k->getDomainMap());
  const LinearReport limited = FetiDpSolver(problem.k, parameters).solve(*b, x);
  EXPECT_FALSE(limited.converged);
  EXPECT_EQ(limited.iterations, 2);
  EXPECT_NE(limited.reason.find("Maximum Iterations"), std::string::npos) << limited.reason;
  EXPECT_LT(limited.largestResidual(), 1); // the best that was found

  x.putScalar(0);
  const LinearReport exhausted = FetiDpSolver(problem.k, {}).solve(*b, x, 1e-18);
  EXPECT_FALSE(exhausted.converged);
  EXPECT_NE(exhausted.reason.find("ound-off"), std::string::npos) << exhausted.reason;
  EXPECT_LE(exhausted.largestResidual(), 1e-13);
}

TEST(FetiDpSolverTest, EveryChoiceOfParametersSolves) {
  using Type = fetidp::PreconditionerParameters::Type;
  using Use = fetidp::AdaptiveConstraintParameters::Use;
  scene::Scene scene = patchwork(12, 1e4);
  scene.bodies.front().regions.push_back(
      {"channel", mesh::rectangle(0, 1, 0.25, 0.34), "", {1e6}}); // jumps inside subdomains
  const LinearProblem problem(scene);
  const RCP<const Vector> b = problem.load();
  for (const Type type : {Type::none, Type::lumped, Type::dirichlet})
    for (const Use use : {Use::no, Use::yes})
      for (const bool isSingle : {false, true}) {
        FetiDpParameters parameters;
        parameters.preconditioner = {type, fetidp::PreconditionerParameters::Scaling::stiffness, isSingle};
        parameters.adaptiveConstraints.use = use;
        FetiDpSolver solver(problem.k, parameters);
        Vector x(problem.k->getDomainMap());
        const LinearReport report = solver.solve(*b, x, 1e-7);
        EXPECT_TRUE(report.converged) << report.reason << " (" << report.largestResidual() << ")";
        EXPECT_EQ(solver.dualProblem().deflatedOperator().is_null(), use == Use::no);
      }
}

TEST(FetiDpSolverTest, RefusesWhatItCannotSolve) {
  const auto refusalOf = [](const scene::Scene& scene) {
    const LinearProblem problem(scene);
    return test::refusal([&] { FetiDpSolver(problem.k, {}); });
  };
  test::expectSays(refusalOf(decomposition::twoMembranes(true, 4, decomposition::grid(2, 2))),
                   {"FETI-DP solves linear problems", "5 rows of contact", "ContactSolver"});
  const LinearProblem floating(decomposition::oneBody(4, 4, decomposition::grid(2, 2), {}));
  test::expectSays(test::unsolvable(SolvabilityError::Kind::notUnique, [&] { FetiDpSolver(floating.k, {}); }),
                   {"nothing holds 'plate'", "add supports"});
  const LinearProblem problem(plate(4, decomposition::grid(2, 2)));
  FetiDpSolver solver(problem.k, {});
  Vector b(problem.k->getRangeMap()), x(problem.k->getDomainMap());
  if (world()->getRank() == 0 && b.getLocalLength() > 0)
    b.replaceLocalValue(0, std::numeric_limits<double>::quiet_NaN());
  test::expectSays(test::refusal([&] { solver.solve(b, x); }), {"right-hand side", "not a finite number"});
}

TEST(FetiDpSolverTest, ParametersAreCheckedAndTakenOver) {
  const auto from = [](const Teuchos::ParameterList& list) {
    return FetiDpParameters::from(validated(list, FetiDpParameters::validParameters(), ""));
  };
  Teuchos::ParameterList list;
  list.set("Tolerance", 1e-5).set("Maximum Iterations", 7);
  list.sublist("Preconditioner").set("Type", "lumped");
  list.sublist("Direct Solvers").set("Share Identical Subdomains", "no");
  const FetiDpParameters parameters = from(list);
  EXPECT_EQ(parameters.tolerance, 1e-5);
  EXPECT_EQ(parameters.maxIterations, 7);
  EXPECT_EQ(parameters.preconditioner.type, fetidp::PreconditionerParameters::Type::lumped);
  EXPECT_FALSE(parameters.directSolvers.shareIdentical);
  list.set("Tolerance", 2.0);
  test::expectSays(test::refusal([&] { from(list); }), {"\"Tolerance\"", "must be"});
}

} // namespace
} // namespace epafi::linear
