#include "QpProblems.hpp"
#include "support/DenseOracle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

/// Every expansion, update and path of the rows leads to the same solution, downhill.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;
using qp::StepKind;

/// Expansions.
class QpVariantsTest : public testing::TestWithParam<std::string> {
protected:
  static QpCall call(double tolerance) {
    QpCall result{withTolerance(tolerance)};
    result.parameters.sublist("MPRGP").set("Expansion", GetParam());
    return result;
  }
};

TEST_P(QpVariantsTest, SolvesBounds) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const DenseProgram program =
        mixedProgram(10 + 5 * static_cast<int>(seed), std::pow(10.0, seed % 4), 107 + seed);

    const QpAnswer answer = solveQp(program, call(1e-10));

    EXPECT_EQ(whyNoSolution(program, answer, 1e-10), "") << seed;
    const OracleAnswer oracle = solveByDualActiveSet(program);
    EXPECT_LE((answer.x - oracle.x.cast<double>()).norm(), 1e-6 * answer.x.norm()) << seed;
  }
}

TEST_P(QpVariantsTest, SolvesRowsWithEveryUpdateOnEveryPath) {
  for (const int numRows : {1, 3, 8}) {
    const DenseProgram program = mixedProgramWithRows(30, numRows, 100, 109);
    const OracleAnswer oracle = solveByDualActiveSet(program);
    for (const char* update : {"both", "balance", "penalty"})
      for (const int dense : {300, 0}) {
        QpCall variant = call(1e-9);
        variant.parameters.sublist("SMALBE").set("Update", std::string(update));
        variant.parameters.sublist("SMALBE").set("Maximum Outer Iterations", 2000);
        variant.parameters.set("Maximum Dense Rows", dense);

        const QpAnswer answer = solveQp(program, variant);

        SCOPED_TRACE(std::to_string(numRows) + " rows, " + update +
                     (dense > 0 ? ", orthonormal" : ", scaled"));
        EXPECT_EQ(whyNoSolution(program, answer, 1e-9), "");
        EXPECT_LE((answer.x - oracle.x.cast<double>()).norm(), 1e-5 * answer.x.norm());
      }
  }
}

TEST_P(QpVariantsTest, TheObjectiveNeverGrows) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const DenseProgram program = mixedProgram(40, std::pow(10.0, seed % 6), 113 + seed);

    const QpAnswer answer = solveQp(program, call(1e-9));

    ASSERT_EQ(answer.report.status, Status::converged) << seed;
    double size = std::abs(answer.report.objective);
    for (const auto& record : answer.report.history)
      size = std::max(size, std::abs(record.objective));
    for (std::size_t k = 1; k < answer.report.history.size(); ++k)
      EXPECT_LE(answer.report.history[k].objective, answer.report.history[k - 1].objective + 1e-13 * size)
          << "seed " << seed << ", record " << k << " of kind "
          << static_cast<char>(answer.report.history[k].kind);
  }
}

TEST_P(QpVariantsTest, TheLagrangianNeverGrowsInsideAnOuterIteration) {
  const DenseProgram program = mixedProgramWithRows(40, 4, 1e3, 127);

  const QpAnswer answer = solveQp(program, call(1e-9));

  ASSERT_EQ(answer.report.status, Status::converged);
  const auto& history = answer.report.history;
  double size = 0;
  for (const auto& record : history)
    size = std::max(size, std::abs(record.objective));
  for (std::size_t k = 1; k < history.size(); ++k)
    if (history[k].kind != StepKind::start) {
      EXPECT_LE(history[k].objective, history[k - 1].objective + 1e-13 * size) << "record " << k;
    }
}

TEST_P(QpVariantsTest, EveryStepIsInTheHistoryAndEveryProductCounted) {
  for (const bool hasRows : {false, true}) {
    const DenseProgram program = hasRows ? mixedProgramWithRows(30, 3, 100, 131) : mixedProgram(30, 100, 131);
    QpCall counted = call(1e-9);
    counted.parameters.set("Operator Norm", 1.0);

    const QpAnswer answer = solveQp(program, counted);

    const auto& counts = answer.report.counts;
    EXPECT_EQ(counts.hessianMultiplications, answer.products);
    int cg = 0, expansions = 0, proportionings = 0, last = -1;
    for (const auto& record : answer.report.history) {
      cg += record.kind == StepKind::conjugateGradient ? 1 : 0;
      expansions += record.kind == StepKind::expansion ? 1 : 0;
      proportionings += record.kind == StepKind::proportioning ? 1 : 0;
      EXPECT_GE(record.hessianMultiplications, last);
      EXPECT_EQ(record.iteration, cg + expansions + proportionings);
      last = record.hessianMultiplications;
    }
    EXPECT_EQ(cg, counts.conjugateGradient);
    EXPECT_EQ(expansions, counts.expansion);
    EXPECT_EQ(proportionings, counts.proportioning);
  }
}

INSTANTIATE_TEST_SUITE_P(Expansions, QpVariantsTest,
                         testing::Values("projected CG", "fixed step", "active set"));

/// Residuals of conjugate gradients from 0 with the preconditioner M.
std::vector<double> residualsOfCg(const DenseProgram& program, const Eigen::MatrixXd& m, int steps) {
  std::vector<double> norms;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(program.size()), r = program.linear, z = m * r, p = z;
  for (int k = 0; k < steps; ++k) {
    norms.push_back(r.norm() / program.linear.norm());
    const Eigen::VectorXd ap = program.hessian * p;
    const double alpha = r.dot(z) / p.dot(ap), before = r.dot(z);
    x += alpha * p;
    r -= alpha * ap;
    z = m * r;
    p = z + r.dot(z) / before * p;
  }
  return norms;
}

void expectSteps(const QpAnswer& answer, const std::vector<double>& norms) {
  ASSERT_GE(answer.report.history.size(), norms.size());
  for (std::size_t k = 0; k < norms.size(); ++k)
    EXPECT_NEAR(answer.report.history[k].projectedGradient, norms[k], 1e-8 * norms[k] + 1e-13)
        << "step " << k;
  EXPECT_EQ(answer.report.counts.expansion, 0);
  EXPECT_EQ(answer.report.counts.proportioning, 0);
}

TEST(QpVariantsTest, WithoutBoundsItIsConjugateGradientsStepByStep) {
  std::mt19937 random(137);
  const DenseProgram program =
      DenseProgram::unconstrained(randomSpd(25, 100, random), Eigen::VectorXd::LinSpaced(25, -1, 2));

  const QpAnswer answer = solveQp(program, {withTolerance(1e-10)});

  expectSteps(answer, residualsOfCg(program, Eigen::MatrixXd::Identity(25, 25), 12));
}

TEST(QpVariantsTest, BoundsThatAreNeverMetChangeNoStep) {
  std::mt19937 random(139);
  DenseProgram program =
      DenseProgram::unconstrained(randomSpd(25, 100, random), Eigen::VectorXd::LinSpaced(25, -1, 2));
  program.lower.setConstant(-1e6);
  program.upper.setConstant(1e6);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-10)});

  expectSteps(answer, residualsOfCg(program, Eigen::MatrixXd::Identity(25, 25), 12));
}

TEST(QpVariantsTest, WithADiagonalPreconditionerItIsPreconditionedConjugateGradientsStepByStep) {
  std::mt19937 random(149);
  DenseProgram program =
      DenseProgram::unconstrained(randomSpd(25, 10, random), Eigen::VectorXd::LinSpaced(25, -1, 2));
  const Eigen::VectorXd scale =
      Eigen::VectorXd::LinSpaced(25, -3, 3).unaryExpr([](double e) { return std::pow(10, e / 2); });
  program.hessian = scale.asDiagonal() * program.hessian * scale.asDiagonal();
  const Eigen::MatrixXd m = program.hessian.diagonal().cwiseInverse().asDiagonal();
  QpCall call{withTolerance(1e-10)};
  call.change = [&](qp::QuadraticProgram& problem) {
    problem.preconditioner = rcp(new DenseOperator(problem.hessian->getDomainMap(), m));
  };

  const QpAnswer answer = solveQp(program, call);

  EXPECT_EQ(whyNoSolution(program, answer, 1e-10), "");
  expectSteps(answer, residualsOfCg(program, m, 12));
  EXPECT_GT(answer.report.counts.preconditionerApplications, 12);
}

} // namespace
