#include "Problems.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/BoundProblem.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace epafi;
using qp::Bounds;
using qp::Status;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A bound-constrained problem with dense copies.
struct Problem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, lower, upper;

  RCP<const Map> map() const { return test::linearMap(static_cast<int>(b.size())); }
};

struct Answer {
  Eigen::VectorXd x;
  qp::SolveReport report;
  int applications;
};

Answer solve(const Problem& problem, double tolerance = 1e-10, double norm = 1.0,
             const Eigen::VectorXd& start = Eigen::VectorXd(), qp::Observer* observer = nullptr) {
  const auto map = problem.map();
  const auto a = rcp(new test::DenseOperator(map, problem.a));
  const Bounds bounds(test::makeVector(map, problem.lower), test::makeVector(map, problem.upper));
  const auto x = start.size() > 0 ? test::makeVector(map, start) : rcp(new Vector(map));
  const auto report =
      qp::solveBoundProblem(a, *test::makeVector(map, problem.b), bounds, *x, tolerance, {}, norm, observer);
  return {test::gather(*x), report, a->applications};
}

/// Norm of the projected gradient, from scratch.
double projectedGradient(const Problem& problem, const Eigen::VectorXd& x) {
  const Eigen::VectorXd g = problem.a * x - problem.b;
  double squared = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double p = g[i];
    if (x[i] <= problem.lower[i])
      p = std::min(p, 0.0);
    if (x[i] >= problem.upper[i])
      p = problem.lower[i] < problem.upper[i] ? std::max(p, 0.0) : 0.0;
    squared += p * p;
  }
  return std::sqrt(squared);
}

/// Random problem with entries bounded below, above, on both sides, on none, or fixed.
Problem randomProblem(int n, double condition, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> kind(0, 4);
  Problem problem{test::randomSpd(n, condition, random), Eigen::VectorXd(n), Eigen::VectorXd(n),
                  Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    problem.b[i] = normal(random);
    const double centre = normal(random);
    const int k = kind(random);
    problem.lower[i] = k == 0 || k == 1 ? centre - 0.5 : k == 4 ? centre : -infinity;
    problem.upper[i] = k == 0 || k == 2 ? centre + 0.5 : k == 4 ? centre : infinity;
  }
  return problem;
}

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

TEST(MprgpTest, AllActiveAndNoneActiveAndZeroLoad) {
  const int n = 6;
  Problem problem{Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Constant(n, -1), Eigen::VectorXd::Zero(n),
                  Eigen::VectorXd::Constant(n, infinity)};
  EXPECT_EQ(solve(problem).x.norm(), 0) << "all active";
  problem.b.setConstant(1);
  EXPECT_NEAR((solve(problem).x - problem.b).norm(), 0, 1e-12) << "none active";
  problem.b.setZero();
  const Answer idle = solve(problem);
  EXPECT_EQ(idle.report.status, Status::converged) << "zero load";
  EXPECT_EQ(idle.x.norm(), 0);
  EXPECT_EQ(idle.report.counts.hessianMultiplications, 0);
}

TEST(MprgpTest, NamesAnIndefiniteOperator) {
  Problem problem{Eigen::Vector3d(1, -1, 1).asDiagonal(), Eigen::Vector3d(1, 1, 1),
                  Eigen::Vector3d::Constant(-infinity), Eigen::Vector3d::Constant(infinity)};
  problem.a(1, 1) = -5;

  EXPECT_EQ(solve(problem).report.status, Status::indefiniteOperator);
}

TEST(MprgpTest, NamesNanFromTheOperator) {
  Problem problem{Eigen::Matrix3d::Constant(std::nan("")), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d::Zero(),
                  Eigen::Vector3d::Constant(infinity)};

  const Answer answer = solve(problem);

  EXPECT_EQ(answer.report.status, Status::notFinite);
  EXPECT_TRUE(answer.x.allFinite());
}

TEST(MprgpTest, StopsAtTheLimitOfProducts) {
  std::mt19937 random(31);
  const Problem problem = randomProblem(40, 1e6, random);
  const auto map = problem.map();
  const Bounds bounds(test::makeVector(map, problem.lower), test::makeVector(map, problem.upper));
  Vector x(map);
  qp::MprgpParameters parameters;
  parameters.maxMultiplications = 5;

  const auto report =
      qp::solveBoundProblem(rcp(new test::DenseOperator(map, problem.a)), *test::makeVector(map, problem.b),
                            bounds, x, 1e-12, parameters, 1.0);

  EXPECT_EQ(report.status, Status::maxIterations);
  EXPECT_LE(report.counts.hessianMultiplications, 7);
  const Eigen::VectorXd last = test::gather(x);
  EXPECT_TRUE((last.array() >= problem.lower.array()).all()) << "the last iterate stays feasible";
}

TEST(MprgpTest, ReachesRoundOffOrSaysThatItCannot) {
  std::mt19937 random(37);
  const Problem problem = randomProblem(30, 1e6, random);

  const Answer answer = solve(problem, 1e-18);

  EXPECT_NE(answer.report.status, Status::converged);
  EXPECT_LE(answer.report.relativeProjectedGradient, 1e-10);
}

TEST(MprgpTest, LeavesBoundsAndRightHandSideAlone) {
  std::mt19937 random(41);
  const Problem problem = randomProblem(10, 10, random);
  const auto map = problem.map();
  const auto b = test::makeVector(map, problem.b), lower = test::makeVector(map, problem.lower);
  const auto upper = test::makeVector(map, problem.upper);
  Vector x(map);

  qp::solveBoundProblem(rcp(new test::DenseOperator(map, problem.a)), *b, Bounds(lower, upper), x, 1e-10, {},
                        1.0);

  EXPECT_EQ(test::gather(*b), problem.b);
  EXPECT_EQ(test::gather(*lower), problem.lower);
  EXPECT_EQ(test::gather(*upper), problem.upper);
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
