#include "EqualityProblems.hpp"

#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/Smalbe.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace epafi;
using qp::Status;

constexpr double infinity = std::numeric_limits<double>::infinity();

using test::projectedGradient;
using test::randomProblem;
using Problem = test::EqualityProblem;

struct Answer {
  Eigen::VectorXd x;
  qp::SolveReport report;
};

Answer solve(const Problem& problem, double tolerance, const qp::SmalbeParameters& parameters = {},
             double norm = 1.0, const Eigen::VectorXd& start = {}) {
  const auto map = test::linearMap(static_cast<int>(problem.b.size()));
  const RCP<const qp::EqualityConstraint> g = rcp(new test::DenseEquality(map, problem.g));
  const RCP<const qp::ConvexSet> box = rcp(new qp::Box(test::makeVector(map, problem.lower)));
  Vector x(map);
  if (start.size() > 0)
    x.assign(*test::makeVector(map, start));
  const qp::Tolerances tolerances{tolerance, problem.b.norm(), tolerance, 1.0};
  const auto report = qp::solveBySmalbe({.hessian = rcp(new test::DenseOperator(map, problem.a)),
                                         .linearTerm = test::makeVector(map, problem.b),
                                         .set = box,
                                         .equality = g,
                                         .operatorNorm = norm},
                                        x, tolerances, parameters, {});
  return {test::gather(x), report};
}

TEST(SmalbeTest, SolvesTwoUnknownsByHand) {
  // min ½(x² + y²) − 3x − y over x + y = 0 (as an orthonormal row), x ≥ −∞, y ≥ −0.5: y = −0.5, x = 0.5.
  Problem problem{Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Constant(1, 2, 1 / std::sqrt(2.0)),
                  Eigen::Vector2d(3, 1), Eigen::Vector2d(-infinity, -0.5)};

  const Answer answer = solve(problem, 1e-10);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_NEAR(answer.x[0], 0.5, 1e-9);
  EXPECT_NEAR(answer.x[1], -0.5, 1e-9);
}

TEST(SmalbeTest, EndsWithAKktPointOnRandomProblems) {
  std::mt19937 random(3);
  for (int repeat = 0; repeat < 30; ++repeat) {
    const int n = 5 + repeat;
    const Problem problem = randomProblem(n, 1 + repeat % 4, repeat % 2 == 0 ? 10 : 1e3, random);

    const Answer answer = solve(problem, 1e-9);

    EXPECT_EQ(answer.report.status, Status::converged) << repeat << ": " << answer.report.reason;
    EXPECT_LE(projectedGradient(problem, answer.x), 1.01e-9 * problem.b.norm() + 1e-14) << repeat;
    EXPECT_TRUE((answer.x.array() >= problem.lower.array()).all());
  }
}

TEST(SmalbeTest, MeetsTheEqualityToRoundOffWhateverTheTolerance) {
  std::mt19937 random(5);
  for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
    const Problem problem = randomProblem(20, 3, 100, random);

    const Answer answer = solve(problem, tolerance);

    EXPECT_EQ(answer.report.status, Status::converged);
    EXPECT_LE((problem.g * answer.x).norm(), 1e-13 * (1 + answer.x.norm())) << "tolerance " << tolerance;
  }
}

TEST(SmalbeTest, PenaltyAndBalanceOverManyOrdersGiveTheSameAnswer) {
  std::mt19937 random(7);
  const Problem problem = randomProblem(16, 2, 50, random);
  const Answer reference = solve(problem, 1e-10);
  for (const double penalty : {1e-2, 1.0, 1e2})
    for (const double balance : {1e-2, 1.0, 1e2}) {
      qp::SmalbeParameters parameters;
      parameters.penalty = penalty;
      parameters.balance = balance;
      parameters.maxOuterIterations = 5000;

      const Answer answer = solve(problem, 1e-10, parameters);

      EXPECT_EQ(answer.report.status, Status::converged) << "ρ " << penalty << ", M " << balance;
      EXPECT_LE((answer.x - reference.x).norm(), 1e-6 * reference.x.norm())
          << "ρ " << penalty << ", M " << balance;
    }
}

TEST(SmalbeTest, ScalingTheObjectiveKeepsTheSteps) {
  std::mt19937 random(11);
  const Problem problem = randomProblem(18, 2, 50, random);
  const Answer plain = solve(problem, 1e-8);
  for (const double factor : {0x1p-40, 0x1p40}) { // powers of two, so that round-off is the same
    Problem scaled = problem;
    scaled.a *= factor;
    scaled.b *= factor;

    const Answer answer = solve(scaled, 1e-8, {}, factor);

    EXPECT_EQ(answer.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications);
    EXPECT_EQ((answer.x - plain.x).norm(), 0);
  }
}

TEST(SmalbeTest, ReachesAConstraintThatOnlyBoundEntriesCanMeetInFewOuterIterations) {
  // min ½|x|² + 5x₁ + 4x₂, x₁ + x₂ = 0, x ≥ −ε. From x = −ε the multiplier has to grow to 5 before
  // anything moves, while the residual is only ε.
  const double epsilon = 1e-6;
  Problem problem{Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Constant(1, 2, 1 / std::sqrt(2.0)),
                  Eigen::Vector2d(-5, -4), Eigen::Vector2d::Constant(-epsilon)};

  const Answer answer = solve(problem, 1e-10);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_LE(answer.report.counts.outer, 30);
  EXPECT_NEAR(answer.x[0], -epsilon, 1e-15);
  EXPECT_NEAR(answer.x[1], epsilon, 1e-9);
}

TEST(SmalbeTest, StopsAtTheOuterLimit) {
  std::mt19937 random(13);
  const Problem problem = randomProblem(20, 3, 1e4, random);
  qp::SmalbeParameters parameters;
  parameters.maxOuterIterations = 1;

  const qp::SolveReport report = solve(problem, 1e-13, parameters).report;

  EXPECT_EQ(report.status, Status::maxIterations);
  EXPECT_NE(report.reason.find("Maximum Outer Iterations"), std::string::npos) << report.reason;
}

TEST(SmalbeTest, AStartAtTheSolutionStaysThere) {
  std::mt19937 random(21);
  for (int trial = 0; trial < 5; ++trial) {
    const Problem problem = randomProblem(20, 3, 100, random);
    const Answer cold = solve(problem, 1e-9);
    ASSERT_EQ(cold.report.status, Status::converged);
    const Answer warm = solve(problem, 1e-8, {}, 1.0, cold.x);
    EXPECT_EQ(warm.report.status, Status::converged);
    EXPECT_LE(warm.report.counts.hessianMultiplications, 3);
    EXPECT_GT(cold.report.counts.hessianMultiplications, 10);
    EXPECT_LE((warm.x - cold.x).norm(), 1e-6 * cold.x.norm());
  }
}

} // namespace
