#include "epafi/scene/EdgeContact.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;
using namespace epafi::scene;

TEST(EdgeSegmentTest, RunsUpwardsOrToTheRight) {
  const mesh::Box box = mesh::rectangle(1, 2, 0, 0.5);
  EXPECT_EQ(toString(segmentOf(box, "left")), "x = 1, y from 0 to 0.5");
  EXPECT_EQ(toString(segmentOf(box, "right")), "x = 2, y from 0 to 0.5");
  EXPECT_EQ(toString(segmentOf(box, "bottom")), "y = 0, x from 1 to 2");
  EXPECT_EQ(toString(segmentOf(box, "top")), "y = 0.5, x from 1 to 2");
}

TEST(EdgeSegmentTest, CoincidesUpToATinyPartOfItsLength) {
  for (const double length : {1e-6, 1.0, 1e6}) {
    const EdgeSegment edge{true, 2 * length, 0, length};
    const double little = 0.5e-10 * length, much = 2e-10 * length;
    EXPECT_TRUE(coincide(edge, {true, 2 * length + little, -little, length + little}));
    EXPECT_FALSE(coincide(edge, {true, 2 * length + much, 0, length}));
    EXPECT_FALSE(coincide(edge, {true, 2 * length, -much, length}));
    EXPECT_FALSE(coincide(edge, {true, 2 * length, 0, length + much}));
  }
}

TEST(EdgeSegmentTest, CoincidesBothWaysRoundOrNeither) {
  const EdgeSegment edge{true, 0, 0, 1}, other{true, 0, 0, 1e12}, crossing{false, 0, 0, 1};
  EXPECT_FALSE(coincide(edge, other));
  EXPECT_FALSE(coincide(other, edge));
  EXPECT_FALSE(coincide(edge, crossing));
}

} // namespace
