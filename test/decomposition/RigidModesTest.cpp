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

} // namespace
} // namespace epafi::decomposition
