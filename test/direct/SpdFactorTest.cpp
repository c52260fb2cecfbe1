#include "epafi/direct/SpdFactor.hpp"
#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using direct::SparseMatrix;

/// 1-D Laplacian of n unknowns, ends held; SPD.
SparseMatrix laplacian(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0);
    if (i > 0) {
      entries.emplace_back(i, i - 1, -1.0);
      entries.emplace_back(i - 1, i, -1.0);
    }
  }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

class SpdFactorTest : public testing::TestWithParam<std::string> {};

TEST_P(SpdFactorTest, SolvesAPlainSystemByHand) {
  const auto factor = direct::factorize(laplacian(3), GetParam(), "a test");
  const Eigen::MatrixXd b = Eigen::Vector3d(1, 0, 1);
  Eigen::MatrixXd x(3, 1);

  factor->solve(b, x);

  EXPECT_NEAR((x - Eigen::Vector3d(1, 1, 1)).norm(), 0, 1e-14);
}

TEST_P(SpdFactorTest, SolvesSeveralColumnsAndChangesTheirNumber) {
  const SparseMatrix a = laplacian(50);
  const auto factor = direct::factorize(a, GetParam(), "a test");
  for (const int columns : {1, 4, 0, 2}) {
    const Eigen::MatrixXd b = Eigen::MatrixXd::Random(50, columns);
    Eigen::MatrixXd x(50, columns);

    factor->solve(b, x);

    EXPECT_LE((a * x - b).norm(), 1e-11 * (1 + b.norm())) << columns << " columns";
  }
}

TEST_P(SpdFactorTest, CountsItsBytes) {
  const auto small = direct::factorize(laplacian(10), GetParam(), "a test");
  const auto large = direct::factorize(laplacian(1000), GetParam(), "a test");

  EXPECT_GE(small->bytes(), 10 * sizeof(double));
  EXPECT_GT(large->bytes(), 50 * small->bytes());
}

TEST_P(SpdFactorTest, TakesAMatrixWithoutRows) {
  const auto factor = direct::factorize(SparseMatrix(0, 0), GetParam(), "a test");
  Eigen::MatrixXd b(0, 1), x(0, 1);

  factor->solve(b, x);

  EXPECT_EQ(factor->size(), 0);
  EXPECT_EQ(factor->bytes(), 0U);
}

INSTANTIATE_TEST_SUITE_P(AllSolvers, SpdFactorTest, testing::ValuesIn(direct::availableSolvers()),
                         [](const auto& solver) { return solver.param; });

TEST(SpdFactorNames, RefusesAnUnknownSolverAndListsTheKnownOnes) {
  try {
    direct::factorize(laplacian(3), "Magic", "a test");
    FAIL() << "no error was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("Magic"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("KLU2"), std::string::npos);
  }
}

TEST(SpdFactorNames, NeverOffersTacho) {
  for (const std::string& name : direct::availableSolvers())
    EXPECT_NE(name, "Tacho");
}

} // namespace
