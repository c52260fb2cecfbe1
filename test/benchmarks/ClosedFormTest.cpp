#include "ClosedForms.hpp"
#include "support/Solving.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace {

using namespace epafi;
using namespace epafi::test;

struct Errors {
  double largest = 0, rootMeanSquare = 0;
};

Errors errorsOf(const KnownBenchmark& benchmark) {
  const benchmarks::BoundBenchmark& problem = benchmark.problem;
  const auto [x, report] = test::solve(problem, 1e-7);
  EXPECT_EQ(report.status, qp::Status::converged) << problem.name << ": " << report.reason;
  const RCP<Vector> error = benchmark.error(*x);
  return {error->normInf(), error->norm2() / std::sqrt(static_cast<double>(problem.grid.size()))};
}

/// The orders in h of both errors, from meshes of about n and 4n unknowns a side. The error of one mesh
/// depends on where in its element the contact ends (it may all but vanish), so error/h² is averaged over six
/// meshes.
Errors observedOrders(const std::function<KnownBenchmark(int)>& make, int n) {
  const auto average = [&](int first) {
    Errors sum;
    for (int k = first; k < first + 6; ++k) {
      const KnownBenchmark benchmark = make(k);
      const Errors errors = errorsOf(benchmark);
      const double squared = benchmark.problem.grid.hx * benchmark.problem.grid.hx;
      sum.largest += errors.largest / squared;
      sum.rootMeanSquare += errors.rootMeanSquare / squared;
    }
    return sum;
  };
  const Errors coarse = average(n), fine = average(4 * n);
  return {2 + std::log(coarse.largest / fine.largest) / std::log(4.0),
          2 + std::log(coarse.rootMeanSquare / fine.rootMeanSquare) / std::log(4.0)};
}

TEST(ClosedFormTest, StringIsAsFarOffAsTheEndOfItsContactIsFromAMeshPoint) {
  // Linear elements are exact at the mesh points but for the contact's end, which falls at a fraction θ of an
  // element: the error is at most fh² θ(1−θ)/2 ≤ fh²/8.
  for (const int n : {9, 24, 39, 80, 127}) {
    const KnownBenchmark benchmark = stringOverObstacle(n, allRanks());
    const double h = benchmark.problem.grid.hx;

    EXPECT_LE(errorsOf(benchmark).largest, 10 * h * h / 8 + 1e-7) << n;
  }
}

TEST(ClosedFormTest, StringConvergesWithSecondOrder) {
  const Errors order = observedOrders([](int n) { return stringOverObstacle(n, allRanks()); }, 12);

  EXPECT_NEAR(order.largest, 2, 0.25);
  EXPECT_NEAR(order.rootMeanSquare, 2, 0.25);
}

TEST(ClosedFormTest, DiskConvergesWithSecondOrder) {
  const Errors order = observedOrders([](int n) { return diskOverObstacle(n, allRanks()); }, 12);

  EXPECT_NEAR(order.largest, 2, 0.25);
  EXPECT_NEAR(order.rootMeanSquare, 2, 0.25);
}

TEST(ClosedFormTest, BallConvergesWithSecondOrder) {
  const Errors order = observedOrders([](int n) { return ballObstacle(n, allRanks()); }, 12);

  EXPECT_NEAR(order.rootMeanSquare, 2, 0.25);
  // In theory the largest error has a power of |ln h| beside h² (Baiocchi 1977; Nitsche 1977): 1.7 is what
  // meshes of this size show.
  EXPECT_GE(order.largest, 1.5);
  EXPECT_LE(order.largest, 2.25);
}

TEST(ClosedFormTest, RadiiOfContactAreThoseKnown) {
  // To 16 digits from an independent root finder.
  EXPECT_NEAR(diskContactRadius(10, 0.5, 1), 0.6621956952852164, 1e-14);
  EXPECT_NEAR(ballContactRadius(), 0.6979651482233735, 1e-14);
}

TEST(ClosedFormTest, SolutionsMeetTheirObstaclesWithoutAKink) {
  const double b = diskContactRadius(10, 0.5, 1), a = ballContactRadius(), step = 1e-6;
  const auto disk = diskOverObstacle(4, allRanks()).exactSolution;
  const auto ball = ballObstacle(4, allRanks()).exactSolution;

  EXPECT_NEAR(disk(b + step, 0), -0.5, 1e-9);
  EXPECT_NEAR((ball(a + step, 0) - ball(a - step, 0)) / (2 * step), -a / std::sqrt(1 - a * a), 1e-5);
  EXPECT_NEAR(ball(2, 0), 0, 1e-15);
}

} // namespace
