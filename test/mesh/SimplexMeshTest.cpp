// Bodies cut into simplices: nothing of them is lost, nothing hangs, arcs stay arcs.

#include "epafi/mesh/SimplexMesh.hpp"

#include "epafi/mesh/MeshOrder.hpp"

#include "support/SimplexSamples.hpp"
#include "support/TurnedMesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace epafi::mesh {
namespace {

using namespace test;

using test::measureOfGroup;
using test::measureOfSurface;
using test::measuresOf;
using test::moved;
using test::quarterRing;
using test::soundBody;
using test::sumOf;

constexpr std::array<std::array<int, 3>, 2> grids{{{3, 2, 0}, {2, 1, 3}}}; // in the plane, in space
constexpr Box box{{0, -1, 2}, {3, 1, 2.5}};

Point unmoved(const Point& point) {
  return point;
}

double distance(const Point& a, const Point& b) {
  return (vectorOf(a) - vectorOf(b)).norm();
}

TEST(SimplexMeshTest, AGridBecomesASoundMeshOfTheSameSizeWithTheSameSurfaces) {
  for (const auto& elements : grids)
    for (const int order : {1, 2}) {
      const StructuredMesh grid(box, elements, order);
      const SimplexMesh simplices = simplicesOf(grid);
      for (const int orderOfSimplices : {1, 2}) {
        const UnstructuredMesh body = soundBody(simplices, orderOfSimplices);
        SCOPED_TRACE(toString(body.cellType()));
        EXPECT_EQ(body.numElements(), (grid.dimension() == 2 ? 2 : 6) * grid.numElements());
        EXPECT_NEAR(sumOf(measuresOf(body)), sumOf(measuresOf(grid)), 1e-13);
        EXPECT_EQ(body.surfaceNames(), grid.surfaceNames());
        for (const std::string& name : grid.surfaceNames())
          EXPECT_NEAR(measureOfSurface(body, name), measureOfSurface(grid, name), 1e-13) << name;
      }
    }
}

/// Prisms and pyramids round their lowest nodes, faces from theirs on.
TEST(SimplexMeshTest, ElementsOfSeveralShapesBecomeASoundMeshOfTheSameSizeWithTheSameSurfaces) {
  for (const auto& elements : grids)
    for (const int order : {1, 2}) {
      MeshArrays arrays = arraysOf(StructuredMesh(box, elements), {}, Cut::mixed);
      if (order == 2)
        arrays = completed(std::move(arrays), false);
      const UnstructuredMesh mixed(arrays), body = soundBody(simplicesOf(mixed));
      EXPECT_NEAR(sumOf(measuresOf(body)), sumOf(measuresOf(mixed)), 1e-13);
      for (const std::string& name : mixed.surfaceNames())
        EXPECT_NEAR(measureOfSurface(body, name), measureOfSurface(mixed, name), 1e-13) << name;
    }
}

TEST(SimplexMeshTest, NeighboursCutTheirFaceAlikeWhateverTheNumbersOfItsNodes) {
  std::mt19937 random(7);
  for (int k = 0; k < 20; ++k) {
    MeshArrays arrays = moved(StructuredMesh({{0, 0, 0}, {1, 1, 1}}, {2, 2, 2}), unmoved);
    std::vector<LocalOrdinal> number(arrays.points.size());
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    const std::vector<Point> points = arrays.points;
    for (std::size_t node = 0; node < points.size(); ++node)
      arrays.points[number[node]] = points[node];
    for (LocalOrdinal& node : arrays.cells)
      node = number[node];
    for (NamedFacets& surface : arrays.surfaces)
      for (LocalOrdinal& node : surface.nodes)
        node = number[node];
    const UnstructuredMesh body = soundBody(simplicesOf(UnstructuredMesh(arrays)));
    EXPECT_NEAR(sumOf(measuresOf(body)), 1, 1e-13);
    EXPECT_NEAR(measureOfGroup(body, "third"), 3.0 / 8, 1e-13);
  }
}

TEST(SimplexMeshTest, SimplicesStayAsTheyAre) {
  for (const auto& elements : grids) {
    const MeshArrays once = arraysOf(simplicesOf(StructuredMesh(box, elements)), 1);
    const SimplexMesh again = simplicesOf(UnstructuredMesh(once));
    const MeshArrays twice = arraysOf(again, 1);
    EXPECT_EQ(again.name, once.name);
    EXPECT_EQ(twice.points, once.points);
    EXPECT_EQ(twice.cells, once.cells);
    ASSERT_EQ(twice.surfaces.size(), once.surfaces.size());
    for (std::size_t s = 0; s < once.surfaces.size(); ++s)
      EXPECT_EQ(twice.surfaces[s].nodes.size(), once.surfaces[s].nodes.size()) << once.surfaces[s].name;
  }
}

TEST(SimplexMeshTest, CornersAreNumberedInTheOrderOfTheMeshAndTheOthersBehindThem) {
  for (const auto& elements : grids) {
    const StructuredMesh corners(box, elements);
    for (const int order : {1, 2}) {
      const SimplexMesh simplices = simplicesOf(StructuredMesh(box, elements, order));
      const MeshArrays arrays = arraysOf(simplices, 2);
      ASSERT_EQ(static_cast<GlobalOrdinal>(simplices.points.size()), corners.numNodes());
      for (std::size_t node = 0; node < simplices.points.size(); ++node) {
        EXPECT_LT(distance(simplices.points[node], corners.point(static_cast<GlobalOrdinal>(node))), 1e-13);
        EXPECT_EQ(arrays.points[node], simplices.points[node]);
        EXPECT_EQ(arrays.nodeTags[node], static_cast<GlobalOrdinal>(node));
      }
      EXPECT_TRUE(std::all_of(arrays.nodeTags.begin() + static_cast<std::ptrdiff_t>(simplices.points.size()),
                              arrays.nodeTags.end(), [](GlobalOrdinal tag) { return tag < 0; }));
    }
  }
}

TEST(SimplexMeshTest, ElementsStayInAllTheirGroupsAndFacetsOnAllTheirSurfaces) {
  for (const auto& elements : grids) {
    MeshArrays arrays = moved(StructuredMesh(box, elements), unmoved);
    arrays.groups.push_back({"first four", {3, 0, 2, 1}}); // overlaps "third"
    arrays.groups.push_back({"fourth", {3}});
    arrays.surfaces.push_back({"left again", arrays.surfaces[0].nodes});
    const UnstructuredMesh whole(arrays), body(arraysOf(simplicesOf(whole), 1));
    EXPECT_EQ(body.groupNames(), whole.groupNames());
    for (const std::string& name : whole.groupNames())
      EXPECT_NEAR(measureOfGroup(body, name), measureOfGroup(whole, name), 1e-13) << name;
    EXPECT_EQ(body.surfaceNames(), whole.surfaceNames());
    EXPECT_EQ(body.surface("left again").facetNodes, body.surface("left").facetNodes);
    EXPECT_NEAR(measureOfSurface(body, "left again"), measureOfSurface(whole, "left"), 1e-13);
  }
}

TEST(SimplexMeshTest, ASurfaceThatIsNotThereGetsNoName) {
  SimplexMesh simplices = simplicesOf(StructuredMesh(box, grids[0]));
  simplices.surfaces.emplace_back("nowhere");
  EXPECT_EQ(UnstructuredMesh(arraysOf(simplices, 1)).surfaceNames(),
            StructuredMesh(box, grids[0]).surfaceNames());
}

TEST(SimplexMeshTest, StraightEdgesAreNotBent) {
  for (const auto& elements : grids)
    EXPECT_TRUE(simplicesOf(StructuredMesh(box, elements, 2)).bends.empty());
}

/// The nodes of bricks of order 2 are those of their simplices: in the middle of edges, of the diagonals that
/// cut faces, and of the one through the brick.
TEST(SimplexMeshTest, CurvedBricksKeepTheirNodesTheirArcsAndTheirSize) {
  for (const std::array<int, 3>& elements : {std::array{2, 3, 0}, std::array{1, 2, 2}}) {
    const UnstructuredMesh ring(quarterRing(elements));
    const SimplexMesh simplices = simplicesOf(ring);
    const UnstructuredMesh curved = soundBody(simplices, 2), straight = soundBody(simplices, 1);
    EXPECT_EQ(curved.numNodes(), ring.numNodes());
    for (GlobalOrdinal node = 0; node < ring.numNodes(); ++node) {
      double nearest = 1;
      for (GlobalOrdinal other = 0; other < curved.numNodes(); ++other)
        nearest = std::min(nearest, distance(ring.point(node), curved.point(other)));
      EXPECT_LT(nearest, 1e-13);
    }
    EXPECT_NEAR(sumOf(measuresOf(curved)), sumOf(measuresOf(ring)), 1e-13);
    EXPECT_LT(sumOf(measuresOf(straight)), sumOf(measuresOf(ring)) - 0.01);
    for (const auto& [name, radius] : {std::pair{"left", 1.0}, {"right", 2.0}}) {
      const Surface arc = curved.surface(name);
      EXPECT_GT(arc.numFacets(), 0U);
      for (const GlobalOrdinal node : arc.facetNodes)
        EXPECT_NEAR(std::hypot(curved.point(node)[0], curved.point(node)[1]), radius, 1e-13);
    }
  }
}

TEST(SimplexMeshTest, CurvedSimplicesKeepTheirNodes) {
  const SimplexMesh simplices = simplicesOf(UnstructuredMesh(quarterRing({1, 2, 1})));
  const MeshArrays once = arraysOf(simplices, 2), twice = arraysOf(simplicesOf(UnstructuredMesh(once)), 2);
  EXPECT_EQ(twice.cells, once.cells);
  ASSERT_EQ(twice.points.size(), once.points.size());
  for (std::size_t node = 0; node < once.points.size(); ++node)
    EXPECT_LT(distance(twice.points[node], once.points[node]), 1e-14);
}

} // namespace
} // namespace epafi::mesh
