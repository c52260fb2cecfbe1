#include "EqualityProblems.hpp"
#include "QpProblems.hpp"
#include "support/DenseOracle.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/qp/constraints/Box.hpp"
#include "epafi/qp/operators/LocalData.hpp"
#include "epafi/qp/solve/Solve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

/// One way to solve: methods that take over from each other, sets that move, programs that are shifted.
namespace {

using namespace epafi;
using qp::Method;
using qp::Status;

test::QpCall byActiveSets(double tolerance) {
  test::QpCall call{test::withTolerance(tolerance)};
  call.parameters.set("Algorithm", std::string("active set"));
  return call;
}

TEST(QpAlgorithmTest, ActiveSetsSolveBoundsWithAndWithoutRows) {
  for (unsigned seed = 0; seed < 8; ++seed)
    for (const int numRows : {0, 1, 4}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << numRows << " rows");
      const int n = 15 + 5 * static_cast<int>(seed);
      const double condition = std::pow(10.0, seed % 4);
      const test::DenseProgram program = numRows > 0
                                             ? test::mixedProgramWithRows(n, numRows, condition, 211 + seed)
                                             : test::mixedProgram(n, condition, 211 + seed);

      const test::QpAnswer answer = test::solveQp(program, byActiveSets(1e-9));

      EXPECT_EQ(test::whyNoSolution(program, answer, 1e-9), "");
      const test::OracleAnswer oracle = test::solveByDualActiveSet(program);
      EXPECT_LE((answer.x - oracle.x.cast<double>()).norm(), 1e-5 * answer.x.norm());
      EXPECT_EQ(answer.report.counts.outer + answer.report.counts.proportioning, 0) << "MPRGP had to go on";
    }
}

TEST(QpAlgorithmTest, WithManyRowsSmalbeTakesThePlaceOfActiveSets) {
  const test::DenseProgram program = test::mixedProgramWithRows(30, 3, 10, 223);
  test::QpCall call = byActiveSets(1e-9);
  call.parameters.set("Maximum Dense Rows", 0);

  const test::QpAnswer answer = test::solveQp(program, call);

  EXPECT_EQ(test::whyNoSolution(program, answer, 1e-9), "");
  EXPECT_GT(answer.report.counts.outer, 0);
}

TEST(QpAlgorithmTest, ActiveSetsNameAnObjectiveWithoutEnd) {
  const test::DenseProgram program =
      test::DenseProgram::unconstrained(Eigen::Vector3d(1, 1, 0).asDiagonal(), Eigen::Vector3d(1, 2, 3));

  const test::QpAnswer answer = test::solveQp(program, byActiveSets(1e-9));

  EXPECT_EQ(answer.report.status, Status::unbounded);
  EXPECT_EQ(whyNotRecession(program, answer.certificate), "");
}

TEST(QpAlgorithmTest, RowsMayBeGivenAsAConstraintOfOnesOwn) {
  std::mt19937 random(227);
  const test::EqualityProblem problem = test::randomProblem(20, 2, 50, random);
  const auto map = test::linearMap(20);
  const qp::QuadraticProgram program{.hessian = rcp(new test::DenseOperator(map, problem.a)),
                                     .linearTerm = test::makeVector(map, problem.b),
                                     .set = rcp(new qp::Box(test::makeVector(map, problem.lower))),
                                     .equality = rcp(new test::DenseEquality(map, problem.g))};
  for (const bool isByFaces : {false, true}) {
    Vector x(map);
    qp::QpSolver solver(isByFaces ? byActiveSets(1e-9).parameters : test::withTolerance(1e-9));

    const qp::QpSolution solution = solver.solve(program, x);

    EXPECT_EQ(solution.report.status, Status::converged) << solution.report.reason;
    EXPECT_LE(test::projectedGradient(problem, test::gather(x)), 1e-8 * problem.b.norm());
    EXPECT_LE((problem.g * test::gather(x)).norm(), 1e-8);
  }
}

/// min ½|x|² − bᵀx over x_0 ≥ 0, |x_1| ≤ x_0/2, or another slope, in every pair of entries: for b = (2, 3)
/// x = (2, 1).
struct Wedges {
  bool knowGrowth = false; ///< whether the set tells how its bounds grow
  double slope = 0.5;
  RCP<const Map> map = ofPairs(4);
  qp::QuadraticProgram program{.hessian = rcp(new test::DenseOperator(map, Eigen::MatrixXd::Identity(8, 8))),
                               .linearTerm = test::makeVector(map, ends(2, 3)),
                               .operatorNorm = 1};

  Wedges() {
    program.set = setAt(Vector(map));
    program.setAt = [this](const Vector& x) { return setAt(x); };
  }
  /// Both of a pair on one rank.
  static RCP<const Map> ofPairs(int number) {
    std::vector<GlobalOrdinal> mine;
    for (const GlobalOrdinal pair : localIndices(*test::linearMap(number)))
      mine.insert(mine.end(), {2 * pair, 2 * pair + 1});
    return makeMap(std::move(mine), test::linearMap(number)->getComm());
  }
  static Eigen::VectorXd ends(double even, double odd) {
    Eigen::VectorXd values(8);
    for (Eigen::Index i = 0; i < 8; ++i)
      values[i] = i % 2 == 0 ? even : odd;
    return values;
  }
  RCP<const qp::ConvexSet> setAt(const Vector& x) const {
    const Eigen::VectorXd values = test::gather(x);
    Eigen::VectorXd lower = ends(0, 0), upper = ends(test::unlimited, 0);
    for (Eigen::Index i = 1; i < 8; i += 2) {
      upper[i] = slope * std::max(values[i - 1], 0.0);
      lower[i] = -upper[i];
    }
    std::vector<qp::Box::Growth> growth;
    for (LocalOrdinal i = 0; knowGrowth && i < static_cast<LocalOrdinal>(numLocal(*map)); i += 2)
      growth.push_back({i + 1, i, slope});
    return rcp(new qp::Box(test::makeVector(map, lower), test::makeVector(map, upper), growth));
  }
};

TEST(SolveTest, ASetThatMovesWithTheSolutionIsFollowed) {
  const Wedges wedges;
  for (const Method method : {Method::mprgp, Method::activeSets, Method::fixedPoint}) {
    Vector x(wedges.map);
    const auto report = qp::solve(wedges.program, method, {1e-10, 1.0}, {}, x);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_LE((test::gather(x) - Wedges::ends(2, 1)).norm(), 1e-9);
    EXPECT_EQ(report.counts.fixedPointRounds > 0, method == Method::fixedPoint);
    EXPECT_EQ(report.counts.negativeCurvatures, 0);
  }
}

/// Of each pair of A = (1, −0.9; −0.9, 1), |x_1| ≤ 2 x_0 and b = (−1.6, 3) the solutions are 0, (2, 4) and
/// (5.8, 8.2); on the face of the second one 1 − 0.9 · 2 < 0.
TEST(SolveTest, CurvatureBelowZeroOnAFaceWithBoundsThatFollowIsCounted) {
  Wedges wedges;
  wedges.knowGrowth = true;
  wedges.slope = 2;
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(8, 8);
  for (Eigen::Index i = 0; i < 8; i += 2)
    a(i, i + 1) = a(i + 1, i) = -0.9;
  wedges.program.hessian = rcp(new test::DenseOperator(wedges.map, a));
  wedges.program.linearTerm = test::makeVector(wedges.map, Wedges::ends(-1.6, 3));
  wedges.program.operatorNorm = 1.9;
  Vector x(*test::makeVector(wedges.map, Wedges::ends(2.5, 5)), Teuchos::Copy);
  wedges.program.set = wedges.setAt(x);

  const auto report = qp::solve(wedges.program, Method::activeSets, {1e-10, 1.0}, {}, x);

  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_LE((test::gather(x) - Wedges::ends(2, 4)).norm(), 1e-9);
  EXPECT_GT(report.counts.negativeCurvatures, 0);
}

TEST(SolveTest, BoundsThatAreKnownToGrowAreFollowedOnTheirFace) {
  const Eigen::MatrixXd a = 0.7 * Eigen::MatrixXd::Identity(8, 8) + Eigen::MatrixXd::Constant(8, 8, 0.3);
  Eigen::VectorXd b = Wedges::ends(2, 3);
  for (Eigen::Index i = 0; i < 8; ++i)
    b[i] += 0.03 * static_cast<double>(i * i);
  std::vector<int> products;
  for (const bool knowGrowth : {false, true}) {
    Wedges wedges;
    wedges.knowGrowth = knowGrowth;
    wedges.program.hessian = rcp(new test::DenseOperator(wedges.map, a));
    wedges.program.linearTerm = test::makeVector(wedges.map, b);
    wedges.program.operatorNorm = 3.1;
    Vector x(wedges.map);

    const auto report = qp::solve(wedges.program, Method::activeSets, {1e-10, 1.0}, {}, x);

    EXPECT_EQ(report.status, Status::converged) << report.reason;
    const Eigen::VectorXd found = test::gather(x), gradient = a * found - b;
    for (Eigen::Index i = 0; i < 8; i += 2) {
      EXPECT_NEAR(gradient[i], 0, 1e-9);
      EXPECT_LT(gradient[i + 1], 0);
      EXPECT_NEAR(found[i + 1], found[i] / 2, 1e-9);
    }
    products.push_back(report.counts.hessianMultiplications);
  }
  EXPECT_LT(products[1], products[0]);
}

TEST(SolveTest, AShiftedProgramHasTheShiftedSolution) {
  const Wedges wedges;
  const RCP<Vector> point = test::makeVector(wedges.map, Wedges::ends(0.7, -0.2));
  Vector y(wedges.map);

  const auto report = qp::solve(wedges.program.shiftedBy(point), Method::activeSets, {1e-10, 1.0}, {}, y);

  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_LE((test::gather(y) - Wedges::ends(1.3, 1.2)).norm(), 1e-9);
}

TEST(SolveTest, ActiveSetsGoOnWhereMprgpIsOutOfPatience) {
  const test::DenseProgram program = test::mixedProgram(40, 1e4, 229);
  qp::QuadraticProgram problem = test::toQuadraticProgram(program);
  problem.operatorNorm = 1;
  const qp::Tolerances tolerances{1e-9, program.linear.norm()};
  Vector x(problem.hessian->getDomainMap()), alone(x.getMap());
  const auto whole = qp::solve(problem, Method::mprgp, tolerances, {}, alone);

  const auto report = qp::solve(problem, Method::mprgp, tolerances, {.patience = 20}, x);

  EXPECT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_LE((test::gather(x) - test::gather(alone)).norm(), 1e-5 * alone.norm2());
  EXPECT_EQ(report.history.back().hessianMultiplications, report.counts.hessianMultiplications);
  EXPECT_LE(whole.counts.hessianMultiplications, 2000);
  EXPECT_GT(whole.counts.hessianMultiplications, 20);
  EXPECT_EQ(report.history[5].projectedGradient, whole.history[5].projectedGradient);
  EXPECT_NE(report.counts.hessianMultiplications, whole.counts.hessianMultiplications);
}

TEST(SolveTest, AFewProductsAreTheLimitOfAllMethodsTogether) {
  const test::DenseProgram program = test::mixedProgram(40, 1e4, 229);
  qp::QuadraticProgram problem = test::toQuadraticProgram(program);
  problem.operatorNorm = 1;
  qp::SolveParameters parameters{.patience = 10};
  parameters.mprgp.maxMultiplications = 15;
  Vector x(problem.hessian->getDomainMap());

  const auto report = qp::solve(problem, Method::mprgp, {1e-12, program.linear.norm()}, parameters, x);

  EXPECT_EQ(report.status, Status::maxIterations);
  EXPECT_LE(report.counts.hessianMultiplications, 19);
}

TEST(SolveTest, RefusesRowsGivenAsAMatrix) {
  const qp::QuadraticProgram problem = test::toQuadraticProgram(test::mixedProgramWithRows(10, 2, 10, 233));
  Vector x(problem.hessian->getDomainMap());
  EXPECT_THROW(qp::solve(problem, Method::mprgp, {}, {}, x), InputError);
}

} // namespace
