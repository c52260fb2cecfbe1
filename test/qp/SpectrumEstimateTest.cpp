#include "support/Problems.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/qp/operators/SpectrumEstimate.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using qp::estimateSpectrum;
using qp::SpectrumEstimate;

/// Eigenvalues of MA, both SPD, ascending.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& a, const Eigen::MatrixXd& m) {
  const Eigen::MatrixXd lower = direct::choleskyFactor(m).value();
  return direct::eigenOf(lower.transpose() * a * lower).values;
}

TEST(SpectrumEstimateTest, FindsTheEndsOfTheSpectrumOfRandomPairs) {
  std::mt19937 random(1);
  for (const int n : {1, 2, 5, 20, 60})
    for (const double condition : {1.0, 10.0, 1e3}) {
      SCOPED_TRACE(testing::Message() << "n = " << n << ", condition " << condition);
      const auto map = test::linearMap(n);
      const Eigen::MatrixXd matrix = 7 * test::randomSpd(n, condition, random),
                            preconditioner = test::randomSpd(n, condition, random);
      const test::DenseOperator a(map, matrix);
      const auto m = rcp(new test::DenseOperator(map, preconditioner));
      const Eigen::VectorXd exact = eigenvalues(matrix, preconditioner);

      const SpectrumEstimate estimate = estimateSpectrum(a, m);

      EXPECT_NEAR(estimate.largest, exact[n - 1], 0.01 * exact[n - 1]);
      EXPECT_NEAR(estimate.smallest, exact[0], 0.01 * exact[0]);
      EXPECT_NEAR(estimate.condition(), exact[n - 1] / exact[0], 0.02 * exact[n - 1] / exact[0]);
      EXPECT_EQ(estimate.multiplications, a.applications);
    }
}

TEST(SpectrumEstimateTest, ItsBoundsHoldAnEigenvalueEach) {
  std::mt19937 random(2);
  const auto map = test::linearMap(40);
  const Eigen::MatrixXd matrix = test::randomSpd(40, 1e4, random);
  const Eigen::VectorXd exact = eigenvalues(matrix, Eigen::MatrixXd::Identity(40, 40));
  for (const int steps : {3, 6, 12, 25}) {
    const SpectrumEstimate estimate =
        estimateSpectrum(test::DenseOperator(map, matrix), Teuchos::null, {steps, 1e-14});
    EXPECT_LE(estimate.multiplications, steps);
    EXPECT_LE((exact.array() - estimate.largest).abs().minCoeff(), estimate.largestError + 1e-12);
    EXPECT_LE((exact.array() - estimate.smallest).abs().minCoeff(), estimate.smallestError + 1e-12);
    EXPECT_LE(estimate.largest, exact[39] * (1 + 1e-10)); // from within
    EXPECT_GE(estimate.smallest, exact[0] * (1 - 1e-6));
  }
}

TEST(SpectrumEstimateTest, DoesNotSeeTheKernel) {
  std::mt19937 random(3);
  const auto map = test::linearMap(30);
  Eigen::MatrixXd matrix = test::randomSpd(30, 20, random);
  const Eigen::VectorXd kernel = Eigen::VectorXd::LinSpaced(30, -1, 2).normalized();
  const Eigen::MatrixXd projector = Eigen::MatrixXd::Identity(30, 30) - kernel * kernel.transpose();
  matrix = (projector * matrix * projector).eval();
  const Eigen::VectorXd exact = eigenvalues(matrix, Eigen::MatrixXd::Identity(30, 30)); // 0 comes first

  const SpectrumEstimate estimate = estimateSpectrum(test::DenseOperator(map, matrix), Teuchos::null);

  EXPECT_NEAR(estimate.smallest, exact[1], 0.01 * exact[1]);
  EXPECT_NEAR(estimate.largest, exact[29], 0.01 * exact[29]);
}

TEST(SpectrumEstimateTest, OfTheZeroOperatorIsNothing) {
  const SpectrumEstimate estimate =
      estimateSpectrum(test::DenseOperator(test::linearMap(4), Eigen::MatrixXd::Zero(4, 4)), Teuchos::null);
  EXPECT_EQ(estimate.largest, 0);
  EXPECT_EQ(estimate.condition(), 1);
}

TEST(SpectrumEstimateTest, RefusesWhatIsNotFiniteAndAPreconditionerThatIsNotPositive) {
  const auto map = test::linearMap(4);
  const test::DenseOperator identity(map, Eigen::MatrixXd::Identity(4, 4));
  EXPECT_THROW(estimateSpectrum(test::DenseOperator(map, Eigen::MatrixXd::Constant(4, 4, std::nan(""))),
                                Teuchos::null),
               Error);
  EXPECT_THROW(
      estimateSpectrum(identity, rcp(new test::DenseOperator(map, -Eigen::MatrixXd::Identity(4, 4)))), Error);
}

} // namespace
