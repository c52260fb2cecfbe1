#include "epafi/direct/SymmetricBlock.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace epafi;
using direct::SymmetricBlock;

Eigen::MatrixXd symmetric(int k) {
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(k, k);
  return random * random.transpose() + Eigen::MatrixXd::Identity(k, k);
}

using Use = SymmetricBlock::Use;
using Precision = SymmetricBlock::Precision;

TEST(SymmetricBlockTest, MultipliesByAnyNumberOfColumnsHoweverItIsStored) {
  for (const int k : {0, 1, 5, 64, 131})
    for (const int columns : {0, 1, 2, 9})
      for (const auto use : {Use::alone, Use::shared})
        for (const auto precision : {Precision::full, Precision::single}) {
          const Eigen::MatrixXd a = symmetric(k), x = Eigen::MatrixXd::Random(k, columns);
          const SymmetricBlock block(a, use, precision);
          Eigen::MatrixXd y(k, columns);

          block.apply(x, y);

          const double accuracy = precision == Precision::single ? 1e-6 : 1e-14;
          EXPECT_LE((y - a * x).norm(), accuracy * (1 + a.norm() * x.norm())) << k << " × " << columns;
        }
}

TEST(SymmetricBlockTest, AColumnDoesNotDependOnHowManyThereAre) {
  for (const int k : {7, 28, 60, 124, 252, 400})
    for (const auto use : {Use::alone, Use::shared}) {
      const SymmetricBlock block(symmetric(k), use);
      const Eigen::MatrixXd x = Eigen::MatrixXd::Random(k, 1);
      Eigen::MatrixXd alone(k, 1);
      block.apply(x, alone);
      for (const int columns : {2, 3, 8, 17, 40, 90, 300}) {
        Eigen::MatrixXd y(k, columns);
        block.apply(x.replicate(1, columns), y);
        EXPECT_EQ((y.colwise() - alone.col(0)).norm(), 0) << k << " × " << columns;
      }
    }
}

TEST(SymmetricBlockTest, GivesItsMatrixBackAndNothingForNothing) {
  for (const int k : {0, 7, 60, 124})
    for (const auto use : {Use::alone, Use::shared}) {
      const Eigen::MatrixXd a = symmetric(k), zero = Eigen::MatrixXd::Zero(k, 3);
      const SymmetricBlock block(a, use);
      EXPECT_EQ((block.matrix() - a).norm(), 0) << k;
      EXPECT_LE((SymmetricBlock(a, use, Precision::single).matrix() - a).norm(), 1e-6 * a.norm()) << k;
      Eigen::MatrixXd y = Eigen::MatrixXd::Ones(k, 3);
      block.apply(zero, y);
      EXPECT_EQ(y, zero) << k;
    }
}

TEST(SymmetricBlockTest, CountsWhatItReads) {
  const Eigen::MatrixXd small = symmetric(10), large = symmetric(100);
  EXPECT_EQ(SymmetricBlock(small, Use::alone).bytes(), 800U);
  EXPECT_EQ(SymmetricBlock(small, Use::alone, Precision::single).bytes(), 400U);
  EXPECT_EQ(SymmetricBlock(large, Use::alone).bytes(), 8U * 5050U);
  EXPECT_EQ(SymmetricBlock(large, Use::shared).bytes(), 80000U);
}

TEST(DenseSymmetricTest, InvertsAndMultipliesFactors) {
  for (const int k : {0, 1, 2, 33}) {
    const Eigen::MatrixXd a = symmetric(k);
    const Eigen::MatrixXd lower = a.llt().matrixL();

    EXPECT_LE((direct::productOfFactor(lower) - a).norm(), 1e-13 * (1 + a.norm()));
    EXPECT_LE((direct::inverseFromFactor(lower) - a.inverse()).norm(), 1e-12 * (1 + a.inverse().norm()));
    EXPECT_LE((direct::inverseOfSpd(a) * a - Eigen::MatrixXd::Identity(k, k)).norm(), 1e-10);
  }
}

TEST(DenseSymmetricTest, RefusesWhatIsNotPositiveDefinite) {
  EXPECT_THROW(direct::inverseOfSpd(Eigen::Matrix2d{{1, 2}, {2, 1}}), Error);
  EXPECT_THROW(direct::inverseFromFactor(Eigen::Matrix2d{{1, 0}, {2, 0}}), Error);
}

TEST(SymmetricEigenTest, VectorsDiagonalise) {
  for (const int k : {0, 1, 2, 40, 150}) {
    const Eigen::MatrixXd a = symmetric(k);
    const direct::SymmetricEigen eigen = direct::eigenOf(a);
    ASSERT_EQ(eigen.values.size(), k);
    EXPECT_LE((eigen.vectors.transpose() * eigen.vectors - Eigen::MatrixXd::Identity(k, k)).norm(),
              1e-12 * (1 + k));
    EXPECT_LE((a * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), 1e-12 * (1 + a.norm()));
    EXPECT_TRUE(std::is_sorted(eigen.values.begin(), eigen.values.end()));
  }
  EXPECT_THROW(direct::eigenOf(Eigen::MatrixXd::Constant(3, 3, std::nan(""))), Error);
}

} // namespace
