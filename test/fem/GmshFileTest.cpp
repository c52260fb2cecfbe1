#include "epafi/fem/GmshFile.hpp"

#include "MeshFiles.hpp"

#include "epafi/fem/ElementShape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <type_traits>

namespace epafi::fem {
namespace {

using test::areaVectors;
using test::expectRefusal;
using test::MeshFolder;

/// 4---5---6
/// | 2 | 3 |   and the edge 1–4, element 1, is the surface "left"; the right square is the group "right"
/// 1---2---3
const std::string plate22 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "left"
2 2 "west"
2 3 "right"
$EndPhysicalNames
$Nodes
7
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
9 5 5 0
$EndNodes
$Elements
4
1 1 2 1 1 1 4
2 3 2 2 1 1 2 5 4
3 3 2 3 2 2 3 6 5
4 15 2 0 3 9
$EndElements
)";

const std::string head41 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "left"
2 2 "west"
2 3 "right"
$EndPhysicalNames
$Entities
1 1 2 0
3 5 5 0 0
1 0 0 0 0 1 0 1 1 0
1 0 0 0 1 1 0 1 2 0
2 1 0 0 2 1 0 1 3 0
$EndEntities
)";

const std::string nodes41 = R"($Nodes
4 7 1 9
0 3 0 1
9
5 5 0
1 1 0 2
1
4
0 0 0
0 1 0
2 1 0 2
2
5
1 0 0
1 1 0
2 2 0 2
3
6
2 0 0
2 1 0
$EndNodes
)";

const std::string elements41 = R"($Elements
3 3 1 3
1 1 1 1
1 1 4
2 1 3 1
2 1 2 5 4
2 2 3 1
3 2 3 6 5
$EndElements
)";

const std::string plate41 = head41 + nodes41 + elements41;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

double measureOf(const Mesh& mesh, GlobalOrdinal element) {
  std::vector<GlobalOrdinal> nodes(static_cast<std::size_t>(mesh.nodesPerElement()));
  mesh.elementNodes(element, nodes);
  std::vector<Point> corners;
  for (const GlobalOrdinal node : nodes)
    corners.push_back(mesh.point(node));
  return shapeOf(mesh.cellType(), corners).measure;
}

double measureOf(const Mesh& mesh) {
  double sum = 0;
  for (GlobalOrdinal element = 0; element < mesh.numElements(); ++element)
    sum += measureOf(mesh, element);
  return sum;
}

/// Neighbours are mutual and share a facet's nodes; nodes and elements know each other; boundary nodes are those of
/// facets without a neighbour.
void expectConsistent(const Mesh& mesh) {
  std::vector<GlobalOrdinal> nodes(static_cast<std::size_t>(mesh.nodesPerElement())), other = nodes, list,
                                                                                      back;
  std::vector<int> counts(static_cast<std::size_t>(mesh.numNodes()), 0);
  for (GlobalOrdinal e = 0; e < mesh.numElements(); ++e) {
    mesh.elementNodes(e, nodes);
    for (const GlobalOrdinal node : nodes) {
      ++counts[static_cast<std::size_t>(node)];
      mesh.nodeElements(node, list);
      EXPECT_TRUE(std::find(list.begin(), list.end(), e) != list.end());
    }
    mesh.elementNeighbours(e, list);
    EXPECT_FALSE(list.empty());
    for (const GlobalOrdinal neighbour : list) {
      mesh.elementNeighbours(neighbour, back);
      EXPECT_EQ(std::count(back.begin(), back.end(), e), 1);
      mesh.elementNodes(neighbour, other);
      const auto common = std::count_if(nodes.begin(), nodes.end(), [&](GlobalOrdinal node) {
        return std::find(other.begin(), other.end(), node) != other.end();
      });
      EXPECT_EQ(common, nodesPerFacet(mesh.cellType()));
    }
  }
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node) {
    mesh.nodeElements(node, list);
    EXPECT_EQ(static_cast<int>(list.size()), counts[static_cast<std::size_t>(node)]);
  }
}

/// All surfaces together enclose the body: Σ a = 0 and ⅓ Σ x·a (in the plane ½) is its volume, which is positive only if
/// normals point outwards; their nodes are the boundary nodes.
void expectEnclosed(const Mesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double measure = 0;
  std::vector<bool> isOnSurface(static_cast<std::size_t>(mesh.numNodes()), false);
  for (const std::string& name : mesh.surfaceNames()) {
    const Surface surface = mesh.surface(name);
    const std::vector<Eigen::Vector3d> areas = areaVectors(mesh, surface);
    const auto count = static_cast<std::size_t>(surface.nodesPerFacet);
    for (std::size_t f = 0; f < areas.size(); ++f) {
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < count; ++i) {
        const GlobalOrdinal node = surface.facetNodes[count * f + i];
        centre += test::vectorOf(mesh.point(node)) / static_cast<double>(count);
        isOnSurface[static_cast<std::size_t>(node)] = true;
      }
      sum += areas[f];
      measure += centre.dot(areas[f]) / dimensionOf(mesh.cellType());
    }
  }
  EXPECT_NEAR(sum.norm(), 0, 1e-12);
  EXPECT_NEAR(measure, measureOf(mesh), 1e-12);
  for (GlobalOrdinal node = 0; node < mesh.numNodes(); ++node)
    EXPECT_EQ(mesh.isBoundaryNode(node), isOnSurface[static_cast<std::size_t>(node)]);
}

void expectEqual(const UnstructuredMesh& a, const UnstructuredMesh& b) {
  ASSERT_EQ(a.cellType(), b.cellType());
  ASSERT_EQ(a.numNodes(), b.numNodes());
  ASSERT_EQ(a.numElements(), b.numElements());
  for (GlobalOrdinal node = 0; node < a.numNodes(); ++node) {
    EXPECT_EQ(a.point(node), b.point(node));
    EXPECT_EQ(a.nodeTag(node), b.nodeTag(node));
  }
  std::vector<GlobalOrdinal> nodes(static_cast<std::size_t>(a.nodesPerElement())), other = nodes;
  for (GlobalOrdinal element = 0; element < a.numElements(); ++element) {
    a.elementNodes(element, nodes);
    b.elementNodes(element, other);
    EXPECT_EQ(nodes, other);
    EXPECT_EQ(a.elementTag(element), b.elementTag(element));
  }
  EXPECT_EQ(a.groupNames(), b.groupNames());
  for (const std::string& name : a.groupNames())
    EXPECT_EQ(a.group(name), b.group(name));
  EXPECT_EQ(a.surfaceNames(), b.surfaceNames());
  for (const std::string& name : a.surfaceNames()) {
    EXPECT_EQ(a.surface(name).facetNodes, b.surface(name).facetNodes);
    EXPECT_EQ(a.surface(name).elements, b.surface(name).elements);
  }
}

/// Text with numbers between as they lie in memory.
struct BinaryText {
  std::string text;

  BinaryText& operator<<(const std::string& more) {
    text += more;
    return *this;
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> BinaryText& operator<<(Number number) {
    text.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
};

class GmshFileTest : public testing::Test {
protected:
  [[nodiscard]] GmshFile plate(const std::string& text) const {
    return GmshFile(folder.write("plate.msh", text));
  }
  void expectRefused(const std::string& text, const std::vector<std::string>& parts,
                     const std::string& group = "", const std::string& name = "plate.msh") const {
    const std::string file = folder.write(name, text);
    expectRefusal([&] { (void)GmshFile(file).body(group); }, parts);
  }

  MeshFolder folder;
};

TEST_F(GmshFileTest, FormatsTwoAndFourGiveTheSameMesh) {
  const GmshFile two = plate(plate22), four = plate(plate41);
  for (const char* group : {"", "west", "right"})
    expectEqual(two.body(group), four.body(group));
  EXPECT_EQ(two.groupNames(), (std::vector<std::string>{"west", "right"}));
  EXPECT_EQ(two.groupNames(), four.groupNames());
  EXPECT_EQ(four.dimension(), 2);
}

TEST_F(GmshFileTest, AllElementsAreTheBodyIfNoGroupIsNamed) {
  const UnstructuredMesh all = plate(plate41).body("");
  EXPECT_EQ(all.cellType(), CellType::quadrilateral);
  EXPECT_EQ(all.numNodes(), 6); // node 9 belongs to a point alone
  EXPECT_EQ(all.nodeTag(5), 6);
  EXPECT_EQ(all.elementTag(0), 2);
  EXPECT_EQ(all.groupNames(), (std::vector<std::string>{"west", "right"}));
  EXPECT_EQ(all.group("right"), (std::vector<GlobalOrdinal>{1}));
  EXPECT_EQ(all.surface("left").facetNodes, (std::vector<GlobalOrdinal>{3, 0}));
  EXPECT_EQ(measureOf(all), 2);
}

TEST_F(GmshFileTest, ABodyHasItsOwnNodesAndTheSurfacesThatBoundIt) {
  const GmshFile file = plate(plate41);
  const UnstructuredMesh west = file.body("west"), right = file.body("right");
  EXPECT_EQ(west.surfaceNames(), (std::vector<std::string>{"left"}));
  EXPECT_TRUE(right.surfaceNames().empty());
  EXPECT_TRUE(right.groupNames().empty());
  EXPECT_EQ(right.numNodes(), 4);
  EXPECT_EQ(right.nodeTag(0), 2);
  EXPECT_EQ(right.elementTag(0), 3);
  EXPECT_EQ(right.point(1), (Point{2, 0, 0}));
}

TEST_F(GmshFileTest, GroupsWithoutANameAreCalledByTheirNumber) {
  const std::string names = plate41.substr(plate41.find("$PhysicalNames"),
                                           plate41.find("$Entities") - plate41.find("$PhysicalNames"));
  const GmshFile file = plate(replaced(plate41, names, ""));
  EXPECT_EQ(file.groupNames(), (std::vector<std::string>{"2", "3"}));
  EXPECT_EQ(file.body("2").surfaceNames(), (std::vector<std::string>{"1"}));
}

TEST_F(GmshFileTest, BinaryFilesAreRead) {
  const std::string names =
      "$PhysicalNames\n3\n1 1 \"left\"\n2 2 \"west\"\n2 3 \"right\"\n$EndPhysicalNames\n";
  BinaryText two;
  two << "$MeshFormat\n2.2 1 8\n" << std::int32_t{1} << "\n$EndMeshFormat\n" << names;
  two << "$Nodes\n6\n";
  const std::array<double, 6> x{0, 1, 2, 0, 1, 2}, y{0, 0, 0, 1, 1, 1};
  for (std::size_t n = 0; n < 6; ++n)
    two << static_cast<std::int32_t>(n + 1) << x[n] << y[n] << 0.0;
  two << "\n$EndNodes\n$Elements\n3\n";
  for (const std::int32_t i : {1, 1, 2, 1, 1, 1, 1, 4, 3, 2, 2, 2, 2, 1, 1, 2, 5, 4, 3, 3, 2, 2, 3, 6, 5})
    two << i; // kind, how many, tags; number, group, entity, nodes
  two << "\n$EndElements\n";

  using Int = std::int32_t;
  using Size = std::uint64_t;
  BinaryText four;
  four << "$MeshFormat\n4.1 1 8\n" << Int{1} << "\n$EndMeshFormat\n" << names;
  four << "$Entities\n" << Size{0} << Size{1} << Size{2} << Size{0};
  Int group = 0;
  for (const Int entity :
       {1, 1, 2}) { // the curve, then the surfaces; each with a box, a group, and no boundary
    four << entity;
    for (const double corner : {0.0, 0.0, 0.0, 2.0, 1.0, 0.0})
      four << corner;
    four << Size{1} << ++group << Size{0};
  }
  four << "\n$EndEntities\n$Nodes\n" << Size{1} << Size{6} << Size{1} << Size{6};
  four << Int{2} << Int{1} << Int{0} << Size{6};
  for (Size n = 1; n <= 6; ++n)
    four << n;
  for (std::size_t n = 0; n < 6; ++n)
    four << x[n] << y[n] << 0.0;
  four << "\n$EndNodes\n$Elements\n" << Size{3} << Size{3} << Size{1} << Size{3};
  four << Int{1} << Int{1} << Int{1} << Size{1} << Size{1} << Size{1} << Size{4};
  four << Int{2} << Int{1} << Int{3} << Size{1} << Size{2} << Size{1} << Size{2} << Size{5} << Size{4};
  four << Int{2} << Int{2} << Int{3} << Size{1} << Size{3} << Size{2} << Size{3} << Size{6} << Size{5};
  four << "\n$EndElements\n";

  const GmshFile ascii = plate(plate41);
  for (const BinaryText& binary : {two, four})
    expectEqual(plate(binary.text).body(""), ascii.body(""));
}

TEST_F(GmshFileTest, IsSilentAndReadsNoConfigurationOfTheUser) {
  const std::string order = folder.write(".gmsh-options", "Mesh.ElementOrder = 2;\n");
  const char* before = std::getenv("GMSH_HOME");
  const std::string home = before == nullptr ? "" : before;
  ::setenv("GMSH_HOME", std::filesystem::path(order).parent_path().c_str(), 1);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const GmshFile file(folder.write("square.geo", R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Printf("Nobody should see this.");
)"));
  expectRefused("Point(1) = {0, 0, 0};\nLine(1) = {1, 2};\n", {"Gmsh says"}, "", "bad.geo");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(file.body("").cellType(), CellType::triangle);
  if (before == nullptr)
    ::unsetenv("GMSH_HOME");
  else
    ::setenv("GMSH_HOME", home.c_str(), 1);
}

TEST_F(GmshFileTest, MeshesTrianglesOfAGeometry) {
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
  const UnstructuredMesh mesh = file.body("ring");
  EXPECT_EQ(mesh.cellType(), CellType::triangle);
  EXPECT_NEAR(measureOf(mesh), 2 * 3.14159265, 0.03);
  expectConsistent(mesh);
  expectEnclosed(mesh);
  const Surface inner = mesh.surface("inner");
  for (const Eigen::Vector3d& normal : areaVectors(mesh, inner)) // away from the ring
    EXPECT_LT(normal[0] + normal[1], 0);
}

TEST_F(GmshFileTest, MeshesQuadrilateralsOfAGeometry) {
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
  const UnstructuredMesh mesh = file.body("both");
  EXPECT_EQ(mesh.cellType(), CellType::quadrilateral);
  EXPECT_NEAR(measureOf(mesh), 3, 1e-12);
  expectConsistent(mesh);
  expectEnclosed(mesh);
  EXPECT_EQ(mesh.groupNames(), (std::vector<std::string>{"soft"}));
  double soft = 0;
  for (const GlobalOrdinal element : mesh.group("soft"))
    soft += measureOf(mesh, element);
  EXPECT_NEAR(soft, 1, 1e-12);
}

TEST_F(GmshFileTest, MeshesTetrahedraOfAGeometry) {
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
    const UnstructuredMesh mesh = file.body(group);
    EXPECT_EQ(mesh.cellType(), CellType::tetrahedron);
    EXPECT_NEAR(measureOf(mesh), 2, 1e-12);
    expectConsistent(mesh);
    EXPECT_EQ(mesh.surfaceNames().size(), group == std::string("lower") ? 3 : 2);
    EXPECT_TRUE(mesh.groupNames().empty());
  }
  expectEnclosed(file.body("upper"));
  const UnstructuredMesh lower = file.body("lower");
  for (const Eigen::Vector3d& area : areaVectors(lower, lower.surface("top of the lower one")))
    EXPECT_GT(area[2], 0);
  for (const Eigen::Vector3d& area : areaVectors(lower, lower.surface("contact")))
    EXPECT_LT(area[2], 0);
  // Nodes of the two bodies lie at the same places, which is right for bodies and wrong inside one.
  expectRefusal([&] { (void)file.body(""); }, {"Mesh file", "are both at"});
}

TEST_F(GmshFileTest, MeshesHexahedraOfAnExtrusion) {
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
  const UnstructuredMesh mesh = file.body("block");
  EXPECT_EQ(mesh.cellType(), CellType::hexahedron);
  EXPECT_EQ(mesh.numElements(), 4 * 3 * 2);
  EXPECT_EQ(mesh.numNodes(), 5 * 4 * 3);
  EXPECT_NEAR(measureOf(mesh), 6, 1e-12);
  expectConsistent(mesh);
  expectEnclosed(mesh);
}

TEST_F(GmshFileTest, NamesTheFileThatIsMissingOrUnreadable) {
  expectRefusal([&] { GmshFile(folder.path("nothing.msh")); }, {"There is no mesh file", "nothing.msh"});
  expectRefusal([&] { GmshFile(folder.path("part.stl")); }, {"part.stl", "must end in .msh or .geo"});
  expectRefused("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n",
                {"plate.msh", "Gmsh says: Could not read nodes"});
  expectRefused("Point(1) = {0, 0, 0};\nLine(1) = {1, 2};\n",
                {"bad.geo", "Gmsh says: Unknown control point 2"}, "", "bad.geo");
  expectRefused("Point(1) = {0, 0, 0};", {"bad.geo", "end it with a line break"}, "", "bad.geo");
  expectRefused("Point(1) = {0, 0, 0};\n", {"bad.geo", "no elements of dimension 2 or 3"}, "", "bad.geo");
  EXPECT_EQ(plate(plate41).body("").numElements(), 2); // none of these leaves Gmsh out of order
}

TEST_F(GmshFileTest, NamesTheGroupsThereAre) {
  expectRefused(plate41,
                {"no physical group \"wset\" of dimension 2", "there are \"west\" and \"right\"",
                 "did you mean \"west\"?"},
                "wset");
  expectRefused(plate41, {"no physical group \"left\"", "one of lower dimension"}, "left");
  expectRefused(replaced(replaced(plate41, "1 1 0 1 2 0", "1 1 0 0 0"), "2 1 0 1 3 0", "2 1 0 0 0"),
                {"no physical group \"west\"", "no other either"}, "west");
  expectRefused(replaced(plate41, "\"right\"", "\"west\""), {"two physical groups \"west\" of dimension 2"});
}

TEST_F(GmshFileTest, RefusesMixedAndCurvedElements) {
  const std::string mixed = replaced(replaced(plate22, "$Elements\n4", "$Elements\n5"), "3 3 2 3 2 2 3 6 5",
                                     "3 2 2 3 2 2 3 6\n5 2 2 3 2 2 6 5");
  expectRefused(mixed,
                {"Mesh file", "mixes triangles and quadrilaterals", "triangles alone or of quadrilaterals"});
  expectRefused(replaced(mixed, "2 3 2 2 1", "2 3 2 3 1"), {"Body \"right\"", "mixes"}, "right");
  const UnstructuredMesh right = plate(mixed).body("right"); // each body of one kind
  EXPECT_EQ(right.cellType(), CellType::triangle);
  expectRefused(R"(SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Mesh.ElementOrder = 2;
)",
                {"curved.geo", "second or higher order", "Mesh.ElementOrder = 1"}, "", "curved.geo");
  expectRefused(R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
6
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 0 1
6 0 1 1
$EndNodes
$Elements
1
1 6 2 0 1 1 2 3 4 5 6
$EndElements
)",
                {"is made of prisms", "tetrahedra alone or of hexahedra alone"});
}

TEST_F(GmshFileTest, RefusesWhatTheChecksRefuseByTheFilesNumbers) {
  expectRefused(replaced(plate41, "2 1 2 5 4", "2 1 4 5 2"), {"west", "element 2 is inverted"}, "west");
  expectRefused(replaced(plate41, "3 2 3 6 5", "3 2 3 6 6"), {"element 3 has node 6 twice"});
  expectRefused(replaced(plate41, "5\n1 0 0\n1 1 0", "5\n1 0 0.5\n1 1 0"), {"node 2 lies at z = 0.5"});
  const std::string doubled = replaced(replaced(plate22, "$Elements\n4", "$Elements\n5"), "3 3 2 3 2 2 3 6 5",
                                       "3 3 2 3 2 2 3 6 5\n7 3 2 2 2 2 3 6 5");
  expectRefused(doubled, {"element 3 and element 7 have the same nodes", "format 4.1"});
}

TEST_F(GmshFileTest, RefusesSolidElementsNumberedTheOtherWayRound) {
  const std::string sound = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
5
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 0 0 -1
$EndNodes
$Elements
2
11 4 2 1 1 1 2 3 4
12 4 2 1 1 1 3 2 5
$EndElements
)";
  EXPECT_EQ(plate(sound).body("1").numElements(), 2);
  expectRefused(replaced(sound, "1 3 2 5", "1 2 3 5"),
                {"Body \"1\"", "element 12 is inverted (volume -0.166"}, "1");
}

TEST_F(GmshFileTest, RefusesNodesOfTheBodyOrASurfaceWithoutAnElement) {
  const std::string more = replaced(plate41, "4 7 1 9", "4 8 1 9");
  const std::string inBody =
      replaced(more, "2 2 0 2\n3\n6\n2 0 0\n2 1 0\n", "2 2 0 3\n3\n6\n8\n2 0 0\n2 1 0\n1.5 0.5 0\n");
  expectRefused(inBody, {"Body \"right\"", "node 8 at (1.5, 0.5)", "none of its elements"}, "right");
  EXPECT_EQ(plate(inBody).body("west").numNodes(), 4); // it is none of its nodes
  const std::string onSurface =
      replaced(more, "1 1 0 2\n1\n4\n0 0 0\n0 1 0\n", "1 1 0 3\n1\n4\n8\n0 0 0\n0 1 0\n0 0.5 0\n");
  expectRefused(onSurface, {"node 8 is listed with the surface \"left\""});
}

TEST_F(GmshFileTest, RefusesSurfacesInsideTheBodyOrWithoutIt) {
  const std::string inside = replaced(plate41, "1 1 1 1\n1 1 4", "1 1 1 1\n1 2 5");
  expectRefused(inside, {"the surface \"left\"", "nodes 2, 5", "inside the body"});
  EXPECT_EQ(plate(inside).body("west").surfaceNames(),
            (std::vector<std::string>{"left"})); // between two bodies
  EXPECT_EQ(plate(inside).body("right").surface("left").facetNodes, (std::vector<GlobalOrdinal>{3 - 1, 0}));
  expectRefused(replaced(plate41, "1 1 1 1\n1 1 4", "1 1 1 1\n1 1 6"),
                {"the surface \"left\" has a facet (element 1)", "no element of dimension 2"});
  expectRefused(replaced(plate41, "1 1 1 1\n1 1 4", "1 1 1 1\n1 1 5"),
                {"nodes 1, 5", "no facet of any element"});
}

} // namespace
} // namespace epafi::fem
