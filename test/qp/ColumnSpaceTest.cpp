#include "epafi/qp/operators/DeflatedOperator.hpp"

#include "support/Problems.hpp"

#include "epafi/base/Maps.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace epafi;

constexpr int n = 12, k = 3;

class ColumnSpaceTest : public testing::Test {
protected:
  ColumnSpaceTest() {
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < n; ++i)
        dense(i, j) = (i * (j + 2)) % 5 == 0 ? 0.0 : std::sin(1.0 + i * (j + 1));
    for (int i = 0; i < n; ++i) {
      matrix(i, i) = 2.5;
      if (i > 0)
        matrix(i, i - 1) = matrix(i - 1, i) = -1;
    }
    gram = dense.transpose() * matrix * dense;
    a = rcp(new test::DenseOperator(map, matrix));
    for (int j = 0; j < k; ++j)
      for (int i = 0; i < n; ++i)
        if (map->isNodeGlobalElement(i))
          u.replaceGlobalValue(i, static_cast<std::size_t>(j), dense(i, j));
    space.add(*a, *u.subView(Teuchos::Range1D(0, 1)));
    space.add(*a, *u.subView(Teuchos::Range1D(2, 2)));
  }

  /// Two columns with entries that differ.
  RCP<MultiVector> someColumns() const {
    const RCP<MultiVector> x = rcp(new MultiVector(map, 2));
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2; ++j)
        if (map->isNodeGlobalElement(i))
          x->replaceGlobalValue(i, static_cast<std::size_t>(j), someEntries(i, j));
    return x;
  }
  static double someEntry(int i, int j) { return 1.0 / (1 + i) + j * std::cos(i); }
  Eigen::MatrixXd someEntries = Eigen::MatrixXd::NullaryExpr(n, 2, [](Eigen::Index i, Eigen::Index j) {
    return someEntry(static_cast<int>(i), static_cast<int>(j));
  });

  void expectEntries(const MultiVector& x, const Eigen::MatrixXd& expected) const {
    for (std::size_t j = 0; j < x.getNumVectors(); ++j) {
      const auto values = x.getData(j);
      for (Teuchos_Ordinal i = 0; i < values.size(); ++i)
        EXPECT_NEAR(
            values[i],
            expected(map->getGlobalElement(static_cast<LocalOrdinal>(i)), static_cast<Eigen::Index>(j)),
            1e-12);
    }
  }

  /// All rows on the ranks but the first one, which has none, if there are several.
  static RCP<const Map> unevenMap() {
    const auto comm = Tpetra::getDefaultComm();
    std::vector<GlobalOrdinal> mine;
    for (GlobalOrdinal i = 0; i < n; ++i)
      if (comm->getSize() == 1 || comm->getRank() == 1 + i % (comm->getSize() - 1))
        mine.push_back(i);
    return makeMap(mine, comm);
  }

  RCP<const Map> map = unevenMap();
  Eigen::MatrixXd dense{n, k}, matrix = Eigen::MatrixXd::Zero(n, n), gram;
  RCP<const Operator> a;
  MultiVector u{map, k};
  qp::ColumnSpace space{map};
};

TEST_F(ColumnSpaceTest, ProjectsAndCorrectsSeveralColumnsAtOnce) {
  ASSERT_TRUE(space.factorize());
  EXPECT_EQ(space.size(), k);
  const Eigen::MatrixXd correction = dense * direct::inverseOfSpd(gram) * dense.transpose(),
                        p = Eigen::MatrixXd::Identity(n, n) - correction * matrix;
  const RCP<MultiVector> x = someColumns(), d = someColumns(), corrected = someColumns();

  space.project(*x);
  space.projectTransposed(*d);
  space.correct(*someColumns(), *corrected);

  expectEntries(*x, p * someEntries);
  expectEntries(*d, p.transpose() * someEntries);
  expectEntries(*corrected, someEntries + correction * someEntries);
}

TEST_F(ColumnSpaceTest, GivesCoefficientsToWhoeverKeepsThem) {
  ASSERT_TRUE(space.factorize());
  qp::ColumnSpace::Coefficients c, image;
  space.coefficients(*someColumns(), c);
  space.imageCoefficients(*someColumns(), image);
  const Eigen::MatrixXd expected = direct::inverseOfSpd(gram) * dense.transpose() * someEntries,
                        expectedImage = direct::inverseOfSpd(gram) * dense.transpose() * matrix * someEntries;
  ASSERT_EQ(c.size(), 2u * k);
  for (std::size_t i = 0; i < c.size(); ++i) {
    EXPECT_NEAR(c[i], expected.data()[i], 1e-12);
    EXPECT_NEAR(image[i], expectedImage.data()[i], 1e-12);
  }
}

TEST_F(ColumnSpaceTest, DeflatesAnOperator) {
  ASSERT_TRUE(space.factorize());
  const qp::DeflatedOperator deflated(a, space);
  const Eigen::MatrixXd au = matrix * dense,
                        expected = matrix - au * direct::inverseOfSpd(gram) * au.transpose();
  MultiVector y(map, 2);

  deflated.apply(*someColumns(), y);
  expectEntries(y, expected * someEntries);
  deflated.apply(u, u);
  expectEntries(u, Eigen::MatrixXd::Zero(n, k));

  const RCP<MultiVector> x = someColumns(); // whatever μ is: Uᵀ(b − Ax) = 0 afterwards
  deflated.complete(*someColumns(), *x);
  MultiVector residual(*someColumns(), Teuchos::Copy);
  a->apply(*x, residual, Teuchos::NO_TRANS, -1.0, 1.0);
  qp::ColumnSpace::Coefficients c;
  space.coefficients(residual, c);
  for (const double value : c)
    EXPECT_NEAR(value, 0, 1e-12);
}

TEST_F(ColumnSpaceTest, SaysThatColumnsDependOnEachOther) {
  space.add(*a, *u.subView(Teuchos::Range1D(1, 1)));
  EXPECT_FALSE(space.factorize());
  qp::ColumnSpace empty(map);
  empty.add(*a, Vector(map));
  EXPECT_FALSE(empty.factorize());
  u.putScalar(std::numeric_limits<double>::quiet_NaN());
  qp::ColumnSpace broken(map);
  broken.add(*a, u);
  EXPECT_FALSE(broken.factorize());
}

TEST_F(ColumnSpaceTest, MayBeEmpty) {
  qp::ColumnSpace empty(map);
  EXPECT_TRUE(empty.factorize());
  const RCP<MultiVector> x = someColumns();
  empty.project(*x);
  empty.projectTransposed(*x);
  empty.correct(*x, *x);
  expectEntries(*x, someEntries);
}

} // namespace
