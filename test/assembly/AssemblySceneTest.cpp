#include "epafi/assembly/AssemblyScene.hpp"

#include "assembly/Assemblies.hpp"
#include "support/Refusal.hpp"

#include <Teuchos_Array.hpp>

#include <algorithm>
#include <numeric>

namespace epafi {
namespace {

using namespace assembly;
using test::assemblyCalled;
using test::expectSays;
using test::refusal;
using Teuchos::ParameterList;

ParameterList ofSteel() {
  ParameterList list("Epafi");
  list.sublist("Assembly").set("Material", "steel");
  return list;
}

AssemblyScene made(const std::string& name, const ParameterList& given) {
  return sceneOf(assemblyCalled(name), given, name + ".step", "given.xml");
}

TEST(AssemblySceneTest, HasABodyForEachSolidAndAContactForEachPair) {
  const AssemblyScene scene = made("flanges", ofSteel());
  const ParameterList &bodies = scene.scene.sublist("Bodies"), &contacts = scene.scene.sublist("Contact");
  EXPECT_EQ(bodies.numParams(), 10);
  const ParameterList& bolt = bodies.sublist("bolt M12:3");
  EXPECT_EQ(bolt.get<std::string>("Mesh"), "flanges.step");
  EXPECT_EQ(bolt.get<std::string>("Group"), "bolt M12:3");
  EXPECT_EQ(bolt.get<double>("Young's Modulus"), 210000);
  EXPECT_FALSE(scene.scene.isSublist("Assembly"));
  EXPECT_EQ(contacts.numParams(), 13);
  EXPECT_EQ(contacts.sublist("bolt M12:1 - upper flange").get<std::string>("First Surface"), "face 23");
  EXPECT_NE(scene.notes.find("4 x bolt M12 - upper flange"), std::string::npos) << scene.notes;
  EXPECT_NE(scene.notes.find("8 pairs of faces are 0.5 mm apart: a Distance of 0.6"), std::string::npos)
      << scene.notes;
}

TEST(AssemblySceneTest, TiesCylindersThatCoincideUnlessTheyAreFits) {
  ParameterList given = ofSteel();
  given.sublist("Contact").sublist("Automatic").set("Friction", 0.2);
  const auto kindOf = [&](const char* name) {
    const AssemblyScene scene = made("bracket", given);
    return scene.scene.sublist("Contact").sublist(name).get<std::string>("Kind");
  };
  EXPECT_EQ(kindOf("nut M10:1 - bolt M10:1"), "tied");
  EXPECT_EQ(kindOf("nut M10:1 - plate"), "contact");
  const AssemblyScene scene = made("bracket", given);
  EXPECT_EQ(scene.scene.sublist("Contact").sublist("bracket - plate").get<double>("Friction"), 0.2);
  EXPECT_FALSE(scene.scene.sublist("Contact").sublist("nut M10:1 - bolt M10:1").isParameter("Friction"));
  given.sublist("Contact").sublist("Automatic").set("Threads", "contact");
  EXPECT_EQ(kindOf("nut M10:1 - bolt M10:1"), "contact");
  EXPECT_EQ(
      made("shrink_fit", ofSteel()).scene.sublist("Contact").sublist("ring - shaft").get<std::string>("Kind"),
      "contact"); // they overlap
}

TEST(AssemblySceneTest, LeavesOutPairsThatAreExcludedOrMadeByHand) {
  ParameterList given = ofSteel();
  ParameterList& contacts = given.sublist("Contact");
  contacts.sublist("Automatic").set("Exclude", "bolt M12:* - nut M12:*, nut M12:1/plane +z - lower flange");
  contacts.sublist("joint")
      .set("First Body", "lower flange")
      .set("First Surface", "plane +z")
      .set("Second Body", "upper flange")
      .set("Second Surface", "upper flange/face 3")
      .set("Kind", "tied");
  const ParameterList found = made("flanges", given).scene.sublist("Contact");
  EXPECT_EQ(found.numParams(), 13 - 4 - 1);
  EXPECT_EQ(found.sublist("joint").get<std::string>("First Surface"), "face 12");
  EXPECT_FALSE(found.isSublist("upper flange - lower flange"));
  EXPECT_FALSE(found.isSublist("nut M12:1 - lower flange"));
  EXPECT_TRUE(found.isSublist("nut M12:2 - lower flange"));
}

TEST(AssemblySceneTest, TakesPairsThatItHasPrintedForTheSame) {
  ParameterList given = ofSteel();
  std::string notes;
  given.sublist("Contact") = pairsOf(assemblyCalled("ball_socket"), given, "given.xml", notes);
  const ParameterList again = made("ball_socket", given).scene.sublist("Contact");
  EXPECT_EQ(again.numParams(), 2);
  EXPECT_GT(again.sublist("base - ball").get<double>("Distance"), 0); // what is far apart stays so
}

TEST(AssemblySceneTest, SpreadsAForceOverAllFacesThatItsWordsMean) {
  ParameterList given = ofSteel();
  given.sublist("Assembly")
      .sublist("Forces")
      .set("pin/plane", Teuchos::Array<double>(std::vector<double>{0, 0, 10000}));
  const ParameterList loads =
      made("pin_in_lug", given).scene.sublist("Bodies").sublist("pin").sublist("Loads");
  ASSERT_EQ(loads.numParams(), 2);
  const double area = 2 * std::acos(-1.0) * 100; // of both ends
  for (const char* const face : {"face 9", "face 10"}) {
    const ParameterList& load = loads.sublist(std::string("plane, ") + face);
    EXPECT_EQ(load.get<std::string>("Surface"), face);
    EXPECT_NEAR(load.get<Teuchos::Array<double>>("Force")[2], 10000 / area, 1e-6);
  }
}

TEST(AssemblySceneTest, HoldsCylindersByTheirAxes) {
  ParameterList given = ofSteel();
  ParameterList& lines = given.sublist("Assembly").sublist("Supports");
  lines.set("ring/cylinder r=40", "around along");
  lines.set("ring/plane -z", "z");
  lines.set("shaft/plane -z", "around z");
  lines.set("shaft/plane +z", "normal");
  lines.set("shaft/point 20 0 0", "xy");
  const ParameterList bodies = made("shrink_fit", given).scene.sublist("Bodies");
  const ParameterList &ring = bodies.sublist("ring").sublist("Supports"),
                      &shaft = bodies.sublist("shaft").sublist("Supports");
  const ParameterList& rim = ring.sublist("cylinder r=40, face 1");
  EXPECT_FALSE(rim.isParameter("X"));
  EXPECT_TRUE(rim.isParameter("Y") && rim.isParameter("Z"));
  const auto line = rim.get<Teuchos::Array<double>>("Cylinder");
  for (const int i : {0, 1, 3, 4})
    EXPECT_NEAR(line[i], 0, 1e-6);
  EXPECT_GT(std::abs(line[5] - line[2]), 1);
  EXPECT_EQ(ring.sublist("plane -z, face 3").numParams(), 2); // surface and z
  EXPECT_TRUE(shaft.sublist("plane -z, face 7").isParameter("Cylinder"));
  EXPECT_TRUE(shaft.sublist("plane +z, face 6").isParameter("Normal"));
  EXPECT_TRUE(std::any_of(shaft.begin(), shaft.end(), [&](const auto& entry) {
    return entry.first.starts_with("point 20 0 0") && shaft.sublist(entry.first).isParameter("X") &&
           shaft.sublist(entry.first).template get<std::string>("Surface").starts_with("point ");
  }));
}

TEST(AssemblySceneTest, AsksForMoreElementsAroundWhereTheGapIsSmall) {
  const auto aroundOf = [](const char* name) {
    const ParameterList bodies = made(name, ofSteel()).scene.sublist("Bodies");
    const ParameterList& body = bodies.sublist(bodies.begin()->first);
    return body.isParameter("Elements Around") ? body.get<int>("Elements Around") : 16;
  };
  EXPECT_EQ(aroundOf("blocks"), 16);
  const int n = aroundOf("shrink_fit");
  EXPECT_GT(n, 16);
  EXPECT_LT(20 * std::pow(1 - std::cos(std::acos(-1.0) / n), 2) / 8,
            0.01 * 0.02); // sag below 1 % of the overlap
}

TEST(AssemblySceneTest, RefinesWhereABallTouches) {
  ParameterList given = ofSteel();
  given.sublist("Assembly").set("Contact Size", 0.1);
  const ParameterList bodies = made("ball_socket", given).scene.sublist("Bodies");
  const auto points = bodies.sublist("lid").get<Teuchos::Array<double>>("Fine Points");
  const std::vector<double> poles{0, 0, -6, 0.1, 0, 0, 14, 0.1};
  ASSERT_EQ(points.size(), std::ssize(poles));
  for (int i = 0; i < std::ssize(poles); ++i)
    EXPECT_NEAR(points[i], poles[i], 0.02); // the gap is flat there
  EXPECT_FALSE(made("pin_in_lug", given).scene.sublist("Bodies").sublist("pin").isParameter("Fine Points"));
}

TEST(AssemblySceneTest, RefusesWhatItCannotTell) {
  const auto said = [](const char* name, const ParameterList& given) {
    return refusal([&] { (void)made(name, given); });
  };
  expectSays(said("blocks", ParameterList("Epafi")), {"given.xml", "lower block", "no material"});
  ParameterList given = ofSteel();
  given.sublist("Bodies").sublist("upper block").set("Material", "steal");
  expectSays(said("blocks", given), {"\"steal\"", "did you mean \"steel\"?"});
  given = ofSteel();
  given.sublist("Assembly").sublist("Supports").set("lower block/plane -z", "fixt");
  expectSays(said("blocks", given), {"lower block/plane -z", "\"fixt\" is none of"});
  given.sublist("Assembly").sublist("Supports").set("lower block/plane -z", "around");
  expectSays(said("blocks", given), {"no cylinder", "around z"});
  given = ofSteel();
  given.sublist("Assembly").sublist("Forces").set("lower block/plane -z", 5.0);
  expectSays(said("blocks", given), {"Array(double) {x, y, z}"});
  given = ofSteel();
  given.sublist("Contact").set("hand", 1.0);
  expectSays(said("blocks", given), {"\"hand\"", "one a pair"});
  given = ofSteel();
  given.set("Bodies", 1.0);
  expectSays(said("blocks", given), {"\"Bodies\" is a parameter, but must be a list"});
  given = ofSteel();
  given.sublist("Assembly").set("Contact Size", -1.0);
  expectSays(said("blocks", given), {"Assembly", "\"Contact Size\""});
  given = ofSteel();
  given.sublist("Contact").sublist("hand").set("First Body", "lower block").set("First Surface", "plane");
  expectSays(said("blocks", given), {"several faces"});
  given = ofSteel();
  given.sublist("Contact").sublist("Automatic").set("Distnace", 1.0);
  expectSays(said("blocks", given), {"Contact/Automatic", "\"Distance\""});
}

} // namespace
} // namespace epafi
