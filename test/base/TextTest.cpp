#include "epafi/base/Text.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using namespace epafi;

TEST(TextTest, WritesNumbersPointsAndNames) {
  EXPECT_EQ(text(0.25), "0.25");
  EXPECT_EQ(text(1e-9), "1e-09");
  EXPECT_EQ(text(1.0 / 3, 2), "0.33");
  EXPECT_EQ(text(std::array{1.0, -0.5, 1.0 / 3}), "(1, -0.5, 0.333333)");
  EXPECT_EQ(text(std::array{1.0 / 3, 2.0}, 4), "(0.3333, 2)");
  EXPECT_EQ(inQuotes("left"), "\"left\"");
}

TEST(TextTest, WordsComeBackFromTheirLines) {
  const std::vector<std::string> words{"a b", "", "c"};
  EXPECT_EQ(linesOf(asLines(words)), words);
  EXPECT_TRUE(linesOf("").empty());
}

} // namespace
