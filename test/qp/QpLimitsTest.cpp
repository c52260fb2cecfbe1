#include "FaultyOperators.hpp"
#include "QpProblems.hpp"
#include "support/DenseOracle.hpp"

#include <Teuchos_Time.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <tuple>

/// Limits of products, outer iterations and time, tolerances that cannot be met, norms that are wrong.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::Status;

DenseProgram programOf(bool hasRows, double condition) {
  return hasRows ? mixedProgramWithRows(30, 3, condition, 79) : mixedProgram(30, condition, 79);
}

class QpLimitsTest : public testing::TestWithParam<bool> {};

TEST_P(QpLimitsTest, StopsAtTheLimitOfProducts) {
  const DenseProgram program = programOf(GetParam(), 1e6);
  for (const int limit : {1, 2, 3, 5, 10, 20}) {
    QpCall call{withTolerance(1e-12)};
    call.parameters.sublist("MPRGP").set("Maximum Multiplications", limit);

    const QpAnswer answer = solveQp(program, call);

    EXPECT_EQ(answer.report.status, Status::maxIterations);
    EXPECT_NE(answer.report.reason.find("Maximum Multiplications"), std::string::npos)
        << answer.report.reason;
    EXPECT_LE(answer.report.counts.hessianMultiplications, limit + 3) << "a step and the certificate";
    EXPECT_LE(residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).feasibility,
              0);
  }
}

TEST_P(QpLimitsTest, StopsAtTheTimeLimit) {
  const DenseProgram program = programOf(GetParam(), 1e6);
  QpCall call{withTolerance(1e-13)};
  call.parameters.set("Operator Norm", 1.0);
  call.parameters.sublist("MPRGP").set("Time Limit", 0.05);
  call.change = [&](qp::QuadraticProgram& problem) {
    problem.hessian = rcp(new SlowOperator(problem.hessian->getDomainMap(), program.hessian, 2));
  };
  const double start = Teuchos::Time::wallTime();

  const QpAnswer answer = solveQp(program, call);

  EXPECT_EQ(answer.report.status, Status::timeLimit) << answer.report.reason;
  EXPECT_NE(answer.report.reason.find("Time Limit"), std::string::npos) << answer.report.reason;
  EXPECT_LT(Teuchos::Time::wallTime() - start, 2);
  EXPECT_LE(residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).feasibility, 0);
}

TEST_P(QpLimitsTest, MultipliersBelongToTheIterateWhereverTheSolveStops) {
  const DenseProgram program = programOf(GetParam(), 100);
  for (int limit = 1; limit < 60; limit += 2) {
    QpCall call{withTolerance(1e-12)};
    call.parameters.sublist("MPRGP").set("Maximum Multiplications", limit);

    const QpAnswer answer = solveQp(program, call);

    if (answer.report.status == Status::converged)
      break;
    const DenseResiduals found =
        residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>());
    EXPECT_NEAR(answer.report.kkt.stationarity, found.stationarity / program.linear.norm(), 1e-12) << limit;
    EXPECT_NEAR(answer.report.kkt.dualFeasibility, found.dualFeasibility / program.linear.norm(), 1e-12)
        << limit;
    const Eigen::VectorXd g =
        program.gradient(answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>()).cast<double>();
    for (Eigen::Index i = 0; i < g.size(); ++i)
      if (answer.boundMultiplier[i] != 0) {
        EXPECT_NEAR(answer.boundMultiplier[i], g[i], 1e-12) << limit;
      }
  }
}

TEST_P(QpLimitsTest, ReachesTwelveDigits) {
  const DenseProgram program = programOf(GetParam(), 1e3);

  const QpAnswer answer = solveQp(program, {withTolerance(1e-12)});

  EXPECT_EQ(whyNoSolution(program, answer, 1e-12), "");
  EXPECT_NEAR((answer.x - solveByDualActiveSet(program).x.cast<double>()).norm(), 0, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Problems, QpLimitsTest, testing::Bool(),
                         [](const auto& instance) { return instance.param ? "rows" : "bounds"; });

TEST(QpLimitsTest, OuterIterationsAreLimitedAndMultipliersStillBelongToTheIterate) {
  const DenseProgram program = programOf(true, 1e4);
  for (const char* update : {"both", "balance", "penalty"})
    for (int limit = 1; limit <= 6; ++limit) {
      QpCall call{withTolerance(1e-13)};
      call.parameters.sublist("SMALBE").set("Maximum Outer Iterations", limit);
      call.parameters.sublist("SMALBE").set("Update", std::string(update));

      const QpAnswer answer = solveQp(program, call);

      if (answer.report.status == Status::converged)
        break;
      EXPECT_EQ(answer.report.status, Status::maxIterations);
      EXPECT_EQ(answer.report.counts.outer, limit);
      EXPECT_NE(answer.report.reason.find("Maximum Outer Iterations"), std::string::npos)
          << answer.report.reason;
      const DenseResiduals found =
          residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>());
      EXPECT_NEAR(answer.report.kkt.stationarity, found.stationarity / program.linear.norm(), 1e-11) << limit;
    }
}

using Variant = std::tuple<bool, std::string>;

/// With rows or without, expansion, release.
class QpAccuracyTest : public testing::TestWithParam<Variant> {
protected:
  static QpCall call(double tolerance) {
    QpCall result{withTolerance(tolerance)};
    result.parameters.sublist("MPRGP").set("Expansion", std::get<1>(GetParam()));
    return result;
  }
  static bool hasRows() { return std::get<0>(GetParam()); }
};

TEST_P(QpAccuracyTest, SaysStagnatedWhereRoundOffAllowsNoMore) {
  for (const double tolerance : {1e-18, 0.0})
    for (const double condition : {1.0, 1e3, 1e6}) {
      const DenseProgram program = programOf(hasRows(), condition);

      const QpAnswer answer = solveQp(program, call(tolerance));

      EXPECT_TRUE(answer.report.status == Status::stagnated || answer.report.status == Status::converged)
          << toString(answer.report.status) << ", condition " << condition;
      const DenseResiduals found =
          residuals(program, answer.x.cast<Real>(), answer.equalityMultiplier.cast<Real>());
      const double limit = 1e3 * program.roundOff(answer.x, answer.equalityMultiplier);
      EXPECT_LE(found.projectedGradient(), limit) << "condition " << condition;
      EXPECT_LE(found.relativeEquality, 1e-12) << "condition " << condition;
      EXPECT_LE(answer.report.counts.hessianMultiplications, 9000) << "condition " << condition;
    }
}

TEST_P(QpAccuracyTest, CorrectsANormThatIsFarTooSmall) {
  const DenseProgram program = programOf(hasRows(), 100); // of norm 1
  const QpAnswer right = solveQp(program, call(1e-10));
  for (const double norm : {1e-1, 1e-2, 1e-3}) {
    QpCall wrong = call(1e-10);
    wrong.parameters.set("Operator Norm", norm);

    const QpAnswer answer = solveQp(program, wrong);

    EXPECT_EQ(whyNoSolution(program, answer, 1e-10), "") << "norm " << norm;
    EXPECT_GT(answer.report.counts.normCorrections, 0) << "norm " << norm;
    EXPECT_GT(answer.report.operatorNorm, norm) << "as known at the end";
    EXPECT_NEAR((answer.x - right.x).norm(), 0, 1e-7 * right.x.norm()) << "norm " << norm;
  }
}

TEST_P(QpAccuracyTest, BearsANormThatIsTooLarge) {
  const DenseProgram program = programOf(hasRows(), 100);
  const QpAnswer right = solveQp(program, call(1e-8));
  for (const double norm : {1e1, 1e3}) {
    QpCall wrong = call(1e-8);
    wrong.parameters.set("Operator Norm", norm);

    const QpAnswer answer = solveQp(program, wrong);

    EXPECT_EQ(whyNoSolution(program, answer, 1e-8), "") << "norm " << norm;
    EXPECT_NEAR((answer.x - right.x).norm(), 0, 1e-5 * right.x.norm()) << "norm " << norm;
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, QpAccuracyTest,
                         testing::Combine(testing::Bool(),
                                          testing::Values("projected CG", "fixed step", "active set")));

} // namespace
