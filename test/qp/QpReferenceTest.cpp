#include "QpProblems.hpp"

#include "epafi/direct/DenseSymmetric.hpp"

#include <gtest/gtest.h>

/// What a residual is relative to must not vanish with the data: loads and right-hand sides that are 0, or
/// nearly.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

DenseProgram definiteProgram() {
  Eigen::Matrix3d a;
  a << 4, 1, 0, 1, 3, 1, 0, 1, 2;
  return DenseProgram::unconstrained(a, Eigen::Vector3d::Zero());
}

TEST(QpReferenceTest, WithoutALoadAndWithZeroInsideTheBoundsTheAnswerIsZeroAtOnce) {
  DenseProgram program = definiteProgram();
  program.lower.setConstant(-1);
  program.upper.setConstant(2);

  const QpAnswer answer = solveQp(program);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_EQ(answer.x.norm(), 0);
  EXPECT_LE(answer.report.counts.hessianMultiplications, 1);
}

TEST(QpReferenceTest, WithoutALoadZeroIsTheAnswerFromAnyStart) {
  DenseProgram program = definiteProgram();
  program.lower.setConstant(-1);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-8), Eigen::Vector3d(1, -0.5, 3)});

  EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
  EXPECT_NEAR(answer.x.norm(), 0, 1e-12);
}

TEST(QpReferenceTest, WithoutLoadAndRightHandSideZeroIsTheAnswerFromAnyStart) {
  DenseProgram program = definiteProgram();
  program.rows = Eigen::MatrixXd::Ones(1, 3);
  program.values = Eigen::VectorXd::Zero(1);
  for (const Eigen::Vector3d& start : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, -0.5, 3)}) {
    const QpAnswer answer = solveQp(program, {withTolerance(1e-8), start});

    EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
    EXPECT_NEAR(answer.x.norm(), 0, 1e-12);
    EXPECT_NEAR(answer.equalityMultiplier.norm(), 0, 1e-12);
  }
}

/// Loads from none to some that are far below everything else in the problem: the same answer, and never
/// "stagnated".
class QpSmallLoadTest : public testing::TestWithParam<double> {};

TEST_P(QpSmallLoadTest, BoundsThatExcludeZero) {
  DenseProgram program = definiteProgram();
  program.linear.setConstant(GetParam());
  program.lower = Eigen::Vector3d(1, -unlimited, 2);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-10)});

  EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
  EXPECT_NEAR((answer.x - Eigen::Vector3d(1, -1, 2)).norm(), 0, 1e-9);
  EXPECT_NEAR((answer.boundMultiplier - Eigen::Vector3d(3, 0, 3)).norm(), 0, 1e-9);
}

TEST_P(QpSmallLoadTest, ARowThatExcludesZero) {
  DenseProgram program = definiteProgram();
  program.linear.setConstant(GetParam());
  program.rows = Eigen::RowVector3d(5, 5, 3); // = (1, 1, 1) A
  program.values = Eigen::VectorXd::Constant(1, 26);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-10)});

  EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
  EXPECT_NEAR((answer.x - Eigen::Vector3d(2, 2, 2)).norm(), 0, 1e-8) << "Ax = −Bᵀμ with μ = −2";
  EXPECT_NEAR(answer.equalityMultiplier[0], -2, 1e-8);
}

TEST_P(QpSmallLoadTest, ARowWithASmallRightHandSide) {
  DenseProgram program = definiteProgram();
  program.linear = Eigen::Vector3d(1, 1, 1);
  program.rows = Eigen::RowVector3d(1, 1, 1);
  program.values = Eigen::VectorXd::Constant(1, GetParam());
  const Eigen::Vector3d image =
      direct::solvedSymmetric(program.hessian, program.linear); // x = A⁻¹(b − Bᵀμ) = (1 − μ) A⁻¹b = 0

  const QpAnswer answer = solveQp(program, {withTolerance(1e-10)});

  EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
  EXPECT_NEAR(answer.x.norm(), 0, 1e-9 * image.norm());
  EXPECT_NEAR(answer.equalityMultiplier[0], 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Loads, QpSmallLoadTest, testing::Values(0.0, 1e-300, 1e-30, -1e-16),
                         [](const auto& instance) { return "number" + std::to_string(instance.index); });

TEST(QpReferenceTest, AGivenReferenceReplacesTheLoad) {
  const DenseProgram program = mixedProgram(20, 1e3, 53);
  Teuchos::ParameterList parameters;
  parameters.set("Tolerance", 1e-3);
  parameters.set("Reference", 1e-4);

  const QpAnswer answer = solveQp(program, {parameters});

  EXPECT_EQ(answer.report.status, Status::converged);
  const Eigen::VectorXd noRows;
  EXPECT_LE(residuals(program, answer.x.cast<Real>(), noRows.cast<Real>()).projectedGradient(), 1.001e-7);
}

TEST(QpReferenceTest, AnAbsoluteToleranceEndsTheSolveAsWell) {
  for (const bool hasRows : {false, true}) {
    const DenseProgram program = hasRows ? mixedProgramWithRows(20, 2, 1e3, 59) : mixedProgram(20, 1e3, 59);
    Teuchos::ParameterList parameters = withTolerance(1e-14);
    parameters.set("Constraint Tolerance", 1e-8);
    const int strict = solveQp(program, {parameters}).report.counts.hessianMultiplications;
    parameters.set("Absolute Tolerance", 1e-4);

    const QpAnswer answer = solveQp(program, {parameters});

    EXPECT_EQ(answer.report.status, Status::converged) << answer.report.reason;
    EXPECT_LT(answer.report.counts.hessianMultiplications, strict);
    const DenseResiduals found =
        residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>());
    EXPECT_LE(found.projectedGradient(), 1.001e-4);
  }
}

} // namespace
