#include "support/GmshPlate.hpp"

#include "epafi/meshing/GmshReader.hpp"
#include "epafi/meshing/MshReader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace epafi::meshing {
namespace {

using test::elements41;
using test::expectRefusal;
using test::head41;
using test::nodes41;
using test::plate22;
using test::plate41;
using test::replaced;

using MshReaderTest = test::GmshTest;

GmshContents contentsOf(const std::string& file) {
  return readMsh(file, textOfMeshFile(file));
}

void expectMshRefused(const std::string& text, const std::vector<std::string>& parts) {
  std::vector<std::string> all = parts;
  all.emplace_back("The mesh file \"a.msh\"");
  expectRefusal([&] { (void)readMsh("a.msh", text); }, all);
}

/// An element: its kind, and its nodes by their places in units of 1e-9, since Gmsh numbers anew what it
/// saves.
using Element = std::vector<std::array<long long, 3>>;

std::multiset<Element> elementsOf(const GmshContents& file, const GmshBlock& block) {
  std::multiset<Element> elements;
  const std::size_t count = numNodesOfGmsh(block.type);
  for (std::size_t e = 0; e < block.tags.size(); ++e) {
    Element element{{block.type, 0, 0}};
    for (std::size_t i = 0; i < count; ++i) {
      const Point& point = file.points[block.nodes[e * count + i]];
      element.push_back(
          {std::llround(1e9 * point[0]), std::llround(1e9 * point[1]), std::llround(1e9 * point[2])});
    }
    elements.insert(element);
  }
  return elements;
}

/// All elements, under the name "", and those of each group.
std::map<std::string, std::multiset<Element>> groupsOf(const GmshContents& file,
                                                       const std::vector<GmshGroup>& groups,
                                                       const std::vector<GmshBlock>& blocks) {
  std::map<std::string, std::multiset<Element>> elements;
  for (const GmshBlock& block : blocks) {
    elements[""].merge(elementsOf(file, block));
    for (const GmshGroup& group : groups)
      if (std::binary_search(group.entities.begin(), group.entities.end(), block.entity))
        elements[group.name].merge(elementsOf(file, block));
  }
  return elements;
}

/// Equal up to numbers.
void expectEqual(const GmshContents& a, const GmshContents& b) {
  EXPECT_EQ(a.dimension, b.dimension);
  EXPECT_FALSE(a.elements.empty());
  EXPECT_EQ(groupsOf(a, a.groups, a.elements), groupsOf(b, b.groups, b.elements));
  EXPECT_EQ(groupsOf(a, a.surfaces, a.facets), groupsOf(b, b.surfaces, b.facets));
}

/// Two bodies with groups, of triangles and of hexahedra.
const std::string plates = R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1}; Rectangle(2) = {2, 0, 0, 1, 1};
Coherence;
Mesh.MeshSizeMax = 0.4;
Physical Surface("west") = {1}; Physical Surface(7) = {2};
Physical Curve("left") = {4}; Physical Curve("ends of the east") = {5, 7};
)";
const std::string blocks = R"(
Point(1) = {0, 0, 0};
line() = Extrude {2, 0, 0} { Point{1}; Layers{3}; };
face() = Extrude {0, 1, 0} { Line{line(1)}; Layers{2}; Recombine; };
lower() = Extrude {0, 0, 1} { Surface{face(1)}; Layers{2}; Recombine; };
upper() = Extrude {0, 0, 1} { Surface{lower(0)}; Layers{1}; Recombine; };
Physical Volume("lower") = {lower(1)}; Physical Volume("upper") = {upper(1)};
Physical Surface("floor") = {face(1)}; Physical Surface("top") = {upper(0)};
)";

TEST_F(MshReaderTest, ReadsWhatGmshWritesAlikeInAllFormats) {
  for (const std::string& geometry : {plates, blocks})
    for (const char* format : {"2.2", "4.1"})
      for (const char* binary : {"0", "1"})
        for (const char* also : {"", "Mesh.SaveParametric = 1;\n", "Mesh.NbPartitions = 2;\n"}) {
          SCOPED_TRACE(std::string(format) + ' ' + binary + ' ' + also + geometry);
          const std::string partitioned = std::string(also).find("Part") != std::string::npos
                                              ? "Mesh.PartitionCreateTopology = 0;\nPartitionMesh 2;\n"
                                              : "";
          const GmshContents had = contentsOf(folder.write(
              "part.geo", geometry + "Mesh.MshFileVersion = " + format + ";\nMesh.Binary = " + binary +
                              ";\n" + also + "Mesh " + (geometry == blocks ? '3' : '2') + ";\n" +
                              partitioned + "Save \"part.msh\";\n"));
          expectEqual(contentsOf(folder.path("part.msh")), had);
        }
}

TEST_F(MshReaderTest, GroupsOfFormatTwoHoldTheElementsThatNameThem) {
  // Both squares on entity 1, as programs other than Gmsh write them.
  const mesh::UnstructuredMesh all = plate(replaced(plate22, "3 3 2 3 2 2", "3 3 2 3 1 2")).body("");
  EXPECT_EQ(all.group("west"), (std::vector<GlobalOrdinal>{0}));
  EXPECT_EQ(all.group("right"), (std::vector<GlobalOrdinal>{1}));
}

TEST_F(MshReaderTest, PassesOverWhatItDoesNotNeed) {
  const std::string comment = "$Comments\n$Nodes\nnot these\n$EndComments\n";
  const std::string data = "$NodeData\n1\n\"u\"\n1\n0\n3\n0\n1\n1\n1 0.5\n$EndNodeData\n";
  for (const std::string& file : {plate22, plate41}) {
    const GmshContents plain = readMsh("a.msh", file);
    expectEqual(readMsh("a.msh", "\n" + comment + file + "\n" + data), plain);
    std::string windows;
    for (const char letter : file)
      windows += letter == '\n' ? std::string("\r\n") : std::string(1, letter);
    expectEqual(readMsh("a.msh", windows), plain);
  }
  expectEqual(readMsh("a.msh", replaced(plate22, "2.2 0 8", "2 0 8")), readMsh("a.msh", plate22));
}

TEST_F(MshReaderTest, RefusesEveryFileThatIsCutOff) {
  for (const std::string& file : {plate22, plate41})
    for (std::size_t length = 0; length + 1 < file.size(); ++length)
      EXPECT_THROW((void)readMsh("a.msh", file.substr(0, length)), InputError) << length;
}

TEST_F(MshReaderTest, NamesTheLineThatIsWrong) {
  expectMshRefused("solid part\n", {"line 1", "\"solid part\"", "no mesh file of Gmsh"});
  expectMshRefused("", {"$MeshFormat is missing"});
  expectMshRefused(plate22.substr(plate22.find("$Nodes")), {"line 1", "$MeshFormat should come first"});
  expectMshRefused(replaced(plate41, "4.1 0 8", "4 0 8"), {"line 2", "format 4 ", "4.1 or 2.2"});
  expectMshRefused(replaced(plate41, "4.1 0 8", "4.1 0 4"), {"line 2", "\"0 4\""});
  expectMshRefused(replaced(plate41, "4.1 0 8", "4.1 1 8"), {"another order of bytes"});
  expectMshRefused(replaced(plate22, "2 1 0 0", "2 one 0 0"), {"line 13", "a number", "\"one\""});
  expectMshRefused(replaced(plate22, "$EndNodes", "$EndKnots"), {"line 19", "$EndNodes", "\"$EndKnots\""});
  expectMshRefused(replaced(plate41, "$EndNodes\n", "$EndNodes\nand so on\n"), {"\"and so on\""});
  expectMshRefused(plate41 + "$Views\n1\n", {"$Views has no end"});
  expectMshRefused(plate41 + nodes41, {"second section $Nodes"});
  expectMshRefused(replaced(plate22, "$Nodes", "$Entities\n0 0 0 0\n$EndEntities\n$Nodes"),
                   {"no section $Entities"});
  expectMshRefused(
      replaced(replaced(plate41, "$Nodes", "$ParametricNodes"), "$EndNodes", "$EndParametricNodes"),
      {"no section $ParametricNodes"});
  expectMshRefused(replaced(plate22, "2 2 \"west\"", "2 2 west"), {"line 7", "2 2 west"});
  expectMshRefused(replaced(plate22, "2 2 \"west\"", "4 2 \"west\""), {"line 7", "physical group"});
  expectMshRefused(replaced(plate22, "\"west\"", "\"we\x1bst\""), {"\"we?st\"", "control characters"});
}

TEST_F(MshReaderTest, RefusesPromisesThatTheFileCannotKeep) {
  expectMshRefused(replaced(plate22, "$Nodes\n7", "$Nodes\n2000000000"),
                   {"promises 2000000000 nodes", "at most"});
  expectMshRefused(replaced(plate22, "$Nodes\n7", "$Nodes\n-7"), {"promises -7 nodes"});
  expectMshRefused(replaced(plate22, "$Elements\n4", "$Elements\n99999999999999999999"), {"too large"});
  expectMshRefused(replaced(plate41, "$Nodes\n4 7 1 9", "$Nodes\n4 8 1 9"), {"7 nodes, but should hold 8"});
  expectMshRefused(replaced(plate41, "$Elements\n3 3", "$Elements\n3 2"), {"3 elements, but should hold 2"});
  expectMshRefused(replaced(plate41, "1 1 0 2\n1\n4", "5 1 0 2\n1\n4"), {"no dimension 5"});
}

TEST_F(MshReaderTest, RefusesElementsThatCannotBe) {
  expectMshRefused(replaced(plate22, "3 3 2 3 2 2 3 6 5", "3 3 2 3 2 2 3 6 8"), {"node 8, but no such node"});
  expectMshRefused(replaced(plate22, "3 3 2 3 2 2 3 6 5", "3 3 2 3 2 2 3 6 -5"), {"the number -5"});
  expectMshRefused(replaced(plate22, "6 2 1 0\n9 5 5 0", "6 2 1 0\n6 5 5 0"), {"node 6 twice"});
  expectMshRefused(replaced(plate22, "3 3 2 3 2 2", "3 21 2 3 2 2"),
                   {"element 3", "kind 21", "higher order"});
  expectMshRefused(replaced(plate22, "3 3 2 3 2 2", "3 -3 2 3 2 2"), {"element 3", "kind -3"});
  expectMshRefused(replaced(plate22, "3 3 2 3 2 2", "3 3 -2 3 2 2"), {"-2 tags"});
  expectMshRefused(replaced(plate22, "3 3 2 3 2 2", "3 3 2 -2147483648 2 2"), {"group", "-2147483648"});
  expectMshRefused(replaced(plate41, "2 2 3 1\n3", "1 2 3 1\n3"), {"element 3", "dimension 1", "kind has 2"});
  expectMshRefused(head41 + nodes41, {"no elements of dimension 2 or 3"});
  expectMshRefused(head41 + elements41, {"node 1, but no such node"});
}

/// As Gmsh writes groups that overlap in format 2.2: one element of two groups, whatever order its nodes are
/// in.
TEST_F(MshReaderTest, ReadsElementsListedOncePerGroupAsOne) {
  const std::string text = replaced(replaced(plate22, "$Elements\n4", "$Elements\n5"), "3 3 2 3 2 2 3 6 5",
                                    "3 3 2 3 2 2 3 6 5\n7 3 2 2 2 3 6 5 2");
  const GmshFile file(readMsh("plate.msh", text));
  const mesh::UnstructuredMesh all = file.body(""), west = file.body("west"), right = file.body("right");
  EXPECT_EQ(all.numElements(), 2);
  EXPECT_EQ(all.group("west").size(), 2U);
  EXPECT_EQ(all.group("right").size(), 1U);
  EXPECT_EQ(west.numElements(), 2);
  EXPECT_EQ(west.group("right").size(), 1U);
  EXPECT_EQ(right.numElements(), 1);
}

TEST_F(MshReaderTest, ReadsNumbersAsLargeAsGmshAllows) {
  std::string text = plate22;
  for (const auto& [small, large] : {std::pair{"6 2 1 0\n", "5000000006 2 1 0\n"},
                                     {"3 3 2 3 2 2 3 6 5", "6000000003 3 2 3 2 2 3 5000000006 5"}})
    text = replaced(text, small, large);
  const GmshContents contents = readMsh("plate.msh", text);
  EXPECT_EQ(contents.nodeTags.back(), 5000000006);
  EXPECT_EQ(GmshFile(contents).body("").numElements(), 2);
}

} // namespace
} // namespace epafi::meshing
