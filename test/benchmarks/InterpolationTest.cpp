#include "support/Solving.hpp"

#include "epafi/benchmarks/Grid.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using namespace epafi::benchmarks;
using test::allRanks;

/// The interpolation between two grids, whole on every rank.
Eigen::MatrixXd interpolation(const Grid& coarse, const Grid& fine) {
  return test::dense(*bilinearInterpolation(coarse, coarse.map(allRanks()), fine, fine.map(allRanks())));
}

TEST(InterpolationTest, SpreadsOneCoarseValueOverTheCellsAroundIt) {
  const Eigen::MatrixXd p = interpolation(Grid::square(1, 0, 1, 0, 4), Grid::square(3, 0, 1, 0, 4));

  Eigen::VectorXd expected(9);
  expected << 0.25, 0.5, 0.25, 0.5, 1, 0.5, 0.25, 0.5, 0.25;
  EXPECT_LE((p - expected).norm(), 1e-14);
}

TEST(InterpolationTest, IsExactForBilinearFunctionsOnGridsThatAreNotNested) {
  const Grid coarse = Grid::square(4, -1, 2, 0, 1), fine = Grid::square(7, -1, 2, 0, 1);
  const auto function = [](double x, double y) { return 3 + x - 2 * y + 5 * x * y; };
  Eigen::VectorXd values(16);
  for (int k = 0; k < 16; ++k)
    values[k] = function(coarse.x(k % 4), coarse.y(k / 4));

  const Eigen::VectorXd result = interpolation(coarse, fine) * values;

  int checked = 0;
  for (int k = 0; k < 49; ++k) {
    const double x = fine.x(k % 7), y = fine.y(k / 7);
    if (x < coarse.x(0) || x > coarse.x(3) || y < coarse.y(0) || y > coarse.y(3))
      continue; // towards the border it goes to 0
    EXPECT_NEAR(result[k], function(x, y), 1e-13);
    ++checked;
  }
  EXPECT_GE(checked, 16);
}

TEST(InterpolationTest, NeverAddsAnything) {
  const Eigen::MatrixXd p = interpolation(Grid::square(3, 0, 1, 0, 1), Grid::square(10, 0, 1, 0, 1));

  EXPECT_GE(p.minCoeff(), 0);
  EXPECT_LE(p.rowwise().sum().maxCoeff(), 1 + 1e-14);
}

} // namespace
