#include "epafi/fem/UnknownMap.hpp"

#include "epafi/mesh/StructuredMesh.hpp"

#include <gtest/gtest.h>

namespace epafi::fem {
namespace {

TEST(UnknownMapTest, TheNodesAreThoseOfTheMesh) {
  const mesh::StructuredMesh linear(mesh::rectangle(0, 3, 0, 2), {3, 2, 0});
  std::vector<GlobalOrdinal> nodes(8), elements, around;
  UnknownMap(linear, 2).elementNodes(std::vector<GlobalOrdinal>{0, 5}, nodes);
  EXPECT_EQ(nodes, (std::vector<GlobalOrdinal>{0, 1, 5, 4, 6, 7, 11, 10}));

  const mesh::StructuredMesh mesh(mesh::rectangle(0, 3, 0, 2), {3, 2, 0}, 2);
  const UnknownMap unknowns(mesh, 2);
  EXPECT_EQ(unknowns.numNodes(), 7 * 5);
  EXPECT_EQ(unknowns.nodesPerElement(), 9);
  EXPECT_EQ(unknowns.unknownsPerElement(), 18);
  nodes.resize(9);
  unknowns.elementNodes(std::vector<GlobalOrdinal>{4}, nodes);
  EXPECT_EQ(nodes, (std::vector<GlobalOrdinal>{16, 18, 32, 30, 17, 25, 31, 23, 24}));
  std::vector<int> numbers(mesh.numNodes());
  std::vector<GlobalOrdinal> all;
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    all.push_back(node);
  unknowns.numNodeElements(all, numbers);
  for (const GlobalOrdinal node : all) {
    EXPECT_EQ(unknowns.point(node), mesh.point(node));
    EXPECT_EQ(unknowns.isBoundaryNode(node), mesh.isBoundaryNode(node));
    unknowns.nodeElements(node, elements);
    mesh.nodeElements(node, around);
    EXPECT_EQ(elements, around);
    EXPECT_EQ(numbers[node], static_cast<int>(around.size()));
  }
  EXPECT_EQ(unknowns.surface("top").facetNodes, mesh.surface("top").facetNodes);
}

} // namespace
} // namespace epafi::fem
