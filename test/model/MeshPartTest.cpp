// What a rank holds of a mesh that is dealt out answers as the whole mesh does, wherever its elements were
// before.

#include "support/Gathered.hpp"
#include "support/Refusal.hpp"

#include "epafi/base/SortUnique.hpp"
#include "epafi/mesh/MeshPart.hpp"
#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/model/MeshPieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace epafi::decomposition {
namespace {

using mesh::Mesh;
using mesh::MeshPart;
using mesh::StructuredMesh;
using mesh::Surface;
using Numbers = std::vector<GlobalOrdinal>;

StructuredMesh meshOf(int dimension, int order) {
  return dimension == 2 ? StructuredMesh({{0, 0, 0}, {3, 2, 0}}, {9, 7, 0}, order)
                        : StructuredMesh({{0, 0, 0}, {3, 2, 1}}, {9, 5, 4}, order);
}

Numbers nodesOf(const Mesh& mesh, const Numbers& elements) {
  Numbers nodes(elements.size() * static_cast<std::size_t>(mesh.nodesPerElement()));
  mesh.elementNodes(elements, nodes);
  return nodes;
}

/// Two columns of elements or more a rank, but none on the last of several.
class Columns {
public:
  explicit Columns(const StructuredMesh& mesh)
      : ranks_(world()->getSize()), grid_(mesh, {2 * ranks_, 1, 1}) {}
  [[nodiscard]] const GridPartition& grid() const { return grid_; }
  [[nodiscard]] model::Share own() const {
    return {endOf(world()->getRank()), endOf(world()->getRank() + 1)};
  }
  [[nodiscard]] Numbers ownElements() const {
    Numbers all;
    for (int part = own().begin; part < own().end; ++part) {
      const Numbers some = grid_.elementsOf(part);
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }

private:
  [[nodiscard]] int endOf(int rank) const {
    return ranks_ == 1 ? 2 * rank : std::min(rank * 2 * ranks_ / (ranks_ - 1), 2 * ranks_);
  }
  int ranks_;
  GridPartition grid_;
};

/// Nobody but the mesh knows of these numbers.
GlobalOrdinal keyOf(GlobalOrdinal node) {
  return 3 * node + 5;
}

/// The elements in turn on all ranks, in one group those of odd numbers.
meshing::LooseMesh scattered(const StructuredMesh& mesh, const Columns& columns) {
  meshing::LooseMesh loose;
  loose.cellType = mesh.cellType();
  loose.numParts = columns.grid().numParts();
  loose.groups = {"every one", "none", "odd"};

  loose.elements = meshing::LooseElements(3, static_cast<std::size_t>(mesh.nodesPerElement()));
  const auto isHere = [](GlobalOrdinal element) {
    return element % world()->getSize() == world()->getRank();
  };
  for (GlobalOrdinal element = mesh.numElements() - 1; element >= 0; --element) {
    if (!isHere(element))
      continue;
    Numbers keys;
    for (const GlobalOrdinal node : mesh::ElementNodes(mesh, element)) {
      keys.push_back(keyOf(node));
      const bool isCorner = keys.size() <= static_cast<std::size_t>(numCornersOf(mesh.cellType()));
      loose.nodes.push_back({keyOf(node), mesh.point(node), isCorner});
    }
    loose.elements.add(element, columns.grid().partOf(element), keys);
    loose.elements.setIn(loose.elements.size() - 1, 0);
    if (element % 2 == 1)
      loose.elements.setIn(loose.elements.size() - 1, 2);
  }
  meshing::FacetList own;
  for (const std::string& name : mesh.surfaceNames()) {
    const Surface surface = mesh.surface(name);
    for (std::size_t f = 0; f < surface.numFacets(); ++f) {
      if (!isHere(surface.elements[f]))
        continue;
      Numbers corners;
      for (int i = numCornersOf(surface.facetType) - 1; i >= 0; --i) // any order will do
        corners.push_back(keyOf(surface.facet(f)[i]));
      own.add(name, corners);
    }
  }
  loose.facets = std::make_shared<const meshing::FacetList>(gathered(own, *world()));

  return loose;
}

void expectSameSurfaces(const Mesh& piece, const Mesh& whole) {
  std::vector<std::string> names = whole.surfaceNames();
  std::sort(names.begin(), names.end());
  ASSERT_EQ(piece.surfaceNames(), names);
  for (const std::string& name : names) {
    const Surface a = piece.surface(name), b = whole.surface(name);
    EXPECT_EQ(a.facetType, b.facetType);
    EXPECT_EQ(a.facetNodes, b.facetNodes);
    EXPECT_EQ(a.elements, b.elements);
    for (const GlobalOrdinal node : b.facetNodes) {
      EXPECT_EQ(piece.point(node), whole.point(node));
      EXPECT_TRUE(piece.isBoundaryNode(node));
    }
    EXPECT_EQ(nodesOf(piece, b.elements), nodesOf(whole, b.elements));
  }
}

void expectSame(const Mesh& piece, const Mesh& whole, const Numbers& own) {
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
  Columns columns_{whole_};
  Numbers own_ = columns_.ownElements();
  BodyLayout body_;

  const MeshPart& dealtOut() {
    dealOut(scattered(whole_, columns_), columns_.own(), *world(), body_);
    return *body_.mesh->part();
  }
};

TEST_P(MeshPartTest, OfItsOwnElementsItAnswersAsTheWholeMesh) {
  const MeshPart& piece = dealtOut();
  expectSame(piece, whole_, own_);
  EXPECT_EQ(piece.box()[0], whole_.point(0));
  EXPECT_EQ(piece.box()[1], whole_.point(whole_.numNodes() - 1));
  EXPECT_EQ(body_.partition->numParts(), columns_.grid().numParts());
  for (int part = columns_.own().begin; part < columns_.own().end; ++part)
    EXPECT_EQ(body_.partition->elementsOf(part), columns_.grid().elementsOf(part));
  for (const GlobalOrdinal element : piece.elements())
    EXPECT_EQ(body_.partition->partOf(element), columns_.grid().partOf(element));
}

TEST_P(MeshPartTest, OfOrder1ItIsThePieceOfTheMeshOfOrder1) {
  expectSame(*dealtOut().ofOrder1(), meshOf(GetParam().first, 1), own_);
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
  sortUnique(expected);
  EXPECT_EQ(dealtOut().elements(), expected);
}

TEST_P(MeshPartTest, GroupsHoldWhatItHoldsOfThem) {
  const MeshPart& piece = dealtOut();
  EXPECT_EQ(piece.groupNames(), (std::vector<std::string>{"every one", "odd"})); // and not those of nothing
  EXPECT_EQ(piece.group("every one"), piece.elements());
  Numbers odd = piece.elements();
  std::erase_if(odd, [](GlobalOrdinal element) { return element % 2 == 0; });
  EXPECT_EQ(piece.group("odd"), odd);
}

INSTANTIATE_TEST_SUITE_P(DimensionsAndOrders, MeshPartTest,
                         testing::Values(std::pair(2, 1), std::pair(2, 2), std::pair(3, 1), std::pair(3, 2)));

class DealtMeshTest : public testing::Test {
protected:
  StructuredMesh whole_{{{0, 0, 0}, {1, 1, 0}}, {40, 20, 0}, 1};
  Columns columns_{whole_};
  BodyLayout body_;

  /// One more in the surface "bottom".
  meshing::LooseMesh withFacet(const Numbers& corners) const {
    meshing::LooseMesh loose = scattered(whole_, columns_);
    meshing::FacetList facets = *loose.facets;
    facets.add("bottom", corners);
    loose.facets = std::make_shared<const meshing::FacetList>(gathered(facets, *world()));
    return loose;
  }
  void expectRefused(meshing::LooseMesh loose, const std::string& words) {
    epafi::test::expectSays(
        epafi::test::refusal([&] { dealOut(std::move(loose), columns_.own(), *world(), body_); }), {words});
  }
};

TEST_F(DealtMeshTest, APieceIsAskedForNothingThatItDoesNotHold) {
  dealOut(scattered(whole_, columns_), columns_.own(), *world(), body_);
  if (columns_.own().end - columns_.own().begin == columns_.grid().numParts())
    GTEST_SKIP() << "this rank holds all";
  const bool isLeft = world()->getRank() == 0;
  const GlobalOrdinal far = (isLeft ? 35 : 4) + 40 * 10, node = (isLeft ? 35 : 4) + 41 * 10;
  Numbers list(4);
  EXPECT_THROW(body_.mesh->elementNodes(far, list), Error);
  EXPECT_THROW((void)body_.mesh->point(node), Error);
  body_.mesh->nodeElements(node, list);
  EXPECT_TRUE(list.empty());
}

TEST_F(DealtMeshTest, FacetsInsideAreRefused) {
  expectRefused(withFacet({keyOf(5 + 41 * 3), keyOf(5 + 41 * 4)}), "lies inside the body");
}

TEST_F(DealtMeshTest, FacetsOfOtherBodiesDoNotMatter) {
  for (const Numbers& corners : {Numbers{1, 2},                          // nodes that it does not have
                                 Numbers{keyOf(0), keyOf(1), keyOf(41)}, // of another kind
                                 Numbers{keyOf(0), keyOf(41 * 20)},      // none of its own
                                 Numbers{keyOf(0), keyOf(1)}}) {         // and one that comes twice
    dealOut(withFacet(corners), columns_.own(), *world(), body_);
    expectSameSurfaces(*body_.mesh, whole_);
  }
}

TEST_F(DealtMeshTest, ThreeElementsAtAFacetAreRefused) {
  meshing::LooseMesh loose = scattered(whole_, columns_);
  if (world()->getRank() == 0) {
    const Numbers keys{keyOf(0), keyOf(1), keyOf(42), keyOf(41)};
    for (const GlobalOrdinal more : {0, 1})
      loose.elements.add(whole_.numElements() + more, 0, keys);
  }
  expectRefused(std::move(loose), "share a facet");
}

TEST_F(DealtMeshTest, ElementsThatShareTheCornersOfAFacetAloneAreRefused) {
  const StructuredMesh quadratic({{0, 0, 0}, {1, 1, 0}}, {9, 4, 0}, 2);
  const Columns columns(quadratic);
  meshing::LooseMesh loose = scattered(quadratic, columns), torn = loose;
  torn.elements = meshing::LooseElements(3, 9);
  const GlobalOrdinal between = 2 + 19, other = keyOf(quadratic.numNodes()); // on the edge of two elements
  for (std::size_t e = 0; e < loose.elements.size(); ++e) {
    Numbers nodes(loose.elements.nodes(e).begin(), loose.elements.nodes(e).end());
    if (loose.elements.number(e) == 1) {
      std::replace(nodes.begin(), nodes.end(), keyOf(between), other);
      torn.nodes.push_back({other, quadratic.point(between), false});
    }
    torn.elements.add(loose.elements.number(e), loose.elements.part(e), nodes);
  }
  epafi::test::expectSays(
      epafi::test::refusal([&] { dealOut(std::move(torn), columns.own(), *world(), body_); }),
      {"share the corners of a facet, but not node"});
}

TEST_F(DealtMeshTest, PartsThatAreNotJoinedInFacetsAreRefused) {
  meshing::LooseMesh loose = scattered(whole_, columns_);
  const int last = loose.numParts++; // at a corner of the body
  const GlobalOrdinal corner = keyOf(whole_.numNodes() - 1), key = 10 * corner;
  if (world()->getRank() == 0) {
    loose.elements.add(whole_.numElements(), last, Numbers{corner, key, key + 1, key + 2});
    for (int i = 0; i < 3; ++i)
      loose.nodes.push_back({key + i, {2, 2, 0}, true});
  }
  auto own = columns_.own();
  own.end += own.end == last ? 1 : 0; // on all ranks behind the last part, too
  epafi::test::expectSays(epafi::test::refusal([&] { dealOut(std::move(loose), own, *world(), body_); }),
                          {"not joined"});
}

TEST_F(DealtMeshTest, NodesAtTwoPlacesAreRefused) {
  meshing::LooseMesh loose = scattered(whole_, columns_);
  if (world()->getRank() == world()->getSize() - 1)
    loose.nodes.push_back({keyOf(7), {7, 7, 0}, true});
  expectRefused(std::move(loose), "different places");
}

} // namespace
} // namespace epafi::decomposition
