#include "epafi/direct/NonNegativeLeastSquares.hpp"

#include <gtest/gtest.h>

#include <random>

namespace epafi::direct {
namespace {

Eigen::MatrixXd randomMatrix(Eigen::Index m, Eigen::Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(m, n, [&] { return normal(random); });
}

/// KKT from scratch: x ≥ 0, Aᵀ(b − Ax) ≤ 0, xᵀAᵀ(b − Ax) = 0, up to the round-off of the data's size.
void expectOptimal(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const NonNegativeSolution solution = nonNegativeLeastSquares(a, b);
  ASSERT_EQ(solution.x.size(), a.cols());
  const Eigen::VectorXd residual = b - a * solution.x, gradient = a.transpose() * residual;
  const double size = a.norm() * b.norm();
  EXPECT_LE((solution.residual - residual).norm(), 1e-13 * (b.norm() + a.norm() * solution.x.norm()));
  for (Eigen::Index j = 0; j < a.cols(); ++j) {
    EXPECT_GE(solution.x[j], 0) << j;
    EXPECT_LE(gradient[j], 1e-11 * size) << j;
    EXPECT_NEAR(solution.x[j] * gradient[j], 0, 1e-11 * size * (1 + solution.x[j])) << j;
  }
}

TEST(NonNegativeLeastSquaresTest, MeetsItsOptimalityConditionsOnRandomCases) {
  std::mt19937 random(4);
  for (const Eigen::Index m : {1, 2, 3, 6})
    for (const Eigen::Index n : {1, 2, 5, 12})
      for (int trial = 0; trial < 20; ++trial) {
        SCOPED_TRACE(testing::Message() << m << " × " << n << ", trial " << trial);
        expectOptimal(randomMatrix(m, n, random), randomMatrix(m, 1, random));
      }
}

TEST(NonNegativeLeastSquaresTest, CopesWithColumnsThatDependOnEachOther) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    SCOPED_TRACE(trial);
    const Eigen::MatrixXd low = randomMatrix(4, 2, random) * randomMatrix(2, 7, random); // rank 2
    expectOptimal(low, randomMatrix(4, 1, random));
    Eigen::MatrixXd twins(3, 6); // every column twice, the twin of another length
    twins.leftCols(3) = randomMatrix(3, 3, random);
    twins.rightCols(3) = 3.0 * twins.leftCols(3);
    expectOptimal(twins, randomMatrix(3, 1, random));
    twins.rightCols(3) = -twins.leftCols(3); // opposite columns: the cone is the whole space
    const Eigen::VectorXd b = randomMatrix(3, 1, random);
    EXPECT_LE(nonNegativeLeastSquares(twins, b).residual.norm(), 1e-10 * b.norm());
  }
}

TEST(NonNegativeLeastSquaresTest, LeavesZeroColumnsAlone) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 4);
  a.col(2) << 1, 2, 2;
  const Eigen::Vector3d b(2, 4, 4);
  const NonNegativeSolution solution = nonNegativeLeastSquares(a, b);
  EXPECT_LE((solution.x - Eigen::Vector4d(0, 0, 2, 0)).norm(), 1e-14);
  expectOptimal(Eigen::MatrixXd::Zero(3, 2), b);
  EXPECT_EQ(nonNegativeLeastSquares(Eigen::MatrixXd::Zero(3, 2), b).residual, b);
}

TEST(NonNegativeLeastSquaresTest, WithoutColumnsAllIsResidual) {
  const Eigen::Vector2d b(1, -1);
  EXPECT_EQ(nonNegativeLeastSquares(Eigen::MatrixXd(2, 0), b).residual, b);
}

TEST(NonNegativeLeastSquaresTest, AZeroRightSideHasTheZeroSolution) {
  std::mt19937 random(6);
  const NonNegativeSolution solution =
      nonNegativeLeastSquares(randomMatrix(3, 5, random), Eigen::VectorXd::Zero(3));
  EXPECT_EQ(solution.x.norm(), 0);
  EXPECT_EQ(solution.residual.norm(), 0);
}

TEST(NonNegativeLeastSquaresTest, ReachesEveryPointOfTheCone) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Eigen::MatrixXd a = randomMatrix(4, 6, random);
    const Eigen::VectorXd b = a * randomMatrix(6, 1, random).cwiseAbs();
    EXPECT_LE(nonNegativeLeastSquares(a, b).residual.norm(), 1e-12 * a.norm() * b.norm()) << trial;
  }
}

TEST(NonNegativeLeastSquaresTest, TheResidualSeparatesAPointOutsideFromTheCone) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::MatrixXd a = randomMatrix(3, 5, random);
    a.row(0) = a.row(0).cwiseAbs(); // a cone in the half-space of the first axis
    Eigen::VectorXd b = randomMatrix(3, 1, random);
    b[0] = -1 - std::abs(b[0]);
    const Eigen::VectorXd r = nonNegativeLeastSquares(a, b).residual;
    EXPECT_GE(r.dot(b), 0.99 * r.squaredNorm()) << trial; // b on one side
    EXPECT_GE(r.norm(), 1) << trial;
    EXPECT_LE((a.transpose() * r).maxCoeff(), 1e-12 * a.norm() * b.norm()) << trial; // the cone on the other
  }
}

TEST(NonNegativeLeastSquaresTest, DoesNotDependOnUnits) {
  std::mt19937 random(9);
  const Eigen::MatrixXd a = randomMatrix(3, 6, random);
  const Eigen::VectorXd b = randomMatrix(3, 1, random), x = nonNegativeLeastSquares(a, b).x;
  for (const double scale : {1e-9, 1e9}) {
    EXPECT_LE((nonNegativeLeastSquares(a, scale * b).x / scale - x).norm(), 1e-12 * x.norm());
    EXPECT_LE((nonNegativeLeastSquares(scale * a, b).x * scale - x).norm(), 1e-12 * x.norm());
  }
}

TEST(NonNegativeLeastSquaresTest, DecidesOnThousandsOfColumns) {
  // Normals at the nodes of three flat faces: whether a resultant lies in their cone is known.
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-1, 1);
  Eigen::MatrixXd faces(18, 9000);
  faces.setZero();
  for (Eigen::Index j = 0; j < faces.cols();
       ++j) { // (force, moment) of a unit force along z at (x, y), on one of 3 bodies
    const double x = place(random), y = place(random);
    faces.col(j).segment(6 * (j % 3), 6) << 0, 0, 1, y, -x, 0;
  }
  Eigen::VectorXd inside(18), outside(18);
  for (Eigen::Index body = 0; body < 3; ++body) {
    inside.segment(6 * body, 6) << 0, 0, 2, 0.5, -1.5, 0;
    outside.segment(6 * body, 6) << 0, 0, 2, 0.5, body == 2 ? -2.1 : 0.0, 0; // beside the face at x = 1
  }
  expectOptimal(faces, inside);
  EXPECT_LE(nonNegativeLeastSquares(faces, inside).residual.norm(), 1e-12);
  expectOptimal(faces, outside);
  const Eigen::VectorXd residual = nonNegativeLeastSquares(faces, outside).residual;
  EXPECT_LE(residual.head(12).norm(), 1e-12);
  EXPECT_GT(residual.tail(6).norm(), 0.01);
}

} // namespace
} // namespace epafi::direct
