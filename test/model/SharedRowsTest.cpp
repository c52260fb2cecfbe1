// A contact's numbers are its own: areas are those that both surfaces have in common, what contacts share is
// shared by area, and no surface is joined twice.

#include "support/BlockScenes.hpp"
#include "support/Refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace epafi::model {
namespace {

TEST(SharedRowsTest, PairsOfNodesHaveTheAreaThatBothSurfacesHaveInCommonWhicheverIsNamedFirst) {
  for (const Meshing& meshing : all) {
    SCOPED_TRACE(toString(meshing));
    std::vector<std::vector<double>> areas;
    for (const bool isBlockFirst : {false, true}) {
      Blocks blocks{meshing};
      blocks.add("plate", 0, 3, -1, 0, 6);
      blocks.add("block", 1, 2, 0, 1, 2);
      SurfaceContact& contact = blocks.join("c", "top", "bottom");
      if (isBlockFirst) {
        std::swap(contact.first, contact.second);
        std::swap(contact.firstSurface, contact.secondSurface);
      }
      const ContactLayout layout = blocks.layout().contacts.at(0);
      ASSERT_EQ(layout.means, "pairs of nodes");
      EXPECT_NEAR(total(layout.areas), 1, 1e-12);
      for (const double area : layout.areas)
        EXPECT_GT(area, 0.005); // may be divided by
      areas.push_back(layout.areas);
      std::sort(areas.back().begin(), areas.back().end());
    }
    ASSERT_EQ(areas[0].size(), areas[1].size());
    for (std::size_t row = 0; row < areas[0].size(); ++row)
      EXPECT_NEAR(areas[0][row], areas[1][row], 1e-13);
  }
}

/// Contacts and ties, meshed alike or apart: as one surface, of which each has its half.
TEST(SharedRowsTest, ContactsOfOneSurfaceShareTheRowsOfTheirCommonNodesByArea) {
  for (const Meshing& meshing : all)
    for (const int upper : {4, 6})
      for (const Kind kind : {Kind::contact, Kind::tied}) {
        SCOPED_TRACE(toString(meshing) + ", " + std::to_string(upper));
        Blocks parts = stacked(meshing, 4, upper), whole = stacked(meshing, 4, upper);
        parts.join("A", "top left", "bottom left", kind);
        SurfaceContact& b = parts.join("B", "top right", "bottom right", kind);
        std::swap(b.first, b.second); // named from the other side
        std::swap(b.firstSurface, b.secondSurface);
        whole.join("all", "top", "bottom", kind);
        const auto layoutsOf = [&](const Blocks& blocks) {
          SceneContacts found = blocks.layout();
          return kind == Kind::tied ? std::move(found.ties) : std::move(found.contacts);
        };
        const std::vector<ContactLayout> layouts = layoutsOf(parts), one = layoutsOf(whole);
        ASSERT_EQ(layouts.size(), 2U);
        ASSERT_EQ(layouts[0].numRows(), one[0].numRows());
        EXPECT_EQ(layouts[0].firstRow, layouts[1].firstRow);
        EXPECT_FALSE(layouts[1].hasOwnRows);
        const double times = kind == Kind::tied ? meshing.dimension : 1;
        for (const ContactLayout& layout : layouts)
          EXPECT_NEAR(ownArea(layout), times, 1e-12) << layout.name;
        for (std::size_t row = 0; row < one[0].areas.size(); ++row) {
          EXPECT_NEAR(layouts[0].portion(row) + layouts[1].portion(row), 1, 1e-12);
          EXPECT_NEAR(layouts[0].areas[row], one[0].areas[row], 1e-13);
        }
      }
}

TEST(SharedRowsTest, OneSurfaceThatFacesTwoHasTheAreaOfEach) {
  for (const int upper : {4, 6}) {
    Blocks blocks = stacked({3, 1, false}, 4, upper);
    blocks.join("A", "top", "bottom left");
    blocks.join("B", "top", "bottom right");
    const std::vector<ContactLayout> layouts = blocks.layout().contacts;
    EXPECT_NEAR(ownArea(layouts[0]), 1, 1e-12);
    EXPECT_NEAR(ownArea(layouts[1]), 1, 1e-12);
  }
}

TEST(SharedRowsTest, FacesOnBothSidesOfAnEdgeKeepRowsOfTheirOwn) {
  Blocks blocks{{2, 1, false}};
  blocks.add("lower", 0, 2, -1, 0, 4);
  for (const char* surface : {"top", "right"}) {
    SurfaceContact& contact = blocks.join(surface, surface, "");
    contact.second = -1;
    contact.obstacle.point = {2, 0, 0};
    contact.obstacle.normal = surface == std::string("top") ? Vector3{0, -1, 0} : Vector3{-1, 0, 0};
  }
  const std::vector<ContactLayout> layouts = blocks.layout().contacts;
  EXPECT_EQ(layouts[0].numRows() + layouts[1].numRows(), 5 + 3);
  EXPECT_EQ(layouts[1].firstRow, 5);
}

TEST(SharedRowsTest, SurfacesAreJoinedOnce) {
  for (const int upper : {4, 6}) {
    Blocks tied = stacked({2, 1, false}, 4, upper);
    tied.join("c1", "top", "bottom");
    tied.join("c2", "top", "bottom", Kind::tied);
    test::expectSays(test::refusal([&] { (void)tied.layout(); }),
                     {"'c1'", "'c2' ties", "remove one of them"});

    Blocks twice = stacked({2, 1, false}, 4, upper);
    twice.join("c1", "top", "bottom").multipliers = Side::first;
    twice.join("c2", "top", "bottom").multipliers = Side::second;
    test::expectSays(test::refusal([&] { (void)twice.layout(); }),
                     {"'c2' says nothing that contact 'c1'", "remove one of them"});

    Blocks within = stacked({2, 1, false}, 4, upper);
    within.join("half", "top left", "bottom left");
    within.join("all", "top", "bottom");
    test::expectSays(test::refusal([&] { (void)within.layout(); }),
                     {"'half' says nothing that contact 'all'"});
  }
}

/// All of a body's skin on a wider plate: at its edges the normal is that of the foot.
TEST(SharedRowsTest, ASkinTakesTheNormalAndTheAreaOfTheFaceThatFacesTheOtherSide) {
  for (const Meshing& meshing : all)
    for (const double gap : {0.0, 0.125})
      for (const int plate : {6, 5}) {
        SCOPED_TRACE(toString(meshing) + ", " + std::to_string(plate));
        Blocks blocks{meshing};
        blocks.add("plate", 0, 3, -1, 0, plate);
        blocks.add("block", 1, 2, gap, 1 + gap, 2);
        SurfaceContact& contact = blocks.join("c", "top", "skin");
        contact.multipliers = Side::second;
        const ContactLayout layout = blocks.layout().contacts.at(0);
        const std::size_t n = meshing.dimension;
        for (std::size_t row = 0; row < layout.firstNodes.size(); ++row) {
          EXPECT_NEAR(std::abs(layout.directions[row * n + n - 1]), 1, 1e-14);
          EXPECT_NEAR(layout.gaps[row], gap, 1e-13);
        }
        EXPECT_NEAR(total(layout.areas), 1, 1e-12);
        EXPECT_EQ(layout.numBent, 0);
      }
  for (const Meshing& meshing : all) { // on an obstacle, too
    Blocks blocks{meshing};
    blocks.add("block", 0, 2, 0, 1, 4);
    SurfaceContact& contact = blocks.join("floor", "skin", "");
    contact.second = -1;
    contact.obstacle.normal = meshing.dimension == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
    contact.distance = 0.125;
    EXPECT_NEAR(total(blocks.layout().contacts.at(0).areas), 2, 1e-12) << toString(meshing);
  }
}

/// However fine the meshes are: 1/32 and 1/33 wide, 0.25 deep; but a body is not pushed through another one.
TEST(SharedRowsTest, OverlapsMayBeDeeperThanElementsAndNotThanBodies) {
  for (const SurfaceContact::Coupling coupling :
       {SurfaceContact::Coupling::mortar, SurfaceContact::Coupling::nodes}) {
    const int upper = coupling == SurfaceContact::Coupling::mortar ? 66 : 64;
    Blocks deep = stacked({2, 1, false}, 64, upper, -0.25), through = stacked({2, 1, false}, 64, upper, -1.5);
    deep.join("c", "top", "bottom").coupling = coupling;
    through.join("c", "top", "bottom").coupling = coupling;
    const ContactLayout layout = deep.layout().contacts.at(0);
    EXPECT_NEAR(total(layout.areas), 2, 1e-12);
    for (const double gap : layout.gaps)
      EXPECT_NEAR(gap, -0.25, 1e-12);
    EXPECT_FALSE(test::refusal([&] { (void)through.layout(); }).empty());
  }
}

/// Facets of two groups that overlap act once.
TEST(SharedRowsTest, WhatGroupsOfFacetsHaveInCommonCountsOnce) {
  for (const Meshing& meshing : all)
    for (const bool isMortar : {false, true}) {
      SCOPED_TRACE(toString(meshing) + (isMortar ? ", mortars" : ", pairs"));
      Blocks blocks = stacked(meshing, 8, isMortar ? 12 : 8);
      blocks.join("left", "top left", "bottom left");
      blocks.join("inner", "top inner", "bottom inner");
      const SceneContacts layouts = blocks.layout();
      EXPECT_NEAR(ownArea(layouts.contacts.at(0)), 1, 1e-12);
      EXPECT_NEAR(ownArea(layouts.contacts.at(1)), 0.5, 1e-12);
    }
}

/// Forces act on the thickness of the thinner body, whichever is named first, and wherever it is thin.
TEST(SharedRowsTest, PlaneBodiesMeetOnTheThicknessOfTheThinnerOne) {
  for (const int order : {1, 2})
    for (const int upper : {4, 7})
      for (const bool isUpperFirst : {false, true})
        for (const Kind kind : {Kind::contact, Kind::tied}) {
          SCOPED_TRACE(testing::Message()
                       << "order " << order << ", " << upper << " elements, " << isUpperFirst);
          Blocks blocks = stacked({2, order, false}, 4, upper);
          blocks.scene.bodies[0].material.thickness = 0.5;
          blocks.scene.bodies[1].material.thickness = 2;
          SurfaceContact& contact = blocks.join("c", "top", "bottom", kind);
          if (isUpperFirst) {
            std::swap(contact.first, contact.second);
            std::swap(contact.firstSurface, contact.secondSurface);
          }
          const auto areaOf = [&] {
            const SceneContacts layouts = blocks.layout();
            return kind == Kind::tied ? ownArea(layouts.ties.at(0)) / 2 : ownArea(layouts.contacts.at(0));
          };
          EXPECT_NEAR(areaOf(), 1, 1e-12);
          fem::SolidRegion thin{"thin", {{-1, -2, 0}, {1, 1, 0}}, "", blocks.scene.bodies[0].material};
          thin.material.thickness = 0.25;
          blocks.scene.bodies[0].regions = {thin};
          if (upper == 4) { // facets of 7 lie across the step
            EXPECT_NEAR(areaOf(), 0.75, 1e-12);
          }
        }
}

/// Of rows at the nodes of a held surface between those of the other one no single force is known.
TEST(SharedRowsTest, OfPairsOfTwoOrdersTheSideThatCanMoveHasTheRows) {
  for (const int dimension : {2, 3}) {
    Blocks blocks{{dimension, 2, false}};
    blocks.add("lower", 0, 2, -1, 0, 4);
    blocks.meshing.order = 1;
    blocks.add("upper", 0, 2, 0, 1, 4);
    blocks.join("c", "top", "bottom");
    SupportedNodes supports;
    EXPECT_EQ(layoutContacts(blocks.scene, blocks.bodies, supports).contacts.at(0).firstBody, 0);
    supports.isHeld = [](int body, GlobalOrdinal, const Eigen::Vector3d&) { return body == 0; };
    const ContactLayout layout = layoutContacts(blocks.scene, blocks.bodies, supports).contacts.at(0);
    EXPECT_EQ(layout.firstBody, 1);
    EXPECT_EQ(layout.numRows(), dimension == 2 ? 5 : 15);
    EXPECT_NEAR(total(layout.areas), 2, 1e-12);
  }
}

/// What is no one surface, because of its orders, distances, or a third contact, is refused instead of
/// counted twice.
TEST(SharedRowsTest, CommonFacetsOfContactsThatAreNoSurfaceAreRefused) {
  const auto refused = [](Blocks& blocks) {
    test::expectSays(test::refusal([&] { (void)blocks.layout(); }),
                     {"'left'", "'inner'", "facets in common"});
  };
  for (const int upper : {8, 12}) {
    Blocks orders = stacked({2, 1, false}, 8, upper);
    orders.bodies.pop_back();
    orders.scene.bodies.pop_back();
    orders.meshing.order = 2;
    orders.add("upper", 0, 2, 0, 1, upper);
    orders.join("left", "top left", "bottom");
    orders.join("inner", "top inner", "bottom");
    refused(orders);
    Blocks distances = stacked({2, 1, false}, 8, upper);
    distances.join("left", "top left", "bottom left").distance = 0.125;
    distances.join("inner", "top inner", "bottom inner").distance = 0.25;
    refused(distances);
    Blocks gaps = stacked({2, 1, false}, 8, upper); // of two gaps the smaller one counts
    gaps.join("left", "top left", "bottom left");
    gaps.join("inner", "top inner", "bottom inner").gap = 0.125;
    EXPECT_EQ(gaps.layout().contacts.size(), 2U);
  }
}

} // namespace
} // namespace epafi::model
