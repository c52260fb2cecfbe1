#include "ClosedForms.hpp"
#include "support/Solving.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/benchmarks/PublishedProblems.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace epafi;
using namespace epafi::benchmarks;
using test::allRanks;
using test::dense;
using test::gather;

std::vector<BoundBenchmark> allBenchmarks(int n, const RCP<const Comm>& comm) {
  return {journalBearing(n, comm),
          obstacle(n, comm),
          obstacle(n, comm, Obstacles::bothSides, 0.5),
          torsion(n, comm),
          test::ballObstacle(n, comm).problem,
          test::stringOverObstacle(n, comm).problem,
          test::diskOverObstacle(n, comm).problem};
}

TEST(GridTest, HasTheCoordinatesOfItsUnknowns) {
  const Grid grid = Grid::square(3, -2, 2, 0, 8);

  EXPECT_EQ(grid.place(7), (std::array<int, 2>{1, 2}));
  EXPECT_EQ(grid.x(1), 0);
  EXPECT_EQ(grid.y(2), 6);
  EXPECT_EQ(grid.size(), 9);
}

TEST(GridTest, RefusesToBeEmpty) {
  EXPECT_THROW(Grid::square(0, 0, 1, 0, 1), InputError);
}

TEST(GridTest, HasLinearFunctionsForSolutionsWithTheirValuesOnTheBorder) {
  // −Δu = 0 with u = x + 10y on the border: linear elements have this u as their solution.
  const Grid grid = Grid::square(3, 0, 1, 0, 2);
  const auto linear = [](double x, double y) { return x + 10 * y; };
  const FivePointSystem system = assembleFivePoint(
      grid, allRanks(), [&](int i, int j) { return laplaceStencil(grid, i, j); },
      [&](int i, int j) { return test::fromBorder(grid, i, j, linear); });

  const RCP<Vector> u =
      grid.vector(system.rightHandSide->getMap(), [&](int i, int j) { return linear(grid.x(i), grid.y(j)); });
  Vector image(u->getMap());
  system.matrix->apply(*u, image);

  image.update(-1.0, *system.rightHandSide, 1.0);
  EXPECT_LE(image.normInf(), 1e-13);
}

TEST(GridTest, LaplaceOfTwoByTwoUnknownsByHand) {
  const BoundBenchmark benchmark = obstacle(2, allRanks());
  Eigen::Matrix4d expected;
  expected << 4, -1, -1, 0, -1, 4, 0, -1, -1, 0, 4, -1, 0, -1, -1, 4;

  EXPECT_LE((dense(*benchmark.hessian) - expected).norm(), 1e-14);
}

TEST(BenchmarkMatrixTest, IsSymmetricPositiveDefiniteInEveryBenchmark) {
  for (const BoundBenchmark& benchmark : allBenchmarks(5, allRanks())) {
    const Eigen::MatrixXd a = dense(*benchmark.hessian);

    EXPECT_LE((a - a.transpose()).norm(), 1e-14 * a.norm()) << benchmark.name;
    EXPECT_GT(direct::eigenOf(a).values[0], 0) << benchmark.name;
  }
}

TEST(BenchmarkMatrixTest, RowsSumToZeroAwayFromTheBorderAndToTheLostWeightsBesideIt) {
  const int n = 5;
  for (const BoundBenchmark& benchmark :
       {journalBearing(n, allRanks()), torsion(n, allRanks()), test::ballObstacle(n, allRanks()).problem}) {
    const Eigen::MatrixXd a = dense(*benchmark.hessian);
    const Eigen::VectorXd sums = a.rowwise().sum();
    for (int row = 0; row < n * n; ++row) {
      const auto [i, j] = benchmark.grid.place(row);
      const bool isInside = i > 0 && i < n - 1 && j > 0 && j < n - 1;
      if (isInside) {
        EXPECT_NEAR(sums[row], 0, 1e-13 * a.norm()) << benchmark.name << ", row " << row;
      } else {
        EXPECT_GT(sums[row], 0.01 * a(row, row)) << benchmark.name << ", row " << row;
      }
    }
  }
}

void expectSame(const RCP<const Vector>& first, const RCP<const Vector>& second, const std::string& name) {
  ASSERT_EQ(first.is_null(), second.is_null()) << name;
  if (!first.is_null()) {
    EXPECT_EQ(gather(*first), gather(*second)) << name;
  }
}

TEST(BenchmarkMatrixTest, IsTheSameOnAnyNumberOfRanks) {
  for (const int n : {1, 4}) { // one unknown leaves ranks empty
    const std::vector<BoundBenchmark> together = allBenchmarks(n, allRanks()),
                                      alone = allBenchmarks(n, test::thisRank());
    for (std::size_t k = 0; k < together.size(); ++k) {
      EXPECT_EQ(dense(*together[k].hessian), dense(*alone[k].hessian)) << together[k].name;
      EXPECT_EQ(gather(*together[k].linearTerm), gather(*alone[k].linearTerm)) << together[k].name;
      expectSame(together[k].lower, alone[k].lower, together[k].name);
      expectSame(together[k].upper, alone[k].upper, together[k].name);
    }
  }
}

} // namespace
