#include "support/Problems.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/qp/constraints/Box.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using qp::Box;

TEST(BoxTest, ProjectsOntoTheNearestFeasibleValue) {
  const Box::Interval interval{-1, 2};

  EXPECT_EQ(interval.project(-3), -1);
  EXPECT_EQ(interval.project(0.5), 0.5);
  EXPECT_EQ(interval.project(7), 2);
}

TEST(BoxTest, SplitsTheGradientInFreeAndChoppedPart) {
  const Box::Interval interval{0, 1};

  EXPECT_EQ(interval.freeGradient(0.5, -3), -3);
  EXPECT_EQ(interval.choppedGradient(0.5, -3), 0);
  EXPECT_EQ(interval.freeGradient(0, -3), 0);
  EXPECT_EQ(interval.choppedGradient(0, -3), -3) << "descent leads inside";
  EXPECT_EQ(interval.choppedGradient(0, 3), 0) << "descent leads outside";
  EXPECT_EQ(interval.choppedGradient(1, 3), 3);
  EXPECT_EQ(interval.choppedGradient(1, -3), 0);
}

TEST(BoxTest, FixedEntriesHaveNoProjectedGradient) {
  const Box::Interval fixed{2, 2};

  for (const double g : {-1.0, 0.0, 1.0}) {
    EXPECT_EQ(fixed.freeGradient(2, g), 0);
    EXPECT_EQ(fixed.choppedGradient(2, g), 0);
  }
}

TEST(BoxTest, ReducedFreeGradientKeepsTheStepFeasible) {
  const Box::Interval interval{0, 1};
  const double step = 0.5;

  for (const double x : {0.1, 0.5, 0.9})
    for (const double g : {-10.0, -0.1, 0.1, 10.0}) {
      const double end = x - step * interval.reducedFreeGradient(x, g, step);
      EXPECT_GE(end, -1e-15);
      EXPECT_LE(end, 1 + 1e-15);
    }
}

TEST(BoxTest, LongestFeasibleStepEndsOnTheBound) {
  const Box::Interval interval{-2, 3};

  EXPECT_DOUBLE_EQ(1 - interval.maxFeasibleStep(1, 4) * 4, -2);
  EXPECT_DOUBLE_EQ(1 - interval.maxFeasibleStep(1, -4) * -4, 3);
  EXPECT_EQ(interval.maxFeasibleStep(1, 0), test::unbounded);
  EXPECT_EQ((Box::Interval{-test::unbounded, test::unbounded}).maxFeasibleStep(1, 5), test::unbounded);
}

TEST(BoxTest, WhatIsMadeActiveMovesToTheNearerBoundIfOneIsNearer) {
  const auto map = test::linearMap(5);
  const auto lower = test::makeVector(map, [](int i) { return i == 4 ? -test::unbounded : 0.0; });
  const auto upper = test::makeVector(map, [](int i) { return i < 2 ? test::unbounded : 1.0; });
  const auto x =
      test::makeVector(map, Eigen::VectorXd((Eigen::VectorXd(5) << 7, 0.3, 0.7, 0.5, -3).finished()));
  Vector all(map);
  all.putScalar(1.0);

  Box(lower, upper).activate(all, *x);

  EXPECT_EQ(test::gather(*x), (Eigen::VectorXd(5) << 0, 0, 1, 0.5, 1).finished());
}

TEST(BoxTest, CrossingBoundsAreNamedOnAllRanks) {
  const auto map = test::linearMap(5);
  const auto lower = test::makeVector(map, [](int i) { return i == 3 ? 2.0 : 0.0; });
  const auto upper = test::makeVector(map, [](int) { return 1.0; });

  EXPECT_NE(Box(lower, upper).emptiness(*map).find("entry 3"), std::string::npos);
  EXPECT_EQ(Box(upper, upper).emptiness(*map), "");
  EXPECT_EQ(Box().emptiness(*map), "");
}

TEST(BoxTest, NanBoundsAreRefused) {
  const auto map = test::linearMap(5);
  const auto lower = test::makeVector(map, [](int i) { return i == 0 ? std::nan("") : 0.0; });

  EXPECT_THROW(std::ignore = Box(lower).emptiness(*map), InputError);
}

} // namespace
