#include "epafi/qp/solve/ProgressWatch.hpp"

#include <gtest/gtest.h>

namespace {

using epafi::qp::ProgressWatch;

TEST(ProgressWatchTest, StandsStillAfterAsManyIdleStepsAsItsPatience) {
  ProgressWatch watch(3);
  watch.look(1, 1);

  for (int step = 0; step < 2; ++step) {
    watch.look(1, 1);
    EXPECT_FALSE(watch.standsStill());
  }
  watch.look(1, 1);

  EXPECT_TRUE(watch.standsStill());
}

TEST(ProgressWatchTest, AGradientBelowNineTenthsOfItsBestIsProgress) {
  ProgressWatch watch(2);
  for (double gradient = 1; gradient > 1e-8; gradient *= 0.89) {
    watch.look(gradient, 0);
    EXPECT_FALSE(watch.standsStill());
  }
}

TEST(ProgressWatchTest, AGradientThatFallsByLessIsNone) {
  ProgressWatch watch(5);
  watch.look(1, 0);

  for (const double gradient : {0.99, 0.98, 0.97, 0.96, 0.95})
    watch.look(gradient, 0);

  EXPECT_TRUE(watch.standsStill());
}

TEST(ProgressWatchTest, SmallStepsAddUp) {
  ProgressWatch watch(11); // 0.99¹¹ < 0.9
  double gradient = 1;
  for (int step = 0; step < 200; ++step) {
    watch.look(gradient, 0);
    EXPECT_FALSE(watch.standsStill()) << step;
    gradient *= 0.99;
  }
}

TEST(ProgressWatchTest, AnObjectiveThatFallsIsProgressWhileTheGradientGrows) {
  ProgressWatch watch(2);
  for (int step = 0; step < 20; ++step) {
    watch.look(1 + step, -step);
    EXPECT_FALSE(watch.standsStill());
  }
}

TEST(ProgressWatchTest, AnObjectiveThatFallsByRoundOffIsNone) {
  ProgressWatch watch(4);
  for (int step = 0; step < 10; ++step)
    watch.look(1, 1e6 - 1e-10 * step);

  EXPECT_TRUE(watch.standsStill());
}

TEST(ProgressWatchTest, NanIsNoProgress) {
  ProgressWatch watch(2);
  watch.look(1, 1);

  for (int step = 0; step < 2; ++step)
    watch.look(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN());

  EXPECT_TRUE(watch.standsStill());
}

TEST(ProgressWatchTest, ForgivenItWaitsAsLongAgainButRemembersTheBest) {
  ProgressWatch watch(2);
  for (int step = 0; step < 3; ++step)
    watch.look(1, 1);
  ASSERT_TRUE(watch.standsStill());

  watch.forgive();
  EXPECT_FALSE(watch.standsStill());
  watch.look(5, 5);
  watch.look(4, 4); // falls, but not below the best
  EXPECT_TRUE(watch.standsStill());
}

TEST(ProgressWatchTest, RestartedItRemembersNothing) {
  ProgressWatch watch(2);
  for (int step = 0; step < 3; ++step)
    watch.look(1, 1);

  watch.restart();
  watch.look(5, 5);
  watch.look(4, 4);
  watch.look(3, 3);

  EXPECT_FALSE(watch.standsStill());
}

} // namespace
