// Friction in random small scenes beside an independent solver.

#include "FrictionTrial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace epafi::fetidp {
namespace {

using namespace test;

/// What came of many draws.
struct Tally {
  int cases = 0, compared = 0, refused = 0, unsolved = 0, others = 0, fallbacks = 0;
  int unrefused = 0; ///< without an equilibrium, and the iteration did not converge, but nobody said why
  std::vector<int> products;
};

double relative(double value, double reference, double scale) {
  return std::abs(value - reference) / std::max(std::abs(reference), scale);
}

/// States of nodes where the reference leaves no doubt.
void expectSameStates(const Trial& trial, const Condensed& reference) {
  constexpr double clear = 1e-6;
  const Eigen::Index n = trial.draw.dimension;
  const VectorXd& lambda = reference.force();
  const VectorXd push = reference.stiffness().cwiseProduct(reference.slip());
  const double least = clear * reference.scaleOf(lambda);
  for (Eigen::Index node = 0; node < trial.state.size(); ++node) {
    if (reference.isIdle(n * node))
      continue;
    const int state = static_cast<int>(trial.state[node]);
    if (std::abs(lambda[n * node]) > least || std::abs(push[n * node]) > least) {
      EXPECT_EQ(state % 2 == 1, lambda[n * node] > least) << "closed, node " << node;
    }
    const double bound = trial.whole.laws[static_cast<std::size_t>(node)].at(lambda[n * node]);
    bool isIdle = false;
    for (Eigen::Index k = 1; k < n; ++k)
      isIdle = isIdle || reference.isIdle(n * node + k);
    if (isIdle || bound <= least)
      continue;
    if (push.segment(n * node + 1, n - 1).norm() > least) {
      EXPECT_LT(state, 2) << "slips, node " << node;
    } else if (lambda.segment(n * node + 1, n - 1).norm() < bound - least) {
      EXPECT_GE(state, 2) << "sticks, node " << node;
    }
  }
}

void compare(const Draw& draw, Tally& tally) {
  SCOPED_TRACE(draw.words);
  ++tally.cases;
  Dice dice(draw.seed + 2000000);
  Trial trial(draw, randomCut(dice, draw.dimension, draw.elements)),
      other(draw, randomCut(dice, draw.dimension, draw.elements));
  trial.solve();
  other.solve();
  Condensed reference(trial.whole);
  const double missing = reference.missing();
  const bool isSolved = missing < 1e-9 && reference.solve();
  EXPECT_EQ(trial.refusal.empty(), other.refusal.empty()) << trial.refusal << other.refusal;
  if (!trial.refusal.empty() || !other.refusal.empty()) {
    ++tally.refused;
    EXPECT_FALSE(isSolved) << trial.refusal << other.refusal << " missing " << missing;
    return;
  }
  if (missing > 1e-9) {
    ++tally.unrefused;
    EXPECT_FALSE(trial.converged() || other.converged()) << "no equilibrium, missing " << missing;
    return;
  }
  if (!isSolved) {
    ++tally.unsolved;
    return;
  }
  ++tally.compared;
  tally.fallbacks += trial.fellBack() ? 1 : 0;
  for (const Trial* each : {&trial, &other}) {
    tally.products.push_back(each->products());
    EXPECT_TRUE(each->converged()) << each->solver->report().reason;
    EXPECT_LE(each->products(), 400);
  }
  const VectorXd u = reference.displacement();
  const double size = std::max(u.lpNorm<Eigen::Infinity>(), 1e-12), work = trial.whole.load.dot(u),
               strain = 0.5 * u.dot(trial.whole.stiffness * u),
               scale = 1e-3 * (strain + std::abs(work)) + 1e-14;
  const double offU = (trial.u - u).lpNorm<Eigen::Infinity>() / size,
               offE = relative(trial.solution.energy, strain - work, scale),
               offW = relative(trial.solution.loadWork, work, scale),
               offCut = (trial.u - other.u).lpNorm<Eigen::Infinity>() / size;
  if (offU > 1e-6) {
    VectorXd balance =
        trial.whole.stiffness * trial.u - trial.whole.load + trial.whole.rows.transpose() * trial.force;
    for (Eigen::Index i = 0; i < balance.size(); ++i)
      if (trial.whole.isHeld[static_cast<std::size_t>(i)])
        balance[i] = 0;
    const VectorXd slip = trial.whole.rows * trial.u - trial.whole.gap;
    const double own = reference.residual(trial.force, slip),
                 unbalanced = balance.lpNorm<Eigen::Infinity>() / reference.scaleOf(trial.force);
    if (std::max(own, unbalanced) < 1e-9) {
      ++tally.others;
      return;
    }
  }
  // bodies that friction alone holds move by more than their forces are off
  const double enough = reference.floats() ? 3e-8 : 1e-8;
  EXPECT_LE(offU, enough);
  EXPECT_LE(offE, 1e-8);
  EXPECT_LE(offW, 1e-8);
  EXPECT_LE(offCut, enough);
  const VectorXd slip = reference.slip();
  double dissipation = 0;
  for (Eigen::Index i = 0; i < slip.size(); ++i)
    dissipation += i % draw.dimension == 0 ? 0 : slip[i] * reference.force()[i];
  EXPECT_NEAR(trial.solution.dissipation, dissipation, 1e-7 * (strain + std::abs(work)));
  expectSameStates(trial, reference);
}

void compareAll(int dimension, Hold hold, unsigned firstSeed, int number) {
  Tally tally;
  for (int i = 0; i < number; ++i)
    compare(drawn(firstSeed + static_cast<unsigned>(i), dimension, hold), tally);
  std::sort(tally.products.begin(), tally.products.end());
  testing::Test::RecordProperty("median_products", tally.products[tally.products.size() / 2]);
  testing::Test::RecordProperty("most_products", tally.products.back());
  testing::Test::RecordProperty("fallbacks", tally.fallbacks);
  EXPECT_LE(10 * tally.unsolved, tally.cases);
  EXPECT_LE(50 * tally.others, tally.cases);
  EXPECT_LE(20 * tally.unrefused, tally.cases);
}

TEST(FrictionRandomTest, HeldBlocksInThePlaneRubAsAnIndependentSolverSays) {
  compareAll(2, Hold::held, 1000, 40);
}
TEST(FrictionRandomTest, BlocksOnASlideInThePlaneRubAsAnIndependentSolverSays) {
  compareAll(2, Hold::slides, 2000, 20);
}
TEST(FrictionRandomTest, BlocksThatFrictionHoldsInThePlaneRestWhereAnIndependentSolverPutsThem) {
  compareAll(2, Hold::floats, 3000, 50);
}
TEST(FrictionRandomTest, BlocksOnBlocksInThePlaneRestWhereAnIndependentSolverPutsThem) {
  compareAll(2, Hold::pair, 4000, 30);
}
TEST(FrictionRandomTest, StacksInThePlaneRestWhereAnIndependentSolverPutsThem) {
  compareAll(2, Hold::stack, 5000, 20);
}
TEST(FrictionRandomTest, HeldCubesRubAsAnIndependentSolverSays) {
  compareAll(3, Hold::held, 6000, 20);
}
TEST(FrictionRandomTest, CubesOnASlideRubAsAnIndependentSolverSays) {
  compareAll(3, Hold::slides, 7000, 10);
}
TEST(FrictionRandomTest, CubesThatFrictionHoldsRestWhereAnIndependentSolverPutsThem) {
  compareAll(3, Hold::floats, 8000, 30);
}
TEST(FrictionRandomTest, CubesOnCubesRestWhereAnIndependentSolverPutsThem) {
  compareAll(3, Hold::pair, 9000, 15);
}

/// Seeds that once failed: a node with a hundredth of the others' force, whose circle is small beside the
/// forces that hold the body.
TEST(FrictionRandomTest, CubesRestWhereOneNodeHardlyPresses) {
  Tally tally;
  for (const unsigned seed : {800034U, 800036U, 800099U, 800236U})
    compare(drawn(seed, 3, Hold::floats), tally);
  for (const unsigned seed : {900008U, 900129U})
    compare(drawn(seed, 3, Hold::pair), tally);
  EXPECT_EQ(tally.compared, 6);
}

} // namespace
} // namespace epafi::fetidp
