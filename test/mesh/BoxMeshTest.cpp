#include "epafi/mesh/StructuredMesh.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace epafi::mesh {
namespace {

using Corners = std::array<GlobalOrdinal, 8>;

const Box brick{{-1, 0.5, 2}, {2, 1.5, 2.5}}; // 3 × 1 × ½

/// The general case, one element, one row of elements in each direction, one layer in each direction.
const std::vector<std::array<int, 3>> boxSizes{{3, 2, 4}, {1, 1, 1}, {4, 1, 1}, {1, 4, 1},
                                               {1, 1, 4}, {1, 3, 2}, {3, 1, 2}, {3, 2, 1}};

StructuredMesh meshOf(const std::array<int, 3>& size) {
  return {brick, size};
}

Corners cornersOf(const StructuredMesh& mesh, GlobalOrdinal element) {
  Corners corners{};
  mesh.elementNodes(element, corners);
  return corners;
}

template <class List>
bool contains(const List& list, GlobalOrdinal value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

Eigen::Vector3d at(const Mesh& mesh, GlobalOrdinal node) {
  const Point p = mesh.point(node);
  return {p[0], p[1], p[2]};
}

TEST(BoxMeshTest, NumbersNodesAndElementsXFirstThenYThenZ) {
  const StructuredMesh mesh(brick, {3, 2, 4});
  EXPECT_EQ(mesh.numNodes(), 60);
  EXPECT_EQ(mesh.numElements(), 24);
  EXPECT_EQ(mesh.nodesPerElement(), 8);
  EXPECT_EQ(mesh.point(0), (Point{-1, 0.5, 2}));
  EXPECT_NEAR(mesh.point(1)[0], 0, 1e-15);
  EXPECT_EQ(mesh.point(4), (Point{-1, 1, 2}));
  EXPECT_EQ(mesh.point(12), (Point{-1, 0.5, 2.125}));
  EXPECT_EQ(mesh.point(59), (Point{2, 1.5, 2.5}));
  EXPECT_EQ(cornersOf(mesh, 0), (Corners{0, 1, 5, 4, 12, 13, 17, 16}));
  EXPECT_EQ(cornersOf(mesh, 1 + 3 * (1 + 2 * 2)), (Corners{29, 30, 34, 33, 41, 42, 46, 45})); // (1,1,2)
}

TEST(BoxMeshTest, CornersOfElementsLieAsThoseOfTheUnitCube) {
  const std::array<Eigen::Vector3d, 8> cube{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    const Vector3 side = mesh.elementSize();
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_DOUBLE_EQ(side[d] * size[d], brick.upper[d] - brick.lower[d]);
    for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
      const Corners corners = cornersOf(mesh, element);
      for (std::size_t c = 0; c < 8; ++c) {
        const Eigen::Vector3d expected =
            at(mesh, corners[0]) + cube[c].cwiseProduct(Eigen::Vector3d(side[0], side[1], side[2]));
        EXPECT_LT((at(mesh, corners[c]) - expected).norm(), 1e-15 * 8) << element << ' ' << c;
      }
    }
  }
}

TEST(BoxMeshTest, NodesKnowExactlyTheElementsThatKnowThem) {
  std::vector<GlobalOrdinal> elements;
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
      mesh.nodeElements(node, elements);
      EXPECT_TRUE(std::is_sorted(elements.begin(), elements.end()));
      for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element)
        EXPECT_EQ(contains(cornersOf(mesh, element), node), contains(elements, element));
      EXPECT_EQ(mesh.isBoundaryNode(node), elements.size() < 8) << node;
    }
  }
}

TEST(BoxMeshTest, ManyAtOnceAreTheSameAsOneByOne) {
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    std::vector<GlobalOrdinal> elements; // ascending with gaps, then backwards
    for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element)
      if (element % 5 != 2)
        elements.push_back(element);
    for (GlobalOrdinal element = mesh.numElements(); element-- > 0;)
      elements.push_back(element);
    std::vector<GlobalOrdinal> all(8 * elements.size());
    mesh.elementNodes(elements, all);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const Corners corners = cornersOf(mesh, elements[e]);
      EXPECT_TRUE(
          std::equal(corners.begin(), corners.end(), all.begin() + static_cast<std::ptrdiff_t>(8 * e)))
          << e;
    }

    for (const GlobalOrdinal step : {1, 3, 7}) { // neighbours, within a row, over rows and layers
      std::vector<GlobalOrdinal> touching, some;
      for (GlobalOrdinal node = 0; node < mesh.numNodes(); node += step)
        some.push_back(node);
      std::vector<int> numbers(some.size());
      mesh.numNodeElements(some, numbers);
      for (std::size_t i = 0; i < some.size(); ++i) {
        mesh.nodeElements(some[i], touching);
        EXPECT_EQ(numbers[i], static_cast<int>(touching.size())) << some[i];
      }
    }
  }
}

TEST(BoxMeshTest, NeighboursAreThoseWhoShareFourNodes) {
  std::vector<GlobalOrdinal> neighbours;
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
      mesh.elementNeighbours(element, neighbours);
      EXPECT_TRUE(std::is_sorted(neighbours.begin(), neighbours.end()));
      const Corners mine = cornersOf(mesh, element);
      for (GlobalOrdinal other = 0; other < mesh.numElements(); ++other) {
        const Corners theirs = cornersOf(mesh, other);
        const auto common =
            std::count_if(mine.begin(), mine.end(), [&](GlobalOrdinal n) { return contains(theirs, n); });
        EXPECT_EQ(std::count(neighbours.begin(), neighbours.end(), other), common == 4 ? 1 : 0)
            << element << ' ' << other;
      }
    }
  }
}

TEST(BoxMeshTest, EndPointsAreExactWhateverTheSpacing) {
  const Box box{{0.1, -0.3, 100.1}, {0.7, 0.9, 100.3}};
  const StructuredMesh fine(box, {7, 49, 11});
  EXPECT_EQ(fine.point(0), box.lower);
  EXPECT_EQ(fine.point(fine.numNodes() - 1), box.upper);
  const std::map<std::string, std::pair<std::size_t, double>> faces{
      {"left", {0, 0.1}}, {"right", {0, 0.7}},    {"front", {1, -0.3}},
      {"back", {1, 0.9}}, {"bottom", {2, 100.1}}, {"top", {2, 100.3}}};
  for (const auto& [name, plane] : faces)
    for (const GlobalOrdinal node : fine.surface(name).facetNodes)
      EXPECT_EQ(fine.point(node)[plane.first], plane.second) << name << ' ' << node;
}

TEST(BoxMeshTest, ElementsFillTheBox) {
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    const auto [a, b, c] = mesh.elementSize();
    EXPECT_NEAR(a * b * c * static_cast<double>(mesh.numElements()), 1.5, 1e-14);
    const std::vector<Point> corners = mesh.elementShape();
    for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element) {
      const Corners nodes = cornersOf(mesh, element);
      for (std::size_t corner = 0; corner < 8; ++corner)
        EXPECT_LT((at(mesh, nodes[corner]) - at(mesh, nodes[0]) -
                   Eigen::Vector3d(corners[corner][0], corners[corner][1], corners[corner][2]))
                      .norm(),
                  1e-15);
    }
  }
}

/// Each facet lies on its element; what they enclose has the box's volume, each face the area and the
/// direction that its name says.
TEST(BoxMeshTest, SurfacesLookOutwards) {
  const std::map<std::string, Eigen::Vector3d> area{{"left", {-0.5, 0, 0}},   {"right", {0.5, 0, 0}},
                                                    {"front", {0, -1.5, 0}},  {"back", {0, 1.5, 0}},
                                                    {"bottom", {0, 0, -3.0}}, {"top", {0, 0, 3.0}}};
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    double volume = 0;
    ASSERT_EQ(mesh.surfaceNames().size(), 6u);
    for (const std::string& name : mesh.surfaceNames()) {
      SCOPED_TRACE(name);
      const Surface surface = mesh.surface(name);
      ASSERT_EQ(surface.nodesPerFacet(), 4);
      ASSERT_EQ(surface.facetNodes.size(), 4 * surface.elements.size());
      EXPECT_TRUE(std::is_sorted(surface.elements.begin(), surface.elements.end()));
      Eigen::Vector3d sum(0, 0, 0);
      for (std::size_t f = 0; f < surface.elements.size(); ++f) {
        const Corners corners = cornersOf(mesh, surface.elements[f]);
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_TRUE(contains(corners, surface.facetNodes[4 * f + c]));
        const auto p = [&](std::size_t c) { return at(mesh, surface.facetNodes[4 * f + c]); };
        const Eigen::Vector3d normal = (p(2) - p(0)).cross(p(3) - p(1)) / 2; // its length is the area
        EXPECT_GT(normal.dot(area.at(name)), 0);
        volume += normal.dot(p(0)) / 3;
        sum += normal;
      }
      EXPECT_LT((sum - area.at(name)).norm(), 1e-14);
    }
    EXPECT_NEAR(volume, 1.5, 1e-13);
  }
}

/// Each edge of a facet is run through once in both directions, and each facet belongs to one element only.
TEST(BoxMeshTest, SurfacesCloseTheBoundary) {
  for (const auto& size : boxSizes) {
    const StructuredMesh mesh = meshOf(size);
    std::map<std::pair<GlobalOrdinal, GlobalOrdinal>, int> edges;
    std::set<GlobalOrdinal> nodes;
    for (const std::string& name : mesh.surfaceNames()) {
      const Surface surface = mesh.surface(name);
      for (std::size_t c = 0; c < surface.facetNodes.size(); ++c) {
        const std::size_t next = c % 4 == 3 ? c - 3 : c + 1;
        ++edges[{surface.facetNodes[c], surface.facetNodes[next]}];
      }
      nodes.insert(surface.facetNodes.begin(), surface.facetNodes.end());
    }
    for (const auto& [edge, times] : edges) {
      EXPECT_EQ(times, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
      EXPECT_EQ(nodes.count(node) == 1, mesh.isBoundaryNode(node)) << node;
  }
}

TEST(BoxMeshTest, NumbersOfLargeMeshesFit) {
  const StructuredMesh large(brick, {3000, 3000, 3000});
  const GlobalOrdinal last = large.numElements() - 1;
  EXPECT_EQ(last, 26999999999);
  EXPECT_EQ(cornersOf(large, last)[6], large.numNodes() - 1);
  EXPECT_EQ(large.point(large.numNodes() - 1), brick.upper);
  std::vector<GlobalOrdinal> neighbours;
  large.elementNeighbours(last, neighbours);
  EXPECT_EQ(neighbours, (std::vector<GlobalOrdinal>{last - 9000000, last - 3000, last - 1}));
}

} // namespace
} // namespace epafi::mesh
