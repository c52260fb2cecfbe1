#include "support/Refusal.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/direct/SpdFactor.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <numeric>

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

/// 9-point stencil on an n × n grid, SPD; ordering it is worth while.
SparseMatrix plate(int n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di)
          if (i + di >= 0 && i + di < n && j + dj >= 0 && j + dj < n)
            entries.emplace_back(i + j * n, i + di + (j + dj) * n,
                                 di == 0 && dj == 0 ? 8.5 + 0.01 * i : -1.0);
  SparseMatrix matrix(n * n, n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Nodes on the border of the plate, in no particular order.
std::vector<int> borderOf(int n) {
  std::vector<int> border;
  for (int k = n - 1; k >= 0; --k)
    for (int l = 0; l < n; ++l)
      if (k == 0 || l == 0 || k == n - 1 || l == n - 1)
        border.push_back(l * n + k);
  return border;
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

TEST_P(SpdFactorTest, CondensesToTheKeptUnknownsInTheOrderGiven) {
  for (const int n : {1, 3, 9, 40}) { // CHOLMOD: simplicial, then supernodal
    const SparseMatrix a = plate(n);
    const std::vector<int> kept = borderOf(n);
    direct::Factorizer factorizer(GetParam());
    const auto factor = factorizer.factorize(a, kept, "a test");

    const Eigen::MatrixXd inverse = factor->inverseOfKept(), schur = factor->schurComplement();

    const Eigen::MatrixXd whole = Eigen::MatrixXd(a).inverse();
    const Eigen::MatrixXd expected = whole(kept, kept);
    EXPECT_LE((inverse - expected).norm(), 1e-12 * expected.norm()) << n;
    EXPECT_LE((schur * expected - Eigen::MatrixXd::Identity(expected.rows(), expected.cols())).norm(), 1e-11)
        << n;
    EXPECT_EQ((inverse - inverse.transpose()).norm(), 0) << n;
    EXPECT_EQ((schur - schur.transpose()).norm(), 0) << n;

    Eigen::VectorXd x = Eigen::VectorXd::Random(expected.rows()), y(x.size());
    factor->solveKept(x, y);
    EXPECT_LE((y - inverse * x).norm(), 1e-12 * x.norm()) << n;
    factor->multiplyKept(y, y);
    EXPECT_LE((y - x).norm(), 1e-12 * x.norm()) << n;
  }
}

TEST_P(SpdFactorTest, SolvesWithUnknownsKept) {
  const SparseMatrix a = plate(12);
  direct::Factorizer factorizer(GetParam());
  const auto factor = factorizer.factorize(a, borderOf(12), "a test");
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(144, 3);
  Eigen::MatrixXd x(144, 3);

  factor->solve(b, x);

  EXPECT_LE((a * x - b).norm(), 1e-12 * b.norm());
}

TEST_P(SpdFactorTest, KeepsUnknownsThatShareASupernodeWithOthers) {
  const SparseMatrix a = plate(30);
  for (const int number : {1, 7, 300}) {
    std::vector<int> kept(number);
    std::iota(kept.begin(), kept.end(), 440);
    direct::Factorizer factorizer(GetParam());
    const auto factor = factorizer.factorize(a, kept, "a test");
    const Eigen::VectorXd b = Eigen::VectorXd::Random(number);
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(900, 1), expected(900, 1);
    whole(kept, 0) = b;
    factor->solve(whole, expected);
    Eigen::VectorXd x(number), y(number);

    factor->solveKept(b, x);
    factor->multiplyKept(x, y);

    EXPECT_LE((x - expected(kept, 0)).norm(), 1e-12 * b.norm()) << number;
    EXPECT_LE((y - b).norm(), 1e-12 * b.norm()) << number;
    EXPECT_LE(factor->numKeptEntries(), factor->numEntries());
  }
}

TEST_P(SpdFactorTest, KeepsAllOrNothing) {
  const SparseMatrix a = plate(4);
  std::vector<int> all(16);
  std::iota(all.begin(), all.end(), 0);
  direct::Factorizer factorizer(GetParam());

  EXPECT_LE((factorizer.factorize(a, all, "a test")->schurComplement() - Eigen::MatrixXd(a)).norm(), 1e-12);
  EXPECT_EQ(factorizer.factorize(a, {}, "a test")->schurComplement().size(), 0);
}

INSTANTIATE_TEST_SUITE_P(AllSolvers, SpdFactorTest, testing::ValuesIn(direct::availableSolvers()),
                         [](const auto& solver) { return solver.param; });

TEST(CholmodFactor, AnalysesAPatternOnce) {
  direct::Factorizer factorizer("CHOLMOD");
  const SparseMatrix a = plate(5);
  const auto first = factorizer.factorize(a, borderOf(5), "a test");
  const auto second = factorizer.factorize(2.0 * a, borderOf(5), "a test");
  EXPECT_EQ(factorizer.numSymbolic(), 1);
  EXPECT_LE((second->schurComplement() - 2 * first->schurComplement()).norm(), 1e-12);

  factorizer.factorize(a, {0, 3}, "a test");
  factorizer.factorize(plate(6), {0, 3}, "a test");
  EXPECT_EQ(factorizer.numSymbolic(), 3);
  factorizer.factorize(a, {3, 0}, "a test"); // another order of the kept is another pattern
  EXPECT_EQ(factorizer.numSymbolic(), 4);
}

TEST(CholmodFactor, NamesAMatrixThatIsNotPositiveDefinite) {
  SparseMatrix a = laplacian(5);
  a.coeffRef(2, 2) = -1;
  try {
    direct::factorize(a, "CHOLMOD", "subdomain 7");
    FAIL() << "no error was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("subdomain 7"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("not positive definite"), std::string::npos);
  }
}

TEST(SpdFactorNames, RefusesAnUnknownSolverAndListsTheKnownOnes) {
  test::expectSays(test::refusal([] { direct::factorize(laplacian(3), "Magic", "a test"); }),
                   {"Magic", "KLU2"});
}

TEST(SpdFactorNames, NeverOffersTacho) {
  for (const std::string& name : direct::availableSolvers())
    EXPECT_NE(name, "Tacho");
}

} // namespace
