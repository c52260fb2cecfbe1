#include "support/GmshPlate.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <type_traits>

namespace epafi::meshing {
namespace {

using test::measureOf;
using test::plate22;
using test::plate41;
using test::replaced;

using GmshFileTest = test::GmshTest;

void expectEqual(const mesh::UnstructuredMesh& a, const mesh::UnstructuredMesh& b) {
  ASSERT_EQ(a.cellType(), b.cellType());
  ASSERT_EQ(a.numNodes(), b.numNodes());
  ASSERT_EQ(a.numElements(), b.numElements());
  for (GlobalOrdinal node = 0; node < a.numNodes(); ++node) {
    EXPECT_EQ(a.point(node), b.point(node));
    EXPECT_EQ(a.nodeTag(node), b.nodeTag(node));
  }
  std::vector<GlobalOrdinal> nodes(a.nodesPerElement()), other = nodes;
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

TEST_F(GmshFileTest, FormatsTwoAndFourGiveTheSameMesh) {
  const GmshFile two = plate(plate22), four = plate(plate41);
  for (const char* group : {"", "west", "right"})
    expectEqual(two.body(group), four.body(group));
  EXPECT_EQ(two.groupNames(), (std::vector<std::string>{"west", "right"}));
  EXPECT_EQ(two.groupNames(), four.groupNames());
  EXPECT_EQ(four.dimension(), 2);
}

TEST_F(GmshFileTest, AllElementsAreTheBodyIfNoGroupIsNamed) {
  const mesh::UnstructuredMesh all = plate(plate41).body("");
  EXPECT_EQ(all.cellType(), mesh::CellType::quadrilateral);
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
  const mesh::UnstructuredMesh west = file.body("west"), right = file.body("right");
  EXPECT_EQ(west.surfaceNames(), (std::vector<std::string>{"left"}));
  EXPECT_TRUE(right.surfaceNames().empty());
  EXPECT_TRUE(right.groupNames().empty());
  EXPECT_EQ(right.numNodes(), 4);
  EXPECT_EQ(right.nodeTag(0), 2);
  EXPECT_EQ(right.elementTag(0), 3);
  EXPECT_EQ(right.point(1), (Point{2, 0, 0}));
}

TEST_F(GmshFileTest, GroupsOfPointsAreSetsOfNodes) {
  std::string text = replaced(plate41, "3\n1 1 \"left\"", "4\n0 7 \"tip\"\n1 1 \"left\"");
  text = replaced(text, "3 5 5 0 0\n", "3 5 5 0 1 7\n");
  const std::string others = "$Elements\n3 3 1 3\n", withPoint = "$Elements\n4 4 1 4\n0 3 15 1\n";
  const auto named = [&](const std::string& node) {
    return plate(replaced(text, others, withPoint + "4 " + node + '\n'));
  };
  EXPECT_TRUE(named("9").body("").nodeSetNames().empty()) << "node 9 is none of the body";
  const GmshFile file = named("6");
  const mesh::UnstructuredMesh all = file.body(""), right = file.body("right");
  EXPECT_EQ(all.nodeSetNames(), std::vector<std::string>{"tip"});
  EXPECT_EQ(all.nodeSet("tip"), std::vector<GlobalOrdinal>{5});
  EXPECT_EQ(right.nodeTag(right.nodeSet("tip").at(0)), 6);
  EXPECT_TRUE(file.body("west").nodeSetNames().empty());
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
  EXPECT_EQ(file.body("").cellType(), mesh::CellType::triangle);
  if (before == nullptr)
    ::unsetenv("GMSH_HOME");
  else
    ::setenv("GMSH_HOME", home.c_str(), 1);
}

} // namespace
} // namespace epafi::meshing
