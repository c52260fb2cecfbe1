#include "support/Problems.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/operators/NormEstimate.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using qp::NormEstimateParameters;

class NormEstimateTest : public testing::Test {
protected:
  NormEstimateParameters parameters() const {
    NormEstimateParameters result;
    result.maxIterations = 200;
    return result;
  }
};

TEST_F(NormEstimateTest, IsSafeAndCloseOnRandomMatrices) {
  std::mt19937 random(1);
  for (const int n : {1, 2, 5, 20, 60})
    for (const double condition : {1.0, 10.0, 1e4}) {
      const auto map = test::linearMap(n);
      const test::DenseOperator a(map, test::randomSpd(n, condition, random)); // norm 1

      const qp::NormEstimate estimate = qp::estimateNorm(a, parameters());

      EXPECT_GE(estimate.norm, 1.0 - 1e-12) << "n = " << n << ", condition " << condition;
      EXPECT_LE(estimate.norm, 1.1) << "n = " << n << ", condition " << condition;
      EXPECT_LE(estimate.lowerBound, 1.0 + 1e-12);
      EXPECT_EQ(estimate.multiplications, a.applications);
    }
}

TEST_F(NormEstimateTest, ScalesWithTheOperator) {
  std::mt19937 random(2);
  const Eigen::MatrixXd matrix = test::randomSpd(15, 100, random);
  const auto map = test::linearMap(15);
  const double unit = qp::estimateNorm(test::DenseOperator(map, matrix), parameters()).norm;

  for (const double factor : {1e-9, 1e9})
    EXPECT_NEAR(qp::estimateNorm(test::DenseOperator(map, factor * matrix), parameters()).norm / factor, unit,
                1e-10);
}

TEST_F(NormEstimateTest, IsZeroForTheZeroOperator) {
  const auto map = test::linearMap(4);

  EXPECT_EQ(qp::estimateNorm(test::DenseOperator(map, Eigen::MatrixXd::Zero(4, 4)), parameters()).norm, 0);
}

TEST_F(NormEstimateTest, ThrowsWhenTheOperatorReturnsNan) {
  const auto map = test::linearMap(4);
  const test::DenseOperator a(map, Eigen::MatrixXd::Constant(4, 4, std::nan("")));

  EXPECT_THROW(qp::estimateNorm(a, parameters()), Error);
}

} // namespace
