#include "SceneLists.hpp"

#include <cmath>
#include <functional>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

TEST(SupportsAndLoadsTest, HoldsOnlyTheComponentsThatAreGiven) {
  ParameterList list = cubeOnFloor();
  bodyOf(list, "cube")
      .sublist("Supports")
      .sublist("wall")
      .set("Surface", "left")
      .set("X", 0.0)
      .set("Z", -1.0);
  const fem::SolidSupport support = solidOf(list).supports.at(0);
  EXPECT_EQ(support.surface, "left");
  EXPECT_EQ(support.value[0], 0.0);
  EXPECT_FALSE(support.value[1]);
  EXPECT_EQ(support.value[2], -1.0);
}

TEST(SupportsAndLoadsTest, HoldsASurfaceAlongItsNormal) {
  ParameterList list = cubeOnFloor();
  ParameterList& supports = bodyOf(list, "cube").sublist("Supports");
  supports.sublist("rail").set("Surface", "left").set("Normal", -0.25);
  supports.sublist("wall").set("Surface", "right").set("X", 0.0);
  const scene::Body solid = solidOf(list);
  ASSERT_EQ(solid.supports.size(), 2u);
  EXPECT_EQ(solid.supports[0].normal, -0.25);
  EXPECT_FALSE(solid.supports[0].value[0]);
  EXPECT_FALSE(solid.supports[1].normal);
}

TEST(SupportsAndLoadsTest, AMembraneIsNotHeldAlongItsNormal) {
  ParameterList list;
  ParameterList& body = bodyOf(list, "skin");
  body.set("Mesh", "skin.msh");
  body.sublist("Supports").sublist("rim").set("Surface", "rim").set("Normal", 0.5);
  EXPECT_NE(refusal([&] { scene::readScene(list, "scenes/a.xml"); }).find("\"Value\""), std::string::npos);
}

TEST(SupportsAndLoadsTest, ReadsEveryKindOfLoad) {
  ParameterList list = cubeOnFloor();
  ParameterList& loads = bodyOf(list, "cube").sublist("Loads");
  loads.sublist("weight").set("Force", numbers({0, 0, -9.81}));
  loads.sublist("push").set("Kind", "traction").set("Surface", "left").set("Force", numbers({1, 0, 0}));
  loads.sublist("press").set("Kind", "pressure").set("Surface", "top").set("Value", 7.0);
  loads.sublist("hook")
      .set("Kind", "point")
      .set("Point", numbers({0, 0, 1}))
      .set("Force", numbers({0, 2, 0}));
  const std::vector<fem::SolidLoad> read = solidOf(list).loads;
  ASSERT_EQ(read.size(), 4u);
  EXPECT_EQ(read[0].kind, fem::SolidLoad::Kind::body);
  EXPECT_EQ(read[0].value[2], -9.81);
  EXPECT_EQ(read[1].kind, fem::SolidLoad::Kind::traction);
  EXPECT_EQ(read[1].where, "left");
  EXPECT_EQ(read[2].kind, fem::SolidLoad::Kind::pressure);
  EXPECT_EQ(read[2].value[0], 7.0);
  EXPECT_EQ(read[3].kind, fem::SolidLoad::Kind::point);
  EXPECT_EQ(read[3].point[2], 1.0);
  EXPECT_EQ(read[3].value[1], 2.0);
}

TEST(SupportsAndLoadsTest, ReadsLoadsAtGroupsOfNodesAndOfBodiesThatTurn) {
  ParameterList list = cubeOnFloor();
  ParameterList& loads = bodyOf(list, "cube").sublist("Loads");
  loads.sublist("nodes").set("Kind", "point").set("Surface", "tip").set("Force", numbers({0, 2, 0}));
  loads.sublist("turn").set("Kind", "rotation").set("Axis", numbers({0, 0, 2})).set("Value", 3.0);
  const std::vector<fem::SolidLoad> read = solidOf(list).loads;
  EXPECT_EQ(read.at(0).where, "tip");
  EXPECT_EQ(read.at(1).kind, fem::SolidLoad::Kind::rotation);
  EXPECT_EQ(read.at(1).axis, (Vector3{0, 0, 2}));
  EXPECT_EQ(read.at(1).value[0], 3.0);
  loads.sublist("nodes").set("Point", numbers({0, 0, 0}));
  EXPECT_NE(refusal([&] { solidOf(list); }).find("\"Surface\", too"), std::string::npos);
}

TEST(SupportsAndLoadsTest, SurfacesThatArePlacesAreOfMeshFiles) {
  ParameterList list;
  ParameterList& body = bodyOf(list, "skin");
  body.set("Mesh", "skin.msh");
  body.sublist("Supports").sublist("rim").set("Surface", "at 1 0.5").set("Value", 0.0);
  body.sublist("Loads").sublist("pull").set("Kind", "traction").set("Surface", "at 1 0.5").set("Value", 1.0);
  EXPECT_EQ(scene::readScene(list, "a.xml").bodies[0].mesh.pieces, std::vector<std::string>{"at 1 0.5"});
  body.set("Mesh", "skin_*.msh");
  expectSays(refusal([&] { scene::readScene(list, "a.xml"); }), {"a.xml", "\"at 1 0.5\"", "is a place"});
  ParameterList cube = cubeOnFloor();
  bodyOf(cube, "cube").sublist("Supports").sublist("wall").set("Surface", "at 1 0.5 0").set("X", 0.0);
  expectSays(refusal([&] { solidOf(cube); }), {"\"cube\"", "is a place"});
}

TEST(SupportsAndLoadsTest, ReadsForcesAndMomentsThatAreSpread) {
  ParameterList list = cubeOnFloor();
  ParameterList& loads = bodyOf(list, "cube").sublist("Loads");
  loads.sublist("even").set("Kind", "distributed").set("Surface", "top").set("Force", numbers({0, 2, 0}));
  ParameterList& remote = loads.sublist("remote");
  remote.set("Kind", "distributed").set("Surface", "top").set("Force", numbers({0, 0, 0}));
  remote.set("Moment", numbers({1, 2, 3})).set("Point", numbers({0, 0, 9}));
  const std::vector<fem::SolidLoad> read = solidOf(list).loads;
  EXPECT_EQ(read.at(0).kind, fem::SolidLoad::Kind::distributed);
  EXPECT_TRUE(read[0].atCentre);
  EXPECT_EQ(read[0].moment, (Vector3{0, 0, 0}));
  EXPECT_FALSE(read.at(1).atCentre);
  EXPECT_EQ(read[1].point, (Vector3{0, 0, 9}));
  EXPECT_EQ(read[1].moment, (Vector3{1, 2, 3}));
  remote.set("Moment", numbers({1}));
  expectSays(refusal([&] { solidOf(list); }), {"Loads/remote", "\"Moment\""});
  remote.set("Kind", "traction").set("Moment", numbers({1, 2, 3}));
  expectSays(refusal([&] { solidOf(list); }), {"Loads/remote", "no use for it"});
}

TEST(SupportsAndLoadsTest, ReadsAxesOfSupports) {
  ParameterList list = cubeOnFloor();
  ParameterList& support = bodyOf(list, "cube").sublist("Supports").sublist("wall");
  support = ParameterList();
  support.set("Surface", "left").set("X", 0.5).set("Cylinder", numbers({1, 0, 0, 1, 0, 2}));
  const fem::SolidSupport read = solidOf(list).supports.at(0);
  ASSERT_TRUE(read.axes);
  EXPECT_TRUE(read.axes->isCylindrical);
  EXPECT_EQ(read.axes->b, (Vector3{1, 0, 2}));
  support.set("Cylinder", numbers({1, 0, 0, 1, 0, 0}));
  EXPECT_NE(refusal([&] { solidOf(list); }).find("that is one point"), std::string::npos);
  support.remove("Cylinder");
  support.set("Axes", numbers({1, 0, 0, -2, 0, 0}));
  EXPECT_NE(refusal([&] { solidOf(list); }).find("that is one direction"), std::string::npos);
}

TEST(SupportsAndLoadsTest, ReadsTemperaturesOfAllNodesOrOfASurface) {
  ParameterList list = cubeOnFloor();
  ParameterList& cube = bodyOf(list, "cube");
  cube.set("Expansion", 1.2e-5);
  ParameterList& loads = cube.sublist("Loads");
  loads.sublist("warm").set("Kind", "temperature").set("Value", 80.0);
  loads.sublist("cold").set("Kind", "temperature").set("Value", -5.0).set("Surface", "top");
  const scene::Body read = solidOf(list);
  EXPECT_EQ(read.material.expansion, 1.2e-5);
  ASSERT_EQ(read.loads.size(), 2u);
  for (const fem::SolidLoad& load : read.loads)
    EXPECT_EQ(load.kind, fem::SolidLoad::Kind::temperature);
  EXPECT_EQ(read.loads[0].where, "");
  EXPECT_EQ(read.loads[0].value[0], 80);
  EXPECT_EQ(read.loads[1].where, "top");
  loads.sublist("cold").set("Force", numbers({1, 0, 0}));
  expectSays(refusal([&] { solidOf(list); }), {"Loads/cold", "\"Force\"", "\"Value\""});
}

TEST(SupportsAndLoadsTest, AMembraneDoesNotExpand) {
  const auto refused = [](const std::function<void(ParameterList&)>& change) {
    ParameterList list;
    ParameterList& body = bodyOf(list, "skin");
    body.set("Mesh", "skin.msh");
    change(body);
    return refusal([&] { scene::readScene(list, "scenes/a.xml"); });
  };
  expectSays(refused([](ParameterList& body) { body.set("Expansion", 1e-5); }),
             {"\"Expansion\"", "membranes have none"});
  expectSays(refused([](ParameterList& body) {
               body.sublist("Loads").sublist("warm").set("Kind", "temperature").set("Value", 1.0);
             }),
             {"\"Kind\"", "membranes do not expand"});
}

TEST(SupportsAndLoadsTest, RefusesSupportsThatHoldNothingOrTooMuch) {
  expectSays(entryRefusal("Supports", [](ParameterList& s) { s.set("X", 0.0); }),
             {"\"Bodies/cube/Supports/new\"", "\"Surface\"", "must be given"});
  expectSays(entryRefusal("Supports", [](ParameterList& s) { s.set("Surface", "left"); }),
             {"\"Bodies/cube/Supports/new\"", "holds nothing", "\"X\", \"Y\", \"Z\""});
  expectSays(entryRefusal("Supports", [](ParameterList& s) { s.set("Surface", "left").set("Value", 1.0); }),
             {"\"Value\"", "\"X\", \"Y\" and \"Z\""});
  expectSays(entryRefusal("Supports", [](ParameterList& s) { s.set("Edge", "left").set("X", 1.0); }),
             {"\"Edge\"", "\"Surface\""});
}

TEST(SupportsAndLoadsTest, RefusesLoadsWithTheWrongPlaceOrValue) {
  const auto says = [](const std::function<void(ParameterList&)>& change,
                       std::initializer_list<std::string> parts) {
    expectSays(entryRefusal("Loads", change), parts);
  };
  says([](ParameterList& l) { l.set("Value", 1.0); }, {"\"Value\"", "\"Force\""});
  says([](ParameterList&) {}, {"\"Bodies/cube/Loads/new\"", "\"Force\"", "must be given"});
  says(
      [](ParameterList& l) {
        l.set("Force", numbers({1, 2}));
      },
      {"\"Force\"", "3 entries {x, y, z}, not 2"});
  says(
      [](ParameterList& l) {
        l.set("Force", numbers({1, 2, 3})).set("Surface", "top");
      },
      {"\"Surface\"", "\"body\"", "no use"});
  says([](ParameterList& l) { l.set("Kind", "pressure").set("Value", 1.0); },
       {"\"Surface\"", "must be given"});
  says([](ParameterList& l) { l.set("Kind", "pressure").set("Surface", "top"); },
       {"\"Value\"", "must be given"});
  says(
      [](ParameterList& l) {
        l.set("Kind", "point").set("Force", numbers({1, 2, 3}));
      },
      {"\"Point\"", "must be given"});
  says(
      [](ParameterList& l) {
        l.set("Force", numbers({0, 0, 1})).set("Box", numbers({2, 3, 0, 1, 0, 1}));
      },
      {"\"Box\"", "must overlap the body, which in x goes from 0 to 1"});
}

} // namespace
