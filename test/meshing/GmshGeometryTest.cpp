#include "support/GmshPlate.hpp"

#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace epafi::meshing {
namespace {

using test::areaVectors;
using test::expectRefusal;
using test::measureOf;
using test::vectorOf;

using GmshGeometryTest = test::GmshTest;

/// Neighbours are mutual and share a facet's nodes; nodes and elements know each other; boundary nodes are
/// those of facets without a neighbour.
void expectConsistent(const mesh::Mesh& mesh) {
  std::vector<GlobalOrdinal> list, back;
  std::vector<int> counts(mesh.numNodes(), 0);
  for (GlobalOrdinal e = 0; e < mesh.numElements(); ++e) {
    const mesh::ElementNodes nodes(mesh, e);
    for (const GlobalOrdinal node : nodes) {
      ++counts[node];
      mesh.nodeElements(node, list);
      EXPECT_TRUE(std::find(list.begin(), list.end(), e) != list.end());
    }
    mesh.elementNeighbours(e, list);
    EXPECT_FALSE(list.empty());
    for (const GlobalOrdinal neighbour : list) {
      mesh.elementNeighbours(neighbour, back);
      EXPECT_EQ(std::count(back.begin(), back.end(), e), 1);
      const mesh::ElementNodes other(mesh, neighbour);
      const auto common = std::count_if(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) {
        return std::find(other.begin(), other.end(), node) != other.end();
      });
      const auto facets = facetsOf(nodes.type());
      EXPECT_TRUE(common == std::ssize(facets.front().nodes) || common == std::ssize(facets.back().nodes));
    }
  }
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    mesh.nodeElements(node, list);
    EXPECT_EQ(static_cast<int>(list.size()), counts[node]);
  }
}

/// All surfaces together enclose the body: Σ a = 0 and ⅓ Σ x·a (in the plane ½) is its volume, which is
/// positive only if normals point outwards; their nodes are the boundary nodes.
void expectEnclosed(const mesh::Mesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double measure = 0;
  std::vector<bool> isOnSurface(mesh.numNodes(), false);
  for (const std::string& name : mesh.surfaceNames()) {
    const mesh::Surface surface = mesh.surface(name);
    const std::vector<Eigen::Vector3d> areas = areaVectors(mesh, surface);
    for (std::size_t f = 0; f < areas.size(); ++f) {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (const GlobalOrdinal node : surface.facet(f)) {
        centre += test::vectorOf(mesh.point(node)) / static_cast<double>(surface.facet(f).size());
        isOnSurface[node] = true;
      }
      sum += areas[f];
      measure += centre.dot(areas[f]) / dimensionOf(mesh.cellType());
    }
  }
  EXPECT_NEAR(sum.norm(), 0, 1e-12);
  EXPECT_NEAR(measure, measureOf(mesh), 1e-12);
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    EXPECT_EQ(mesh.isBoundaryNode(node), isOnSurface[node]);
}

TEST_F(GmshGeometryTest, MeshesTrianglesOfAGeometry) {
  const GmshFile file(folder.write("ring.geo", R"(
lc = 0.2;
Point(1) = {0, 0, 0, lc}; Point(2) = {1, 0, 0, lc}; Point(3) = {3, 0, 0, lc};
Point(4) = {0, 3, 0, lc}; Point(5) = {0, 1, 0, lc};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Physical Surface("ring") = {1};
Physical Curve("inner") = {4}; Physical Curve("outer") = {2}; Physical Curve("cuts") = {1, 3};
)"));
  const mesh::UnstructuredMesh mesh = file.body("ring");
  EXPECT_EQ(mesh.cellType(), mesh::CellType::triangle);
  EXPECT_NEAR(measureOf(mesh), 2 * 3.14159265, 0.03);
  expectConsistent(mesh);
  expectEnclosed(mesh);
  const mesh::Surface inner = mesh.surface("inner");
  for (const Eigen::Vector3d& normal : areaVectors(mesh, inner)) // away from the ring
    EXPECT_LT(normal[0] + normal[1], 0);
}

/// Layers of bricks or prisms below, tetrahedra above them; on bricks Gmsh puts pyramids.
TEST_F(GmshGeometryTest, MeshesLayersUnderTetrahedra) {
  using enum mesh::CellType;
  for (const bool areBricks : {false, true}) {
    const std::string geometry = R"(
Mesh.CharacteristicLengthMax = 0.5;
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
)" + std::string(areBricks ? "Transfinite Surface {1}; Recombine Surface {1};\n" : "") +
                                 R"(low() = Extrude {0, 0, 0.4} { Surface{1}; Layers{2}; Recombine; };
high() = Extrude {0, 0, 0.7} { Surface{low(0)}; };
Physical Volume("body") = {low(1), high(1)};
Physical Surface("ends") = {1, high(0)};
Physical Surface("sides") = {low(2), low(3), low(4), low(5), high(2), high(3), high(4), high(5)};
)";
    const std::string name = folder.write(areBricks ? "bricks.geo" : "prisms.geo", geometry);
    const GmshFile file(name), quadratic(readMsh(name, textOfMeshFile(name, 1, 0, 2)));
    const mesh::UnstructuredMesh linear = file.body("body"), two = quadratic.body("body");
    EXPECT_EQ(linear.cellType(), areBricks ? hexahedron : prism);
    EXPECT_EQ(two.cellType(), areBricks ? hexahedron20 : prism15);
    EXPECT_EQ(two.numElements(), linear.numElements());
    std::set<mesh::CellType> types;
    for (GlobalOrdinal element = 0; element < linear.numElements(); ++element)
      types.insert(mesh::ElementNodes(linear, element).type());
    EXPECT_EQ(types,
              areBricks ? (std::set{tetrahedron, pyramid, hexahedron}) : (std::set{tetrahedron, prism}));
    EXPECT_NEAR(measureOf(linear), 1.1, 1e-12);
    EXPECT_NEAR(measureOf(two), 1.1, 1e-12);
    expectConsistent(linear);
    expectConsistent(two);
    expectEnclosed(linear);
  }
}

TEST_F(GmshGeometryTest, MeshesQuadrilateralsOfAGeometry) {
  const GmshFile file(folder.write("plate.geo", R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
Rectangle(2) = {2, 0, 0, 1, 1};
Coherence;
Mesh.CharacteristicLengthMax = 0.2;
Recombine Surface {1, 2};
Mesh.SubdivisionAlgorithm = 1;
Physical Surface("both") = {1, 2};
Physical Surface("soft") = {2};
edges() = CombinedBoundary{ Surface{1, 2}; };
Physical Curve("edge") = {edges()};
)"));
  const mesh::UnstructuredMesh mesh = file.body("both");
  EXPECT_EQ(mesh.cellType(), mesh::CellType::quadrilateral);
  EXPECT_NEAR(measureOf(mesh), 3, 1e-12);
  expectConsistent(mesh);
  expectEnclosed(mesh);
  EXPECT_EQ(mesh.groupNames(), (std::vector<std::string>{"soft"}));
  double soft = 0;
  for (const GlobalOrdinal element : mesh.group("soft"))
    soft += measureOf(mesh, element);
  EXPECT_NEAR(soft, 1, 1e-12);
}

TEST_F(GmshGeometryTest, MeshesTetrahedraOfAGeometry) {
  const GmshFile file(folder.write("box.geo", R"(
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 2, 1, 1};
Box(2) = {0, 0, 1, 2, 1, 1}; // on top of the other, with nodes of its own
Mesh.CharacteristicLengthMax = 0.5;
Physical Volume("lower") = {1};
Physical Volume("upper") = {2};
Physical Surface("skin") = {1:4, 6, 7:10, 12};
Physical Surface("contact") = {5, 11};
Physical Surface("top of the lower one") = {6};
)"));
  for (const char* group : {"lower", "upper"}) {
    const mesh::UnstructuredMesh mesh = file.body(group);
    EXPECT_EQ(mesh.cellType(), mesh::CellType::tetrahedron);
    EXPECT_NEAR(measureOf(mesh), 2, 1e-12);
    expectConsistent(mesh);
    EXPECT_EQ(mesh.surfaceNames().size(), group == std::string("lower") ? 3 : 2);
    EXPECT_TRUE(mesh.groupNames().empty());
  }
  expectEnclosed(file.body("upper"));
  const mesh::UnstructuredMesh lower = file.body("lower");
  for (const Eigen::Vector3d& area : areaVectors(lower, lower.surface("top of the lower one")))
    EXPECT_GT(area[2], 0);
  for (const Eigen::Vector3d& area : areaVectors(lower, lower.surface("contact")))
    EXPECT_LT(area[2], 0);
  // Nodes of the two bodies lie at the same places, which is right for bodies and wrong inside one.
  expectRefusal([&] { (void)file.body(""); }, {"Mesh file", "are both at"});
}

TEST_F(GmshGeometryTest, MeshesHexahedraOfAnExtrusion) {
  const GmshFile file(folder.write("block.geo", R"(
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 5; Transfinite Curve {2, 4} = 4;
Transfinite Surface {1}; Recombine Surface {1};
out() = Extrude {0, 0, 3} { Surface{1}; Layers{2}; Recombine; };
Physical Volume("block") = {out(1)};
Physical Surface("bottom") = {1};
Physical Surface("top") = {out(0)};
Physical Surface("sides") = {out(2), out(3), out(4), out(5)};
)"));
  const mesh::UnstructuredMesh mesh = file.body("block");
  EXPECT_EQ(mesh.cellType(), mesh::CellType::hexahedron);
  EXPECT_EQ(mesh.numElements(), 4 * 3 * 2);
  EXPECT_EQ(mesh.numNodes(), 5 * 4 * 3);
  EXPECT_NEAR(measureOf(mesh), 6, 1e-12);
  expectConsistent(mesh);
  expectEnclosed(mesh);
}

/// Every element of a file, of a geometry and of an old mesh alike, is split; groups and surfaces keep their
/// names and places.
TEST_F(GmshGeometryTest, RefinesMeshesByHalvingAllEdges) {
  const std::string plate = folder.write("plate.msh", test::plate41);
  const mesh::UnstructuredMesh coarse = GmshFile(plate).body(""),
                               fine = GmshFile(readMsh(plate, textOfMeshFile(plate, 1, 2))).body("");
  EXPECT_EQ(fine.numElements(), 16 * coarse.numElements());
  EXPECT_NEAR(measureOf(fine), measureOf(coarse), 1e-14);
  EXPECT_EQ(fine.group("right").size(), 16 * coarse.group("right").size());
  EXPECT_EQ(fine.surface("left").elements.size(), 4 * coarse.surface("left").elements.size());
  for (GlobalOrdinal node = 0; node < coarse.numNodes(); ++node) { // coarse nodes are fine nodes
    bool isThere = false;
    for (GlobalOrdinal other = 0; other < fine.numNodes(); ++other)
      isThere = isThere || (vectorOf(fine.point(other)) - vectorOf(coarse.point(node))).norm() < 1e-14;
    EXPECT_TRUE(isThere);
  }

  const std::string disk = folder.write("disk.geo", R"(
SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 2};
Mesh.CharacteristicLengthMax = 1;
Physical Surface("disk") = {1};
Physical Curve("rim") = {1};
)");
  const mesh::UnstructuredMesh round = GmshFile(readMsh(disk, textOfMeshFile(disk, 1, 1))).body("disk");
  const mesh::Surface rim = round.surface("rim");
  for (const GlobalOrdinal node : rim.facetNodes)
    EXPECT_NEAR(vectorOf(round.point(node)).norm(), 2, 1e-9); // new nodes lie on the circle
}

/// Drawn in millimetres, saved in metres, as is what is asked of sizes.
TEST_F(GmshGeometryTest, KeepsTheScaleOfAGeometry) {
  const std::string plate = folder.write("plate.geo", R"(
Mesh.ScalingFactor = 0.001;
Point(1) = {0, 0, 0, 50}; Point(2) = {200, 0, 0, 50};
Point(3) = {200, 100, 0, 50}; Point(4) = {0, 100, 0, 50};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
)");
  EXPECT_NEAR(measureOf(GmshFile(plate).body("")), 0.02, 1e-15);
  const std::vector<Point> corners{{0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0}};
  const mesh::SizeField sizes({2, corners, {0.02, 0.02, 0.02}});
  const mesh::UnstructuredMesh fine = GmshFile(readMsh(plate, textOfGeometry(plate, 1, sizes))).body("");
  EXPECT_NEAR(measureOf(fine), 0.02, 1e-15);
  EXPECT_NEAR(static_cast<double>(fine.numElements()), 0.02 / (0.02 * 0.02 * 0.433), 40); // equilateral ones
}

/// Shapes that are meshes are not meshed anew: without their triangles nothing is left.
TEST_F(GmshGeometryTest, LeavesShapesThatAreMeshesAsTheyAre) {
  ASSERT_NE(folder.write("plate.msh", test::plate41), "");
  const std::string merged = folder.write("merged.geo", "Merge \"plate.msh\";\n");
  EXPECT_EQ(GmshFile(merged).body("").numElements(), 2);
  EXPECT_EQ(textOfGeometry(merged, 1, mesh::SizeField({2, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 1, 1}})),
            "");
}

} // namespace
} // namespace epafi::meshing
