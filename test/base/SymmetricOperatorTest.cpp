#include "epafi/base/SymmetricOperator.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace epafi;

/// 2 x.
class Twice final : public SymmetricOperator {
public:
  using SymmetricOperator::SymmetricOperator;

private:
  void multiply(const MultiVector& x, MultiVector& y) const override { y.update(2.0, x, 0.0); }
};

class SymmetricOperatorTest : public testing::Test {
protected:
  /// y's entries after y = alpha A x + beta y; x = 3, y = `before`, with a given number of columns.
  void expectApplied(double alpha, double beta, double before, double after, std::size_t columns = 1) {
    MultiVector x(map, columns), y(map, columns);
    x.putScalar(3.0);
    y.putScalar(before);
    twice.apply(x, y, Teuchos::TRANS, alpha, beta);
    for (std::size_t column = 0; column < columns; ++column)
      for (const double entry : y.getData(column))
        EXPECT_EQ(entry, after);
  }

  RCP<const Map> map = rcp(new Map(5, 0, Tpetra::getDefaultComm()));
  Twice twice{map};
};

TEST_F(SymmetricOperatorTest, ScalesAndAdds) {
  expectApplied(1, 0, 100, 6);
  expectApplied(-0.5, 0, 100, -3);
  expectApplied(0, 2, 10, 20);
  expectApplied(1, 1, 10, 16);
  expectApplied(0.5, -1, 10, -7, 3);
  expectApplied(0.5, -1, 10, -7, 2);
}

TEST_F(SymmetricOperatorTest, OverwritesWhatIsNoNumberWhereBetaIsZero) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  expectApplied(1, 0, nan, 6);
  expectApplied(0, 0, nan, 0);
}

TEST_F(SymmetricOperatorTest, HasTheSameMapOnBothSides) {
  EXPECT_EQ(twice.getDomainMap(), map);
  EXPECT_EQ(twice.getRangeMap(), map);
  EXPECT_TRUE(twice.hasTransposeApply());
}

} // namespace
