// The XDMF text for a grid small enough to read.

#include "epafi/output/Xdmf.hpp"

#include <gtest/gtest.h>

namespace epafi::output {
namespace {

using mesh::CellType;
using Type = XdmfData::Type;
using Center = XdmfAttribute::Center;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(XdmfTest, MeshGridNamesItsDatasetsWithTheirDimensionsAndTypes) {
  const XdmfGrid grid{"left",
                      {"/bodies/left/points", 9, 3},
                      CellType::quadrilateral,
                      {"/bodies/left/cells", 4, 4, Type::integer8},
                      {{"u", Center::node, {"/bodies/left/u", 9, 1}},
                       {"subdomain", Center::cell, {"/bodies/left/subdomain", 4, 0, Type::integer4}}}};
  const std::string text = xdmfDocument("run.h5", {grid});
  EXPECT_TRUE(contains(text, "TopologyType=\"Quadrilateral\" NumberOfElements=\"4\""));
  EXPECT_TRUE(
      contains(text, "Dimensions=\"9 3\" NumberType=\"Float\" Precision=\"8\">run.h5:/bodies/left/points<"));
  EXPECT_TRUE(
      contains(text, "Dimensions=\"4 4\" NumberType=\"Int\" Precision=\"8\">run.h5:/bodies/left/cells<"));
  EXPECT_TRUE(
      contains(text, "Dimensions=\"9 1\" NumberType=\"Float\" Precision=\"8\">run.h5:/bodies/left/u<"));
  EXPECT_TRUE(
      contains(text, "Dimensions=\"4\" NumberType=\"Int\" Precision=\"4\">run.h5:/bodies/left/subdomain<"));
}

TEST(XdmfTest, CellsOfOnePointAreACloudOfPoints) {
  const std::string text = xdmfDocument("run.h5", {{"pair",
                                                    {"/contact/pair/points", 5, 3},
                                                    std::nullopt,
                                                    {"/contact/pair/cells", 5, 1, Type::integer8},
                                                    {}}});
  EXPECT_TRUE(contains(text, "TopologyType=\"Polyvertex\" NodesPerElement=\"1\" NumberOfElements=\"5\">"));
  EXPECT_TRUE(
      contains(text, "Dimensions=\"5 1\" NumberType=\"Int\" Precision=\"8\">run.h5:/contact/pair/cells<"));
}

TEST(XdmfTest, EveryTypeOfCellHasItsName) {
  const auto text = [](CellType type, int corners) {
    return xdmfDocument("run.h5", {{"a", {"/p", 9, 3}, type, {"/c", 2, corners, Type::integer8}, {}}});
  };
  EXPECT_TRUE(contains(text(CellType::line, 2), "TopologyType=\"Polyline\" NodesPerElement=\"2\""));
  EXPECT_TRUE(contains(text(CellType::triangle, 3), "TopologyType=\"Triangle\""));
  EXPECT_TRUE(contains(text(CellType::tetrahedron, 4), "TopologyType=\"Tetrahedron\""));
  EXPECT_TRUE(contains(text(CellType::hexahedron, 8), "TopologyType=\"Hexahedron\""));
  EXPECT_TRUE(contains(text(CellType::prism, 6), "TopologyType=\"Wedge\""));
  EXPECT_TRUE(contains(text(CellType::pyramid13, 13), "TopologyType=\"Pyramid_13\""));
  EXPECT_TRUE(contains(text(CellType::quadrilateral8, 8), "TopologyType=\"Quadrilateral_8\""));
  EXPECT_TRUE(contains(text(CellType::hexahedron20, 20), "TopologyType=\"Hexahedron_20\""));
}

/// A prism and a pyramid: each its number and its nodes.
TEST(XdmfTest, CellsOfSeveralTypesAreASequence) {
  XdmfGrid grid{"a", {"/p", 7, 3}, CellType::prism, {"/c", 13, 0, Type::integer8}, {}};
  grid.numMixed = 2;
  const std::string text = xdmfDocument("run.h5", {grid});
  EXPECT_TRUE(contains(text, "TopologyType=\"Mixed\" NumberOfElements=\"2\""));
  EXPECT_TRUE(contains(text, "Dimensions=\"13\""));
  EXPECT_EQ(xdmfNumber(CellType::prism), 8);
  EXPECT_EQ(xdmfNumber(CellType::pyramid), 7);
}

TEST(XdmfTest, KindOfAttributeFollowsTheNumberOfColumns) {
  const auto kind = [](int columns) {
    return xdmfDocument("run.h5",
                        {{"a", {"/p", 5, 3}, std::nullopt, {}, {{"u", Center::node, {"/u", 5, columns}}}}});
  };
  EXPECT_TRUE(contains(kind(1), "AttributeType=\"Scalar\""));
  EXPECT_TRUE(contains(kind(2), "AttributeType=\"Matrix\""));
  EXPECT_TRUE(contains(kind(3), "AttributeType=\"Vector\""));
}

TEST(XdmfTest, EachLoadStepHasItsTimeItsFieldsAndTheMeshOfAll) {
  const XdmfGrid grid{
      "a", {"/p", 1, 3}, std::nullopt, {}, {{"u", Center::node, {"/u", 1, 0, Type::real8, true}}}};
  const std::string text = xdmfDocument("run.h5", {grid}, {{"out", 1, "/steps/out"}, {"&", 3, "/steps/_"}});
  EXPECT_TRUE(contains(text, "CollectionType=\"Temporal\">\n    <Grid Name=\"out\" "));
  EXPECT_TRUE(contains(text, "<Grid Name=\"&amp;\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
                             "      <Time Value=\"3\"/>"));
  EXPECT_TRUE(contains(text, ">run.h5:/steps/out/u<"));
  EXPECT_TRUE(contains(text, ">run.h5:/steps/_/u<"));
  EXPECT_FALSE(contains(text, "/steps/out/p"));
}

TEST(XdmfTest, NamesAreEscaped) {
  const std::string text = xdmfDocument("a&b.h5", {{"<\"x\">", {"/p", 1, 3}, std::nullopt, {}, {}}});
  EXPECT_TRUE(contains(text, "Name=\"&lt;&quot;x&quot;&gt;\""));
  EXPECT_TRUE(contains(text, ">a&amp;b.h5:/p<"));
}

} // namespace
} // namespace epafi::output
