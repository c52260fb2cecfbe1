// Clusters where the scene leaves their size open.

#include "epafi/model/ClusterSize.hpp"

#include "epafi/meshing/Partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace epafi::model {
namespace {

using Counts = std::array<int, 3>;

mesh::StructuredMesh bricks(const Vector3& sides, const Counts& elements) {
  return mesh::StructuredMesh(mesh::Box{{0, 0, 0}, sides}, elements);
}

int sizeOf(const Counts& counts, GlobalOrdinal numSubdomains, int numRanks) {
  return clusterSizeFor(bricks({1, 1, 1}, {2 * counts[0], 2 * counts[1], 2 * counts[2]}), counts,
                        numSubdomains, numRanks);
}

TEST(ClusterSizeTest, FewSubdomainsOrRanksShareOneCoarseProblem) {
  EXPECT_EQ(sizeOf({16, 16, 16}, 8192, 1), 0);
  EXPECT_EQ(sizeOf({4, 4, 4}, 128, 4), 0);
  EXPECT_EQ(sizeOf({12, 12, 12}, 3456, 2), 0);
  EXPECT_GT(sizeOf({16, 16, 16}, 8192, 2), 0);
  const mesh::StructuredMesh plane(mesh::rectangle(0, 1, 0, 1), {256, 256, 0}, 1);
  EXPECT_EQ(clusterSizeFor(plane, {128, 128, 1}, 32768, 8), 0);
  EXPECT_EQ(clusterSizeFor(plane, {128, 128, 1}, 32768, 64), 64);
}

/// Ranks with less than a cluster share one: smaller ones take too many products.
TEST(ClusterSizeTest, IsTheSameOnAnyNumberOfRanksFromSomeOn) {
  for (const int numRanks : {3, 16, 100, 1000})
    EXPECT_EQ(sizeOf({16, 16, 16}, 4096, numRanks), 64);
}

TEST(ClusterSizeTest, BodiesThatCannotBeHalvedShareOneCoarseProblem) {
  EXPECT_EQ(sizeOf({17, 17, 17}, 2 * 4913, 8), 0);
  EXPECT_EQ(sizeOf({10, 10, 10}, 20'000, 8), 0) << "5 × 5 × 5 are more than 64, and odd";
}

/// Bounding boxes of the runs of parts hold nothing but them.
TEST(ClusterSizeTest, RunsOfSuchSizesAreBlocks) {
  struct Case {
    Vector3 sides;
    Counts counts;
  };
  for (const Case& c : {Case{{1, 1, 1}, {12, 12, 12}}, Case{{4, 2, 1}, {16, 8, 8}},
                        Case{{1, 3, 1}, {8, 24, 8}}, Case{{9, 1, 1}, {4, 8, 16}}}) {
    const mesh::StructuredMesh mesh = bricks(c.sides, c.counts); // an element each
    const int size = clusterSizeFor(mesh, c.counts, 20'000, 8),
              number = c.counts[0] * c.counts[1] * c.counts[2];
    ASSERT_GT(size, 0);
    EXPECT_EQ(number % size, 0);
    const meshing::GroupedPartition grouped(std::make_shared<const meshing::GridPartition>(mesh, c.counts),
                                            mesh, size);
    for (int first = 0; first < number; first += size) {
      Counts low, high;
      low.fill(std::numeric_limits<int>::max());
      high.fill(0);
      for (int part = first; part < first + size; ++part) {
        const auto element = static_cast<int>(grouped.elementsOf(part).front());
        const Counts place{element % c.counts[0], element / c.counts[0] % c.counts[1],
                           element / c.counts[0] / c.counts[1]};
        for (std::size_t d = 0; d < 3; ++d) {
          low[d] = std::min(low[d], place[d]);
          high[d] = std::max(high[d], place[d] + 1);
        }
      }
      EXPECT_EQ((high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]), size) << first;
    }
  }
}

} // namespace
} // namespace epafi::model
