#include "epafi/mesh/UnstructuredMesh.hpp"

#include "support/MeshFiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace epafi::mesh {
namespace {

using test::areaVectors;
using test::expectRefusal;

/// 6---7---8
/// | 2 | 3 |   elements 0 … 3; in the file, nodes are numbered from 10 and elements from 100
/// 3---4---5
/// | 0 | 1 |
/// 0---1---2
MeshArrays fourSquares() {
  MeshArrays mesh;
  mesh.name = "Body \"plate\"";
  mesh.cellType = CellType::quadrilateral;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      mesh.points.push_back({1.0 * i, 1.0 * j, 0});
  mesh.cells = {0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8, 7};
  mesh.surfaces = {{"bottom", {2, 1, 0, 1}}, {"left", {0, 3, 3, 6}}};
  mesh.groups = {{"right half", {3, 1}}};
  for (GlobalOrdinal n = 0; n < 9; ++n)
    mesh.nodeTags.push_back(10 + n);
  for (GlobalOrdinal e = 0; e < 4; ++e)
    mesh.elementTags.push_back(100 + e);
  return mesh;
}

/// Boxes of the unit cube's eighths: the same in space, from bottom to top.
MeshArrays eightCubes() {
  MeshArrays mesh;
  mesh.name = "Body \"block\"";
  mesh.cellType = CellType::hexahedron;
  const auto node = [](int i, int j, int k) { return i + 3 * j + 9 * k; };
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        mesh.points.push_back({0.5 * i, 0.5 * j, 0.5 * k});
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        for (int up = 0; up < 2; ++up)
          mesh.cells.insert(mesh.cells.end(), {node(i, j, k + up), node(i + 1, j, k + up),
                                               node(i + 1, j + 1, k + up), node(i, j + 1, k + up)});
  mesh.surfaces = {{"top", {}}};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) // clockwise from above: inward
      mesh.surfaces[0].nodes.insert(mesh.surfaces[0].nodes.end(), {node(i, j, 2), node(i, j + 1, 2),
                                                                   node(i + 1, j + 1, 2), node(i + 1, j, 2)});
  for (GlobalOrdinal n = 0; n < 27; ++n)
    mesh.nodeTags.push_back(n + 1);
  for (GlobalOrdinal e = 0; e < 8; ++e)
    mesh.elementTags.push_back(e + 1);
  return mesh;
}

void expectRefused(MeshArrays mesh, const std::vector<std::string>& parts) {
  expectRefusal([&] { UnstructuredMesh(std::move(mesh)); }, parts);
}

TEST(UnstructuredMeshTest, KnowsNodesNeighboursAndBoundary) {
  const UnstructuredMesh mesh(fourSquares());
  EXPECT_EQ(mesh.numNodes(), 9);
  EXPECT_EQ(mesh.numElements(), 4);
  EXPECT_EQ(mesh.point(5), (Point{2, 1, 0}));
  std::vector<GlobalOrdinal> list(8);
  mesh.elementNodes(std::vector<GlobalOrdinal>{3, 1}, list);
  EXPECT_EQ(list, (std::vector<GlobalOrdinal>{4, 5, 8, 7, 1, 2, 5, 4}));
  mesh.nodeElements(4, list);
  EXPECT_EQ(list, (std::vector<GlobalOrdinal>{0, 1, 2, 3}));
  mesh.nodeElements(1, list);
  EXPECT_EQ(list, (std::vector<GlobalOrdinal>{0, 1}));
  std::vector<int> numbers(3);
  mesh.numNodeElements(std::vector<GlobalOrdinal>{0, 1, 4}, numbers);
  EXPECT_EQ(numbers, (std::vector<int>{1, 2, 4}));
  mesh.elementNeighbours(0, list);
  EXPECT_EQ(list, (std::vector<GlobalOrdinal>{1, 2}));
  for (GlobalOrdinal node = 0; node < 9; ++node)
    EXPECT_EQ(mesh.isBoundaryNode(node), node != 4) << node;
  EXPECT_EQ(mesh.nodeTag(4), 14);
  EXPECT_EQ(mesh.elementTag(3), 103);
}

TEST(UnstructuredMeshTest, SurfacesLookOutwardWhicheverWayTheirFacetsAreGiven) {
  const UnstructuredMesh plate(fourSquares());
  EXPECT_EQ(plate.surfaceNames(), (std::vector<std::string>{"bottom", "left"}));
  const Surface bottom = plate.surface("bottom");
  EXPECT_EQ(bottom.nodesPerFacet(), 2);
  EXPECT_EQ(bottom.facetNodes, (std::vector<GlobalOrdinal>{0, 1, 1, 2}));
  EXPECT_EQ(bottom.elements, (std::vector<GlobalOrdinal>{0, 1}));
  EXPECT_EQ(plate.surface("left").facetNodes, (std::vector<GlobalOrdinal>{3, 0, 6, 3}));

  const UnstructuredMesh block(eightCubes());
  const Surface top = block.surface("top");
  EXPECT_EQ(top.nodesPerFacet(), 4);
  EXPECT_EQ(top.elements, (std::vector<GlobalOrdinal>{4, 5, 6, 7}));
  for (const Eigen::Vector3d& area : areaVectors(block, top))
    EXPECT_EQ(area, Eigen::Vector3d(0, 0, 0.25));
}

TEST(UnstructuredMeshTest, GroupsAscend) {
  const UnstructuredMesh mesh(fourSquares());
  EXPECT_EQ(mesh.groupNames(), (std::vector<std::string>{"right half"}));
  EXPECT_EQ(mesh.group("right half"), (std::vector<GlobalOrdinal>{1, 3}));
}

TEST(UnstructuredMeshTest, RefusesSurfacesThatBoundNothing) {
  MeshArrays inside = fourSquares();
  inside.surfaces = {{"joint", {3, 4, 4, 5}}};
  expectRefused(inside, {"Body \"plate\"", "the surface \"joint\"", "nodes 13, 14", "inside the body",
                         "element 10", "take this part out"});
  MeshArrays nowhere = fourSquares();
  nowhere.surfaces = {{"diagonal", {0, 4}}};
  expectRefused(nowhere, {"\"diagonal\"", "nodes 10, 14", "no facet of any element"});
  MeshArrays twice = fourSquares();
  twice.surfaces = {{"bottom", {0, 1, 1, 0}}};
  expectRefused(twice, {"\"bottom\" lists a facet of element 100 twice"});
}

TEST(UnstructuredMeshTest, RefusesInvertedElementsOneOrAll) {
  MeshArrays one = fourSquares();
  std::reverse(one.cells.begin() + 4, one.cells.begin() + 8);
  expectRefused(one, {"element 101 is inverted (area -1)", "counter-clockwise", "curve loop"});
  MeshArrays all = fourSquares();
  for (auto cell = all.cells.begin(); cell != all.cells.end(); cell += 4)
    std::reverse(cell, cell + 4);
  expectRefused(all, {"element 100 and 3 others are inverted"});

  MeshArrays block = eightCubes();
  for (auto lower = block.cells.begin(); lower != block.cells.begin() + 16; lower += 8)
    std::swap_ranges(lower, lower + 4, lower + 4);
  expectRefused(block, {"element 1 and another one are inverted (volume -0.125)", "the other way round"});
}

TEST(UnstructuredMeshTest, RefusesFlatAndFoldedElements) {
  MeshArrays flat = fourSquares();
  flat.cellType = CellType::triangle;
  flat.cells = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6, 3, 4, 5, 4, 8, 7};
  flat.elementTags = {1, 2, 3, 4, 5, 6, 7, 8};
  flat.surfaces = {};
  flat.groups = {};
  expectRefused(flat, {"element 7 near (0, 1) is flat: its area is 0"});

  MeshArrays folded = fourSquares();
  folded.points[4] = {0.2, 0.2, 0}; // the first square's corner is pulled in
  expectRefused(folded, {"element 100 is folded at node 14"});
  folded.points[4] = {0.5, 0.5, 0}; // straight: a triangle with four nodes
  expectRefused(folded, {"element 100 is folded at node 14"});

  MeshArrays block = eightCubes();
  block.points[26] = {0.6, 0.6, 0.6}; // the outer corner is pulled in
  expectRefused(block, {"element 8 is folded at node"});
}

TEST(UnstructuredMeshTest, RefusesNodesThatAreTwoOrNone) {
  MeshArrays twice = fourSquares();
  twice.cells[2] = 1;
  expectRefused(twice, {"element 100 has node 11 twice", "4 different nodes"});

  MeshArrays orphan = fourSquares();
  orphan.points.push_back({0.5, 0.25, 0});
  orphan.nodeTags.push_back(77);
  expectRefused(orphan, {"node 77 at (0.5, 0.25)", "belongs to none of its elements"});

  MeshArrays cut = fourSquares(); // the upper half has nodes of its own
  for (const std::size_t n : {3, 4, 5}) {
    Point copy = cut.points[n];
    copy[0] += 1e-11;
    cut.points.push_back(copy);
    cut.nodeTags.push_back(50 + static_cast<GlobalOrdinal>(n));
  }
  for (std::size_t i = 8; i < 16; ++i)
    if (cut.cells[i] <= 5)
      cut.cells[i] += 6;
  cut.surfaces = {};
  expectRefused(cut, {"node 13 and node 53 are both at (0, 1)", "merge them"});

  MeshArrays infinite = fourSquares();
  infinite.points[3][1] = std::numeric_limits<double>::quiet_NaN();
  expectRefused(infinite, {"node 13", "not a finite number"});
  MeshArrays high = fourSquares();
  high.points[2][2] = 0.25;
  expectRefused(high, {"node 12 lies at z = 0.25", "plane z = 0"});
}

TEST(UnstructuredMeshTest, RefusesElementsThatShareTooMuch) {
  MeshArrays copies = fourSquares();
  copies.cells.insert(copies.cells.end(), {4, 3, 0, 1});
  copies.elementTags.push_back(104);
  expectRefused(copies, {"element 100 and element 104 have the same nodes", "list an element once"});

  MeshArrays two = fourSquares(); // nothing but an element and its copy
  two.cells = {0, 1, 2, 3, 0, 1, 2, 3};
  two.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  two.elementTags.resize(2);
  two.surfaces = {};
  two.groups = {};
  expectRefused(two, {"element 100 and element 101 have the same nodes"});

  MeshArrays three = fourSquares(); // a third square on the edge 1–4
  three.points.insert(three.points.end(), {{1.5, 0.2, 0}, {1.5, 0.8, 0}});
  three.nodeTags.insert(three.nodeTags.end(), {60, 61});
  three.cells.insert(three.cells.end(), {1, 9, 10, 4});
  three.elementTags.push_back(104);
  expectRefused(three, {"the elements 100, 101 and 104 share one edge"});
}

TEST(UnstructuredMeshTest, RefusesHangingNodesInThePlane) {
  MeshArrays mesh = fourSquares(); // the upper left square is halved, the lower left one is not
  mesh.points.insert(mesh.points.end(), {{0.5, 1, 0}, {0.5, 2, 0}});
  mesh.nodeTags.insert(mesh.nodeTags.end(), {60, 61});
  mesh.cells = {0, 1, 4, 3, 1, 2, 5, 4, 3, 9, 10, 6, 9, 4, 7, 10, 4, 5, 8, 7};
  mesh.elementTags.push_back(104);
  expectRefused(mesh,
                {"node 60 at (0.5, 1) lies on the boundary of element 100", "hanging node", "Coherence;"});
  mesh.points[9][1] += 1e-8; // written with few digits
  expectRefused(mesh, {"node 60"});
}

TEST(UnstructuredMeshTest, RefusesHangingNodesInSpace) {
  MeshArrays mesh = eightCubes(); // a large cube beside the small ones, on x = 1
  const auto first = static_cast<LocalOrdinal>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), {{2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}});
  mesh.nodeTags.insert(mesh.nodeTags.end(), {60, 61, 62, 63});
  mesh.cells.insert(mesh.cells.end(), {2, first, first + 1, 8, 20, first + 2, first + 3, 26});
  mesh.elementTags.push_back(9);
  expectRefused(mesh, {"node 6 at (1, 0.5, 0) lies on the boundary of element 9", "hanging node"});
}

TEST(UnstructuredMeshTest, LargeAndTinyElementsMayMeetAtANode) {
  MeshArrays mesh; // a fan of ever smaller triangles round the origin, sizes 1 … 2⁻³⁰
  mesh.cellType = CellType::triangle;
  mesh.points = {{0, 0, 0}};
  mesh.nodeTags = {1};
  for (int k = 0; k < 30; ++k) {
    const double size = std::ldexp(1.0, -k), angle = 0.1 * k;
    mesh.points.push_back({size * std::cos(angle), size * std::sin(angle), 0});
    mesh.nodeTags.push_back(k + 2);
    if (k > 0) {
      mesh.cells.insert(mesh.cells.end(), {0, k, k + 1});
      mesh.elementTags.push_back(k);
    }
  }
  EXPECT_EQ(UnstructuredMesh(mesh).numElements(), 29);
}

} // namespace
} // namespace epafi::mesh
