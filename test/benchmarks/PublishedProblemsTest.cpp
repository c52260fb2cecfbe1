#include "support/Solving.hpp"

#include "epafi/benchmarks/PublishedProblems.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace {

using namespace epafi;
using namespace epafi::benchmarks;
using test::allRanks;
using test::gather;
using test::solve;

/// The optimal values that CUTEst's files state ("LO SOLTN"), by points a side with the border.
TEST(ObstacleTest, HasTheOptimalValuesOfCutest) {
  const std::pair<int, double> below[] = {
      {4, 0.753659753}, {10, 1.397897560}, {23, 1.678027027}, {32, 1.748270031}};
  const std::pair<int, double> bothSides[] = {
      {4, -0.0081108}, {10, 2.87503823}, {23, 6.51932527}, {32, 6.88708670}};
  for (const auto& [points, value] : below)
    EXPECT_NEAR(solve(obstacle(points - 2, allRanks(), Obstacles::below, 0.5), 1e-8).report.objective, value,
                1e-8)
        << "OBSTCLAE, " << points;
  for (const auto& [points, value] : bothSides)
    EXPECT_NEAR(solve(obstacle(points - 2, allRanks(), Obstacles::bothSides, 0.5), 1e-8).report.objective,
                value, 1e-8)
        << "OBSTCLBM, " << points;
}

TEST(TorsionTest, HasTheOptimalValuesOfCutest) {
  const std::pair<int, double> values[] = {{4, -5.1851852e-1}, {10, -4.9234185e-1}, {22, -4.5608771e-1}};
  for (const auto& [points, value] : values)
    EXPECT_NEAR(solve(torsion(points - 2, allRanks(), 5, 0.5), 1e-8).report.objective, value, 1e-8)
        << "TORSION1, " << points;
}

TEST(TorsionTest, TurnsRoundWithTheTwist) {
  const Eigen::VectorXd there = gather(*solve(torsion(12, allRanks(), 5), 1e-10).x);
  const Eigen::VectorXd back = gather(*solve(torsion(12, allRanks(), -5), 1e-10).x);

  EXPECT_LE((there + back).norm(), 1e-8 * there.norm());
}

TEST(JournalBearingTest, EndsWithAKktPoint) {
  const BoundBenchmark benchmark = journalBearing(40, allRanks());

  const auto [x, report] = solve(benchmark, 1e-8);

  ASSERT_EQ(report.status, qp::Status::converged) << report.reason;
  Vector gradient(*benchmark.linearTerm, Teuchos::Copy);
  benchmark.hessian->apply(*x, gradient, Teuchos::NO_TRANS, 1.0, -1.0);
  const Eigen::VectorXd u = gather(*x), g = gather(gradient);
  const double limit = 1e-8 * benchmark.linearTerm->norm2();
  EXPECT_GE(u.minCoeff(), 0);
  double squared = 0; // of the projected gradient
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    const double part = u[k] > 0 ? g[k] : std::min(g[k], 0.0);
    squared += part * part;
  }
  EXPECT_LE(std::sqrt(squared), 1.001 * limit);
  EXPECT_GT((u.array() > 0).count(), 0) << "pressure in one half";
  EXPECT_GT((u.array() == 0).count(), 0) << "cavitation in the other";
}

TEST(JournalBearingTest, IsSymmetricAlongTheBearing) {
  const int n = 15;
  const Eigen::VectorXd u = gather(*solve(journalBearing(n, allRanks()), 1e-10).x);

  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      EXPECT_NEAR(u[i + n * j], u[i + n * (n - 1 - j)], 1e-8 * u.maxCoeff());
}

TEST(JournalBearingTest, TakesFewerProductsThanThePlainMethodElsewhere) {
  const auto report = solve(journalBearing(100, allRanks()), 1e-6).report;

  EXPECT_EQ(report.status, qp::Status::converged);
  EXPECT_LE(report.counts.hessianMultiplications, 444) << "PERMON 3.18, the method as published";
  EXPECT_GE(report.counts.hessianMultiplications, 250)
      << "about 400 are usual; far fewer would not be this problem";
}

TEST(JournalBearingTest, HasTheSameSolutionOnAnyNumberOfRanks) {
  const Eigen::VectorXd together = gather(*solve(journalBearing(20, allRanks()), 1e-10).x);
  const Eigen::VectorXd alone = gather(*solve(journalBearing(20, test::thisRank()), 1e-10).x);

  EXPECT_LE((together - alone).norm(), 1e-8 * alone.norm());
}

} // namespace
