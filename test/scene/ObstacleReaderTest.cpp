// Obstacles, and the contacts with them.

#include "SceneLists.hpp"

#include <cmath>
#include <functional>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

TEST(ObstacleReaderTest, RefusesToTieABodyToAnObstacleOrToGiveItAMesh) {
  const auto refused = [](const std::string& name, const std::string& value) {
    return solidRefusal(
        [&](ParameterList& list) { list.sublist("Contact").sublist("rest").set(name, value); });
  };
  expectSays(refused("Kind", "tied"), {"\"Kind\"", "obstacle", "support"});
  expectSays(refused("Coupling", "mortar"), {"\"Coupling\"", "an obstacle has no mesh"});
  expectSays(refused("Multipliers", "second"), {"\"Multipliers\"", "an obstacle has no mesh"});
}

TEST(ObstacleReaderTest, ReadsObstaclesWithNormalsOfLengthOne) {
  const scene::SurfaceContact contact = scene::readScene(cubeOnFloor(), "a.xml").contacts.at(0);
  EXPECT_EQ(contact.second, -1);
  EXPECT_EQ(contact.obstacle.kind, scene::Obstacle::Kind::plane);
  EXPECT_EQ(contact.obstacle.normal, (Vector3{0, 0, 1}));
  EXPECT_TRUE(std::isinf(contact.distance)) << "no limit unless one is given";
  ParameterList list = cubeOnFloor();
  list.sublist("Obstacles").sublist("floor") = ParameterList();
  list.sublist("Obstacles")
      .sublist("floor")
      .set("Kind", "sphere")
      .set("Point", numbers({0, 0, -3}))
      .set("Radius", 3.0);
  list.sublist("Contact").sublist("rest").set("Distance", 0.25).set("Gap", -0.1);
  const scene::SurfaceContact ball = scene::readScene(list, "a.xml").contacts.at(0);
  EXPECT_EQ(ball.obstacle.kind, scene::Obstacle::Kind::sphere);
  EXPECT_EQ(ball.obstacle.radius, 3.0);
  EXPECT_EQ(ball.distance, 0.25);
  EXPECT_EQ(ball.gap, -0.1);
}

TEST(ObstacleReaderTest, AHollowCylinderHasAnAxisAndASide) {
  ParameterList list = cubeOnFloor();
  ParameterList& floor = list.sublist("Obstacles").sublist("floor");
  floor = ParameterList();
  floor.set("Kind", "cylinder").set("Point", numbers({0, 0, 3})).set("Radius", 3.0).set("Side", "inside");
  EXPECT_THROW(scene::readScene(list, "a.xml"), InputError); // no axis
  floor.set("Axis", numbers({0, 2, 0}));
  const scene::Obstacle bore = scene::readScene(list, "a.xml").contacts.at(0).obstacle;
  EXPECT_EQ(bore.kind, scene::Obstacle::Kind::cylinder);
  EXPECT_EQ(bore.normal, (Vector3{0, 1, 0}));
  EXPECT_TRUE(bore.isHollow);
  floor.set("Kind", "sphere");
  EXPECT_THROW(scene::readScene(list, "a.xml"), InputError); // which has no axis
}

TEST(ObstacleReaderTest, ASphereInThePlaneIsACircle) {
  const std::string text = solidRefusal([](ParameterList& list) {
    list.sublist("Obstacles")
        .sublist("ball")
        .set("Kind", "sphere")
        .set("Point", numbers({0, -3}))
        .set("Radius", 3.0);
  });
  EXPECT_NE(text.find("\"circle\""), std::string::npos) << text;
}

TEST(ObstacleReaderTest, RefusesContactsThatDoNotSayWhereOrWithWhat) {
  const auto says = [](const std::function<void(ParameterList&)>& change,
                       std::initializer_list<std::string> parts) {
    expectSays(solidRefusal([&](ParameterList& list) { change(list.sublist("Contact").sublist("rest")); }),
               parts);
  };
  says([](ParameterList& p) { p.remove("First Surface"); }, {"\"First Surface\"", "must be given"});
  says([](ParameterList& p) { p.set("First Edge", "bottom"); }, {"\"First Edge\"", "only membranes"});
  says([](ParameterList& p) { p.set("Second Body", "cube"); }, {"\"Second Body\"", "obstacle"});
  says([](ParameterList& p) { p.set("Second Surface", "top"); }, {"\"Second Surface\"", "obstacle"});
  says([](ParameterList& p) { p.set("Obstacle", "flor"); }, {"\"Obstacle\"", "did you mean \"floor\"?"});
  says([](ParameterList& p) { p.set("Distance", -1.0); }, {"\"Distance\"", "-1"});
  says([](ParameterList& p) { p.remove("Obstacle"); }, {"\"Second Body\"", "unless there is an obstacle"});
}

TEST(ObstacleReaderTest, RefusesObstaclesThatLackTheirShape) {
  const auto says = [](const std::function<void(ParameterList&)>& change,
                       std::initializer_list<std::string> parts) {
    expectSays(solidRefusal([&](ParameterList& list) { change(list.sublist("Obstacles").sublist("floor")); }),
               parts);
  };
  says([](ParameterList& o) { o.remove("Normal"); }, {"\"Obstacles/floor\"", "\"Normal\"", "must be given"});
  says(
      [](ParameterList& o) {
        o.set("Normal", numbers({0, 0, 0}));
      },
      {"\"Normal\"", "must have a direction"});
  says([](ParameterList& o) { o.set("Radius", 1.0); }, {"\"Radius\"", "\"plane\"", "no use"});
  says([](ParameterList& o) { o.set("Kind", "circle").remove("Normal"); }, {"\"Point\"", "2 entries"});
  says(
      [](ParameterList& o) {
        o.set("Point", numbers({0, 0})).set("Normal", numbers({0, 1}));
      },
      {"\"Obstacle\"", "in the plane"});
  expectSays(solidRefusal([](ParameterList& list) {
               list.sublist("Obstacles").sublist("roof") = list.sublist("Obstacles").sublist("floor");
             }),
             {"\"Contact\"", "no pair with the obstacle \"roof\""});
}

TEST(ObstacleReaderTest, MembranesMeetWhatLiesAlongZ) {
  const auto list = [](const std::function<void(ParameterList&, ParameterList&)>& change) {
    ParameterList scene = twoBodies();
    ParameterList& floor = scene.sublist("Obstacles").sublist("floor");
    floor.set("Kind", "plane").set("Point", numbers({0, 0, -1})).set("Normal", numbers({0, 0, 1}));
    ParameterList& pair = scene.sublist("Contact").sublist("rest");
    pair.set("First Body", "left").set("Obstacle", "floor");
    change(floor, pair);
    return scene;
  };
  const scene::SurfaceContact contact =
      scene::readScene(list([](ParameterList&, ParameterList&) {}), "a.xml").contacts.back();
  EXPECT_TRUE(contact.coversBody());
  EXPECT_EQ(contact.obstacle.point, (Vector3{0, 0, -1}));
  const auto says = [&](const std::function<void(ParameterList&, ParameterList&)>& change,
                        std::initializer_list<std::string> parts) {
    expectSays(refusal([&] { scene::readScene(list(change), "a.xml"); }), parts);
  };
  says([](ParameterList&, ParameterList& p) { p.set("First Surface", "bottom"); },
       {"\"First Surface\"", "anywhere"});
  says([](ParameterList&, ParameterList& p) { p.set("First Edge", "bottom"); },
       {"\"First Edge\"", "anywhere"});
  says([](ParameterList&, ParameterList& p) { p.set("Friction", 0.3); }, {"\"Friction\"", "membranes"});
  says(
      [](ParameterList& o, ParameterList&) {
        o.set("Normal", numbers({1, 0, 0}));
      },
      {"\"Obstacle\"", "upright"});
  says(
      [](ParameterList& o, ParameterList&) {
        o.set("Point", numbers({0, 0})).set("Normal", numbers({0, 1}));
      },
      {"\"Obstacle\"", "three coordinates"});
  says(
      [](ParameterList& o, ParameterList&) {
        o.set("Kind", "sphere").set("Radius", 3.0).set("Side", "inside").remove("Normal");
      },
      {"\"Obstacle\"", "from outside"});
}

} // namespace
