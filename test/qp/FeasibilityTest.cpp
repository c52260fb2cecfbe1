#include "support/DenseProgram.hpp"
#include "support/Problems.hpp"

#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/constraints/MatrixEquality.hpp"
#include "epafi/qp/solve/Feasibility.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace epafi;
using namespace epafi::test;

struct Found {
  qp::Feasibility feasibility;
  Eigen::VectorXd x, certificate; ///< the certificate on the rows of B
};

Found find(const DenseProgram& program, int maxDenseRows, const Eigen::VectorXd& start) {
  const RCP<const Map> domain = linearMap(static_cast<int>(program.size()));
  const RCP<const Map> range = linearMap(static_cast<int>(program.numRows()));
  const qp::PreparedEquality prepared = qp::prepareEquality(
      rcp(new DenseRows(domain, range, program.rows)), makeVector(range, program.values), maxDenseRows, {});
  const RCP<const qp::ConvexSet> box =
      rcp(new qp::Box(makeVector(domain, program.lower), makeVector(domain, program.upper)));
  const RCP<Vector> x = makeVector(domain, start);
  Found found{qp::findFeasiblePoint(prepared.constraint, box, *x), gather(*x), {}};
  if (!found.feasibility.isFeasible)
    found.certificate = gather(*prepared.multiplierOfRows(found.feasibility.certificate));
  return found;
}

/// 0 ≤ x ≤ 1, n entries, and rows of noise.
DenseProgram unitBox(int n, int m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  DenseProgram program = DenseProgram::unconstrained(Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n));
  program.lower.setZero();
  program.upper.setOnes();
  program.rows = Eigen::MatrixXd::NullaryExpr(m, n, [&] { return normal(random); });
  program.values = Eigen::VectorXd::Zero(m);
  return program;
}

bool isInBox(const Eigen::VectorXd& x) {
  return (x.array() >= 0).all() && (x.array() <= 1).all();
}

/// Rows made orthonormal, or only scaled.
class FeasibilityTest : public testing::TestWithParam<int> {};

TEST_P(FeasibilityTest, LeavesAFeasiblePointAlone) {
  DenseProgram program = unitBox(10, 3, 1);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(10, 0.1, 0.9);
  program.values = program.rows * x;

  const Found found = find(program, GetParam(), x);

  EXPECT_TRUE(found.feasibility.isFeasible);
  EXPECT_LE((found.x - x).norm(), 1e-13);
}

TEST_P(FeasibilityTest, FindsAPointInsideTheBounds) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    DenseProgram program = unitBox(12, 1 + static_cast<int>(seed % 5), seed);
    program.values = program.rows * Eigen::VectorXd::LinSpaced(12, 0.05, 0.95);

    const Found found = find(program, GetParam(), Eigen::VectorXd::Constant(12, 7));

    EXPECT_TRUE(found.feasibility.isFeasible) << seed;
    EXPECT_TRUE(isInBox(found.x)) << seed;
    EXPECT_LE((program.rows * found.x - program.values).norm(), 1e-6) << seed;
  }
}

TEST_P(FeasibilityTest, FindsACornerThatIsTheOnlyFeasiblePoint) {
  DenseProgram program = unitBox(6, 1, 2);
  program.rows.setOnes();
  program.values.setConstant(6);

  const Found found = find(program, GetParam(), Eigen::VectorXd::Zero(6));

  EXPECT_TRUE(found.feasibility.isFeasible);
  EXPECT_LE((found.x - Eigen::VectorXd::Ones(6)).norm(), 1e-6);
}

TEST_P(FeasibilityTest, ProvesThatThereIsNoPoint) {
  for (const double gap : {1e-4, 1e-2, 1.0, 1e3}) {
    DenseProgram program = unitBox(8, 2, 3);
    const double most = program.rows.row(0).cwiseMax(0).sum();
    program.values[0] = most + gap;
    program.values[1] = program.rows.row(1).sum() / 2;

    const Found found = find(program, GetParam(), Eigen::VectorXd::Zero(8));

    ASSERT_FALSE(found.feasibility.isFeasible) << gap;
    EXPECT_GT(found.feasibility.distance, 0);
    EXPECT_GT(separation(program, found.certificate), 0) << gap;
    EXPECT_TRUE(isInBox(found.x)) << gap;
  }
}

TEST_P(FeasibilityTest, MissesAnInfeasibleRowByAsLittleAsCanBe) {
  DenseProgram program = unitBox(4, 1, 5);
  program.rows.setConstant(0.5); // of length 1
  program.values.setConstant(3); // at most 2

  const Found found = find(program, GetParam(), Eigen::VectorXd::Zero(4));

  EXPECT_FALSE(found.feasibility.isFeasible);
  EXPECT_NEAR(found.feasibility.distance, 1, GetParam() > 0 ? 1e-9 : 0.1)
      << "‖B‖ is over-estimated by some per cent";
  EXPECT_LE((found.x - Eigen::VectorXd::Ones(4)).norm(), 1e-12);
}

TEST_P(FeasibilityTest, WithoutBoundsRowsOfFullRankAreAlwaysFeasible) {
  DenseProgram program = unitBox(10, 4, 7);
  program.lower.setConstant(-test::unbounded);
  program.upper.setConstant(test::unbounded);
  program.values.setConstant(1e4);

  const Found found = find(program, GetParam(), Eigen::VectorXd::Zero(10));

  EXPECT_TRUE(found.feasibility.isFeasible);
  EXPECT_LE((program.rows * found.x - program.values).norm(), 1e-8 * program.values.norm());
}

TEST_P(FeasibilityTest, TinyBoxesAndRightHandSidesAreSeenAtTheirOwnScale) {
  for (const double unit : {1e-12, 1e12}) {
    DenseProgram program = unitBox(8, 1, 11);
    program.upper *= unit;
    const double most = program.rows.row(0).cwiseMax(0).sum();
    program.values.setConstant(0.9 * most * unit);
    EXPECT_TRUE(find(program, GetParam(), Eigen::VectorXd::Zero(8)).feasibility.isFeasible) << unit;

    program.values.setConstant(1.1 * most * unit);
    EXPECT_FALSE(find(program, GetParam(), Eigen::VectorXd::Zero(8)).feasibility.isFeasible) << unit;
  }
}

INSTANTIATE_TEST_SUITE_P(Paths, FeasibilityTest, testing::Values(300, 0),
                         [](const auto& instance) { return instance.param > 0 ? "orthonormal" : "scaled"; });

} // namespace
