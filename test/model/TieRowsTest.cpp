// Ties hold all turns, beside contacts and supports too, and say where their forces are not unique.

#include "support/BlockScenes.hpp"
#include "support/Refusal.hpp"

#include "epafi/model/TiedNodes.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

namespace epafi::model {
namespace {

/// Mortars hold the nodes of one side alone, whichever that is of a contact by pairs beside them.
TEST(TieRowsTest, NodesOfEitherSideThatMortarsHoldHaveNoPairInAContact) {
  for (const bool isOfFirst : {true, false}) {
    SCOPED_TRACE(isOfFirst);
    ContactLayout tie, contact;
    tie.name = "tie";
    tie.firstBody = isOfFirst ? 0 : 1;
    tie.secondBody = 1 - tie.firstBody;
    tie.firstNodes = {isOfFirst ? 5 : 25};
    tie.firstShares = {{{tie.firstNodes[0], 1.0}}};
    tie.secondNodes = {{{7, 0.5}, {8, 0.5}}};
    tie.areas = {1};
    contact.firstBody = 0;
    contact.secondBody = 1;
    contact.firstNodes = {5, 6};
    contact.secondNodes = {{{25, 1.0}}, {{26, 1.0}}};
    contact.directions = {0, 1, 0, 1};
    contact.gaps = {0, 0};
    contact.areas = {0.5, 0.5};
    std::vector<ContactLayout> ties{tie};

    TiedNodes(ties).dropFrom(contact);

    EXPECT_EQ(contact.firstNodes, std::vector<GlobalOrdinal>{6});
    EXPECT_EQ(ties[0].areas, std::vector<double>{1.5});
    EXPECT_NE(contact.note.find("1 more node is tied by 'tie'"), std::string::npos) << contact.note;
  }
}

/// At corners of six-node triangles ∫N is 0, and forces by it would be anything.
TEST(TieRowsTest, TractionsOfTiesAreForcesByAreasThatAreNotZero) {
  for (const Meshing& meshing : all) {
    SCOPED_TRACE(toString(meshing));
    Blocks blocks = stacked(meshing, 4, 4);
    blocks.join("t", "top", "bottom", Kind::tied);
    const ContactLayout tie = blocks.layout().ties.at(0);
    ASSERT_EQ(tie.means, "pairs of nodes");
    EXPECT_EQ(tie.smoothed.empty(), meshing.order == 1);
    for (const auto& shares : tie.smoothed) {
      double area = 0;
      for (const ContactLayout::Share& share : shares)
        area += share.weight * tie.areas[share.node];
      EXPECT_GT(area, 0.01);
    }
  }
}

TEST(TieRowsTest, ATieBesideAContactKeepsTheirCommonNodes) {
  for (const Meshing& meshing : all)
    for (const int upper : {4, 6}) {
      SCOPED_TRACE(toString(meshing) + ", " + std::to_string(upper));
      Blocks blocks = stacked(meshing, 4, upper);
      blocks.join("touch", "top right", "bottom right");
      blocks.join("weld", "top left", "bottom left", Kind::tied);
      const SceneContacts found = blocks.layout();
      const ContactLayout &touch = found.contacts.at(0), &weld = found.ties.at(0);
      for (const GlobalOrdinal node : touch.firstNodes)
        EXPECT_GT(blocks.bodies[touch.firstBody].mesh->point(node)[0], 1 + 1e-9);
      if (meshing.order == 1 || upper == 6) { // areas of single nodes of order 2 are none of N̂
        EXPECT_NEAR(total(touch.areas) + total(weld.areas) / meshing.dimension, 2, 1e-12);
      }
      EXPECT_EQ(touch.note.empty(), upper == 6); // by mortars nothing is shared
    }
}

/// A node in the middle of a straight edge hangs on both ends of that, of which the tie may hold one.
TEST(TieRowsTest, ATieOfBodiesOfTwoOrdersLeavesTheContactItsNodesBesideIt) {
  for (const Meshing& meshing : {Meshing{2, 1, false}, {2, 1, true}, {3, 1, false}, {3, 1, true}})
    for (const int lowerOrder : {1, 2}) {
      SCOPED_TRACE(toString(meshing) + ", lower order " + std::to_string(lowerOrder));
      Blocks blocks{meshing};
      blocks.meshing.order = lowerOrder;
      blocks.add("lower", 0, 2, -1, 0, 4);
      blocks.meshing.order = 3 - lowerOrder;
      blocks.add("upper", 0, 2, 0, 1, 4);
      blocks.join("touch", "top right", "bottom right");
      blocks.join("weld", "top left", "bottom left", Kind::tied);
      const SceneContacts found = blocks.layout();
      const ContactLayout& touch = found.contacts.at(0);
      ASSERT_EQ(touch.means, "pairs of nodes");
      const mesh::Mesh& mesh = *blocks.bodies[touch.firstBody].mesh;
      const mesh::Surface surface = mesh.surface(touch.firstBody == 0 ? "top right" : "bottom right");
      std::set<GlobalOrdinal> beside;
      for (std::size_t f = 0; f < surface.numFacets(); ++f)
        for (const GlobalOrdinal node : surface.facet(f))
          if (mesh.point(node)[0] > 1 + 1e-9)
            beside.insert(node);
      EXPECT_EQ(std::set<GlobalOrdinal>(touch.firstNodes.begin(), touch.firstNodes.end()), beside);
    }
}

TEST(TieRowsTest, ATieInsideAContactKeepsItsAreaAndTheContactTheRest) {
  for (const int dimension : {2, 3})
    for (const int upper : {4, 6}) {
      Blocks blocks = stacked({dimension, 1, false}, 4, upper);
      blocks.join("all", "top", "bottom");
      blocks.join("weld", "top left", "bottom left", Kind::tied);
      const SceneContacts found = blocks.layout();
      const double tied = total(found.ties.at(0).areas) / dimension, free = total(found.contacts.at(0).areas);
      EXPECT_NEAR(tied + free, 2, 1e-12);
      EXPECT_NEAR(free, upper == 6 ? 1 : 0.75, 1e-12); // of pairs the tie has the common nodes
    }
}

TEST(TieRowsTest, AContactBesideATieOnTheOtherSideOfMortarsHasItsWholeArea) {
  for (const Meshing& meshing : all) {
    SCOPED_TRACE(toString(meshing));
    Blocks blocks = stacked(meshing, 7, 4);
    blocks.join("tie", "top", "bottom left", Kind::tied).multipliers = Side::second;
    blocks.join("contact", "top", "bottom right").multipliers = Side::first;
    const SceneContacts layouts = blocks.layout();
    EXPECT_NEAR(total(layouts.contacts.at(0).areas), 1, 1e-12);
    EXPECT_EQ(layouts.contacts.at(0).firstBody, 0);
    EXPECT_EQ(layouts.ties.at(0).firstBody, 1);
  }
}

/// A tie holds all turns, also where none of its nodes lies within the other surface; and multipliers go to
/// the surface that is covered.
TEST(TieRowsTest, AWideSurfaceIsTiedAtMoreThanOnePoint) {
  for (const Meshing& meshing : all)
    for (const Side side : {Side::first, Side::automatic}) {
      SCOPED_TRACE(toString(meshing));
      Blocks blocks{meshing};
      blocks.add("wide", 0, 2, -1, 0, 1);
      blocks.add("narrow", 0.25, 1.75, 0, 1, 1);
      blocks.join("tie", "top", "bottom", Kind::tied).multipliers = side;
      const ContactLayout tie = blocks.layout().ties.at(0);
      EXPECT_EQ(tie.firstBody, side == Side::first ? 0 : 1);
      std::set<double> places;
      for (const GlobalOrdinal node : tie.firstNodes)
        places.insert(blocks.bodies[tie.firstBody].mesh->point(node)[0]);
      EXPECT_GE(places.size(), 2U);
    }
}

TEST(TieRowsTest, TiesInACircleSayThatTheirForcesAreNotUnique) {
  for (const Meshing& meshing : all) {
    SCOPED_TRACE(toString(meshing));
    Blocks blocks{meshing};
    blocks.add("base", 0, 2, -1, 0, 4);
    blocks.add("left", 0, 1, 0, 1, 2);
    blocks.add("right", 1, 2, 0, 1, 2);
    blocks.join("a", "top", "bottom", Kind::tied);
    blocks.join("b", "top", "bottom", Kind::tied).second = 2;
    SurfaceContact& seam = blocks.join("seam", "right", "left", Kind::tied);
    seam.first = 1;
    seam.second = 2;
    const SceneContacts layouts = blocks.layout();
    EXPECT_TRUE(layouts.ties.at(0).note.empty());
    EXPECT_TRUE(layouts.ties.at(1).note.empty());
    EXPECT_NE(layouts.ties.at(2).note.find("not unique"), std::string::npos) << layouts.ties.at(2).note;
  }
}

/// A tie holds turns beside a support that holds one of the two nodes that could.
TEST(TieRowsTest, ATieBesideASupportHoldsTurns) {
  Blocks blocks{{2, 1, false}};
  blocks.add("wide", 0, 2, -1, 0, 1);
  blocks.add("narrow", 0.25, 1.75, 0, 1, 1);
  blocks.join("tie", "top", "bottom", Kind::tied).multipliers = Side::first;
  SupportedNodes supports;
  const mesh::Mesh& wide = *blocks.bodies[0].mesh;
  supports.isHeld = [&](int body, GlobalOrdinal node, const Eigen::Vector3d&) {
    return body == 0 && wide.point(node)[0] == 0;
  };
  EXPECT_EQ(layoutContacts(blocks.scene, blocks.bodies, supports).ties.at(0).numRows(), 4);
}

} // namespace
} // namespace epafi::model
