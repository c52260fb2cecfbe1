#include "EqualityProblems.hpp"

#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/qp/constraints/Discs.hpp"
#include "epafi/qp/solve/ActiveSets.hpp"
#include "epafi/qp/solve/MprgpSolve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

using namespace epafi;
using qp::Disc;
using qp::Status;
using Pair = Disc::Pair;

const Disc unitDisc{0, 1, 1};

Pair pair(double first, double second) {
  return {first, second};
}

Pair at(double angle, double length = 1) {
  return {length * std::cos(angle), length * std::sin(angle)};
}

TEST(DiscTest, ProjectsOntoTheNearestPoint) {
  EXPECT_EQ(unitDisc.project({0.3, -0.4}), pair(0.3, -0.4));
  EXPECT_NEAR((unitDisc.project({3, -4}) - pair(0.6, -0.8)).norm(), 0, 1e-15);
  EXPECT_NEAR((Disc{0, 1, 2, {1, 1}}.project({1, 7}) - pair(1, 3)).norm(), 0, 1e-15);
  EXPECT_EQ((Disc{0, 1, 0}.project({3, -4})), pair(0, 0));
}

TEST(DiscTest, WhatIsProjectedOntoACircleFarFromTheOriginIsOnIt) {
  for (int k = 0; k < 100; ++k) {
    const double angle = 0.1 * k;
    const Disc disc{.first = 0, .second = 1, .radius = 1e-3, .centre = {1 + angle, -2}};
    const Pair outside = disc.centre + pair(std::cos(angle), std::sin(angle));
    EXPECT_FALSE(disc.isFree(disc.project(outside))) << angle;
    EXPECT_TRUE(disc.isFree(disc.centre + 0.999 * (disc.project(outside) - disc.centre))) << angle;
  }
}

TEST(DiscTest, OnTheCircleAGradientThatPressesOutwardsLeadsAlongItAlone) {
  for (const double angle : {0.0, 0.7, 2.5, 4.0}) {
    const Pair x = at(angle), normal = at(angle), along = at(angle + std::numbers::pi / 2);
    ASSERT_FALSE(unitDisc.isFree(x));
    // x moves against g
    EXPECT_NEAR((unitDisc.choppedGradient(x, -2 * normal + 3 * along) - 3 * along).norm(), 0, 1e-14);
    EXPECT_NEAR((unitDisc.choppedGradient(x, 2 * normal + 3 * along) - (2 * normal + 3 * along)).norm(), 0,
                1e-14);
    EXPECT_EQ(unitDisc.choppedGradient(x, -2 * normal + 1e-13 * along, 1e-12), pair(0, 0)) << "negligible";
  }
  EXPECT_EQ(unitDisc.choppedGradient({0.5, 0}, {1, 1}), pair(0, 0)) << "inside";
  EXPECT_EQ((Disc{0, 1, 0}.choppedGradient({0, 0}, {1, 1})), pair(0, 0)) << "fixed";
}

TEST(DiscTest, TheLongestStepEndsOnTheCircle) {
  const Disc disc{0, 1, 2, {1, -1}};
  for (const Pair& x : {pair(1, -1), pair(1.5, 0), pair(1 - std::sqrt(2.0), -1 + std::sqrt(2.0))})
    for (int k = 0; k < 8; ++k) {
      const Pair p = at(0.1 + k, 0.3);
      const double length = disc.maxFeasibleStep(x, p);
      ASSERT_GE(length, 0);
      const double end = (x - length * p - disc.centre).norm();
      if (disc.isFree(x) || p.dot(x - disc.centre) > 0)
        EXPECT_NEAR(end, 2, 1e-14);
      else
        EXPECT_LE(length, 1e-7); // the circle's own rim
    }
  EXPECT_EQ(disc.maxFeasibleStep({1, 0}, {0, 0}), test::unbounded);
}

TEST(DiscTest, TheReducedFreeGradientKeepsTheStepInside) {
  for (const double length : {0.0, 0.5, 0.99})
    for (const Pair& g : {pair(10, 0), pair(0.1, 0.1), pair(-7, 3)}) {
      const Pair x = at(1, length), reduced = unitDisc.reducedFreeGradient(x, g, 0.5);
      EXPECT_LE((x - 0.5 * reduced).norm(), 1 + 1e-15);
      EXPECT_GE(reduced.dot(g), 0);
    }
}

/// min ½xᵀAx − bᵀx, x_i ≥ lower_i, the pairs (3k + 1, 3k + 2) in discs: a normal force and two tangential
/// ones a node, its friction bounded by g_k.
struct TrescaProblem {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, bounds;
  Eigen::MatrixXd rows = Eigen::MatrixXd(0, 0); ///< orthonormal, Bx = 0, or none
  bool isPreconditioned = false;

  [[nodiscard]] Eigen::Index numNodes() const { return bounds.size(); }
};

double distance(Eigen::Index a, Eigen::Index b) {
  return std::abs(static_cast<double>(a - b));
}

/// Nodes on a line that feel each other, normal and tangential forces coupled; loads that press here, pull
/// there and push along all directions. \param friction  about the bounds, beside forces of size 1
TrescaProblem trescaProblem(unsigned seed, int numNodes, double friction) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  const Eigen::Index n = 3 * numNodes;
  TrescaProblem problem{Eigen::MatrixXd(n, n), Eigen::VectorXd(n), Eigen::VectorXd(numNodes)};
  Eigen::MatrixXd mixing(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      mixing(i, j) = number(random) * std::exp(-distance(i / 3, j / 3));
  problem.a = mixing * mixing.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
  for (double& value : problem.b)
    value = 2 * number(random);
  for (double& value : problem.bounds)
    value = friction * std::abs(number(random));
  return problem;
}

/// Three entries a node, no node torn apart.
RCP<const Map> mapOfNodes(int numNodes) {
  const auto nodes = test::linearMap(numNodes);
  std::vector<GlobalOrdinal> mine;
  for (std::size_t i = 0; i < numLocal(*nodes); ++i)
    for (GlobalOrdinal k = 0; k < 3; ++k)
      mine.push_back(3 * nodes->getGlobalElement(static_cast<LocalOrdinal>(i)) + k);
  return makeMap(std::move(mine), nodes->getComm());
}

qp::QuadraticProgram handedOver(const TrescaProblem& problem) {
  const Eigen::Index n = problem.b.size();
  const auto map = mapOfNodes(static_cast<int>(problem.numNodes()));
  std::vector<Disc> discs;
  const auto lower = rcp(new Vector(map));
  for (LocalOrdinal i = 0; i < static_cast<LocalOrdinal>(numLocal(*map)); ++i) {
    const GlobalOrdinal node = map->getGlobalElement(i) / 3;
    if (map->getGlobalElement(i) % 3 == 0)
      discs.push_back({i + 1, i + 2, problem.bounds[static_cast<Eigen::Index>(node)]});
  }
  qp::QuadraticProgram given;
  given.hessian = rcp(new test::DenseOperator(map, problem.a));
  given.linearTerm = test::makeVector(map, problem.b);
  given.set = rcp(new qp::Discs(qp::Box(lower), discs, map));
  given.operatorNorm = problem.a.norm();
  if (problem.isPreconditioned)
    given.preconditioner = rcp(new test::DenseOperator(map, 4 * problem.a.inverse().eval()));
  if (problem.rows.rows() > 0)
    given.equality = rcp(new test::DenseEquality(map, problem.rows));
  EXPECT_EQ(static_cast<Eigen::Index>(map->getGlobalNumElements()), n);
  return given;
}

/// Projection by hand, apart from the library's kernels.
Eigen::VectorXd projected(const TrescaProblem& problem, Eigen::VectorXd x) {
  for (Eigen::Index k = 0; k < problem.numNodes(); ++k) {
    x[3 * k] = std::max(x[3 * k], 0.0);
    const double length = std::hypot(x[3 * k + 1], x[3 * k + 2]);
    if (length > problem.bounds[k])
      x.segment(3 * k + 1, 2) *= problem.bounds[k] / length;
  }
  return x;
}

/// ‖x − P(x − (Ax − b + Bᵀμ)/‖A‖)‖ ‖A‖/‖b‖ with the best μ: 0 at the solution alone.
double naturalResidual(const TrescaProblem& problem, const Eigen::VectorXd& x) {
  const double norm = problem.a.norm();
  Eigen::VectorXd g = problem.a * x - problem.b;
  if (problem.rows.rows() > 0) { // μ from what is free: on a circle along it
    Eigen::MatrixXd free = Eigen::MatrixXd::Zero(x.size(), x.size()); // a projector
    for (Eigen::Index k = 0; k < problem.numNodes(); ++k) {
      free(3 * k, 3 * k) = x[3 * k] > 1e-9 ? 1 : 0;
      const Eigen::Vector2d pair = x.segment(3 * k + 1, 2);
      auto block = free.block(3 * k + 1, 3 * k + 1, 2, 2);
      block.setIdentity();
      if (pair.norm() > problem.bounds[k] * (1 - 1e-9))
        block -= pair.normalized() * pair.normalized().transpose();
    }
    g += problem.rows.transpose() *
         direct::leastSquares(free * problem.rows.transpose(), Eigen::VectorXd(-free * g));
  }
  return (x - projected(problem, x - g / norm)).norm() * norm / problem.b.norm();
}

TEST(TrescaTest, ASingleNodeSlipsAlongItsPush) {
  // Independent entries: x_n = 2; the tangential push (3, 4) against a bound of 1 slips along (0.6, 0.8).
  TrescaProblem problem{Eigen::Matrix3d::Identity(), Eigen::Vector3d(2, 3, 4), Eigen::VectorXd::Ones(1)};
  const auto given = handedOver(problem);
  Vector x(given.linearTerm->getMap());

  const auto report = qp::solveByActiveSets(given, x, {}, {1e-12, 1.0, 1e-10, 1.0}, {});

  EXPECT_EQ(report.status, Status::converged);
  EXPECT_NEAR((test::gather(x) - Eigen::Vector3d(2, 0.6, 0.8)).norm(), 0, 1e-14);
}

TEST(TrescaTest, MprgpAndActiveSetsFindTheSameForces) {
  for (const bool isPreconditioned : {false, true})
    for (const double friction : {0.0, 0.05, 0.5, 5.0})
      for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(testing::Message() << "friction " << friction << ", seed " << seed << ", preconditioned "
                                        << isPreconditioned);
        TrescaProblem problem = trescaProblem(seed, 6, friction);
        problem.isPreconditioned = isPreconditioned;
        const auto given = handedOver(problem);
        Vector byFaces(given.linearTerm->getMap()), byMprgp(byFaces.getMap());

        const auto faces =
            qp::solveByActiveSets(given, byFaces, {}, {1e-10, problem.b.norm(), 1e-10, 1.0}, {});
        EXPECT_EQ(faces.status, Status::converged) << faces.reason;
        EXPECT_LE(naturalResidual(problem, test::gather(byFaces)), 1e-9);
        EXPECT_LE(faces.counts.hessianMultiplications, 150);
        if (seed > 1) // MPRGP takes some twenty times as many products
          continue;
        qp::MprgpParameters limits;
        limits.maxMultiplications = 20000;
        const auto mprgp = qp::solveByMprgp(given, byMprgp, {1e-5, problem.b.norm()}, limits);
        EXPECT_EQ(mprgp.status, Status::converged) << mprgp.reason;
        EXPECT_LE(naturalResidual(problem, test::gather(byMprgp)), 1e-4);
        EXPECT_LE((test::gather(byFaces) - test::gather(byMprgp)).norm(), 1e-3 * problem.b.norm());
      }
}

TEST(TrescaTest, EquilibriumIsHeldBesideTheDiscs) {
  for (const double friction : {0.05, 0.5, 5.0})
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(testing::Message() << "friction " << friction << ", seed " << seed);
      TrescaProblem problem = trescaProblem(seed, 8, friction);
      problem.rows = Eigen::MatrixXd::Zero(1, problem.b.size());
      for (Eigen::Index k = 0; k < problem.numNodes(); ++k) // the sum of all forces along one tangent
        problem.rows(0, 3 * k + 1) = 1 / std::sqrt(static_cast<double>(problem.numNodes()));
      const auto given = handedOver(problem);
      Vector x(given.linearTerm->getMap());

      const auto report = qp::solveByActiveSets(given, x, {}, {1e-10, problem.b.norm(), 1e-10, 1.0}, {});

      EXPECT_EQ(report.status, Status::converged) << report.reason;
      const Eigen::VectorXd found = test::gather(x);
      EXPECT_LE((problem.rows * found).norm(), 1e-10);
      EXPECT_LE(naturalResidual(problem, found), 1e-8);
    }
}

TEST(DiscsTest, AShiftedSetIsTheSetSeenFromElsewhere) {
  const TrescaProblem problem = trescaProblem(3, 5, 0.5);
  const auto given = handedOver(problem);
  const auto map = given.linearTerm->getMap();
  const auto origin = test::makeVector(map, [](int i) { return 0.1 * i - 0.3; }),
             x = test::makeVector(map, [](int i) { return std::sin(3.0 * i); });
  const auto shifted = given.set->shiftedBy(*origin);
  Vector there(*x, Teuchos::Copy), here(*x, Teuchos::Copy);

  shifted->project(there);
  here.update(1.0, *origin, 1.0);
  given.set->project(here);
  here.update(-1.0, *origin, 1.0);

  EXPECT_LE((test::gather(there) - test::gather(here)).norm(), 1e-14);
}

TEST(DiscsTest, APairOnACircleThatGrowsFollowsItsLeaderOutwards) {
  const auto map = mapOfNodes(test::linearMap(1)->getComm()->getSize());
  Disc disc{.first = 1, .second = 2, .radius = 1};
  disc.slope = 0.5;
  const qp::Discs discs(qp::Box(), {disc}, map);
  Vector x(map), g(map);
  x.replaceLocalValue(1, 0.6);
  x.replaceLocalValue(2, -0.8);
  for (const bool isFree : {false, true}) {
    qp::Face face(map);
    face.isFree.replaceLocalValue(0, isFree ? 1.0 : 0.0);

    discs.followBoundary(x, g, 0, nullptr, face);

    ASSERT_EQ(face.followers.size(), isFree ? 2U : 0U) << "only with a leader that moves";
    Vector direction(map);
    direction.replaceLocalValue(0, 2.0);
    face.addFollowers(direction);
    EXPECT_NEAR(direction.getData()[1], isFree ? 0.6 : 0, 1e-15);
    EXPECT_NEAR(direction.getData()[2], isFree ? -0.8 : 0, 1e-15);
  }
}

TEST(DiscsTest, DiscsHaveNoDirectionWithoutAnEnd) {
  const TrescaProblem problem = trescaProblem(3, 5, 0.5);
  const auto given = handedOver(problem);
  const auto map = given.linearTerm->getMap();
  Vector direction(map);
  direction.putScalar(1.0);

  given.set->recessionCone(map)->project(direction);

  const Eigen::VectorXd found = test::gather(direction);
  for (Eigen::Index i = 0; i < found.size(); ++i)
    EXPECT_EQ(found[i], i % 3 == 0 ? 1 : 0);
}

TEST(DiscsTest, TheSumsOfAStepAreThoseOfTheSplitGradient) {
  const TrescaProblem problem = trescaProblem(5, 7, 0.5);
  const auto given = handedOver(problem);
  const auto map = given.linearTerm->getMap();
  const auto x = test::makeVector(map, [](int i) { return std::cos(5.0 * i); }),
             g = test::makeVector(map, [](int i) { return std::sin(2.0 * i + 1); });
  given.set->project(*x);
  Vector free(map), chopped(map), whole(map);
  given.set->subtractFromFreeGradient(*x, *g, 0.0, free);
  given.set->choppedGradient(*x, *g, 0.0, chopped);
  given.set->projectedGradient(*x, *g, 0.0, whole);

  qp::GradientSums sums = given.set->measure(*x, *g, *given.linearTerm, 1e-3);
  std::array<AccurateSum, 3> total{sums.freeSquared, sums.choppedSquared, sums.freeTimesImage};
  sumOverRanks(*map->getComm(), total);

  EXPECT_NEAR(total[0].value(), free.dot(free), 1e-14);
  EXPECT_NEAR(total[1].value(), chopped.dot(chopped), 1e-14);
  EXPECT_NEAR(total[2].value(), free.dot(*given.linearTerm), 1e-14);
  free.update(1.0, chopped, 1.0);
  EXPECT_LE((test::gather(free) - test::gather(whole)).norm(), 1e-15);
}

TEST(DiscsTest, ARadiusBelowZeroIsRefused) {
  const auto map = mapOfNodes(2);
  std::vector<Disc> discs;
  if (numLocal(*map) > 0)
    discs.push_back({1, 2, -1.0});

  EXPECT_THROW(std::ignore = qp::Discs(qp::Box(), discs, map).emptiness(*map), InputError);
}

} // namespace
