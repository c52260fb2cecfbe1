#include "epafi/fem/RecentlyUsed.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

bool knows(RecentlyUsed<int>& things, int thing) {
  return things.find([thing](int known) { return known == thing; }) != nullptr;
}

TEST(RecentlyUsedTest, DropsWhatWasNotUsedForLongest) {
  RecentlyUsed<int> things(2, 100);
  EXPECT_FALSE(knows(things, 1));
  things.add(1, 1);
  things.add(2, 1);
  EXPECT_TRUE(knows(things, 1)); // used: 2 is the older one now
  things.add(3, 1);
  EXPECT_FALSE(knows(things, 2));
  EXPECT_TRUE(knows(things, 1));
  EXPECT_TRUE(knows(things, 3));
}

TEST(RecentlyUsedTest, KeepsNoMoreThanItsSizeButAlwaysTheNewest) {
  RecentlyUsed<int> things(9, 10);
  things.add(1, 6);
  things.add(2, 4);
  EXPECT_TRUE(knows(things, 1));
  EXPECT_TRUE(knows(things, 2));
  const auto huge = things.add(3, 11);
  EXPECT_FALSE(knows(things, 1));
  EXPECT_FALSE(knows(things, 2));
  EXPECT_TRUE(knows(things, 3));
  things.add(4, 1);
  EXPECT_FALSE(knows(things, 3));
  EXPECT_EQ(*huge, 3); // still alive for its holder
}

} // namespace
} // namespace epafi::fem
