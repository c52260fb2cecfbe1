#include "support/Problems.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/qp/constraints/MatrixEquality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

/// Any rows made ready for SMALBE: orthonormal ones up to a number, scaled ones beyond.
namespace {

using namespace epafi;
using namespace epafi::test;
using qp::PreparedEquality;

constexpr int noDenseRows = 0, denseRows = 300;

PreparedEquality prepare(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values, int maxDenseRows) {
  const RCP<const Map> domain = linearMap(static_cast<int>(rows.cols())),
                       range = linearMap(static_cast<int>(rows.rows()));
  const RCP<const Vector> c = values.size() > 0 ? makeVector(range, values) : RCP<Vector>();
  return qp::prepareEquality(rcp(new DenseRows(domain, range, rows)), c, maxDenseRows, {});
}

Eigen::MatrixXd noise(int m, int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(m, n, [&] { return normal(random); });
}

/// The rows that the constraint stands for, by products with unit vectors on every rank.
Eigen::MatrixXd rowsOf(const PreparedEquality& prepared, int n) {
  const Eigen::Index k = prepared.constraint->numEntries();
  Eigen::MatrixXd result(k, n);
  std::vector<double> column(k);
  for (int j = 0; j < n; ++j) {
    prepared.constraint->product(*makeVector(linearMap(n), [j](int i) { return i == j ? 1.0 : 0.0; }),
                                 column);
    result.col(j) = Eigen::Map<const Eigen::VectorXd>(column.data(), k);
  }
  return result;
}

/// ‖WBx − Wc‖ from the two halves around the sum over the ranks.
double residualOf(const PreparedEquality& prepared, const Vector& x) {
  std::vector<AccurateSum> sums(prepared.constraint->numSums());
  prepared.constraint->addLocalSums(x, sums);
  sumOverRanks(*x.getMap()->getComm(), sums);
  std::vector<double> r(prepared.constraint->numEntries()), weighed(r.size());
  return prepared.constraint->finishResidual(sums, r, weighed);
}

void expectOrthonormal(const PreparedEquality& prepared, int n, double tolerance) {
  const Eigen::MatrixXd rows = rowsOf(prepared, n);
  EXPECT_LE((rows * rows.transpose() - Eigen::MatrixXd::Identity(rows.rows(), rows.rows())).norm(),
            tolerance);
}

TEST(MatrixEqualityTest, RowsOfFullRankBecomeOrthonormal) {
  for (const int m : {1, 2, 5, 17, 40}) { // 17: more than a block of columns of the Gram matrix
    const Eigen::MatrixXd b = noise(m, 45, 1);

    const PreparedEquality prepared = prepare(b, Eigen::VectorXd::Ones(m), denseRows);

    ASSERT_TRUE(prepared.constraint->isReplicated());
    EXPECT_EQ(prepared.rank, m);
    EXPECT_EQ(prepared.numRows, m);
    EXPECT_NEAR(prepared.norm, b.norm(), 1e-12 * b.norm());
    EXPECT_EQ(prepared.contradiction, "");
    expectOrthonormal(prepared, 45, 1e-10);
  }
}

TEST(MatrixEqualityTest, RowsOfAnyLengthBecomeOrthonormal) {
  Eigen::MatrixXd b = noise(4, 12, 2);
  b.row(0) *= 1e-12;
  b.row(2) *= 1e12;

  const PreparedEquality prepared = prepare(b, {}, denseRows);

  EXPECT_EQ(prepared.rank, 4);
  expectOrthonormal(prepared, 12, 1e-12);
}

TEST(MatrixEqualityTest, RowsThatAreNearlyTheSameBecomeOrthonormalAsFarAsTheyAreTwo) {
  for (const double angle : {1e-2, 1e-4, 1e-6}) {
    Eigen::MatrixXd b = noise(3, 10, 3);
    b.row(1) = b.row(0) + angle * b.row(0).norm() * b.row(1).normalized();

    const PreparedEquality prepared = prepare(b, {}, denseRows);

    EXPECT_EQ(prepared.rank, 3) << angle;
    expectOrthonormal(prepared, 10,
                      1e-14 / (angle * angle)); // round-off of the Gram matrix beside its eigenvalue
  }
}

TEST(MatrixEqualityTest, RedundantRowsAreFound) {
  const Eigen::MatrixXd b = noise(3, 10, 5);
  Eigen::MatrixXd rows(8, 10);
  rows << b, b.row(1), -2e6 * b.row(2), b.row(0) + b.row(1), Eigen::MatrixXd::Zero(1, 10), 1e-9 * b.row(0);
  const Eigen::VectorXd x = noise(10, 1, 6);

  const PreparedEquality prepared = prepare(rows, rows * x, denseRows);

  EXPECT_EQ(prepared.rank, 3);
  EXPECT_EQ(prepared.contradiction, "");
  EXPECT_EQ(prepared.constraint->numEntries(), 3);
  expectOrthonormal(prepared, 10, 1e-9);
  EXPECT_LE(residualOf(prepared, *makeVector(linearMap(10), x)), 1e-7)
      << "what holds the rows holds the constraint";
}

TEST(MatrixEqualityTest, TheConstraintHoldsWhereTheRowsHoldAndNowhereElse) {
  const Eigen::MatrixXd b = noise(4, 9, 7);
  const Eigen::VectorXd x = noise(9, 1, 8), off = noise(9, 1, 9);
  for (const int path : {denseRows, noDenseRows}) {
    const PreparedEquality prepared = prepare(b, b * x, path);

    EXPECT_LE(residualOf(prepared, *makeVector(linearMap(9), x)), 1e-13);
    EXPECT_GT(residualOf(prepared, *makeVector(linearMap(9), off)), 1e-2);
  }
}

TEST(MatrixEqualityTest, TheTransposedProductIsTheTransposeAndGivesTheMultiplierOfTheRows) {
  const Eigen::MatrixXd b = noise(4, 9, 11);
  for (const int path : {denseRows, noDenseRows}) {
    const PreparedEquality prepared = prepare(b, b * noise(9, 1, 12), path);
    std::vector<double> mu(prepared.constraint->numEntries());
    for (std::size_t i = 0; i < mu.size(); ++i)
      mu[i] = 1.0 + static_cast<double>(i);
    Vector y(linearMap(9));
    y.putScalar(1);
    const RCP<Vector> probe = makeVector(linearMap(9), Eigen::VectorXd(noise(9, 1, 13)));
    std::vector<double> image(mu.size());

    prepared.constraint->addTransposedProduct(mu, 0.5, y);
    prepared.constraint->product(*probe, image);

    const Eigen::VectorXd transposed = 2 * (gather(y) - Eigen::VectorXd::Ones(9));
    EXPECT_NEAR(prepared.constraint->dot(mu, image), transposed.dot(gather(*probe)), 1e-11)
        << "μᵀ(Bx) = (Bᵀμ)ᵀx";
    const Eigen::VectorXd ofRows = gather(*prepared.multiplierOfRows(mu));
    EXPECT_LE((b.transpose() * ofRows - transposed).norm(), 1e-11) << "Bᵀμ in the rows given";
  }
}

TEST(MatrixEqualityTest, BeyondTheLimitRowsAreDividedByTheNorm) {
  const Eigen::MatrixXd b = 1e5 * noise(6, 9, 14);

  const PreparedEquality prepared = prepare(b, {}, 5);

  EXPECT_FALSE(prepared.constraint->isReplicated());
  EXPECT_TRUE(prepared.constraint->isHomogeneous());
  EXPECT_EQ(prepared.rank, 6);
  const double norm = direct::rightSingularOf(b).values[0];
  EXPECT_GE(prepared.norm, (1 - 1e-12) * norm);
  EXPECT_LE(prepared.norm, 1.1 * norm);
  const RCP<Vector> x = makeVector(linearMap(9), Eigen::VectorXd(noise(9, 1, 15)));
  EXPECT_NEAR(residualOf(prepared, *x), (b * gather(*x)).norm() / prepared.norm, 1e-13);
}

TEST(MatrixEqualityTest, ContradictingRowsComeWithACertificate) {
  const Eigen::MatrixXd b = noise(3, 10, 16);
  Eigen::MatrixXd rows(5, 10);
  rows << b, 1e6 * (b.row(0) - b.row(2)), b.row(1);
  const Eigen::VectorXd x = noise(10, 1, 17);
  for (const int wrong : {0, 1, 3, 4})
    for (const double share : {1e-6, 1.0}) {
      Eigen::VectorXd c = rows * x;
      c[wrong] += share * rows.row(wrong).norm();

      const PreparedEquality prepared = prepare(rows, c, denseRows);

      EXPECT_NE(prepared.contradiction, "") << wrong << ", " << share;
      ASSERT_FALSE(prepared.certificate.is_null());
      const Eigen::VectorXd y = gather(*prepared.certificate);
      EXPECT_NEAR(y.norm(), 1, 1e-12);
      double size = 0;
      for (Eigen::Index i = 0; i < 5; ++i)
        size += std::abs(y[i]) * rows.row(i).norm();
      EXPECT_LE((rows.transpose() * y).norm(), 1e-12 * size) << "Bᵀy = 0";
      EXPECT_LT(y.dot(c), -0.1 * share * size / 5) << "yᵀc < 0";
    }
}

TEST(MatrixEqualityTest, RoundOffInRedundantRowsIsNoContradiction) {
  const Eigen::MatrixXd b = noise(4, 10, 18);
  const Eigen::VectorXd x = noise(10, 1, 19);
  for (const double error : {1e-16, 1e-13, 1e-11}) {
    Eigen::MatrixXd rows(5, 10);
    rows << b, b.row(0) / 3 + b.row(1) / 7;
    Eigen::VectorXd c = rows * x;
    c[4] *= 1 + error;

    EXPECT_EQ(prepare(rows, c, denseRows).contradiction, "") << error;
  }
}

TEST(MatrixEqualityTest, NoRowsAndRowsOfZerosAreNoConstraint) {
  EXPECT_TRUE(prepare(Eigen::MatrixXd(0, 5), {}, denseRows).constraint.is_null());
  for (const int path : {denseRows, noDenseRows}) {
    const PreparedEquality prepared = prepare(Eigen::MatrixXd::Zero(3, 5), {}, path);
    EXPECT_TRUE(prepared.constraint.is_null());
    EXPECT_EQ(prepared.contradiction, "");
    EXPECT_EQ(prepared.rank, 0);
  }
}

TEST(MatrixEqualityTest, MoreRowsThanUnknownsAreRedundant) {
  const Eigen::MatrixXd b = noise(12, 5, 20);
  const Eigen::VectorXd x = noise(5, 1, 21);

  const PreparedEquality prepared = prepare(b, b * x, denseRows);

  EXPECT_EQ(prepared.rank, 5);
  EXPECT_EQ(prepared.contradiction, "");
  expectOrthonormal(prepared, 5, 1e-9);
}

TEST(MatrixEqualityTest, RightHandSidesOnAnotherMapAreRefused) {
  const RCP<const Map> domain = linearMap(6), range = linearMap(2);
  const RCP<const Operator> rows = rcp(new DenseRows(domain, range, Eigen::MatrixXd::Ones(2, 6)));

  EXPECT_THROW(qp::prepareEquality(rows, rcp(new Vector(domain)), denseRows, {}), InputError);
}

} // namespace
