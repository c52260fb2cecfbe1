#include "QpProblems.hpp"

#include <gtest/gtest.h>

#include <cmath>

/// Objectives that fall without end, and curvature that is negative.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

DenseProgram withRows(DenseProgram program, const Eigen::MatrixXd& rows, const Eigen::VectorXd& values) {
  program.rows = rows;
  program.values = values;
  return program;
}

void expectUnbounded(const DenseProgram& program, const QpAnswer& answer) {
  EXPECT_EQ(answer.report.status, Status::unbounded)
      << toString(answer.report.status) << ": " << answer.report.reason;
  EXPECT_EQ(whyNotRecession(program, answer.certificate), "");
  EXPECT_TRUE(answer.x.allFinite());
  EXPECT_TRUE((answer.x.array() >= program.lower.array()).all() &&
              (answer.x.array() <= program.upper.array()).all());
}

TEST(QpUnboundedTest, NamesALoadOnTheKernel) {
  const DenseProgram program =
      DenseProgram::unconstrained(Eigen::Vector3d(1, 1, 0).asDiagonal(), Eigen::Vector3d(1, 2, 3));

  expectUnbounded(program, solveQp(program));
}

TEST(QpUnboundedTest, NamesALoadWithoutAnyStiffness) {
  const DenseProgram program =
      DenseProgram::unconstrained(Eigen::Matrix3d::Zero(), Eigen::Vector3d(1, -2, 0));

  expectUnbounded(program, solveQp(program));
}

/// A chain of springs without a support; each entry may have a bound.
DenseProgram chain(int n, double load) {
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Constant(n, load));
  for (int i = 0; i + 1 < n; ++i) {
    program.hessian(i, i) += 1;
    program.hessian(i + 1, i + 1) += 1;
    program.hessian(i, i + 1) = program.hessian(i + 1, i) = -1;
  }
  return program;
}

TEST(QpUnboundedTest, NamesAFloatingChainThatIsPulledOffItsObstacle) {
  for (const int n : {2, 5, 20}) {
    DenseProgram program = chain(n, 1.0 / n);
    program.lower.setZero();

    expectUnbounded(program, solveQp(program));
  }
}

TEST(QpUnboundedTest, NamesAFloatingChainUnderAnUnevenLoad) {
  DenseProgram program = chain(12, 0);
  program.linear = Eigen::VectorXd::LinSpaced(12, -1, 1.5); // 3 in sum, but down at one end
  program.lower.setConstant(-0.1);

  expectUnbounded(program, solveQp(program));
}

TEST(QpUnboundedTest, AFloatingChainThatIsPressedAgainstItsObstacleIsFine) {
  DenseProgram program = chain(12, -0.5);
  program.lower.setConstant(-0.1);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-9)});

  EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
}

TEST(QpUnboundedTest, ALoadInBalanceOnAFloatingChainIsFine) {
  DenseProgram program = chain(12, 0);
  program.linear = Eigen::VectorXd::LinSpaced(12, -1, 1);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-9)});

  EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
}

TEST(QpUnboundedTest, ALoadInBalanceIsNeverCalledUnboundedHoweverMuchIsAsked) {
  for (const double tolerance : {1e-12, 1e-15, 0.0}) {
    DenseProgram program = chain(12, 0);
    program.linear = Eigen::VectorXd::LinSpaced(12, -0.1, 0.1); // its sum is round-off

    const QpAnswer answer = solveQp(program, {withTolerance(tolerance)});

    EXPECT_TRUE(answer.report.status == Status::converged || answer.report.status == Status::stagnated)
        << toString(answer.report.status);
    EXPECT_LE((program.hessian * answer.x - program.linear).norm(), 1e-12);
    EXPECT_LE(answer.x.norm(), 100);
  }
}

TEST(QpUnboundedTest, NamesADirectionThatTheRowsAllow) {
  // Two free ends may move apart along x₀ = x₁ in the kernel of A.
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(2, 2) = a(3, 3) = 1;
  const DenseProgram program = withRows(DenseProgram::unconstrained(a, Eigen::Vector4d(1, 1, 1, -1)),
                                        Eigen::RowVector4d(1, -1, 1, 0), Eigen::VectorXd::Constant(1, 2));

  expectUnbounded(program, solveQp(program, {withTolerance(1e-8)}));
}

TEST(QpUnboundedTest, ADirectionThatTheRowsForbidIsFine) {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(2, 2) = a(3, 3) = 1;
  Eigen::MatrixXd rows(2, 4);
  rows << 1, -1, 1, 0, 1, 1, 0, 0;
  const DenseProgram program =
      withRows(DenseProgram::unconstrained(a, Eigen::Vector4d(1, 1, 1, -1)), rows, Eigen::Vector2d(2, 1));

  const QpAnswer answer = solveQp(program, {withTolerance(1e-9)});

  EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
}

TEST(QpUnboundedTest, NamesItInUnitsOfAnySize) {
  for (const double unit : {1e-9, 1e9}) {
    DenseProgram program = chain(5, 0.2 * unit);
    program.hessian *= unit;
    program.lower.setZero();

    expectUnbounded(program, solveQp(program));
  }
}

void expectIndefinite(const DenseProgram& program, const QpAnswer& answer) {
  EXPECT_EQ(answer.report.status, Status::indefiniteOperator) << answer.report.reason;
  ASSERT_EQ(answer.certificate.size(), program.size());
  EXPECT_NEAR(answer.certificate.norm(), 1, 1e-12);
  EXPECT_LT(answer.certificate.dot(program.hessian * answer.certificate), 0) << "dᵀAd";
  EXPECT_TRUE(answer.x.allFinite());
  EXPECT_TRUE((answer.x.array() >= program.lower.array()).all() &&
              (answer.x.array() <= program.upper.array()).all());
}

TEST(QpUnboundedTest, NamesNegativeCurvature) {
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::Vector3d(1, -5, 1).asDiagonal(), Eigen::Vector3d(1, 1, 1));
  expectIndefinite(program, solveQp(program));

  program.lower.setConstant(-10);
  program.upper.setConstant(10);
  expectIndefinite(program, solveQp(program));
}

TEST(QpUnboundedTest, NamesNegativeCurvatureThatIsSmall) {
  const DenseProgram program =
      DenseProgram::unconstrained(Eigen::Vector3d(1, -1e-6, 1).asDiagonal(), Eigen::Vector3d(1, 1, 1));

  expectIndefinite(program, solveQp(program));
}

TEST(QpUnboundedTest, NamesNegativeCurvatureInPresenceOfRows) {
  const DenseProgram program = withRows(
      DenseProgram::unconstrained(Eigen::Vector4d(2, -5, 1, 1).asDiagonal(), Eigen::Vector4d(1, 1, 1, 1)),
      Eigen::RowVector4d(0, 0, 1, -1), Eigen::VectorXd::Zero(1));

  expectIndefinite(program, solveQp(program));
}

TEST(QpUnboundedTest, NamesANegativeDefiniteOperator) {
  const DenseProgram program =
      DenseProgram::unconstrained(-Eigen::Matrix3d::Identity(), Eigen::Vector3d(1, 2, 3));

  expectIndefinite(program, solveQp(program));
}

} // namespace
