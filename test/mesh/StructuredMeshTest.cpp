#include "epafi/mesh/StructuredMesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace epafi::mesh {
namespace {

const StructuredMesh oblong(mesh::rectangle(-1, 2, 0.5, 1.5), {3, 2, 0});

bool contains(const std::vector<GlobalOrdinal>& list, GlobalOrdinal value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

TEST(RectangleTest, NumbersNodesAndElementsRowByRow) {
  EXPECT_EQ(oblong.numNodes(), 12);
  EXPECT_EQ(oblong.numElements(), 6);
  EXPECT_EQ(oblong.point(0), (Point{-1, 0.5, 0}));
  EXPECT_EQ(oblong.point(11), (Point{2, 1.5, 0}));
  std::array<GlobalOrdinal, 4> nodes{};
  oblong.elementNodes(4, nodes);
  EXPECT_EQ(nodes, (std::array<GlobalOrdinal, 4>{5, 6, 10, 9}));
}

TEST(RectangleTest, NodesKnowExactlyTheElementsThatKnowThem) {
  std::vector<GlobalOrdinal> elements;
  std::array<GlobalOrdinal, 4> nodes{};
  for (GlobalOrdinal node = 0; node < oblong.numNodes(); ++node) {
    oblong.nodeElements(node, elements);
    for (GlobalOrdinal element = 0; element < oblong.numElements(); ++element) {
      oblong.elementNodes(element, nodes);
      EXPECT_EQ(std::find(nodes.begin(), nodes.end(), node) != nodes.end(), contains(elements, element));
    }
    EXPECT_EQ(oblong.isBoundaryNode(node), elements.size() < 4) << node;
  }
}

/// In the plane and in space, for all sizes that are special: what elements, nodes, sides and points say of
/// each other.
TEST(StructuredMeshTest, OfOrderTwoEverythingFitsTogether) {
  for (const std::array<int, 3>& size : {std::array{3, 2, 0}, {1, 1, 0}, {1, 4, 0}, {2, 3, 2}, {1, 1, 1}}) {
    SCOPED_TRACE(testing::Message() << size[0] << size[1] << size[2]);
    const StructuredMesh quadratic({{-1, 0.5, 2}, {2, 1.5, 3}}, size, 2);
    std::vector<GlobalOrdinal> elements, nodes(static_cast<std::size_t>(quadratic.nodesPerElement())), all;
    std::vector<std::set<GlobalOrdinal>> at(quadratic.numNodes());
    const std::vector<Point> shape = quadratic.elementShape();
    for (GlobalOrdinal e = 0; e < quadratic.numElements(); ++e) {
      quadratic.elementNodes(e, nodes);
      const Point corner = quadratic.point(nodes[0]);
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        at[nodes[i]].insert(e);
        for (std::size_t d = 0; d < 3; ++d)
          EXPECT_NEAR(quadratic.point(nodes[i])[d], corner[d] + shape[i][d], 1e-15);
      }
    }
    std::vector<int> numbers(at.size());
    for (GlobalOrdinal node = 0; node < quadratic.numNodes(); ++node)
      all.push_back(node);
    quadratic.numNodeElements(all, numbers);
    std::set<GlobalOrdinal> onSides;
    for (const std::string& name : quadratic.surfaceNames()) {
      const Surface side = quadratic.surface(name);
      onSides.insert(side.facetNodes.begin(), side.facetNodes.end());
    }
    for (const GlobalOrdinal node : all) {
      const auto& touching = at[node];
      quadratic.nodeElements(node, elements);
      EXPECT_EQ(elements, std::vector<GlobalOrdinal>(touching.begin(), touching.end())) << node;
      EXPECT_EQ(numbers[node], static_cast<int>(touching.size())) << node;
      EXPECT_EQ(quadratic.isBoundaryNode(node), onSides.count(node) > 0) << node;
    }
  }
}

TEST(RectangleTest, ManyAtOnceAreTheSameAsOneByOne) {
  const std::vector<GlobalOrdinal> elements{1, 2, 3, 5, 0, 4}; // runs, a gap, a step back
  std::vector<GlobalOrdinal> all(4 * elements.size());
  oblong.elementNodes(elements, all);
  std::array<GlobalOrdinal, 4> nodes{};
  for (std::size_t e = 0; e < elements.size(); ++e) {
    oblong.elementNodes(elements[e], nodes);
    EXPECT_TRUE(std::equal(nodes.begin(), nodes.end(), all.begin() + static_cast<std::ptrdiff_t>(4 * e)))
        << e;
  }

  for (const std::array<int, 3> size : {std::array{3, 2, 0}, {1, 1, 0}, {1, 4, 0}, {5, 1, 0}}) {
    const StructuredMesh other(mesh::rectangle(0, 1, 0, 1), size);
    std::vector<GlobalOrdinal> touching;
    std::vector<GlobalOrdinal> some; // two of three nodes
    for (GlobalOrdinal node = 0; node < other.numNodes(); ++node)
      if (node % 3 != 1)
        some.push_back(node);
    std::vector<int> numbers(some.size());
    other.numNodeElements(some, numbers);
    for (std::size_t i = 0; i < some.size(); ++i) {
      other.nodeElements(some[i], touching);
      EXPECT_EQ(numbers[i], static_cast<int>(touching.size())) << some[i];
    }
  }
}

TEST(RectangleTest, NeighboursShareTwoNodes) {
  std::vector<GlobalOrdinal> neighbours;
  std::array<GlobalOrdinal, 4> a{}, b{};
  for (GlobalOrdinal element = 0; element < oblong.numElements(); ++element) {
    oblong.elementNeighbours(element, neighbours);
    oblong.elementNodes(element, a);
    for (GlobalOrdinal other = 0; other < oblong.numElements(); ++other) {
      oblong.elementNodes(other, b);
      const auto common = std::count_if(
          a.begin(), a.end(), [&](GlobalOrdinal n) { return std::find(b.begin(), b.end(), n) != b.end(); });
      EXPECT_EQ(contains(neighbours, other), common == 2) << element << ' ' << other;
    }
  }
}

TEST(RectangleTest, EdgesHaveTheNodesOnThem) {
  const std::vector<std::pair<std::string, std::set<GlobalOrdinal>>> edges{
      {"left", {0, 4, 8}}, {"right", {3, 7, 11}}, {"bottom", {0, 1, 2, 3}}, {"top", {8, 9, 10, 11}}};
  std::vector<std::string> names;
  for (const auto& [name, nodes] : edges) {
    names.push_back(name);
    const std::vector<GlobalOrdinal> all = oblong.surface(name).facetNodes;
    EXPECT_EQ(std::set<GlobalOrdinal>(all.begin(), all.end()), nodes) << name;
  }
  EXPECT_EQ(oblong.surfaceNames(), names);
}

TEST(RectangleTest, EndPointsAreExactWhateverTheSpacing) {
  const StructuredMesh fine(mesh::rectangle(0.1, 0.7, -0.3, 0.9), {7, 49, 0});
  EXPECT_EQ(fine.point(fine.numNodes() - 1), (Point{0.7, 0.9, 0}));
}

TEST(RectangleTest, ElementsFillTheRectangle) {
  EXPECT_EQ(oblong.elements(), (std::array<int, 3>{3, 2, 1}));
  EXPECT_EQ(oblong.elementSize(), (Vector3{1, 0.5, 0}));
  EXPECT_EQ(oblong.elementShape(), (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 0.5, 0}, {0, 0.5, 0}}));
}

TEST(RectangleTest, SurfacesRunAroundTheBodyWithItOnTheirLeft) {
  const StructuredMesh plate(mesh::rectangle(1, 4, -2, 0), {5, 3, 0});
  double twiceArea = 0, length = 0;
  for (const std::string& name : plate.surfaceNames()) {
    const Surface surface = plate.surface(name);
    ASSERT_EQ(surface.facetNodes.size(), 2 * surface.elements.size());
    for (std::size_t k = 0; k < surface.elements.size(); ++k) {
      const Point a = plate.point(surface.facetNodes[2 * k]), b = plate.point(surface.facetNodes[2 * k + 1]);
      twiceArea += a[0] * b[1] - a[1] * b[0];
      length += std::hypot(b[0] - a[0], b[1] - a[1]);
      std::array<GlobalOrdinal, 4> corners{};
      plate.elementNodes(surface.elements[k], corners);
      for (std::size_t end = 0; end < 2; ++end)
        EXPECT_NE(std::find(corners.begin(), corners.end(), surface.facetNodes[2 * k + end]), corners.end());
    }
  }
  EXPECT_NEAR(twiceArea, 2 * 6.0, 1e-14);
  EXPECT_NEAR(length, 10.0, 1e-14);
}

} // namespace
} // namespace epafi::mesh
