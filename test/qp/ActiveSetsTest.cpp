#include "EqualityProblems.hpp"

#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/solve/ActiveSets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace epafi;
using qp::Status;

struct Problem : test::EqualityProblem {
  Eigen::MatrixXd m{}; ///< preconditioner, or empty
  double faceReduction = 0.1;
};

struct Answer {
  Eigen::VectorXd x;
  qp::SolveReport report;
};

Answer solve(const Problem& problem, double tolerance, const Eigen::VectorXd& face = {},
             const qp::MprgpParameters& limits = {}, const Eigen::VectorXd& start = {}) {
  const auto map = test::linearMap(static_cast<int>(problem.b.size()));
  qp::QuadraticProgram given;
  given.hessian = rcp(new test::DenseOperator(map, problem.a));
  given.linearTerm = test::makeVector(map, problem.b);
  given.set = rcp(new qp::Box(test::makeVector(map, problem.lower)));
  given.operatorNorm = 1;
  if (problem.g.rows() > 0)
    given.equality = rcp(new test::DenseEquality(map, problem.g));
  if (problem.m.size() > 0)
    given.preconditioner = rcp(new test::DenseOperator(map, problem.m));
  Vector x(map);
  if (start.size() > 0)
    x.assign(*test::makeVector(map, start));
  const RCP<Vector> first = face.size() > 0 ? test::makeVector(map, face) : Teuchos::null;
  const auto report = qp::solveByActiveSets(given, x, {problem.faceReduction, first.get()},
                                            {tolerance, problem.b.norm(), 1e-10, 1.0}, limits);
  return {test::gather(x), report};
}

TEST(ActiveSetsTest, SolvesTwoUnknownsByHand) {
  // min ½(x² + y²) − 3x − y over x + y = 0 (as an orthonormal row), y ≥ −0.5: y = −0.5, x = 0.5.
  const Problem problem{Eigen::Matrix2d::Identity(), Eigen::MatrixXd::Constant(1, 2, 1 / std::sqrt(2.0)),
                        Eigen::Vector2d(3, 1), Eigen::Vector2d(-test::unbounded, -0.5)};

  const Answer answer = solve(problem, 1e-10);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_NEAR(answer.x[0], 0.5, 1e-12);
  EXPECT_NEAR(answer.x[1], -0.5, 1e-12);
}

TEST(ActiveSetsTest, AtTheOriginThePreconditionerChoosesTheFirstFace) {
  Problem problem{Eigen::VectorXd::LinSpaced(12, 1, 5).asDiagonal(), Eigen::MatrixXd(0, 12), {}, {}};
  problem.b = Eigen::VectorXd::LinSpaced(12, -3, 4).array().sin().matrix();
  problem.lower = Eigen::VectorXd::Zero(12);
  EXPECT_GT(solve(problem, 1e-10).report.counts.expansion, 0); // from the face where nothing moves
  problem.m = direct::inverseOfSpd(problem.a);

  const Answer answer = solve(problem, 1e-10);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_LE((answer.x - (problem.m * problem.b).cwiseMax(0.0)).norm(), 1e-14);
  EXPECT_EQ(answer.report.counts.conjugateGradient, 1);
  EXPECT_EQ(answer.report.counts.hessianMultiplications, 2); // no product at 0; the second confirms
}

TEST(ActiveSetsTest, TellsADirectionWithoutEndFromOneThatBoundsEnd) {
  Problem problem{(Eigen::Matrix2d() << 1, -1, -1, 1).finished(), Eigen::MatrixXd(0, 2),
                  Eigen::Vector2d(1, 2), Eigen::Vector2d::Zero()};
  const Eigen::VectorXd everywhere = Eigen::VectorXd::Ones(2);
  EXPECT_EQ(solve(problem, 1e-10, everywhere).report.status, Status::unbounded); // along (1, 1)
  problem.a << 1, 1, 1, 1; // no curvature along (1, −1), which the bounds end
  const Answer answer = solve(problem, 1e-10, everywhere);
  EXPECT_NE(answer.report.status, Status::unbounded);
  if (answer.report.status == Status::converged) {
    EXPECT_LE((answer.x - Eigen::Vector2d(0, 2)).norm(), 1e-9);
  }
}

/// x₀ = 0, x₁ = x₂. With x₁ and x₂ on their bounds nothing can make them equal: x₁, whose bound is the lower
/// one, has to move.
TEST(ActiveSetsTest, AFaceThatCannotHoldTheRowsTakesInWhatStopsTheMotionThatIsLeft) {
  const double root = std::sqrt(0.5);
  const Problem problem{Eigen::Matrix3d::Identity(),
                        (Eigen::MatrixXd(2, 3) << 1, 0, 0, 0, root, -root).finished(),
                        Eigen::Vector3d(0, -3, -3), Eigen::Vector3d(-1, -1, -0.5)};

  const Answer answer = solve(problem, 1e-10, Eigen::Vector3d(1, 0, 0), {}, problem.lower);

  EXPECT_EQ(answer.report.status, Status::converged);
  EXPECT_LE((answer.x - Eigen::Vector3d(0, -0.5, -0.5)).norm(), 1e-12);
}

/// Entries that nearly depend on each other may get forces out of all proportion; then the way leads through
/// points of the set.
TEST(ActiveSetsTest, GoesOnInTheSetWhereFacesDoNotSettle) {
  std::mt19937 random(7);
  for (int problemNumber = 0; problemNumber < 60; ++problemNumber) {
    SCOPED_TRACE(problemNumber);
    Problem problem{test::randomProblem(16, 1, 10, random)};
    problem.g.resize(0, 16);
    problem.lower = Eigen::VectorXd::Zero(16);
    for (int i = 0; i < 6; ++i) { // entry i + 8 acts as entry i does, but for 10⁻⁵
      problem.a.row(i + 8) = problem.a.row(i);
      problem.a.col(i + 8) = problem.a.col(i);
      problem.a(i + 8, i + 8) = problem.a(i, i) * (1 + 1e-10);
    }
    const Answer answer = solve(problem, 1e-10, Eigen::VectorXd::Ones(16));
    EXPECT_EQ(answer.report.status, Status::converged);
    EXPECT_GE(answer.x.minCoeff(), 0.0);
    const Eigen::VectorXd g = problem.a * answer.x - problem.b;
    EXPECT_GE(g.minCoeff(), -1e-9 * problem.b.norm());
    EXPECT_LE(std::abs(g.dot(answer.x)), 1e-9 * problem.b.norm() * answer.x.norm());
  }
}

/// Of two entries that act alike one is worth more: where both may move, the face has no minimum, and forces
/// grow until round-off ends that. The bounds are not 0, so that a step along a direction is no point of the
/// set.
TEST(ActiveSetsTest, EntriesThatActAlikeEndInThoseThatAreWorthMost) {
  std::mt19937 random(11);
  int numSettled = 0;
  for (int problemNumber = 0; problemNumber < 100; ++problemNumber) {
    SCOPED_TRACE(problemNumber);
    Problem problem{test::randomProblem(16, 1, 1e4, random)};
    problem.lower.setConstant(-0.1);
    if (problemNumber % 2 == 0)
      problem.g.resize(0, 16);
    for (int i = 0; i < 6; ++i) {
      problem.a.row(i + 8) = problem.a.row(i);
      problem.a.col(i + 8) = problem.a.col(i);
      problem.b[i + 8] = problem.b[i] - 1e-3;
      if (problem.g.rows() > 0)
        problem.g(0, i + 8) = problem.g(0, i);
    }
    if (problem.g.rows() > 0)
      problem.g.row(0).normalize();

    const Answer answer = solve(problem, 1e-8, Eigen::VectorXd::Ones(16));

    EXPECT_TRUE(answer.report.status == Status::converged || answer.report.status == Status::stagnated);
    EXPECT_GE((answer.x - problem.lower).minCoeff(), 0.0);
    if (answer.report.status == Status::converged) {
      ++numSettled;
      EXPECT_LE(test::projectedGradient(problem, answer.x), 1.01e-8 * problem.b.norm());
      EXPECT_LE((answer.x - problem.lower).segment(8, 6).maxCoeff(), 0.0);
    }
  }
  EXPECT_GE(numSettled, 95); // of 100; it is all of them
}

TEST(ActiveSetsTest, MeetsTheConditionsOfKktWhereItSaysSo) {
  std::mt19937 random(1);
  int numSettled = 0;
  for (int problemNumber = 0; problemNumber < 40; ++problemNumber) {
    const int rows = problemNumber % 4;
    Problem problem{test::randomProblem(24, std::max(rows, 1), 100, random)};
    if (rows == 0)
      problem.g.resize(0, 24);
    if (problemNumber % 2 != 0)
      problem.m = direct::inverseOfSpd(problem.a) + 0.1 * Eigen::MatrixXd::Identity(24, 24);

    const Answer answer = solve(problem, 1e-8);

    EXPECT_TRUE(answer.report.status == Status::converged || answer.report.status == Status::stagnated);
    EXPECT_GE((answer.x - problem.lower).minCoeff(), 0.0) << problemNumber;
    if (answer.report.status != Status::converged)
      continue;
    ++numSettled;
    EXPECT_LE(test::projectedGradient(problem, answer.x), 1.01e-8 * problem.b.norm()) << problemNumber;
    if (rows > 0) {
      EXPECT_LE((problem.g * answer.x).norm(), 1e-13) << problemNumber;
    }
    ASSERT_FALSE(answer.report.gradient.is_null());
    const Eigen::VectorXd rest = test::gather(*answer.report.gradient) - (problem.a * answer.x - problem.b);
    const Eigen::VectorXd inRows =
        rows > 0 ? Eigen::VectorXd(problem.g.transpose() * (problem.g * rest)) : Eigen::VectorXd::Zero(24);
    EXPECT_LE((rest - inRows).norm(), 1e-12) << "the gradient is Ax − b + Bᵀμ";
  }
  EXPECT_GE(numSettled, 36);
}

/// Where all wrong multipliers at once lead in circles one after the other leads on (33 of 200 settle
/// without, 191 with).
TEST(ActiveSetsTest, SettlesOnMostProblemsOfBadCondition) {
  std::mt19937 random(5);
  int numSettled = 0;
  for (int problemNumber = 0; problemNumber < 200; ++problemNumber) {
    const Problem problem{test::randomProblem(30, 1, 1e5, random)};
    const Answer answer = solve(problem, 1e-8);
    if (answer.report.status != Status::converged)
      continue;
    ++numSettled;
    EXPECT_LE(test::projectedGradient(problem, answer.x), 1.01e-8 * problem.b.norm()) << problemNumber;
  }
  EXPECT_GE(numSettled, 160);
}

TEST(ActiveSetsTest, NeedsLessFromNearby) {
  std::mt19937 random(2);
  Problem problem{test::randomProblem(30, 3, 100, random)};
  const Answer first = solve(problem, 1e-8);
  ASSERT_EQ(first.report.status, Status::converged);
  Eigen::VectorXd nearby = first.x;
  for (Eigen::Index i = 0; i < 30; ++i)
    if (nearby[i] > problem.lower[i])
      nearby[i] *= 1.0001;

  const Answer again = solve(problem, 1e-8, {}, {}, nearby);

  EXPECT_EQ(again.report.status, Status::converged);
  EXPECT_LT(again.report.counts.hessianMultiplications, first.report.counts.hessianMultiplications);
  EXPECT_LT((again.x - first.x).norm(), 1e-6);
}

TEST(ActiveSetsTest, LooksAtFewerFacesTheFurtherEachIsSolved) {
  int early = 0, late = 0; // faces
  std::mt19937 random(7);
  for (int problemNumber = 0; problemNumber < 40; ++problemNumber) {
    Problem problem{test::randomProblem(30, 1, 100, random)};
    problem.faceReduction = 0.5;
    const Answer soon = solve(problem, 1e-8);
    problem.faceReduction = 1e-6;
    const Answer thorough = solve(problem, 1e-8);
    if (soon.report.status != Status::converged || thorough.report.status != Status::converged)
      continue;
    EXPECT_LE((soon.x - thorough.x).norm(), 1e-5 * thorough.x.norm()) << problemNumber;
    early += soon.report.counts.expansion;
    late += thorough.report.counts.expansion;
  }
  EXPECT_GT(late, 0);
  EXPECT_LT(1.2 * late, early);
}

TEST(ActiveSetsTest, EndsInTheSetWhereAFaceCannotHoldTheEquality) {
  // x ≥ 1 and x₁ + … + x₄ = 0 contradict each other.
  const Problem problem{Eigen::MatrixXd::Identity(4, 4), Eigen::MatrixXd::Constant(1, 4, 0.5),
                        Eigen::VectorXd::Constant(4, -1.0), Eigen::VectorXd::Constant(4, 1.0)};

  const Answer answer = solve(problem, 1e-8, Eigen::VectorXd::Ones(4));

  EXPECT_EQ(answer.report.status, Status::stagnated);
  EXPECT_GE(answer.x.minCoeff(), 1.0);
}

TEST(ActiveSetsTest, StopsAtTheLimitOfProducts) {
  std::mt19937 random(3);
  const Problem problem{test::randomProblem(40, 2, 1e4, random)};
  qp::MprgpParameters limits;
  limits.maxMultiplications = 7;

  const Answer answer = solve(problem, 1e-12, {}, limits);

  EXPECT_EQ(answer.report.status, Status::maxIterations);
  EXPECT_LE(answer.report.counts.hessianMultiplications, 8);
  EXPECT_GE((answer.x - problem.lower).minCoeff(), 0.0);
}

TEST(ActiveSetsTest, LeavesASolutionAlone) {
  std::mt19937 random(4);
  const Problem problem{test::randomProblem(20, 2, 50, random)};
  const Answer first = solve(problem, 1e-10);
  ASSERT_EQ(first.report.status, Status::converged);

  const Answer again = solve(problem, 1e-8, {}, {}, first.x);

  EXPECT_EQ(again.report.status, Status::converged);
  EXPECT_EQ(again.report.counts.hessianMultiplications, 1);
  EXPECT_LT((again.x - first.x).norm(), 1e-13);
}

} // namespace
