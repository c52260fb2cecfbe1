#include "support/GmshPlate.hpp"

#include "epafi/meshing/GmshReader.hpp"

#include <gtest/gtest.h>

namespace epafi::meshing {
namespace {

using test::expectRefusal;
using test::plate22;
using test::plate41;
using test::replaced;

using GmshRefusalsTest = test::GmshTest;

TEST_F(GmshRefusalsTest, NamesTheFileThatIsMissingOrUnreadable) {
  expectRefusal([&] { GmshFile(folder.path("nothing.msh")); }, {"There is no mesh file", "nothing.msh"});
  expectRefusal([&] { GmshFile(folder.path("part.stl")); },
                {"part.stl", "must end in .msh, .geo, .step or .inp"});
  expectRefused("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n",
                {"plate.msh", "line 5", "promises 2 nodes"});
  expectRefused("Point(1) = {0, 0, 0};\nLine(1) = {1, 2};\n",
                {"bad.geo", "Gmsh says: Unknown control point 2"}, "", "bad.geo");
  expectRefused("Point(1) = {0, 0, 0};", {"bad.geo", "end it with a line break"}, "", "bad.geo");
  expectRefused("Point(1) = {0, 0, 0};\n", {"bad.geo", "no elements of dimension 2 or 3"}, "", "bad.geo");
  EXPECT_EQ(plate(plate41).body("").numElements(), 2); // none of these leaves Gmsh out of order
}

TEST_F(GmshRefusalsTest, NamesTheGroupsThereAre) {
  expectRefused(plate41,
                {"no physical group \"wset\" of dimension 2", "there are \"west\" and \"right\"",
                 "did you mean \"west\"?"},
                "wset");
  expectRefused(plate41, {"no physical group \"left\"", "one of lower dimension"}, "left");
  expectRefused(replaced(replaced(plate41, "1 1 0 1 2 0", "1 1 0 0 0"), "2 1 0 1 3 0", "2 1 0 0 0"),
                {"no physical group \"west\"", "no other either"}, "west");
  expectRefused(replaced(plate41, "\"right\"", "\"west\""), {"two physical groups \"west\" of dimension 2"});
}

TEST_F(GmshRefusalsTest, RefusesElementsThatDoNotGoTogetherAndCurvedOnes) {
  const std::string mixed = replaced(replaced(plate22, "$Elements\n4", "$Elements\n5"), "3 3 2 3 2 2 3 6 5",
                                     "3 2 2 3 2 2 3 6\n5 2 2 3 2 2 6 5");
  const mesh::UnstructuredMesh right = plate(mixed).body("right"); // what is alone has a type of its own
  EXPECT_EQ(right.cellType(), mesh::CellType::triangle);
  EXPECT_EQ(plate(mixed).body("").cellType(), mesh::CellType::quadrilateral);
  expectRefused(replaced(mixed, "3 2 2 3 2 2 3 6", "3 9 2 3 2 2 3 6 1 4 5"),
                {"Mesh file", "mixes elements of"});
  expectRefused(R"(SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Mesh.ElementOrder = 3;
)",
                {"curved.geo", "third or higher order", "Mesh.ElementOrder = 2"}, "", "curved.geo");
  expectRefused(R"($MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
18
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 0 1
6 0 1 1
7 0.5 0 0
8 0 0.5 0
9 0 0 0.5
10 0.5 0.5 0
11 1 0 0.5
12 0 1 0.5
13 0.5 0 1
14 0 0.5 1
15 0.5 0.5 1
16 0.5 0 0.5
17 0 0.5 0.5
18 0.5 0.5 0.5
$EndNodes
$Elements
1
1 13 2 0 1 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18
$EndElements
)",
                {"has prisms with nodes in the middle of their faces", "Mesh.SecondOrderIncomplete = 1"});
}

TEST_F(GmshRefusalsTest, RefusesWhatTheChecksRefuseByTheFilesNumbers) {
  expectRefused(replaced(plate41, "2 1 2 5 4", "2 1 4 5 2"), {"west", "element 2 is inverted"}, "west");
  expectRefused(replaced(plate41, "3 2 3 6 5", "3 2 3 6 6"), {"element 3 has node 6 twice"});
  expectRefused(replaced(plate41, "5\n1 0 0\n1 1 0", "5\n1 0 0.5\n1 1 0"), {"node 2 lies at z = 0.5"});
  const std::string doubled = replaced(replaced(plate22, "$Elements\n4", "$Elements\n5"), "3 3 2 3 2 2 3 6 5",
                                       "3 3 2 3 2 2 3 6 5\n7 3 2 3 2 2 3 6 5");
  expectRefused(doubled, {"element 3 and element 7 have the same nodes", "list an element once"});
}

TEST_F(GmshRefusalsTest, RefinesElementsOfSeveralGroupsOfFormat41Alone) {
  const std::string twice = replaced(
      replaced(replaced(plate22, "$Elements\n4", "$Elements\n5"), "3 3 2 3 2", "7 1 2 4 2 1 4\n3 3 2 3 2"),
      "3\n1 1 \"left\"", "4\n1 4 \"skin\"\n1 1 \"left\"");
  EXPECT_EQ(plate(twice).body("").surfaceNames(), (std::vector<std::string>{"left", "skin"}));
  const std::string file = folder.write("plate.msh", twice);
  expectRefusal([&] { (void)textOfMeshFile(file, 1, 1, 0); }, {"plate.msh", "must be saved in format 4.1"});
}

TEST_F(GmshRefusalsTest, RefusesSolidElementsNumberedTheOtherWayRound) {
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

TEST_F(GmshRefusalsTest, RefusesNodesOfTheBodyOrASurfaceWithoutAnElement) {
  const std::string more = replaced(plate41, "4 7 1 9", "4 8 1 9");
  const std::string inBody =
      replaced(more, "2 2 0 2\n3\n6\n2 0 0\n2 1 0\n", "2 2 0 3\n3\n6\n8\n2 0 0\n2 1 0\n1.5 0.5 0\n");
  expectRefused(inBody, {"Body \"right\"", "node 8 at (1.5, 0.5)", "none of its elements"}, "right");
  EXPECT_EQ(plate(inBody).body("west").numNodes(), 4); // it is none of its nodes
  const std::string onSurface =
      replaced(more, "1 1 0 2\n1\n4\n0 0 0\n0 1 0\n", "1 1 0 3\n1\n4\n8\n0 0 0\n0 1 0\n0 0.5 0\n");
  expectRefused(onSurface, {"node 8 is listed with the surface \"left\""});
}

TEST_F(GmshRefusalsTest, RefusesSurfacesInsideTheBodyOrWithoutIt) {
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

TEST_F(GmshRefusalsTest, SaysWhatIsWrongWithNumbersAndFormats) {
  expectRefused(replaced(plate22, "4 0 1 0", "4 0 1.0D+00 0"), {"line 15", "1.0D+00", "Fortran's D"});
  expectRefused(replaced(plate22, "4 0 1 0", "40000000000000000000 0 1 0"), {"line 15", "too large"});
  expectRefused("$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n", {"format 1", "4.1 or 2.2"});
}

/// A quadratic mesh too coarse for a wall is neither numbered wrongly nor to be moved node by node.
TEST_F(GmshRefusalsTest, NamesSizesWhereAMeshIsTooCoarse) {
  const std::string cam = R"(SetFactory("OpenCASCADE");
Disk(1) = {0, 0, 0, 10}; Disk(2) = {0, 5.8, 0, 4};
BooleanDifference{ Surface{1}; Delete; }{ Surface{2}; Delete; }
Mesh.MeshSizeMax = 4;
Mesh.ElementOrder = 2;
)";
  expectRefused(cam, {"cam.geo", "too coarse", "Mesh Size Factor"}, "", "cam.geo");
}

/// Mistakes of geometries, and what Gmsh makes of them: errors in its threads over surfaces, its end, nothing
/// at all.
TEST_F(GmshRefusalsTest, OutlivesGmshAndLeavesNoFiles) {
  const std::string square = R"(
Point(1) = {0, 0, 0, 0.5}; Point(2) = {1, 0, 0, 0.5}; Point(3) = {1, 1, 0, 0.5}; Point(4) = {0, 1, 0, 0.5};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
)";
  const std::string uneven = square + "Transfinite Curve{:} = 5; Transfinite Curve{3} = 7;\n",
                    solid = square +
                            "Extrude {0, 0, 1} { Surface{1}; }\nTransfinite Curve{:} = 3; Transfinite "
                            "Curve{1} = 5;\n";
  const std::filesystem::path before = std::filesystem::temp_directory_path();
  const std::string own = folder.path("temporary");
  std::filesystem::create_directories(own);
  ::setenv("TMPDIR", own.c_str(), 1);
  for (const std::string& text : {uneven + "Transfinite Surface{1};\n", solid + "Transfinite Surface{:};\n"})
    try { // later releases of Gmsh mesh them as if not asked for rows
      const GmshFile file(folder.write("uneven.geo", text));
      EXPECT_NEAR(test::measureOf(file.body("")), 1, 1e-12);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("cannot be meshed using the transfinite algo"),
                std::string::npos)
          << error.what();
    }
  expectRefused(square + "Mesh 2;\nExit;\n", {"exit.geo", "ended of its own accord", "Exit"}, "", "exit.geo");
  expectRefused(replaced(square, "{1, 2, 3, 4}", "{1, 2, 3}"), {"open.geo", "Gmsh says: "}, "", "open.geo");
  expectRefused(square + "Error(\"no %g\", 7);\nMerge \"nothing.stl\";\n", {"Gmsh says: no 7"}, "",
                "first.geo"); // the first of several
  EXPECT_TRUE(std::filesystem::is_empty(own));
  ::setenv("TMPDIR", before.c_str(), 1);
}

} // namespace
} // namespace epafi::meshing
