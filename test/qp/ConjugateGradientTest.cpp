#include "support/Problems.hpp"

#include "epafi/qp/solve/ConjugateGradient.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using qp::Status;

qp::SolveReport solveDense(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                           double tolerance, int limit = 1000) {
  const auto map = test::linearMap(static_cast<int>(b.size()));
  const RCP<Vector> solution = test::makeVector(map, x);
  auto report = qp::solveUnconstrained(rcp(new test::DenseOperator(map, a)), test::makeVector(map, b),
                                       solution, tolerance, limit);
  x = test::gather(*solution);
  return report;
}

TEST(ConjugateGradientTest, SolvesToTheToleranceAndCertifiesIt) {
  std::mt19937 random(1);
  const Eigen::MatrixXd a = test::randomSpd(30, 100, random);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(30, 1, 2);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(30);

  const auto report = solveDense(a, b, x, 1e-9);

  EXPECT_EQ(report.status, Status::converged);
  EXPECT_LE((a * x - b).norm(), 1e-9 * b.norm());
  EXPECT_NEAR(report.relativeProjectedGradient, (a * x - b).norm() / b.norm(), 1e-13);
  EXPECT_NEAR(report.objective, -0.5 * b.dot(x), 1e-6 * std::abs(b.dot(x)));
  EXPECT_EQ(static_cast<int>(report.history.size()), report.counts.conjugateGradient + 1);
}

TEST(ConjugateGradientTest, AnswersAZeroRightHandSideWithZero) {
  Eigen::VectorXd x = Eigen::VectorXd::Ones(5);

  const auto report = solveDense(Eigen::MatrixXd::Identity(5, 5), Eigen::VectorXd::Zero(5), x, 1e-9);

  EXPECT_EQ(report.status, Status::converged);
  EXPECT_EQ(x.norm(), 0);
}

TEST(ConjugateGradientTest, SaysThatTheLimitWasReached) {
  std::mt19937 random(2);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(40);

  const auto report = solveDense(test::randomSpd(40, 1e8, random), Eigen::VectorXd::Ones(40), x, 1e-12, 3);

  EXPECT_EQ(report.status, Status::maxIterations);
  EXPECT_EQ(report.counts.conjugateGradient, 3);
}

TEST(ConjugateGradientTest, NamesAnIndefiniteOperator) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);

  EXPECT_EQ(solveDense(-Eigen::Matrix3d::Identity(), Eigen::Vector3d(1, 2, 3), x, 1e-9).status,
            Status::indefiniteOperator);
}

TEST(ConjugateGradientTest, KeepsTheStartWhenTheOperatorReturnsNan) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);

  EXPECT_EQ(solveDense(Eigen::Matrix3d::Constant(std::nan("")), Eigen::Vector3d(1, 2, 3), x, 1e-9).status,
            Status::notFinite);
  EXPECT_TRUE(x.allFinite());
}

} // namespace
