#include "epafi/fem/MeshPart.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/StructuredMesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace epafi::fem {
namespace {

using Numbers = std::vector<GlobalOrdinal>;

StructuredMesh meshOf(int dimension, int order) {
  return dimension == 2 ? StructuredMesh({{0, 0, 0}, {3, 2, 0}}, {9, 7, 0}, order)
                        : StructuredMesh({{0, 0, 0}, {3, 2, 1}}, {6, 5, 4}, order);
}

/// A block of elements in the middle, and one that hangs at it by a node.
Numbers ownElements(const StructuredMesh& mesh) {
  const auto [nx, ny, nz] = mesh.elements();
  Numbers own;
  for (int k = mesh.dimension() == 2 ? 0 : 1; k < (mesh.dimension() == 2 ? 1 : 3); ++k)
    for (int j = 2; j < 4; ++j)
      for (int i = 2; i < 4; ++i)
        own.push_back(i + nx * (j + ny * k));
  own.push_back(4 + nx * 4);
  return own;
}

Numbers nodesOf(const Mesh& mesh, const Numbers& elements) {
  Numbers nodes(elements.size() * static_cast<std::size_t>(mesh.nodesPerElement()));
  mesh.elementNodes(elements, nodes);
  return nodes;
}

void expectSameSurfaces(const Mesh& piece, const Mesh& whole) {
  ASSERT_EQ(piece.surfaceNames(), whole.surfaceNames());
  for (const std::string& name : whole.surfaceNames()) {
    const Surface a = piece.surface(name), b = whole.surface(name);
    EXPECT_EQ(a.facetType, b.facetType);
    EXPECT_EQ(a.facetNodes, b.facetNodes);
    EXPECT_EQ(a.elements, b.elements);
    for (const GlobalOrdinal node : b.facetNodes)
      EXPECT_EQ(piece.point(node), whole.point(node));
    EXPECT_EQ(nodesOf(piece, b.elements), nodesOf(whole, b.elements));
  }
}

void expectSame(const MeshPart& piece, const Mesh& whole, const Numbers& own) {
  EXPECT_EQ(piece.numNodes(), whole.numNodes());
  EXPECT_EQ(piece.numElements(), whole.numElements());
  EXPECT_EQ(piece.cellType(), whole.cellType());
  const Numbers nodes = nodesOf(whole, own);
  EXPECT_EQ(nodesOf(piece, own), nodes);
  Numbers a, b;
  for (const GlobalOrdinal node : nodes) {
    EXPECT_EQ(piece.point(node), whole.point(node));
    EXPECT_EQ(piece.isBoundaryNode(node), whole.isBoundaryNode(node));
    piece.nodeElements(node, a);
    whole.nodeElements(node, b);
    EXPECT_EQ(a, b);
    int number = 0;
    piece.numNodeElements(std::span(&node, 1), std::span(&number, 1));
    EXPECT_EQ(number, static_cast<int>(b.size()));
  }
  for (const GlobalOrdinal element : own) {
    piece.elementNeighbours(element, a);
    whole.elementNeighbours(element, b);
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    EXPECT_EQ(a, b);
  }
  expectSameSurfaces(piece, whole);
}

class MeshPartTest : public testing::TestWithParam<std::pair<int, int>> {
protected:
  StructuredMesh whole_ = meshOf(GetParam().first, GetParam().second);
  Numbers own_ = ownElements(whole_);
  MeshPart piece_{PartArrays::unpacked(MeshCutter(whole_).around(own_).packed())};
};

TEST_P(MeshPartTest, OfItsOwnElementsItAnswersAsTheWholeMesh) {
  expectSame(piece_, whole_, own_);
  EXPECT_EQ(piece_.box()[0], whole_.point(0));
  EXPECT_EQ(piece_.box()[1], whole_.point(whole_.numNodes() - 1));
}

TEST_P(MeshPartTest, OfOrder1ItIsThePieceOfTheMeshOfOrder1) {
  expectSame(*piece_.ofOrder1(), meshOf(GetParam().first, 1), own_);
}

TEST_P(MeshPartTest, HoldsWhatTouchesItsNodesOrASurfaceAndNothingElse) {
  Numbers expected = own_, around;
  for (const GlobalOrdinal node : nodesOf(whole_, own_)) {
    whole_.nodeElements(node, around);
    expected.insert(expected.end(), around.begin(), around.end());
  }
  for (const std::string& name : whole_.surfaceNames())
    for (const GlobalOrdinal element : whole_.surface(name).elements)
      expected.push_back(element);
  std::sort(expected.begin(), expected.end());
  expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
  EXPECT_EQ(piece_.elements(), expected);
}

INSTANTIATE_TEST_SUITE_P(DimensionsAndOrders, MeshPartTest,
                         testing::Values(std::pair(2, 1), std::pair(2, 2), std::pair(3, 1), std::pair(3, 2)));

TEST(MeshPartOfManyTest, IsAskedForNothingThatItDoesNotHold) {
  const StructuredMesh whole({{0, 0, 0}, {1, 1, 0}}, {20, 20, 0}, 1);
  const MeshPart piece(MeshCutter(whole).around({21}));
  const GlobalOrdinal far = 10 + 20 * 10;
  Numbers list(4);
  EXPECT_THROW(piece.elementNodes(far, list), Error);
  EXPECT_THROW((void)piece.point(10 + 21 * 10), Error);
  piece.nodeElements(10 + 21 * 10, list);
  EXPECT_TRUE(list.empty());
  EXPECT_LT(piece.elements().size(), 100U); // of 400
}

TEST(MeshPartOfManyTest, WithoutElementsItHoldsTheSurfacesAlone) {
  const StructuredMesh whole({{0, 0, 0}, {1, 1, 0}}, {20, 20, 0}, 2);
  const MeshPart piece(MeshCutter(whole).around({}));
  EXPECT_EQ(piece.elements().size(), 76U);
  expectSameSurfaces(piece, whole);
}

} // namespace
} // namespace epafi::fem
