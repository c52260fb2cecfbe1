#include "QpProblems.hpp"
#include "support/DenseOracle.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Tpetra_MultiVector.hpp>
#include <gtest/gtest.h>

#include <cmath>

/// Preconditioning in face, by a conjugate projector, and starts from a guess of the active set: the answer
/// stays, the number of products falls.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

QpCall preconditioned(double tolerance, const Eigen::MatrixXd& m) {
  QpCall call{withTolerance(tolerance)};
  call.change = [m](qp::QuadraticProgram& problem) {
    problem.preconditioner = rcp(new DenseOperator(problem.hessian->getDomainMap(), m));
  };
  return call;
}

/// A membrane of k × k unknowns pulled down on an obstacle under every third of its last rows.
DenseProgram membrane(int k) {
  const int n = k * k;
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Constant(n, -1.0 / n));
  for (int i = 0; i < n; ++i) {
    program.hessian(i, i) = 4;
    if (i % k != 0)
      program.hessian(i, i - 1) = program.hessian(i - 1, i) = -1;
    if (i >= k)
      program.hessian(i, i - k) = program.hessian(i - k, i) = -1;
    if (i >= n - 2 * k)
      program.lower[i] = -0.01;
  }
  return program;
}

TEST(QpPreconditioningTest, TheExactInverseNeedsFarFewerStepsForTheSameAnswer) {
  const DenseProgram program = membrane(12);
  const QpAnswer plain = solveQp(program, {withTolerance(1e-9)});

  const QpAnswer answer = solveQp(program, preconditioned(1e-9, direct::inverseOfSpd(program.hessian)));

  EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
  EXPECT_LE((answer.x - plain.x).norm(), 1e-6 * plain.x.norm());
  EXPECT_LE(2 * answer.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications);
  EXPECT_GT(answer.report.counts.preconditionerApplications, 0);
}

TEST(QpPreconditioningTest, TheInverseOfTheFaceSolvesInAStepWhereTheFaceIsRight) {
  const DenseProgram program = membrane(12);
  const OracleAnswer oracle = solveByDualActiveSet(program);
  const Eigen::VectorXd exact = oracle.x.cast<double>();
  int made = 0;
  QpCall call{withTolerance(1e-9),
              exact + 1e-3 * (exact.array() > program.lower.array()).matrix().cast<double>()};
  call.change = [&](qp::QuadraticProgram& problem) {
    problem.facePreconditioner = [&](const Vector& indicator) -> RCP<const Operator> {
      ++made;
      const Eigen::VectorXd free = gather(indicator);
      Eigen::MatrixXd face = program.hessian;
      for (Eigen::Index i = 0; i < free.size(); ++i)
        if (free[i] == 0) {
          face.row(i).setZero();
          face.col(i).setZero();
          face(i, i) = 1;
        }
      return rcp(new DenseOperator(indicator.getMap(), direct::inverseOfSpd(face)));
    };
  };

  const QpAnswer answer = solveQp(program, call);

  EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
  EXPECT_EQ(made, 1) << "made once a solve";
  EXPECT_LE(answer.report.counts.hessianMultiplications, 5);
  EXPECT_LE((answer.x - exact).norm(), 1e-6 * exact.norm());
}

TEST(QpPreconditioningTest, ThePreconditionerOfTheFaceSeesTheFaceOfTheStart) {
  const DenseProgram program = mixedProgram(15, 10, 151);
  Eigen::VectorXd start = Eigen::VectorXd::Constant(15, 1e3), seen;
  QpCall call{withTolerance(1e-9), start};
  call.change = [&](qp::QuadraticProgram& problem) {
    problem.preconditioner =
        rcp(new DenseOperator(problem.hessian->getDomainMap(), -Eigen::MatrixXd::Identity(15, 15)));
    problem.facePreconditioner = [&](const Vector& indicator) -> RCP<const Operator> {
      seen = gather(indicator);
      return rcp(new DenseOperator(indicator.getMap(), Eigen::MatrixXd::Identity(15, 15)));
    };
  };

  const QpAnswer answer = solveQp(program, call);

  EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "") << "it takes the place of the other one";
  const Eigen::VectorXd projected = start.cwiseMax(program.lower).cwiseMin(program.upper);
  for (Eigen::Index i = 0; i < 15; ++i)
    EXPECT_EQ(seen[i], program.lower[i] < projected[i] && projected[i] < program.upper[i] ? 1 : 0) << i;
}

TEST(QpPreconditioningTest, AnySymmetricPositivePreconditionerGivesTheSameAnswer) {
  std::mt19937 random(157);
  for (const bool hasRows : {false, true})
    for (const double condition : {1.0, 10.0, 1e3}) {
      const DenseProgram program = hasRows ? mixedProgramWithRows(25, 3, 50, 157) : mixedProgram(25, 50, 157);
      const OracleAnswer oracle = solveByDualActiveSet(program);
      for (const double scale : {1e-9, 1.0, 1e9}) {
        const QpAnswer answer =
            solveQp(program, preconditioned(1e-9, scale * randomSpd(25, condition, random)));

        EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "")
            << "rows " << hasRows << ", condition " << condition << ", scale " << scale;
        EXPECT_LE((answer.x - oracle.x.cast<double>()).norm(), 1e-5 * answer.x.norm());
      }
    }
}

TEST(QpPreconditioningTest, APreconditionerThatIsNotPositiveDefiniteIsNamed) {
  for (const bool hasRows : {false, true}) {
    const DenseProgram program = hasRows ? mixedProgramWithRows(15, 2, 50, 163) : mixedProgram(15, 50, 163);
    for (const Eigen::MatrixXd& m : {Eigen::MatrixXd(-Eigen::MatrixXd::Identity(15, 15)),
                                     Eigen::MatrixXd(Eigen::MatrixXd::Zero(15, 15))}) {
      const QpAnswer answer = solveQp(program, preconditioned(1e-9, m));

      EXPECT_EQ(answer.report.status, Status::indefinitePreconditioner) << answer.report.reason;
      EXPECT_LE(residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).feasibility,
                0);
      EXPECT_TRUE(answer.x.allFinite());
    }
  }
}

/// Blocks of width entries each, 1 in the entries without bounds.
Eigen::MatrixXd aggregates(const DenseProgram& program, const std::vector<int>& blockOf, int count) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(program.size(), count);
  for (Eigen::Index i = 0; i < program.size(); ++i)
    if (std::isinf(program.lower[i]) && std::isinf(program.upper[i]))
      u(i, blockOf[i]) = 1;
  return u;
}

QpCall projected(double tolerance, const Eigen::MatrixXd& u) {
  QpCall call{withTolerance(tolerance)};
  call.change = [u](qp::QuadraticProgram& problem) {
    const RCP<const Map> map = problem.hessian->getDomainMap();
    const RCP<MultiVector> columns = rcp(new MultiVector(map, static_cast<std::size_t>(u.cols())));
    for (Eigen::Index k = 0; k < u.cols(); ++k)
      columns->getVectorNonConst(static_cast<std::size_t>(k))
          ->assign(*makeVector(map, Eigen::VectorXd(u.col(k))));
    problem.coarseSpace = columns;
  };
  return call;
}

TEST(QpPreconditioningTest, AProjectorNeedsFewerProductsOnAString) {
  const int n = 120; // bounds at both ends only
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Constant(n, -1e-3));
  std::vector<int> blocks;
  for (int i = 0; i < n; ++i) {
    program.hessian(i, i) = 2;
    if (i > 0)
      program.hessian(i, i - 1) = program.hessian(i - 1, i) = -1;
    if (i < 10 || i >= n - 10)
      program.lower[i] = -0.3;
    blocks.push_back(std::min(11, std::max(0, (i - 10) * 12 / 100)));
  }
  const QpAnswer plain = solveQp(program, {withTolerance(1e-9)});

  const QpAnswer answer = solveQp(program, projected(1e-9, aggregates(program, blocks, 12)));

  EXPECT_EQ(whyNoSolution(program, answer, 1e-8), "");
  EXPECT_LE((answer.x - plain.x).norm(), 1e-6 * plain.x.norm());
  EXPECT_LT(answer.products, plain.products) << "those of U included";
  EXPECT_GT((answer.x.array() == program.lower.array()).count(), 0);
}

TEST(QpPreconditioningTest, AProjectorNeedsFewerProductsOnAMembrane) {
  const int k = 20;
  const DenseProgram program = membrane(k);
  std::vector<int> blocks;
  for (int i = 0; i < k * k; ++i)
    blocks.push_back(std::min(i / k / 5, 3) * 4 + i % k / 5);
  Eigen::MatrixXd u = aggregates(program, blocks, 16);
  const QpAnswer plain = solveQp(program, {withTolerance(1e-9)});

  const QpAnswer answer = solveQp(program, projected(1e-9, u));

  EXPECT_EQ(whyNoSolution(program, answer, 1e-8), "");
  EXPECT_LE((answer.x - plain.x).norm(), 1e-6 * plain.x.norm());
  EXPECT_LT(answer.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications);
}

TEST(QpPreconditioningTest, AProjectorOntoAllFreeEntriesLeavesOnlyTheBoundedOnes) {
  const DenseProgram program = membrane(6);
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < program.size(); ++i)
    if (std::isinf(program.lower[i]))
      free.push_back(i);
  const Eigen::MatrixXd u = Eigen::MatrixXd::Identity(36, 36)(allOf, free);

  const QpAnswer answer = solveQp(program, projected(1e-9, u));

  EXPECT_EQ(whyNoSolution(program, answer, 1e-8), "");
  EXPECT_LE((answer.x - solveByDualActiveSet(program).x.cast<double>()).norm(), 1e-6 * answer.x.norm());
}

TEST(QpPreconditioningTest, CertificatesHoldForTheProblemItselfUnderAProjector) {
  // A string with one end on an obstacle, pulled off it: the kernel is no longer seen after the projection.
  const int n = 20;
  DenseProgram program =
      DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Constant(n, 0.05));
  for (int i = 0; i + 1 < n; ++i) {
    program.hessian(i, i) += 1;
    program.hessian(i + 1, i + 1) += 1;
    program.hessian(i, i + 1) = program.hessian(i + 1, i) = -1;
  }
  program.lower.head(2).setZero();
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(n, 2);
  u.col(0).segment(4, 6).setOnes();
  u.col(1).segment(12, 6).setOnes();

  const QpAnswer answer = solveQp(program, projected(1e-8, u));

  EXPECT_EQ(answer.report.status, Status::unbounded) << answer.report.reason;
  EXPECT_EQ(whyNotRecession(program, answer.certificate), "");
}

TEST(QpPreconditioningTest, NegativeCurvatureIsProvedForTheProblemItselfUnderAProjector) {
  DenseProgram program = membrane(5);
  program.hessian(24, 24) = -50; // a bounded entry
  program.lower[24] = -10;
  program.upper[24] = 10;
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(25, 1);
  u.col(0).head(12).setOnes();

  const QpAnswer answer = solveQp(program, projected(1e-8, u));

  EXPECT_EQ(answer.report.status, Status::indefiniteOperator) << answer.report.reason;
  ASSERT_EQ(answer.certificate.size(), 25);
  EXPECT_NEAR(answer.certificate.norm(), 1, 1e-12);
  EXPECT_LT(answer.certificate.dot(program.hessian * answer.certificate), 0);
}

TEST(QpPreconditioningTest, AGuessOfTheActiveSetSavesStepsIfItIsRightAndCostsNoAnswerIfNot) {
  const DenseProgram program = membrane(12);
  const QpAnswer cold = solveQp(program, {withTolerance(1e-9)});
  const Eigen::VectorXd active = (cold.x.array() == program.lower.array()).matrix().cast<double>();
  for (const bool isRight : {true, false}) {
    QpCall call{withTolerance(1e-9)};
    call.change = [&](qp::QuadraticProgram& problem) {
      const Eigen::VectorXd guess = isRight ? active : Eigen::VectorXd(Eigen::VectorXd::Ones(144) - active);
      problem.activeGuess = makeVector(problem.hessian->getDomainMap(), guess);
    };

    const QpAnswer answer = solveQp(program, call);

    EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
    EXPECT_LE((answer.x - cold.x).norm(), 1e-6 * cold.x.norm());
    if (isRight) {
      EXPECT_EQ(answer.report.history.front().activeBounds, static_cast<long long>(active.sum()));
      EXPECT_LT(answer.report.counts.hessianMultiplications, cold.report.counts.hessianMultiplications);
    }
  }
}

} // namespace
