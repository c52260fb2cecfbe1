#include "QpProblems.hpp"

#include <gtest/gtest.h>

#include <cmath>

/// Problems without a solution: the status that names them and the certificate that proves it.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

/// min ½|x|² − Σx over −1 ≤ x ≤ 1.
DenseProgram cube(int n) {
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Ones(n));
  program.lower.setConstant(-1);
  program.upper.setConstant(1);
  return program;
}

DenseProgram withRows(DenseProgram program, const Eigen::MatrixXd& rows, const Eigen::VectorXd& values) {
  program.rows = rows;
  program.values = values;
  return program;
}

void expectInfeasible(const DenseProgram& program, const QpAnswer& answer) {
  EXPECT_EQ(answer.report.status, Status::infeasible) << toString(answer.report.status);
  ASSERT_EQ(answer.certificate.size(), program.numRows());
  EXPECT_NEAR(answer.certificate.norm(), 1, 1e-12);
  EXPECT_GT(separation(program, answer.certificate), 0) << "yᵀ(Bx − c) > 0 for every x within the bounds";
  EXPECT_TRUE((answer.x.array() >= program.lower.array()).all() &&
              (answer.x.array() <= program.upper.array()).all());
}

TEST(QpFailuresTest, BoundsThatMeetAreNoFailure) {
  DenseProgram program = cube(4);
  program.lower[2] = program.upper[2] = 0.25;

  const QpAnswer answer = solveQp(program);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_EQ(answer.x[2], 0.25);
}

TEST(QpFailuresTest, NamesTheEntryWhoseBoundsCross) {
  DenseProgram program = cube(7);
  program.lower[5] = 3;

  const QpAnswer answer = solveQp(program);

  EXPECT_EQ(answer.report.status, Status::infeasible);
  EXPECT_NE(answer.report.reason.find("entry 5"), std::string::npos) << answer.report.reason;
}

TEST(QpFailuresTest, NamesTheEntryWhoseLowerBoundIsInfinite) {
  DenseProgram program = cube(7);
  program.upper.setConstant(unlimited);
  program.lower[6] = unlimited;

  const QpAnswer answer = solveQp(program);

  EXPECT_EQ(answer.report.status, Status::infeasible);
  EXPECT_NE(answer.report.reason.find("entry 6"), std::string::npos) << answer.report.reason;
}

TEST(QpFailuresTest, DuplicateRowsAreNoFailure) {
  const DenseProgram program = withRows(cube(3), Eigen::MatrixXd::Ones(3, 3), Eigen::Vector3d::Constant(0.5));

  const QpAnswer answer = solveQp(program, {withTolerance(1e-10)});

  EXPECT_EQ(whyNoSolution(program, answer, 1e-10), "");
  EXPECT_NEAR((answer.x - Eigen::Vector3d::Constant(0.5 / 3)).norm(), 0, 1e-9);
}

TEST(QpFailuresTest, NamesRowsThatContradictEachOther) {
  Eigen::MatrixXd rows(3, 4);
  rows << 1, 2, 0, 0, 0, 0, 1, 1, 2, 4, -1, -1; // the third: twice the first less the second
  const DenseProgram program = withRows(cube(4), rows, Eigen::Vector3d(1, 0.5, 1.6));

  const QpAnswer answer = solveQp(program);

  expectInfeasible(program, answer);
  EXPECT_NE(answer.report.reason.find("contradict"), std::string::npos) << answer.report.reason;
  EXPECT_NEAR((rows.transpose() * answer.certificate).norm(), 0, 1e-12) << "Bᵀy = 0";
  EXPECT_LT(answer.certificate.dot(program.values), -1e-3) << "yᵀc < 0";
}

TEST(QpFailuresTest, NamesContradictionsWhateverTheScaleOfTheRows) {
  for (const double scale : {1e-9, 1e9}) {
    Eigen::MatrixXd rows(2, 3);
    rows << 1, 1, 1, scale, scale, scale;
    const DenseProgram program = withRows(cube(3), rows, Eigen::Vector2d(1, 1.001 * scale));

    expectInfeasible(program, solveQp(program));
  }
}

TEST(QpFailuresTest, NamesARowOfZerosThatAsksForMore) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, 3);
  rows.row(0).setOnes();
  const DenseProgram program = withRows(cube(3), rows, Eigen::Vector2d(1, 1e-6));

  expectInfeasible(program, solveQp(program));
}

TEST(QpFailuresTest, AnEmptyMatrixThatAsksForMoreIsNamedOnEveryPath) {
  const DenseProgram program = withRows(cube(3), Eigen::MatrixXd::Zero(2, 3), Eigen::Vector2d(0, 1));
  for (const int dense : {300, 0}) {
    QpCall call;
    call.parameters.set("Maximum Dense Rows", dense);

    expectInfeasible(program, solveQp(program, call));
  }
}

/// Rows made orthonormal, or only scaled.
class QpInfeasibleTest : public testing::TestWithParam<int> {
protected:
  static QpCall call() {
    QpCall result;
    result.parameters.set("Maximum Dense Rows", GetParam());
    return result;
  }
};

TEST_P(QpInfeasibleTest, NamesARowThatTheBoundsCannotGive) {
  for (const double value : {3.5, -3.001, 1e6}) { // the cube gives |Σx| ≤ 3
    const DenseProgram program =
        withRows(cube(3), Eigen::MatrixXd::Ones(1, 3), Eigen::VectorXd::Constant(1, value));

    expectInfeasible(program, solveQp(program, call()));
  }
}

TEST_P(QpInfeasibleTest, NamesASmallGapBetweenBoundsAndARow) {
  for (const double gap : {1e-2, 1e-4, 1e-6}) {
    const DenseProgram program =
        withRows(cube(3), Eigen::MatrixXd::Ones(1, 3), Eigen::VectorXd::Constant(1, 3 + gap));

    expectInfeasible(program, solveQp(program, call()));
  }
}

TEST_P(QpInfeasibleTest, ACornerThatIsJustReachedIsFeasible) {
  const DenseProgram program =
      withRows(cube(3), Eigen::MatrixXd::Ones(1, 3), Eigen::VectorXd::Constant(1, 3));

  const QpAnswer answer = solveQp(program, call());

  EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
  EXPECT_NEAR((answer.x - Eigen::Vector3d::Ones()).norm(), 0, 1e-6);
}

TEST_P(QpInfeasibleTest, NamesTwoRowsThatMeetOutsideTheBounds) {
  Eigen::MatrixXd rows(2, 3);
  rows << 1, 1, 0, 1, -1, 0; // x₀ = 1.5, x₁ = 0
  const DenseProgram program = withRows(cube(3), rows, Eigen::Vector2d(1.5, 1.5));

  expectInfeasible(program, solveQp(program, call()));
}

TEST_P(QpInfeasibleTest, NamesFixedEntriesThatContradictARow) {
  DenseProgram program = withRows(cube(3), Eigen::RowVector3d(1, 1, 0), Eigen::VectorXd::Constant(1, 0.5));
  program.lower.head(2) = program.upper.head(2) = Eigen::Vector2d(0.5, 0.25);

  expectInfeasible(program, solveQp(program, call()));
}

TEST_P(QpInfeasibleTest, NamesItInUnitsOfAnySize) {
  for (const double unit : {1e-9, 1e9}) {
    DenseProgram program =
        withRows(cube(3), Eigen::MatrixXd::Ones(1, 3), Eigen::VectorXd::Constant(1, 3.5 * unit));
    program.lower *= unit;
    program.upper *= unit;

    expectInfeasible(program, solveQp(program, call()));
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, QpInfeasibleTest, testing::Values(300, 0),
                         [](const auto& instance) { return instance.param > 0 ? "orthonormal" : "scaled"; });

} // namespace
