#include "epafi/fem/LocalNumbering.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace epafi::fem {
namespace {

using Corners = std::vector<GlobalOrdinal>;

/// Two triangles over the nodes 3, 5, 8, 20.
const Corners triangles{5, 3, 20, 3, 20, 8};

std::vector<int> list(std::span<const int> values) {
  return {values.begin(), values.end()};
}

TEST(LocalNumberingTest, NumbersNodesInAscendingOrder) {
  const LocalNumbering numbering(triangles, 3);
  EXPECT_EQ(numbering.numNodes(), 4u);
  EXPECT_EQ(numbering.numElements(), 2u);
  EXPECT_EQ(numbering.nodes(3), (Corners{3, 5, 8, 20}));
  EXPECT_EQ(list(numbering.corners()), (std::vector<int>{1, 0, 3, 0, 3, 2}));
  EXPECT_EQ(list(numbering.elementNodes(1)), (std::vector<int>{0, 3, 2}));
  EXPECT_EQ(list(numbering.numElementsAt()), (std::vector<int>{2, 1, 1, 2}));
}

TEST(LocalNumberingTest, KnowsShiftedCopiesOfItselfAndNothingElse) {
  const LocalNumbering numbering(triangles, 3);
  EXPECT_EQ(numbering.firstNodeIfShifted(triangles), 3);
  Corners other = triangles;
  for (GlobalOrdinal& node : other)
    node += 1000;
  EXPECT_EQ(numbering.firstNodeIfShifted(other), 1003);
  other.back() += 1;
  EXPECT_EQ(numbering.firstNodeIfShifted(other), std::nullopt);
  other.pop_back();
  EXPECT_EQ(numbering.firstNodeIfShifted(other), std::nullopt);
  EXPECT_EQ(numbering.firstNodeIfShifted(Corners{3, 5, 20, 3, 20, 8}), std::nullopt); // other corners first
}

TEST(LocalNumberingTest, TheOrderOfTheElementsDoesNotMatter) {
  Corners strip; // segments of a line, from right to left and from both ends
  for (GlobalOrdinal i = 0; i < 40; ++i) {
    const GlobalOrdinal left = 7 * (i % 2 == 0 ? 39 - i / 2 : i / 2);
    strip.insert(strip.end(), {left, left + 7});
  }
  const LocalNumbering numbering(strip, 2);
  const Corners nodes = numbering.nodes(0);
  ASSERT_EQ(nodes.size(), 41u);
  EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
  for (std::size_t c = 0; c < strip.size(); ++c)
    EXPECT_EQ(nodes[numbering.corners()[c]], strip[c]);
}

} // namespace
} // namespace epafi::fem
