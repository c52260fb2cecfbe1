#include "support/Gathered.hpp"

#include "epafi/base/Compatibility.hpp"

#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace epafi::decomposition {
namespace {

/// Tables 1 and 2 of Dostál, Horák, Stefanica, "An Overview of Scalable FETI-DP Algorithms for Variational
/// Inequalities": both problems have the same dimensions. 1/H = 8, H/h = 8 is printed 10365, a misprint of
/// 128 · 81 = 10368.
struct Row {
  int counts, ratio;
  GlobalOrdinal primal, dual, corners;
};
constexpr Row paper[] = {{2, 16, 2312, 153, 10}, {4, 16, 9248, 785, 42}, {8, 16, 36992, 3489, 154},
                         {2, 8, 648, 73, 10},    {4, 8, 2592, 369, 42},  {8, 8, 10368, 1633, 154},
                         {2, 4, 200, 33, 10},    {4, 4, 800, 161, 42},   {8, 4, 3200, 705, 154}};

TEST(DimensionTest, AllEighteenCellsOfThePaperAreReproduced) {
  for (const bool coercive : {true, false})
    for (const Row& row : paper) {
      SCOPED_TRACE((coercive ? "coercive " : "semicoercive ") + std::to_string(row.counts) + ", " +
                   std::to_string(row.ratio));
      const auto result =
          decompose(twoMembranes(coercive, row.counts * row.ratio, grid(row.counts, row.counts)), world());
      EXPECT_EQ(result.problem.primalDimension, row.primal);
      EXPECT_EQ(result.problem.dualDimension(), row.dual);
      EXPECT_EQ(result.problem.numCrosspoints, row.corners);
      EXPECT_EQ(result.problem.numInequalities, row.counts * row.ratio + 1);
      EXPECT_EQ(result.problem.kernelDimension, coercive ? 0 : 1);
      EXPECT_EQ(result.problem.numSubdomains, 2 * row.counts * row.counts);
    }
}

TEST(DimensionTest, MapsHoldExactlyTheNumbersTheyAnnounce) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    const DecomposedProblem& p = result.problem;
    EXPECT_EQ(static_cast<GlobalOrdinal>(p.multiplierMap->getGlobalNumElements()), p.dualDimension());
    if (p.dualDimension() > 0) {
      EXPECT_EQ(p.multiplierMap->getMinAllGlobalIndex(), 0);
      EXPECT_EQ(p.multiplierMap->getMaxAllGlobalIndex(), p.dualDimension() - 1);
    }
    for (const RCP<const Map>& map : {p.multiplierMap, p.crosspointMap})
      if (map->getGlobalNumElements() > 0) { // Tpetra calls a map without entries replicated
        EXPECT_TRUE(map->isOneToOne());
      }
    EXPECT_LE(static_cast<GlobalOrdinal>(p.crosspointMap->getGlobalNumElements()), p.numCrosspoints);
    std::size_t remainders = 0;
    for (const Subdomain& s : p.subdomains)
      remainders += s.remainderUnknowns.size();
    EXPECT_EQ(numLocal(*p.remainderMap), remainders);
    const auto ghosts = localIndices(*p.multiplierGhostMap);
    EXPECT_TRUE(std::is_sorted(ghosts.begin(), ghosts.end()));
  }
}

} // namespace
} // namespace epafi::decomposition
