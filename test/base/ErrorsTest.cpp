#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

#include <vector>

using epafi::editDistance;
using epafi::nearestName;

TEST(NearestNameTest, CountsSingleLetterEditsAndIgnoresCase) {
  EXPECT_EQ(editDistance("", ""), 0u);
  EXPECT_EQ(editDistance("", "abc"), 3u);
  EXPECT_EQ(editDistance("Elements", "elements"), 0u);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
}

TEST(NearestNameTest, FindsTheNameWithAMissingLetter) {
  const std::vector<std::string> names = {"Rectangle", "Elements", "Conductivity"};
  EXPECT_EQ(nearestName("Elemnts", names), "Elements");
  EXPECT_EQ(nearestName("conductivty", names), "Conductivity");
}

TEST(NearestNameTest, SuggestsNothingWhereNothingIsNear) {
  const std::vector<std::string> names = {"Rectangle", "Elements"};
  EXPECT_EQ(nearestName("Zwölf", names), "");
  EXPECT_EQ(nearestName("Gap", std::vector<std::string>()), "");
}
