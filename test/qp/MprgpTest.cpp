#include "BoundProblems.hpp"

#include "epafi/qp/solve/MprgpSolve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace epafi;
using qp::Status;
using test::Answer;
using test::infinity;
using test::Problem;
using test::projectedGradient;
using test::randomProblem;
using test::solve;

TEST(MprgpTest, SolvesTwoUnknownsByHand) {
  // min x² + y² − 2x + 2y over x, y ≥ 0: x = 1, y = 0 with force 2.
  const Problem problem{2 * Eigen::Matrix2d::Identity(), Eigen::Vector2d(2, -2), Eigen::Vector2d::Zero(),
                        Eigen::Vector2d::Constant(infinity)};

  const Answer answer = solve(problem, 1e-12, 2.0);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_NEAR(answer.x[0], 1, 1e-12);
  EXPECT_EQ(answer.x[1], 0);
}

TEST(MprgpTest, EndsWithAKktPointOnRandomProblemsWithMixedBounds) {
  std::mt19937 random(7);
  for (int repeat = 0; repeat < 60; ++repeat) {
    const int n = 1 + repeat % 30;
    const Problem problem = randomProblem(n, repeat % 3 == 0 ? 1.0 : std::pow(10.0, repeat % 5), random);

    const Answer answer = solve(problem);

    EXPECT_EQ(answer.report.status, Status::converged) << repeat << ": " << answer.report.reason;
    EXPECT_LE(projectedGradient(problem, answer.x), 1.001e-10 * problem.b.norm() + 1e-14) << repeat;
    EXPECT_TRUE((answer.x.array() >= problem.lower.array()).all());
    EXPECT_TRUE((answer.x.array() <= problem.upper.array()).all());
  }
}

/// The solution of a problem with lower bounds only, found by trying all active sets.
Eigen::VectorXd enumerateActiveSets(const Problem& problem) {
  const auto n = problem.b.size();
  double best = infinity;
  Eigen::VectorXd solution;
  for (unsigned set = 0; set < (1U << n); ++set) {
    Eigen::MatrixXd a = problem.a;
    Eigen::VectorXd b = problem.b;
    for (Eigen::Index i = 0; i < n; ++i)
      if ((set >> i & 1U) != 0) { // held at its bound; the others solve their equations
        a.row(i).setZero();
        a(i, i) = 1;
        b[i] = problem.lower[i];
      }
    const Eigen::VectorXd x = a.partialPivLu().solve(b);
    const double value = 0.5 * x.dot(problem.a * x) - problem.b.dot(x);
    if ((x.array() >= problem.lower.array() - 1e-12).all() && value < best) {
      best = value;
      solution = x;
    }
  }
  return solution;
}

TEST(MprgpTest, AgreesWithEnumerationOfActiveSets) {
  std::mt19937 random(11);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Problem problem = randomProblem(1 + repeat % 7, 10, random);
    problem.upper.setConstant(infinity);
    problem.lower.setConstant(-0.1);
    const Eigen::VectorXd oracle = enumerateActiveSets(problem);

    const Answer answer = solve(problem, 1e-12);

    EXPECT_LE((answer.x - oracle).norm(), 1e-9) << repeat;
    const double value = 0.5 * oracle.dot(problem.a * oracle) - problem.b.dot(oracle);
    EXPECT_NEAR(answer.report.objective, value, 1e-11 * (1 + std::abs(value)));
  }
}

TEST(MprgpTest, IsConjugateGradientsWithoutBounds) {
  std::mt19937 random(3);
  const int n = 25;
  const Problem problem{test::randomSpd(n, 100, random), Eigen::VectorXd::LinSpaced(n, -1, 2),
                        Eigen::VectorXd::Constant(n, -infinity), Eigen::VectorXd::Constant(n, infinity)};
  std::vector<double> residuals; // plain CG from 0
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), r = problem.b, p = r;
  for (int k = 0; k < 10; ++k) {
    residuals.push_back(r.norm() / problem.b.norm());
    const Eigen::VectorXd ap = problem.a * p;
    const double alpha = r.dot(p) / p.dot(ap);
    x += alpha * p;
    r -= alpha * ap;
    p = r - r.dot(ap) / p.dot(ap) * p;
  }

  const Answer answer = solve(problem, 1e-8);

  EXPECT_EQ(answer.report.counts.expansion, 0);
  EXPECT_EQ(answer.report.counts.proportioning, 0);
  for (std::size_t k = 0; k < residuals.size(); ++k)
    EXPECT_NEAR(answer.report.history[k].projectedGradient, residuals[k], 1e-9 * residuals[k] + 1e-13)
        << "step " << k;
}

TEST(MprgpTest, CountsEveryProductAndEveryStep) {
  std::mt19937 random(5);
  const Problem problem = randomProblem(40, 1e3, random);

  const Answer answer = solve(problem);

  const auto& counts = answer.report.counts;
  EXPECT_EQ(counts.hessianMultiplications, answer.applications);
  int steps = 0;
  for (const auto& record : answer.report.history)
    steps += record.kind != qp::StepKind::start ? 1 : 0;
  EXPECT_EQ(steps, counts.conjugateGradient + counts.expansion + counts.proportioning);
  EXPECT_GT(counts.expansion, 0);
}

TEST(MprgpTest, ObjectiveFallsWithEveryStepAndEndsAtItsValue) {
  std::mt19937 random(13);
  const Problem problem = randomProblem(30, 1e3, random);

  const Answer answer = solve(problem);

  const double size = std::abs(answer.report.objective) + 1;
  for (std::size_t k = 1; k < answer.report.history.size(); ++k)
    EXPECT_LE(answer.report.history[k].objective, answer.report.history[k - 1].objective + 1e-12 * size);
  const double value = 0.5 * answer.x.dot(problem.a * answer.x) - problem.b.dot(answer.x);
  EXPECT_NEAR(answer.report.objective, value, 1e-12 * size);
}

TEST(MprgpTest, SurvivesANormThatIsFarTooSmall) {
  std::mt19937 random(17);
  const Problem problem = randomProblem(30, 100, random);
  const Answer right = solve(problem, 1e-10, 1.0);

  const Answer wrong = solve(problem, 1e-10, 1e-3); // the true norm is 1

  EXPECT_EQ(wrong.report.status, Status::converged);
  EXPECT_LE((wrong.x - right.x).norm(), 1e-7 * right.x.norm());
}

TEST(MprgpTest, ScalingTheProblemScalesTheAnswerAndKeepsTheSteps) {
  std::mt19937 random(19);
  const Problem problem = randomProblem(20, 100, random);
  const Answer plain = solve(problem);
  for (const double factor : {1e-12, 1e12}) {
    Problem objective = problem; // ½xᵀ(sA)x − (sb)ᵀx: the same x
    objective.a *= factor;
    objective.b *= factor;

    const Answer scaled = solve(objective, 1e-10, factor);

    EXPECT_EQ(scaled.report.status, Status::converged);
    EXPECT_NEAR(scaled.report.counts.hessianMultiplications, plain.report.counts.hessianMultiplications, 1);
    EXPECT_LE((scaled.x - plain.x).norm(), 1e-8 * plain.x.norm());
  }
}

TEST(MprgpTest, StartsWellFromTheSolution) {
  std::mt19937 random(23);
  const Problem problem = randomProblem(30, 100, random);
  const Answer cold = solve(problem);

  const Answer warm = solve(problem, 1e-9, 1.0, cold.x);

  EXPECT_EQ(warm.report.status, Status::converged);
  EXPECT_LE(warm.report.counts.hessianMultiplications, 2);
}

TEST(MprgpTest, AStartOutsideIsProjectedFirst) {
  std::mt19937 random(29);
  const Problem problem = randomProblem(12, 10, random);

  const Answer answer = solve(problem, 1e-10, 1.0, Eigen::VectorXd::Constant(12, 1e3));

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_LE(projectedGradient(problem, answer.x), 1e-9 * problem.b.norm());
}

/// A string over a flat obstacle: −u'' = −f on (0, L), u = 0 at both ends, u ≥ −d. Touches where fL²/8 > d;
/// with s = √(2d/f): u = fx²/2 − fsx on [0, s], −d between.
TEST(MprgpTest, StringOverAnObstacleConvergesToTheClosedForm) {
  const double f = 10, d = 0.5, length = 1, s = std::sqrt(2 * d / f);
  std::vector<double> errors;
  for (const int elements : {20, 40, 80, 160}) {
    const int n = elements - 1;
    const double h = length / elements;
    Problem problem{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Constant(n, -f * h),
                    Eigen::VectorXd::Constant(n, -d), Eigen::VectorXd::Constant(n, infinity)};
    for (int i = 0; i < n; ++i) {
      problem.a(i, i) = 2 / h;
      if (i > 0)
        problem.a(i, i - 1) = problem.a(i - 1, i) = -1 / h;
    }
    const Answer answer = solve(problem, 1e-12, 4 / h);
    double error = 0;
    for (int i = 0; i < n; ++i) {
      const double x = (i + 1) * h, side = std::min(x, length - x);
      const double exact = side <= s ? f * side * side / 2 - f * s * side : -d;
      error = std::max(error, std::abs(answer.x[i] - exact));
    }
    errors.push_back(error);
  }
  EXPECT_LE(errors.back(), 2e-4);
  EXPECT_GE(errors.front() / errors.back(), 16)
      << "second order, up to where the contact's end falls in its element";
}

} // namespace
