#include "support/Solving.hpp"

#include "Multigrid.hpp"

#include "epafi/benchmarks/PublishedProblems.hpp"
#include "epafi/qp/constraints/Box.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using namespace epafi::benchmarks;
using test::allRanks;
using test::dense;

/// 1 where the index is not in a block of a third of all.
RCP<Vector> someFree(const BoundBenchmark& benchmark) {
  const auto n = static_cast<int>(benchmark.grid.size());
  return test::makeVector(benchmark.hessian->getDomainMap(),
                          [n](int i) { return i < n / 3 || i > 2 * n / 3 ? 1.0 : 0.0; });
}

TEST(MultigridTest, FaceKeepsTheFreeBlockAndTheDiagonal) {
  const BoundBenchmark benchmark = journalBearing(5, allRanks());
  const RCP<Vector> free = someFree(benchmark);

  const Eigen::MatrixXd face = dense(*drivers::restrictedToFace(*benchmark.hessian, *free));

  const Eigen::MatrixXd a = dense(*benchmark.hessian);
  const Eigen::VectorXd kept = test::gather(*free);
  Eigen::MatrixXd expected = kept.asDiagonal() * a * kept.asDiagonal();
  expected.diagonal() = a.diagonal();
  EXPECT_EQ(face, expected);
}

TEST(MultigridTest, IsSymmetricPositiveDefiniteAndCloseToTheInverse) {
  const BoundBenchmark benchmark = journalBearing(12, allRanks());

  const Eigen::MatrixXd m = dense(*drivers::makeMultigrid(benchmark.hessian));

  EXPECT_LE((m - m.transpose()).norm(), 1e-10 * m.norm());
  const Eigen::MatrixXd a = dense(*benchmark.hessian);
  const Eigen::VectorXd values =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(m, a.inverse()).eigenvalues();
  EXPECT_GT(values.minCoeff(), 0.3);
  EXPECT_LT(values.maxCoeff(), 3);
}

TEST(MultigridTest, OfTheFaceLeavesFixedEntriesAlone) {
  const BoundBenchmark benchmark = journalBearing(11, allRanks());
  const RCP<Vector> free = someFree(benchmark);

  const Eigen::MatrixXd m = dense(*drivers::makeFaceMultigrid(benchmark.hessian, *free));

  const Eigen::VectorXd kept = test::gather(*free);
  const Eigen::VectorXd fixed = Eigen::VectorXd::Ones(kept.size()) - kept;
  EXPECT_LE((kept.asDiagonal() * m * fixed.asDiagonal()).norm(), 1e-12 * m.norm());
}

TEST(MultigridTest, OfAFaceWithoutFreeEntriesIsNone) {
  const BoundBenchmark benchmark = journalBearing(4, allRanks());

  EXPECT_TRUE(
      drivers::makeFaceMultigrid(benchmark.hessian, Vector(benchmark.hessian->getDomainMap())).is_null());
}

TEST(MultigridTest, OneFreeEntryIsEnoughForAFace) {
  const BoundBenchmark benchmark = journalBearing(10, allRanks());
  const auto one =
      test::makeVector(benchmark.hessian->getDomainMap(), [](int i) { return i == 37 ? 1.0 : 0.0; });
  Vector image(benchmark.hessian->getDomainMap());

  drivers::makeFaceMultigrid(benchmark.hessian, *one)->apply(*one, image);

  EXPECT_GT(image.norm2(), 0);
}

TEST(MultigridTest, SavesFourOfFiveProducts) {
  const BoundBenchmark benchmark = journalBearing(60, allRanks());
  qp::QuadraticProgram problem = benchmark.program();
  problem.preconditioner = drivers::makeMultigrid(benchmark.hessian);
  Vector x(benchmark.hessian->getDomainMap());

  const qp::SolveReport report = qp::QpSolver().solve(problem, x).report;

  const qp::SolveReport plain = test::solve(benchmark, 1e-6).report;
  EXPECT_EQ(report.status, qp::Status::converged) << report.reason;
  EXPECT_LE(5 * report.counts.hessianMultiplications, plain.counts.hessianMultiplications);
}

} // namespace
