#include "epafi/decomposition/RigidModes.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace epafi::decomposition {
namespace {

TEST(RigidModesTest, ALineHoldsNothingAboutItselfUntilItClearlyBends) {
  const RigidModes modes(3, {0, 0, 0}, 1);
  const auto numFree = [&](double bend) -> int {
    std::vector<HeldDirection> held;
    for (const Point& point : {Point{-1, 0, 0}, Point{0, bend, 0}, Point{1, 0, 0}})
      for (int c = 0; c < 3; ++c)
        held.push_back({point, Eigen::Vector3d::Unit(c)});
    const FreeModes free = modes.freeOf(held);
    return free.leastHold < RigidModes::heldFrom ? -1 : static_cast<int>(free.modes.cols());
  };
  for (const double bend : {0.0, 1e-15, 1e-12, 1e-10})
    EXPECT_EQ(numFree(bend), 1) << bend; // turns about the line
  for (const double bend : {1e-5, 1e-3, 1.0})
    EXPECT_EQ(numFree(bend), 0) << bend;
  EXPECT_EQ(numFree(1e-7), -1); // in between it is said, not guessed
}

TEST(RigidModesTest, ASolidOfRevolutionSlidesAlongItsAxisUntilSomethingHoldsThat) {
  const RigidModes modes(2, {1, 5, 0}, 3, true);
  EXPECT_EQ(modes.number(), 1);
  EXPECT_EQ(modes.at({7, 2, 0}, 0)[0], 0);
  EXPECT_EQ(modes.at({7, 2, 0}, 1)[0], 1);
  EXPECT_EQ(modes.twists(), (Eigen::MatrixXd(6, 1) << 0, 1, 0, 0, 0, 0).finished());
  const HeldDirection across{{0, 1, 0}, Eigen::Vector3d::UnitX()},
      slanted{{4, 1, 0}, Eigen::Vector3d(0.6, 0.8, 0)};
  EXPECT_EQ(modes.freeOf(std::vector{across}).modes.cols(), 1);
  EXPECT_EQ(modes.freeOf(std::vector{across, slanted}).modes.cols(), 0);
}

} // namespace
} // namespace epafi::decomposition
