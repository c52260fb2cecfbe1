#include "epafi/direct/SymmetricBlock.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include "epafi/base/Errors.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace {

using namespace epafi;
using direct::SymmetricBlock;

Eigen::MatrixXd symmetric(int k) {
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(k, k);
  return random * random.transpose() + Eigen::MatrixXd::Identity(k, k);
}

TEST(SymmetricBlockTest, MultipliesByAnyNumberOfColumnsInEveryStorage) {
  for (const int k : {0, 1, 5, 64, 131})
    for (const int columns : {0, 1, 2, 9}) {
      const Eigen::MatrixXd a = symmetric(k), x = Eigen::MatrixXd::Random(k, columns);
      for (const auto storage : {SymmetricBlock::Storage::full, SymmetricBlock::Storage::packed,
                                 SymmetricBlock::Storage::single}) {
        const SymmetricBlock block(a, storage);
        Eigen::MatrixXd y(k, columns);

        block.apply(x, y);

        const double accuracy = storage == SymmetricBlock::Storage::single ? 1e-6 : 1e-14;
        EXPECT_LE((y - a * x).norm(), accuracy * (1 + a.norm() * x.norm())) << k << " × " << columns;
      }
    }
}

TEST(SymmetricBlockTest, CountsWhatItReads) {
  const Eigen::MatrixXd a = symmetric(10);
  EXPECT_EQ(SymmetricBlock(a, SymmetricBlock::Storage::full).bytes(), 800U);
  EXPECT_EQ(SymmetricBlock(a, SymmetricBlock::Storage::packed).bytes(), 440U);
  EXPECT_EQ(SymmetricBlock(a, SymmetricBlock::Storage::single).bytes(), 400U);
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

} // namespace
