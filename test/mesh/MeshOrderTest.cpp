#include "epafi/mesh/MeshOrder.hpp"

#include "support/GmshPlate.hpp"
#include "support/SampleCells.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/mesh/ElementGeometry.hpp"
#include "epafi/meshing/GmshReader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace epafi::mesh {
namespace {

using namespace test;

using MeshOrderTest = test::GmshTest;

MeshArrays boxOf(CellType type) {
  const bool inSpace = dimensionOf(type) == 3;
  const StructuredMesh mesh({{0, 0, 0}, {1, 1, 1}}, inSpace ? std::array{2, 3, 2} : std::array{3, 2, 0});
  return test::arraysOf(mesh, test::placed(dimensionOf(type), 0.4, {1, 2, inSpace ? 3.0 : 0.0}),
                        type == CellType::prism                                       ? Cut::prisms
                        : type == CellType::pyramid                                   ? Cut::pyramids
                        : type == CellType::triangle || type == CellType::tetrahedron ? Cut::simplices
                                                                                      : Cut::none);
}

/// Nodes of order 2: those of order 1, the edges, and of bricks the faces with four corners and the elements.
std::size_t numNodesOfOrderTwo(const MeshArrays& mesh) {
  std::set<std::set<LocalOrdinal>> entities;
  for (LocalOrdinal e = 0; e < mesh.numElements(); ++e) {
    const auto nodes = nodesOf(mesh.cellType, mesh.cells, e);
    const auto edges = edgesOf(mesh.cellType);
    for (std::size_t i = 0; i < edges.size(); i += 2)
      entities.insert({nodes[edges[i]], nodes[edges[i + 1]]});
    for (const Facet& facet : facetsOf(mesh.cellType))
      if (mesh.cellType == CellType::hexahedron) {
        std::set<LocalOrdinal> corners;
        for (const int place : facet)
          corners.insert(nodes[place]);
        entities.insert(corners);
      }
    if (mesh.cellType == CellType::quadrilateral || mesh.cellType == CellType::hexahedron)
      entities.insert({nodes.begin(), nodes.end()});
  }
  return mesh.points.size() + entities.size();
}

TEST_F(MeshOrderTest, EachEntityHasOneNodeAndStraightElementsTheirNodesInTheMiddle) {
  for (const CellType type : linearCellTypes) {
    SCOPED_TRACE(toString(type));
    const MeshArrays linear = boxOf(type), quadratic = completed(linear, false);
    EXPECT_EQ(quadratic.cellType, withOrder(type, 2));
    EXPECT_EQ(quadratic.points.size(), numNodesOfOrderTwo(linear));
    for (LocalOrdinal e = 0; e < linear.numElements(); ++e) {
      std::vector<Point> corners;
      for (const LocalOrdinal node : nodesOf(type, linear.cells, e))
        corners.push_back(linear.points[node]);
      const std::vector<Point> expected = withAllNodes(quadratic.cellType, corners);
      const auto nodes = nodesOf(quadratic.cellType, quadratic.cells, e);
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((vectorOf(quadratic.points[nodes[i]]) - vectorOf(expected[i])).norm(), 1e-14);
    }
    const UnstructuredMesh mesh(quadratic);
    EXPECT_EQ(mesh.surfaceNames(), UnstructuredMesh(linear).surfaceNames());
    EXPECT_EQ(mesh.surface("left").elements, UnstructuredMesh(linear).surface("left").elements);
  }
}

/// What stands beside others has the nodes of edges alone, whatever is asked for.
TEST_F(MeshOrderTest, MixedMeshesAreOfOrderTwoAndBackElementByElement) {
  for (const bool inSpace : {false, true}) {
    const StructuredMesh grid({{0, 0, 0}, {1, 1, 1}}, {5, 2, inSpace ? 2 : 0});
    const MeshArrays linear = arraysOf(grid, {}, Cut::mixed), quadratic = completed(linear, false),
                     again = linearised(quadratic);
    EXPECT_EQ(quadratic.cellType, inSpace ? CellType::hexahedron20 : CellType::quadrilateral9);
    std::set<CellType> types;
    for (LocalOrdinal e = 0; e < linear.numElements(); ++e) {
      const CellType type = cellOf(linear.cellType, nodesOf(linear.cellType, linear.cells, e).size());
      types.insert(type);
      EXPECT_EQ(cellOf(quadratic.cellType, nodesOf(quadratic.cellType, quadratic.cells, e).size()),
                inSpace ? withoutInnerNodes(withOrder(type, 2)) : withOrder(type, 2));
    }
    EXPECT_EQ(types.size(), inSpace ? 4U : 2U);
    EXPECT_EQ(again.cells, linear.cells);
    EXPECT_EQ(again.points, linear.points);
    const UnstructuredMesh one(linear), two(quadratic);
    EXPECT_EQ(two.surface("left").elements, one.surface("left").elements);
    double volume = 0;
    for (GlobalOrdinal e = 0; e < two.numElements(); ++e) {
      std::vector<Point> points;
      two.elementPoints(e, points);
      volume += measureOf(ElementNodes(two, e).type(), points);
    }
    EXPECT_NEAR(volume, 1, 1e-13);
  }
}

TEST_F(MeshOrderTest, CornersAloneAreTheLinearMeshAgain) {
  for (const CellType type : linearCellTypes) {
    const MeshArrays linear = boxOf(type), again = linearised(completed(linear, false));
    EXPECT_EQ(again.cellType, linear.cellType);
    EXPECT_EQ(again.points, linear.points);
    EXPECT_EQ(again.cells, linear.cells);
    EXPECT_EQ(again.nodeTags, linear.nodeTags);
    EXPECT_EQ(again.surfaces.front().nodes, linear.surfaces.front().nodes);
  }
}

/// Elements of 8 and 20 nodes in a file become those of 9 and 27, with a curved edge as it is.
TEST_F(MeshOrderTest, SerendipityElementsOfFilesAreCompleted) {
  for (const CellType type : {CellType::quadrilateral, CellType::hexahedron}) {
    SCOPED_TRACE(toString(type));
    MeshArrays mesh = completed(boxOf(type), false);
    const std::size_t perElement = numNodesOf(mesh.cellType);
    const std::size_t given = type == CellType::quadrilateral ? 8 : 20;
    std::vector<LocalOrdinal> cells;
    for (std::size_t i = 0; i < mesh.cells.size(); ++i)
      if (i % perElement < given)
        cells.push_back(mesh.cells[i]);
    const std::size_t used = static_cast<std::size_t>(*std::max_element(cells.begin(), cells.end())) + 1;
    std::vector<bool> isUsed(mesh.points.size(), false);
    for (const LocalOrdinal node : cells)
      isUsed[node] = true;
    std::vector<LocalOrdinal> number(used, -1);
    std::vector<Point> points;
    for (std::size_t node = 0; node < used; ++node)
      if (isUsed[node]) {
        number[node] = static_cast<LocalOrdinal>(points.size());
        points.push_back(mesh.points[node]);
      }
    for (LocalOrdinal& node : cells)
      node = number[node];
    for (NamedFacets& surface : mesh.surfaces)
      for (LocalOrdinal& node : surface.nodes)
        node = number[node];
    const UnstructuredMesh whole(mesh);
    mesh.points = points;
    mesh.cells = cells;
    const std::string file = folder.write("cut.msh", test::fileOf(mesh, given));
    const UnstructuredMesh read = meshing::GmshFile(file).body("body");
    EXPECT_EQ(read.cellType(), withOrder(type, 2));
    EXPECT_EQ(read.numNodes(), whole.numNodes());
    std::vector<Point> own, expected;
    for (GlobalOrdinal e = 0; e < read.numElements(); ++e) {
      read.elementPoints(e, own);
      whole.elementPoints(e, expected);
      for (std::size_t i = 0; i < own.size(); ++i)
        EXPECT_LT((vectorOf(own[i]) - vectorOf(expected[i])).norm(), 1e-13);
    }
  }
}

TEST_F(MeshOrderTest, SerendipityElementsOfFilesStayAsTheyAreIfAsked) {
  for (const CellType type : {CellType::quadrilateral, CellType::hexahedron}) {
    SCOPED_TRACE(toString(type));
    const MeshArrays linear = boxOf(type);
    MeshArrays mesh = completed(linear, false, InnerNodes::none);
    EXPECT_EQ(mesh.cellType, withoutInnerNodes(withOrder(type, 2)));
    SignedRandomNumbers random(3);
    for (Point& point : mesh.points)
      for (int d = 0; d < dimensionOf(type); ++d)
        point[d] += 0.01 * random();
    const meshing::GmshFile file(folder.write("serendipity.msh", test::fileOf(mesh)));
    const UnstructuredMesh read = file.body("body", 0, InnerNodes::none);
    EXPECT_EQ(read.cellType(), mesh.cellType);
    ASSERT_EQ(read.numNodes(), std::ssize(mesh.points));
    std::vector<Point> own;
    for (GlobalOrdinal e = 0; e < read.numElements(); ++e) {
      read.elementPoints(e, own);
      const auto nodes = nodesOf(mesh.cellType, mesh.cells, e);
      for (std::size_t i = 0; i < own.size(); ++i)
        EXPECT_EQ(own[i], mesh.points[nodes[i]]);
    }
    const UnstructuredMesh whole = file.body("body"); // the same elements, with inner nodes
    EXPECT_EQ(whole.cellType(), withOrder(type, 2));
    EXPECT_NEAR(test::measureOf(whole), test::measureOf(read), 1e-14);
    const UnstructuredMesh corners = file.body("body", 1, InnerNodes::none);
    EXPECT_EQ(corners.cellType(), type);
    EXPECT_EQ(corners.numNodes(), std::ssize(linear.points));
  }
}

TEST_F(MeshOrderTest, GeometriesOfOrderTwoAreCurved) {
  const std::string geometries[] = {R"(
Disk(1) = {0, 0, 0, 1};
Physical Surface("ball") = {1}; Physical Curve("rim") = {1};
)",
                                    R"(
Disk(1) = {0, 0, 0, 1};
Recombine Surface {1}; Mesh.SubdivisionAlgorithm = 1;
Physical Surface("ball") = {1}; Physical Curve("rim") = {1};
)",
                                    R"(
Sphere(1) = {0, 0, 0, 1};
Physical Volume("ball") = {1}; Physical Surface("rim") = {1};
)"};
  const double measures[] = {M_PI, M_PI, 4 * M_PI / 3};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = folder.write(
        "ball.geo", "SetFactory(\"OpenCASCADE\"); Mesh.CharacteristicLengthMax = 0.4;\n" + geometries[i]);
    const meshing::GmshFile file(meshing::readMsh(name, meshing::textOfMeshFile(name, 1, 0, 2)));
    const UnstructuredMesh mesh = file.body("ball");
    SCOPED_TRACE(toString(mesh.cellType()));
    EXPECT_EQ(orderOf(mesh.cellType()), 2);
    EXPECT_NEAR(test::measureOf(mesh), measures[i], 2e-3 * measures[i]); // straight edges: 2 to 5 % less
    const Surface rim = mesh.surface("rim");
    for (const GlobalOrdinal node : rim.facetNodes)
      EXPECT_NEAR(vectorOf(mesh.point(node)).norm(), 1, 1e-9);
    const UnstructuredMesh linear = file.body("ball", 1);
    EXPECT_EQ(orderOf(linear.cellType()), 1);
    EXPECT_EQ(linear.numElements(), mesh.numElements());
    EXPECT_LT(test::measureOf(linear), 0.998 * measures[i]);
  }
}

} // namespace
} // namespace epafi::mesh
