#include "QpProblems.hpp"
#include "support/DenseOracle.hpp"

#include "epafi/qp/constraints/Box.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <gtest/gtest.h>

#include <cmath>

/// Answers of QpSolver that can be checked by hand, multipliers with their signs, and starts of every kind.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

/// min ½|x|² − bᵀx over x ≥ 0.
DenseProgram identityProgram(const Eigen::VectorXd& b) {
  DenseProgram program = DenseProgram::unconstrained(Eigen::MatrixXd::Identity(b.size(), b.size()), b);
  program.lower.setZero();
  return program;
}

/// The same with the sum of x given.
DenseProgram simplexProgram(const Eigen::VectorXd& b, double sum) {
  DenseProgram program = identityProgram(b);
  program.rows = Eigen::MatrixXd::Ones(1, b.size());
  program.values = Eigen::VectorXd::Constant(1, sum);
  return program;
}

TEST(QpSolverTest, SolvesBoundsByHand) {
  const QpAnswer answer = solveQp(identityProgram(Eigen::Vector2d(1, -2)), {withTolerance(1e-12)});

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_NEAR(answer.x[0], 1, 1e-12);
  EXPECT_EQ(answer.x[1], 0);
  EXPECT_EQ(answer.boundMultiplier[0], 0);
  EXPECT_NEAR(answer.boundMultiplier[1], 2, 1e-12) << "a lower bound pushes up";
  EXPECT_EQ(answer.equalityMultiplier.size(), 0);
}

TEST(QpSolverTest, TheMultiplierOfAnUpperBoundIsNegative) {
  DenseProgram program = identityProgram(Eigen::Vector2d(3, -1));
  program.upper.setConstant(1);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-12)});

  EXPECT_EQ(answer.x, Eigen::Vector2d(1, 0));
  EXPECT_NEAR(answer.boundMultiplier[0], -2, 1e-12);
  EXPECT_NEAR(answer.boundMultiplier[1], 1, 1e-12);
}

TEST(QpSolverTest, SolvesBoundsAndARowByHand) {
  // The projection of (2, 0.5, −1) onto the simplex: x = (1, 0, 0), μ = 1, forces (0, 0.5, 2).
  const DenseProgram program = simplexProgram(Eigen::Vector3d(2, 0.5, -1), 1);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-12)});

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_NEAR((answer.x - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-11);
  EXPECT_NEAR(answer.equalityMultiplier[0], 1, 1e-11);
  EXPECT_NEAR((answer.boundMultiplier - Eigen::Vector3d(0, 0.5, 2)).norm(), 0, 1e-11);
}

TEST(QpSolverTest, FixedEntriesKeepTheirValueAndCarryAForceOfEitherSign) {
  DenseProgram program = DenseProgram::unconstrained(Eigen::Matrix3d::Identity(), Eigen::Vector3d(1, 1, 1));
  program.lower = program.upper = Eigen::Vector3d(3, -3, 1);

  const QpAnswer answer = solveQp(program);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_EQ(answer.x, Eigen::Vector3d(3, -3, 1));
  EXPECT_EQ(answer.boundMultiplier, Eigen::Vector3d(2, -4, 0));
}

TEST(QpSolverTest, SolvesWithoutASetAndWithoutBounds) {
  const DenseProgram program =
      DenseProgram::unconstrained(2 * Eigen::Matrix3d::Identity(), Eigen::Vector3d(2, 4, 6));

  const QpAnswer answer = solveQp(program, {withTolerance(1e-12)});

  EXPECT_NEAR((answer.x - Eigen::Vector3d(1, 2, 3)).norm(), 0, 1e-11);
  EXPECT_NEAR(answer.report.objective, -14, 1e-10);
  EXPECT_EQ(answer.boundMultiplier.norm(), 0);
}

TEST(QpSolverTest, TakesSparseMatrices) {
  // A string of 20 springs over a flat obstacle, its middle entry tied to the first by a row.
  const int n = 20;
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Constant(n, -0.1));
  const RCP<const Map> map = linearMap(n), rowMap = linearMap(1);
  const RCP<CrsMatrix> a = rcp(new CrsMatrix(map, 3)), b = rcp(new CrsMatrix(rowMap, 2));
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - 1); j <= std::min(n - 1, i + 1); ++j) {
      program.hessian(i, j) = i == j ? 2 : -1;
      if (map->isNodeGlobalElement(i))
        a->insertGlobalValues(i, Teuchos::tuple<GlobalOrdinal>(j), Teuchos::tuple(program.hessian(i, j)));
    }
  if (rowMap->isNodeGlobalElement(0))
    b->insertGlobalValues(0, Teuchos::tuple<GlobalOrdinal>(0, n / 2), Teuchos::tuple(1.0, -1.0));
  a->fillComplete();
  b->fillComplete(map, rowMap);
  program.lower.setConstant(-0.5);
  program.rows = Eigen::MatrixXd::Zero(1, n);
  program.rows(0, 0) = 1;
  program.rows(0, n / 2) = -1;
  program.values = Eigen::VectorXd::Constant(1, 0.2);
  QpCall call{withTolerance(1e-10)};
  call.change = [&](qp::QuadraticProgram& problem) {
    problem.hessian = a;
    problem.constraintMatrix = b;
  };

  const QpAnswer answer = solveQp(program, call);

  EXPECT_EQ(whyNoSolution(program, answer, 1e-10), "");
  EXPECT_NEAR((answer.x - solveByDualActiveSet(program).x.cast<double>()).norm(), 0, 1e-8);
}

TEST(QpSolverTest, RedundantRowsLeaveTheAnswerAndGiveMultipliersThatBalance) {
  const DenseProgram plain = simplexProgram(Eigen::Vector3d(2, 0.5, -1), 1);
  DenseProgram redundant = plain;
  redundant.rows.resize(4, 3);
  redundant.rows << 1, 1, 1, 0, 0, 0, 1, 1, 1, -3e5, -3e5, -3e5; // itself, zero, itself, a multiple
  redundant.values = Eigen::Vector4d(1, 0, 1, -3e5);

  const QpAnswer answer = solveQp(redundant, {withTolerance(1e-12)});

  EXPECT_EQ(whyNoSolution(redundant, answer, 1e-12), "");
  EXPECT_NEAR((answer.x - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-11);
  const double combined = (redundant.rows.transpose() * answer.equalityMultiplier)[0];
  EXPECT_NEAR(combined, 1, 1e-11) << "Bᵀμ is unique, μ is not";
  EXPECT_EQ(answer.equalityMultiplier[1], 0) << "a row of zeros has no force";
}

TEST(QpSolverTest, RowsOfZerosAloneAreNoConstraint) {
  DenseProgram program = identityProgram(Eigen::Vector3d(1, -2, 3));
  program.rows = Eigen::MatrixXd::Zero(2, 3);
  program.values = Eigen::Vector2d::Zero();

  const QpAnswer answer = solveQp(program, {withTolerance(1e-12)});

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_NEAR((answer.x - Eigen::Vector3d(1, 0, 3)).norm(), 0, 1e-11);
  EXPECT_EQ(answer.equalityMultiplier, Eigen::Vector2d::Zero());
}

TEST(QpSolverTest, LeavesBoundsLinearTermAndRowsAlone) {
  const DenseProgram program = mixedProgramWithRows(12, 2, 10, 41);
  const qp::QuadraticProgram problem = toQuadraticProgram(program);
  const RCP<const Map> map = problem.hessian->getDomainMap();
  const RCP<Vector> lower = makeVector(map, program.lower), upper = makeVector(map, program.upper);
  qp::QuadraticProgram shared = problem;
  shared.set = rcp(new qp::Box(lower, upper));
  Vector x(map);

  qp::QpSolver().solve(shared, x);

  EXPECT_EQ(gather(*problem.linearTerm), program.linear);
  EXPECT_EQ(gather(*problem.constraintValues), program.values);
  EXPECT_EQ(gather(*lower), program.lower);
  EXPECT_EQ(gather(*upper), program.upper);
}

TEST(QpSolverTest, SolvesTheSameProblemTwiceInTheSameWay) {
  const DenseProgram program = mixedProgramWithRows(20, 3, 100, 43);
  const qp::QuadraticProgram problem = toQuadraticProgram(program);
  Vector first(problem.hessian->getDomainMap()), second(problem.hessian->getDomainMap());
  qp::QpSolver solver;

  const auto once = solver.solve(problem, first), twice = solver.solve(problem, second);

  EXPECT_EQ(gather(first), gather(second));
  EXPECT_EQ(once.report.counts.hessianMultiplications, twice.report.counts.hessianMultiplications);
}

/// Bounds only, and with rows.
class QpStartTest : public testing::TestWithParam<bool> {
protected:
  DenseProgram program() const {
    return GetParam() ? mixedProgramWithRows(25, 3, 50, 47) : mixedProgram(25, 50, 47);
  }
  static double tolerance() { return 1e-9; }
};

TEST_P(QpStartTest, AStartFarOutsideIsProjectedFirst) {
  for (const double far : {-1e6, 1e3}) {
    const QpAnswer answer =
        solveQp(program(), {withTolerance(tolerance()), Eigen::VectorXd::Constant(25, far)});

    EXPECT_EQ(whyNoSolution(program(), answer, tolerance()), "");
  }
}

TEST_P(QpStartTest, TheExactOptimumIsAGoodStart) {
  const OracleAnswer oracle = solveByDualActiveSet(program());

  const QpAnswer answer = solveQp(program(), {withTolerance(tolerance()), oracle.x.cast<double>()});

  EXPECT_EQ(whyNoSolution(program(), answer, tolerance()), "");
  EXPECT_LE(answer.report.counts.hessianMultiplications, 5);
}

TEST_P(QpStartTest, TheExactOptimumIsNoTroubleEvenIfNothingIsAsked) {
  const OracleAnswer oracle = solveByDualActiveSet(program());
  Teuchos::ParameterList parameters = withTolerance(0);

  const QpAnswer answer = solveQp(program(), {parameters, oracle.x.cast<double>()});

  EXPECT_TRUE(answer.report.status == Status::converged || answer.report.status == Status::stagnated)
      << toString(answer.report.status);
  EXPECT_NEAR((answer.x - oracle.x.cast<double>()).norm(), 0, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Problems, QpStartTest, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "rows" : "bounds"; });

TEST(QpSolverTest, AWholeNumberOptimumAsStartHasAGradientOfExactlyZero) {
  const DenseProgram program = identityProgram(Eigen::Vector3d(1, 2, 3));

  const QpAnswer answer = solveQp(program, {withTolerance(0), Eigen::Vector3d(1, 2, 3)});

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_EQ(answer.x, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(answer.report.counts.hessianMultiplications, 1);
}

} // namespace
