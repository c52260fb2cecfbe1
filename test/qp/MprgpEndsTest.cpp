#include "BoundProblems.hpp"

#include "epafi/qp/solve/MprgpSolve.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace epafi;
using qp::Box;
using qp::Status;
using test::Answer;
using test::infinity;
using test::Problem;
using test::randomProblem;
using test::solve;

/// How MPRGP ends where there is little to do, or nothing that can be done.
TEST(MprgpEndsTest, AllActiveAndNoneActiveAndZeroLoad) {
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

TEST(MprgpEndsTest, NamesAnIndefiniteOperator) {
  Problem problem{Eigen::Vector3d(1, -1, 1).asDiagonal(), Eigen::Vector3d(1, 1, 1),
                  Eigen::Vector3d::Constant(-infinity), Eigen::Vector3d::Constant(infinity)};
  problem.a(1, 1) = -5;

  EXPECT_EQ(solve(problem).report.status, Status::indefiniteOperator);
}

TEST(MprgpEndsTest, NamesNanFromTheOperator) {
  Problem problem{Eigen::Matrix3d::Constant(std::nan("")), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d::Zero(),
                  Eigen::Vector3d::Constant(infinity)};

  const Answer answer = solve(problem);

  EXPECT_EQ(answer.report.status, Status::notFinite);
  EXPECT_TRUE(answer.x.allFinite());
}

TEST(MprgpEndsTest, StopsAtTheLimitOfProducts) {
  std::mt19937 random(31);
  const Problem problem = randomProblem(40, 1e6, random);
  const auto map = problem.map();
  const RCP<const Box> box =
      rcp(new Box(test::makeVector(map, problem.lower), test::makeVector(map, problem.upper)));
  Vector x(map);
  qp::MprgpParameters parameters;
  parameters.maxMultiplications = 5;

  const auto report = qp::solveByMprgp({.hessian = rcp(new test::DenseOperator(map, problem.a)),
                                        .linearTerm = test::makeVector(map, problem.b),
                                        .set = box,
                                        .operatorNorm = 1.0},
                                       x, {1e-12, problem.b.norm()}, parameters);

  EXPECT_EQ(report.status, Status::maxIterations);
  EXPECT_LE(report.counts.hessianMultiplications, 7);
  const Eigen::VectorXd last = test::gather(x);
  EXPECT_TRUE((last.array() >= problem.lower.array()).all()) << "the last iterate stays feasible";
}

TEST(MprgpEndsTest, ReachesRoundOffOrSaysThatItCannot) {
  std::mt19937 random(37);
  const Problem problem = randomProblem(30, 1e6, random);

  const Answer answer = solve(problem, 1e-18);

  EXPECT_NE(answer.report.status, Status::converged);
  EXPECT_LE(answer.report.relativeProjectedGradient, 1e-10);
}

TEST(MprgpEndsTest, LeavesBoundsAndRightHandSideAlone) {
  std::mt19937 random(41);
  const Problem problem = randomProblem(10, 10, random);
  const auto map = problem.map();
  const auto b = test::makeVector(map, problem.b), lower = test::makeVector(map, problem.lower);
  const auto upper = test::makeVector(map, problem.upper);
  Vector x(map);

  qp::solveByMprgp({.hessian = rcp(new test::DenseOperator(map, problem.a)),
                    .linearTerm = b,
                    .set = rcp(new Box(lower, upper)),
                    .operatorNorm = 1.0},
                   x, {1e-10, problem.b.norm()}, {});

  EXPECT_EQ(test::gather(*b), problem.b);
  EXPECT_EQ(test::gather(*lower), problem.lower);
  EXPECT_EQ(test::gather(*upper), problem.upper);
}

} // namespace
