#include "Gathered.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ConnectedParts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace epafi::decomposition {
namespace {

/// Every element is in exactly one part, as both queries say, and every part is non-empty and connected.
void expectSound(const Partition& partition, const fem::Mesh& mesh) {
  GlobalOrdinal total = 0;
  std::vector<GlobalOrdinal> neighbours;
  for (int part = 0; part < partition.numParts(); ++part) {
    const std::vector<GlobalOrdinal> elements = partition.elementsOf(part);
    ASSERT_FALSE(elements.empty()) << part;
    EXPECT_TRUE(std::is_sorted(elements.begin(), elements.end()));
    std::set<GlobalOrdinal> unseen(elements.begin(), elements.end());
    total += static_cast<GlobalOrdinal>(unseen.size());
    std::vector<GlobalOrdinal> stack{elements.front()};
    unseen.erase(elements.front());
    while (!stack.empty()) {
      const GlobalOrdinal element = stack.back();
      stack.pop_back();
      EXPECT_EQ(partition.partOf(element), part);
      mesh.elementNeighbours(element, neighbours);
      for (const GlobalOrdinal other : neighbours)
        if (unseen.erase(other) > 0)
          stack.push_back(other);
    }
    EXPECT_TRUE(unseen.empty()) << "part " << part << " is not connected";
  }
  EXPECT_EQ(total, mesh.numElements());
}

TEST(PartitionTest, GridsCutIntoEqualPartsThatCoverTheBody) {
  for (const auto& [n, m] : {std::pair{8, 8}, {7, 5}, {3, 11}})
    for (const auto& [a, b] : {std::pair{1, 1}, {2, 2}, {3, 5}, {3, 1}}) {
      const fem::RectangleMesh mesh({0, 1, 0, 1}, {n, m});
      const GridPartition partition(mesh, {a, b});
      EXPECT_EQ(partition.numParts(), a * b);
      expectSound(partition, mesh);
      for (int part = 0; part < a * b; ++part) {
        const auto size = static_cast<int>(partition.elementsOf(part).size());
        EXPECT_GE(size, (n / a) * (m / b));
        EXPECT_LE(size, (n / a + 1) * (m / b + 1));
      }
    }
}

TEST(PartitionTest, GraphPartsAreConnectedAndCoverTheBody) {
  const fem::RectangleMesh mesh({0, 1, 0, 1}, {13, 9});
  for (const int parts : {1, 2, 3, 7, 16, 40, 117}) {
    const GraphPartition partition(mesh, parts, *world());
    EXPECT_LE(partition.numParts(), parts);
    // METIS leaves parts empty when few elements are left for each; with three or more it does not waste half
    // of them.
    EXPECT_GE(partition.numParts(), parts <= 40 ? (parts + 1) / 2 : 40);
    expectSound(partition, mesh);
  }
}

TEST(PartitionTest, GraphPartsAreTheSameOnEveryRank) {
  const fem::RectangleMesh mesh({0, 1, 0, 1}, {13, 9});
  const GraphPartition partition(mesh, 7, *world());
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
    const double part = partition.partOf(element);
    EXPECT_EQ(maxOverRanks(*world(), part), minOverRanks(*world(), part));
  }
}

/// Number of parts that have elements; each of them connected.
int expectConnected(const fem::Mesh& mesh, const std::vector<int>& part) {
  std::set<int> begun;
  std::vector<char> seen(part.size(), 0);
  std::vector<GlobalOrdinal> neighbours;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (seen[seed] != 0)
      continue;
    EXPECT_TRUE(begun.insert(part[seed]).second) << "part " << part[seed] << " is not connected";
    std::vector<GlobalOrdinal> stack{static_cast<GlobalOrdinal>(seed)};
    seen[seed] = 1;
    while (!stack.empty()) {
      mesh.elementNeighbours(stack.back(), neighbours);
      stack.pop_back();
      for (const GlobalOrdinal other : neighbours)
        if (part[static_cast<std::size_t>(other)] == part[seed] &&
            seen[static_cast<std::size_t>(other)]++ == 0)
          stack.push_back(other);
    }
  }
  return static_cast<int>(begun.size());
}

TEST(PartitionTest, PartsInManyPiecesAreMadeConnected) {
  const fem::RectangleMesh mesh({0, 1, 0, 1}, {12, 11});
  const auto size = static_cast<std::size_t>(mesh.numElements());
  std::vector<int> checkerboard(size), stripes(size), scattered(size);
  for (std::size_t e = 0; e < size; ++e) {
    checkerboard[e] = static_cast<int>((e % 12 + e / 12) % 2);
    stripes[e] = static_cast<int>(e / 12 % 2);
    scattered[e] = static_cast<int>(e * 7919 % 13 * (e % 5) % 6);
  }
  for (std::vector<int>* part : {&checkerboard, &stripes, &scattered}) {
    makeConnected(mesh, *part);
    EXPECT_GE(expectConnected(mesh, *part), 1);
  }
  // A stray element goes where most of its edges are.
  std::vector<int> halves(size, 0);
  for (std::size_t e = 0; e < size; ++e)
    halves[e] = e % 12 < 6 ? 0 : 1;
  std::vector<int> withStray = halves;
  withStray[12 * 5 + 2] = 1;
  makeConnected(mesh, withStray);
  EXPECT_EQ(withStray, halves);
}

TEST(PartitionTest, BodiesThatAreMeshedAndCutAlikeShareTheirPartition) {
  scene::Scene scene = twoMembranes(true, 9, metis(7));
  const auto alike = decompose(scene, world());
  EXPECT_EQ(alike.bodies[0].partition, alike.bodies[1].partition);
  scene.bodies[1].decomposition = metis(6);
  const auto different = decompose(scene, world());
  EXPECT_NE(different.bodies[0].partition, different.bodies[1].partition);
  scene.bodies[1].decomposition = grid(3, 3);
  EXPECT_EQ(decompose(scene, world()).bodies[1].partition->numParts(), 9);
}

TEST(PartitionTest, ImpossibleCountsAreRefused) {
  const fem::RectangleMesh mesh({0, 1, 0, 1}, {3, 2});
  EXPECT_THROW(GraphPartition(mesh, 0, *world()), InputError);
  EXPECT_THROW(GraphPartition(mesh, 7, *world()), InputError);
  EXPECT_NO_THROW(GraphPartition(mesh, 6, *world()));
}

} // namespace
} // namespace epafi::decomposition
