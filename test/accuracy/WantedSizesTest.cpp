// The mesh that reaches an error with the fewest elements.

#include "epafi/accuracy/WantedSizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <tuple>
#include <vector>

namespace epafi::accuracy {
namespace {

using Values = std::vector<double>;

double total(const Values& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// n = 2^(d·halvings) of each element.
Values partsOf(const WantedSizes& wanted, int dimension) {
  Values parts;
  for (const double halvings : wanted.halvings)
    parts.push_back(std::exp2(dimension * halvings));
  return parts;
}

/// Σ η² n^(−2q/d)
double squaredErrorAfter(const Values& squared, const Values& orders, const Values& parts, int dimension) {
  double sum = 0;
  for (std::size_t e = 0; e < squared.size(); ++e)
    sum += squared[e] * std::pow(parts[e], -2 * orders[e] / dimension);
  return sum;
}

/// Errors over some powers of ten and orders between those of corners and of smooth solutions.
struct Sample {
  Values squared, orders;

  explicit Sample(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-6, 0), order(0.4, 2);
    for (int e = 0; e < 60; ++e) {
      squared.push_back(std::pow(10, exponent(random)));
      orders.push_back(order(random));
    }
  }
  [[nodiscard]] double error() const { return std::sqrt(total(squared)); }
};

constexpr double noLimit = 1e30;

/// All cut alike, η falls like h^q.
TEST(WantedSizesTest, EqualElementsAreHalvedAlikeAndReachTheGoal) {
  for (const int dimension : {2, 3})
    for (const double order : {0.5, 1.0, 2.0})
      for (const double halvings : {0.25, 1.0}) {
        const Values squared(7, 0.01), orders(7, order);
        const double goal = std::sqrt(total(squared)) * std::exp2(-order * halvings);
        const WantedSizes wanted = wantedSizes(squared, orders, {.dimension = dimension, .error = goal});
        for (const double own : wanted.halvings)
          EXPECT_NEAR(own, halvings, 1e-10);
        EXPECT_NEAR(wanted.growth, std::exp2(dimension * halvings), 1e-9);
        EXPECT_NEAR(wanted.error, goal, 1e-10 * goal);
      }
}

TEST(WantedSizesTest, NothingIsAskedForIfTheGoalIsMet) {
  const Values squared{0.01, 0.02, 0.06}, orders{1, 1, 2};
  for (const double goal : {0.3 * (1 + 1e-12), 1.0}) {
    const WantedSizes wanted = wantedSizes(squared, orders, {.error = goal, .coarsening = 2});
    EXPECT_EQ(wanted.halvings, Values(3, 0.0));
    EXPECT_EQ(wanted.growth, 1);
  }
  EXPECT_EQ(wantedSizes(Values(3, 0.0), orders, {.error = 0}).halvings, Values(3, 0.0));
}

TEST(WantedSizesTest, ReachesTheGoalIfNoLimitIsInTheWay) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Sample sample(seed);
    for (const int dimension : {2, 3})
      for (const double share : {0.9, 0.5, 0.1}) {
        const double goal = share * sample.error();
        const WantedSizes wanted =
            wantedSizes(sample.squared, sample.orders,
                        {.dimension = dimension, .error = goal, .growth = noLimit, .mostHalvings = 40});
        const Values parts = partsOf(wanted, dimension);
        EXPECT_NEAR(wanted.error, goal, 1e-9 * goal);
        EXPECT_NEAR(std::sqrt(squaredErrorAfter(sample.squared, sample.orders, parts, dimension)), goal,
                    1e-9 * goal);
        EXPECT_NEAR(wanted.growth, total(parts) / static_cast<double>(parts.size()), 1e-12 * wanted.growth);
      }
  }
}

/// Karush, Kuhn, Tucker: one more part pays everywhere alike, −∂η²/∂n = 2q/d η² n^(−2q/d − 1), less where n
/// cannot fall, more where it cannot rise.
TEST(WantedSizesTest, NoElementWouldUseAPartBetterThanAnother) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Sample sample(seed);
    for (const int dimension : {2, 3})
      for (const double coarsening : {0.0, 0.5}) {
        const RefinementGoal goal{.dimension = dimension,
                                  .error = 0.2 * sample.error(),
                                  .growth = noLimit,
                                  .coarsening = coarsening,
                                  .mostHalvings = 3};
        const WantedSizes wanted = wantedSizes(sample.squared, sample.orders, goal);
        const Values parts = partsOf(wanted, dimension);
        Values free, coarsest, finest;
        for (std::size_t e = 0; e < parts.size(); ++e) {
          const double decay = 2 * sample.orders[e] / dimension;
          const double gain = decay * sample.squared[e] * std::pow(parts[e], -decay - 1);
          (wanted.halvings[e] == -coarsening         ? coarsest
           : wanted.halvings[e] == goal.mostHalvings ? finest
                                                     : free)
              .push_back(gain);
        }
        ASSERT_FALSE(free.empty());
        ASSERT_FALSE(coarsest.empty());
        const auto [least, most] = std::minmax_element(free.begin(), free.end());
        EXPECT_LE(*most, *least * (1 + 1e-9));
        EXPECT_LE(*std::max_element(coarsest.begin(), coarsest.end()), *most * (1 + 1e-9));
        for (const double gain : finest)
          EXPECT_GE(gain, *least * (1 - 1e-9));
      }
  }
}

TEST(WantedSizesTest, MovingPartsFromOneElementToAnotherDoesNotPay) {
  const Sample sample(4);
  constexpr int dimension = 2;
  const WantedSizes wanted = wantedSizes(
      sample.squared, sample.orders, {.error = 0.2 * sample.error(), .growth = noLimit, .mostHalvings = 40});
  const Values best = partsOf(wanted, dimension);
  const double least = squaredErrorAfter(sample.squared, sample.orders, best, dimension);
  for (std::size_t from = 0; from < best.size(); ++from)
    for (std::size_t to = 0; to < best.size(); ++to) {
      if (from == to || best[from] < 1.1)
        continue;
      Values parts = best;
      parts[from] -= 0.05;
      parts[to] += 0.05;
      EXPECT_GE(squaredErrorAfter(sample.squared, sample.orders, parts, dimension), least * (1 - 1e-13));
    }
}

TEST(WantedSizesTest, WhereTheOrderIsLowerElementsGetSmaller) {
  const Values squared(8, 0.01), orders{1, 1, 1, 1, 1, 1, 1, 0.5};
  const WantedSizes wanted = wantedSizes(squared, orders, {.error = 0.03, .growth = noLimit});
  for (std::size_t e = 0; e < 7; ++e)
    EXPECT_GT(wanted.halvings.back(), 1.2 * wanted.halvings[e]);
}

TEST(WantedSizesTest, WhatMakesNoErrorStaysAsItIsOrGetsAsCoarseAsItMay) {
  const Values squared{0.04, 0, 1e-12, 0.04}, orders(4, 1.0);
  for (const double coarsening : {0.0, 1.5}) {
    const WantedSizes wanted =
        wantedSizes(squared, orders, {.error = 0.1, .growth = noLimit, .coarsening = coarsening});
    EXPECT_EQ(wanted.halvings[1], -coarsening);
    EXPECT_EQ(wanted.halvings[2], -coarsening);
    EXPECT_GT(wanted.halvings[0], 1);
    EXPECT_EQ(wanted.halvings[0], wanted.halvings[3]);
  }
}

TEST(WantedSizesTest, AFarGoalIsReachedInEqualStepsEachWithinTheGrowth) {
  const Values orders(5, 1.0);
  for (const auto& [whole, growth, steps] :
       {std::tuple{64.0, 4.0, 3}, {64.0, 8.0, 2}, {10.0, 8.0, 2}, {8.0, 8.0, 1}, {2.0, 8.0, 1}}) {
    Values squared(5, 0.01);
    const double goal = std::sqrt(total(squared) / whole); // order 1 in the plane: η² falls with the parts
    for (int step = 0; step < steps; ++step) {
      const WantedSizes wanted = wantedSizes(squared, orders, {.error = goal, .growth = growth});
      EXPECT_NEAR(wanted.growth, std::pow(whole, 1.0 / steps), 1e-8);
      EXPECT_NEAR(wanted.error, std::sqrt(total(squared) / wanted.growth), 1e-10);
      for (double& own : squared)
        own /= wanted.growth;
    }
    EXPECT_NEAR(std::sqrt(total(squared)), goal, 1e-8 * goal);
  }
}

/// As where neighbours follow: every element, and some of them once more.
TEST(WantedSizesTest, WhatComesByItselfIsNotAskedForAndTheGoalIsStillReached) {
  const Sample sample(4);
  for (const int dimension : {2, 3}) {
    const Outcome more = [dimension](const Values& halvings) {
      Values parts;
      for (const double halving : halvings)
        parts.push_back((parts.size() % 3 == 0 ? 3.0 : 1.5) * std::exp2(dimension * halving));
      return parts;
    };
    const double number = static_cast<double>(sample.squared.size());
    for (const bool isNear : {true, false}) { // else a step on the way
      const RefinementGoal goal{.dimension = dimension,
                                .error = (isNear ? 0.4 : 0.02) * sample.error(),
                                .growth = isNear ? noLimit : 4,
                                .mostHalvings = 40};
      const WantedSizes naive = wantedSizes(sample.squared, sample.orders, goal),
                        wanted = wantedSizes(sample.squared, sample.orders, goal, more);
      const Values parts = more(wanted.halvings);
      EXPECT_NEAR(wanted.growth, total(parts) / number, 1e-12 * wanted.growth);
      EXPECT_NEAR(wanted.error, std::sqrt(squaredErrorAfter(sample.squared, sample.orders, parts, dimension)),
                  1e-12 * wanted.error);
      EXPECT_LT(wanted.growth, 0.8 * total(more(naive.halvings)) / number);
      if (isNear) {
        EXPECT_LE(wanted.error, goal.error);
        EXPECT_GE(wanted.error, 0.8 * goal.error);
      } else {
        EXPECT_GE(wanted.growth, naive.growth);
      }
    }
  }
}

TEST(WantedSizesTest, NoElementIsHalvedMoreOftenThanItMayBe) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Sample sample(seed);
    const WantedSizes wanted =
        wantedSizes(sample.squared, sample.orders,
                    {.error = 1e-6 * sample.error(), .growth = noLimit, .mostHalvings = 2});
    EXPECT_LE(*std::max_element(wanted.halvings.begin(), wanted.halvings.end()), 2);
    EXPECT_GE(*std::min_element(wanted.halvings.begin(), wanted.halvings.end()), 0);
    EXPECT_NEAR(wanted.error,
                std::sqrt(squaredErrorAfter(sample.squared, sample.orders, partsOf(wanted, 2), 2)),
                1e-9 * wanted.error);
  }
}

/// What the others add is no matter beside what cannot be helped at once.
TEST(WantedSizesTest, BesideAnElementThatCanGetNoSmallerTheOthersAreNotRefinedForNothing) {
  const Values squared{1, 1e-3, 1e-3, 1e-3, 1e-3}, orders{0.5, 1, 1, 1, 1};
  const WantedSizes wanted =
      wantedSizes(squared, orders, {.error = 1e-3, .growth = noLimit, .mostHalvings = 4});
  EXPECT_EQ(wanted.halvings[0], 4);
  const double stuck = std::exp2(-4); // η² · 2^(−2q · 4)
  EXPECT_GE(wanted.error * wanted.error, stuck);
  EXPECT_LE(wanted.error * wanted.error, 2 * stuck * (1 + 1e-9));
  for (std::size_t e = 1; e < 5; ++e)
    EXPECT_LT(wanted.halvings[e], 1);
}

} // namespace
} // namespace epafi::accuracy
