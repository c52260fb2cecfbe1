#include "epafi/model/SceneContacts.hpp"

#include "support/Refusal.hpp"

#include "epafi/mesh/StructuredMesh.hpp"
#include "epafi/mesh/UnstructuredMesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace epafi::model {
using contact::ContactLayout;
namespace {

BodyLayout box(const std::string& name, const mesh::Box& extent, std::array<int, 3> elements) {
  return {name, std::make_unique<const mesh::StructuredMesh>(extent, elements), nullptr, 0};
}

scene::SurfaceContact topOnBottom() {
  return {"joint", 0, "top", 1, "bottom"};
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::string complaint(const scene::SurfaceContact& contact, const std::vector<BodyLayout>& bodies,
                      int components) {
  return epafi::test::refusal([&] { layoutContact(contact, bodies, components); });
}

TEST(ContactSearchTest, FindsTheNodesThatFaceEachOther) {
  for (const double gap : {0.0, 0.25}) {
    std::vector<BodyLayout> bodies;
    bodies.push_back(box("lower", {{0, 0, 0}, {2, 1, 1}}, {4, 3, 2}));
    bodies.push_back(box("upper", {{0, 0, 1 + gap}, {2, 1, 2 + gap}}, {4, 3, 1}));
    const ContactLayout contact = layoutContact(topOnBottom(), bodies, 3);
    ASSERT_EQ(contact.numRows(), 20);
    EXPECT_NEAR(sum(contact.areas), 2.0, 1e-13);
    for (std::size_t row = 0; row < 20; ++row) {
      const Point a = bodies[0].mesh->point(contact.firstNodes[row]),
                  b = bodies[1].mesh->point(contact.secondNodes[row].front().node);
      EXPECT_NEAR(a[0], b[0], 1e-13);
      EXPECT_NEAR(a[1], b[1], 1e-13);
      EXPECT_NEAR(contact.gaps[row], gap, 1e-13);
      EXPECT_NEAR(contact.directions[3 * row + 2], 1.0, 1e-13); // the second body lies above
      EXPECT_NEAR(contact.directions[3 * row], 0.0, 1e-13);
    }
  }
}

TEST(ContactSearchTest, NodesBesideAPunchGetNoRow) {
  std::vector<BodyLayout> bodies;
  bodies.push_back(box("ground", mesh::rectangle(0, 4, 0, 1), {8, 2, 0}));
  bodies.push_back(box("punch", mesh::rectangle(1, 2, 1, 3), {2, 2, 0}));
  const ContactLayout contact = layoutContact(topOnBottom(), bodies, 2);
  EXPECT_EQ(contact.numRows(), 3);
}

TEST(ContactSearchTest, NodesTooFarFromTheOtherSideGetNoRow) {
  std::vector<BodyLayout> bodies;
  bodies.push_back(box("ground", mesh::rectangle(0, 1, 0, 1), {4, 2, 0}));
  bodies.push_back(box("far", mesh::rectangle(0, 1, 1.5, 3), {4, 2, 0}));
  scene::SurfaceContact contact = topOnBottom();
  contact.distance = 0.4;
  EXPECT_NE(complaint(contact, bodies, 2).find("distance"), std::string::npos);
  contact.distance = 0.6;
  EXPECT_EQ(layoutContact(contact, bodies, 2).numRows(), 5);
}

/// A distance that leaves one pair of nodes does not make of surfaces that do not match some that do.
TEST(ContactSearchTest, CouplesByMortarsWhereNodesAndFacetsDoNotFaceEachOtherOneByOne) {
  const auto meansOf = [](std::array<int, 3> lower, std::array<int, 3> upper, double distance,
                          double gap = 0) {
    std::vector<BodyLayout> bodies;
    bodies.push_back(box("lower", mesh::rectangle(0, 1, 0, 1), lower));
    bodies.push_back(box("upper", mesh::rectangle(0, 1, 1 + gap, 2 + gap), upper));
    scene::SurfaceContact contact = topOnBottom();
    contact.distance = distance + gap;
    return layoutContact(contact, bodies, 2).means;
  };
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  EXPECT_EQ(meansOf({4, 2, 0}, {4, 3, 0}, anywhere), "pairs of nodes");
  for (const double distance : {anywhere, 1e-3}) {
    EXPECT_EQ(meansOf({4, 2, 0}, {8, 2, 0}, distance),
              "mortars on 'lower'"); // each node of one has a partner
    EXPECT_EQ(meansOf({8, 2, 0}, {4, 2, 0}, distance), "mortars on 'lower'");
    EXPECT_EQ(meansOf({1, 2, 0}, {2, 2, 0}, distance), "mortars on 'lower'");
    EXPECT_EQ(meansOf({5, 2, 0}, {7, 2, 0}, distance, 0.9),
              "mortars on 'lower'");                                          // farther apart than nodes are
    EXPECT_EQ(meansOf({5, 2, 0}, {7, 2, 0}, distance), "mortars on 'lower'"); // both ends face each other
  }
}

TEST(ContactSearchTest, RefusesSurfacesThatDoNotMatch) {
  std::vector<BodyLayout> bodies;
  bodies.push_back(box("lower", mesh::rectangle(0, 1, 0, 1), {4, 2, 0}));
  bodies.push_back(box("upper", mesh::rectangle(0, 1, 1, 2), {5, 2, 0}));
  scene::SurfaceContact pairs = topOnBottom();
  pairs.coupling = scene::SurfaceContact::Coupling::nodes;
  EXPECT_NE(complaint(pairs, bodies, 2).find("do not match"), std::string::npos);
  scene::SurfaceContact unknown = topOnBottom();
  unknown.secondSurface = "sole";
  for (const char* word : {"'sole'", "'bottom'", "'top'"}) // what is wrong, and what there is
    EXPECT_NE(complaint(unknown, bodies, 2).find(word), std::string::npos) << word;
}

TEST(ContactSearchTest, ObstaclesHaveTheGapOfTheirGeometry) {
  std::vector<BodyLayout> bodies;
  bodies.push_back(box("block", mesh::rectangle(-1, 1, 0, 1), {8, 2, 0}));
  scene::SurfaceContact contact = topOnBottom();
  contact.second = -1;
  contact.obstacle.kind = scene::Obstacle::Kind::sphere;
  contact.obstacle.point = {0, 3.5, 0};
  contact.obstacle.radius = 2.4;
  const ContactLayout all = layoutContact(contact, bodies, 2);
  ASSERT_EQ(all.numRows(), 9);
  EXPECT_TRUE(all.secondNodes.empty());
  for (std::size_t row = 0; row < 9; ++row) {
    const Point x = bodies[0].mesh->point(all.firstNodes[row]);
    const double distance = std::hypot(x[0], 2.5);
    EXPECT_NEAR(all.gaps[row], distance - 2.4, 1e-14);
    EXPECT_NEAR(all.directions[2 * row], -x[0] / distance, 1e-14); // towards the centre
    EXPECT_NEAR(all.directions[2 * row + 1], 2.5 / distance, 1e-14);
  }
  contact.distance = 0.12; // only the middle is as near as that
  EXPECT_EQ(layoutContact(contact, bodies, 2).numRows(), 3);

  contact.obstacle = {scene::Obstacle::Kind::plane, {0, 1.2, 0}, {0, -1, 0}, 1};
  contact.distance = 1;
  for (const double gap : layoutContact(contact, bodies, 2).gaps)
    EXPECT_NEAR(gap, 0.2, 1e-15);
}

TEST(ContactSearchTest, HollowsHaveTheGapToTheirWall) {
  std::vector<BodyLayout> bodies;
  bodies.push_back(box("block", {{-1, 0, 0}, {1, 1, 2}}, {8, 2, 4}));
  scene::SurfaceContact contact = topOnBottom();
  contact.second = -1;
  contact.obstacle = {scene::Obstacle::Kind::cylinder, {0, 7, -2}, {0, 1, 0}, 5, true};
  const ContactLayout all = layoutContact(contact, bodies, 3);
  ASSERT_EQ(all.numRows(), 27);
  for (std::size_t row = 0; row < 27; ++row) {
    const Point x = bodies[0].mesh->point(all.firstNodes[row]);
    const double distance = std::hypot(x[0], x[2] + 2);
    EXPECT_NEAR(all.gaps[row], 5 - distance, 1e-14);
    EXPECT_NEAR(all.directions[3 * row], x[0] / distance, 1e-14); // outwards
    EXPECT_NEAR(all.directions[3 * row + 1], 0, 1e-14);
    EXPECT_NEAR(all.directions[3 * row + 2], (x[2] + 2) / distance, 1e-14);
  }
  contact.obstacle.point[2] = 5; // the wall is nearer on the other side
  EXPECT_NE(complaint(contact, bodies, 3).find("is the body inside of the obstacle?"), std::string::npos);
}

TEST(ContactSearchTest, SaysWhyNothingMeets) {
  std::vector<BodyLayout> bodies;
  bodies.push_back(box("block", mesh::rectangle(-1, 1, 0, 1), {8, 2, 0}));
  bodies.push_back(box("aside", mesh::rectangle(5, 7, 1, 2), {8, 2, 0}));
  const auto says = [&](const scene::SurfaceContact& contact, const std::string& words) {
    const std::string said = complaint(contact, bodies, 2);
    EXPECT_NE(said.find("contact 'joint'"), std::string::npos) << said;
    EXPECT_NE(said.find(words), std::string::npos) << said;
  };
  scene::SurfaceContact contact = topOnBottom();
  says(contact, "check which surfaces are to meet"); // no distance is too small
  contact.second = -1;
  contact.obstacle = {scene::Obstacle::Kind::plane, {0, 1.2, 0}, {0, 1, 0}, 1};
  says(contact, "does the obstacle's normal point to the body?");
  contact.obstacle.kind = scene::Obstacle::Kind::sphere;
  contact.obstacle.point = {0, 0.5, 0};
  says(contact, "is the centre of the obstacle inside the body?");
  contact.obstacle.point = {0, 1, 0};
  says(contact, "the node at (0, 1, 0) lies in the centre of the obstacle");
}

/// An even pressure loads them so, see tractionLoad().
TEST(ContactSearchTest, NodesHaveTheShareOfTheirShapeFunctions) {
  mesh::MeshArrays arrays; // one hexahedron, its top a trapezium
  arrays.cellType = mesh::CellType::hexahedron;
  arrays.points = {{0, 0, 0}, {3, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 0, 1}, {3, 0, 1}, {2, 1, 1}, {1, 1, 1}};
  arrays.cells = {0, 1, 2, 3, 4, 5, 6, 7};
  arrays.nodeTags = {1, 2, 3, 4, 5, 6, 7, 8};
  arrays.elementTags = {1};
  arrays.surfaces = {{"top", {4, 5, 6, 7}}};
  std::vector<BodyLayout> bodies;
  bodies.push_back({"block", std::make_unique<const mesh::UnstructuredMesh>(arrays), nullptr, 0});
  scene::SurfaceContact contact = topOnBottom();
  contact.second = -1;
  contact.obstacle = {scene::Obstacle::Kind::plane, {0, 0, 2}, {0, 0, -1}, 1};
  const std::vector<double> areas = layoutContact(contact, bodies, 3).areas;
  ASSERT_EQ(areas.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(areas[k], (k < 2 ? 7.0 : 5.0) / 12, 1e-15);
}

} // namespace
} // namespace epafi::model
