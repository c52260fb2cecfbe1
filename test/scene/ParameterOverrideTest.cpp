#include "epafi/scene/ParameterOverride.hpp"

#include "SceneLists.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/scene/SceneSchema.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using scene::applyOverride;
using Teuchos::ParameterList;

ParameterList schema() {
  ParameterList list = scene::sceneSchema();
  addReal(list.sublist("Solver"), "Tolerance", 1e-6, "Where to stop.", 0.0, 1.0, true);
  return list;
}

ParameterList overridden(const std::string& assignment) {
  ParameterList list = twoBodies();
  applyOverride(list, schema(), assignment);
  return list;
}

std::string refusalOfAssignment(const std::string& assignment) {
  return refusal([&] { overridden(assignment); });
}

TEST(ParameterOverrideTest, ReplacesAValue) {
  ParameterList list = overridden("Bodies/left/Elements={8, 16}");
  EXPECT_EQ(bodyOf(list, "left").get<Teuchos::Array<int>>("Elements"), counts({8, 16}));
  EXPECT_EQ(bodyOf(list, "right").get<Teuchos::Array<int>>("Elements"), counts({4, 4}));
}

TEST(ParameterOverrideTest, TakesTheTypeFromTheSchema) {
  ParameterList list = overridden("Contact/interface/Gap=1");
  EXPECT_EQ(pairOf(list).get<double>("Gap"), 1.0);
  EXPECT_EQ(overridden("Decomposition/Parts=9").sublist("Decomposition").get<int>("Parts"), 9);
  EXPECT_EQ(overridden("Title=9").get<std::string>("Title"), "9");
}

TEST(ParameterOverrideTest, KeepsFurtherEqualsSignsInTheValue) {
  EXPECT_EQ(overridden("Title=f = -1").get<std::string>("Title"), "f = -1");
}

TEST(ParameterOverrideTest, AddsParametersAndListsThatTheSchemaKnows) {
  EXPECT_EQ(overridden("Solver/Tolerance=1e-3").sublist("Solver").get<double>("Tolerance"), 1e-3);
  ParameterList list = overridden("Bodies/right/Loads/new one/Value=-2");
  EXPECT_EQ(bodyOf(list, "right").sublist("Loads").sublist("new one").get<double>("Value"), -2.0);
}

TEST(ParameterOverrideTest, IsReadLikeAValueOfTheFile) {
  const auto bodies = scene::readScene(overridden("Decomposition/Grid={4, 1}"), "a.xml").bodies;
  EXPECT_EQ(bodies[1].decomposition.counts, (std::array<int, 3>{4, 1, 1}));
}

TEST(ParameterOverrideTest, RefusesATextWithoutEqualsSign) {
  expectSays(refusalOfAssignment("Solver/Tolerance"),
             {"--set \"Solver/Tolerance\"", "no \"=\"", "Parameter=value"});
}

TEST(ParameterOverrideTest, RefusesAnEmptyName) {
  for (const char* const text : {"=1", "Solver/=1", "/Title=1", "Solver//Tolerance=1"})
    expectSays(refusalOfAssignment(text), {"--set \"" + std::string(text) + '"', "empty name"});
}

TEST(ParameterOverrideTest, RefusesUnknownNamesAndSuggestsTheNearest) {
  expectSays(refusalOfAssignment("Solver/Tolerence=1e-3"),
             {"--set \"Solver/Tolerence=1e-3\"", "list \"Solver\"", "did you mean \"Tolerance\"?"});
  expectSays(refusalOfAssignment("Solvre/Tolerance=1e-3"),
             {"--set \"Solvre/", "\"Solvre\"", "did you mean \"Solver\"?"});
  expectSays(refusalOfAssignment("Bodies/left/Elemnts={1, 1}"),
             {"\"Bodies/left\"", "did you mean \"Elements\"?"});
}

TEST(ParameterOverrideTest, RefusesAValueOfAnotherType) {
  expectSays(refusalOfAssignment("Solver/Tolerance=small"),
             {"--set \"Solver/Tolerance=small\"", "\"small\"", "not a number", "type double"});
  expectSays(refusalOfAssignment("Decomposition/Parts=2.5"), {"\"2.5\"", "not a whole number", "type int"});
  expectSays(refusalOfAssignment("Bodies/left/Elements=8"), {"\"8\"", "not an array", "type Array(int)"});
  expectSays(refusalOfAssignment("Solver/Tolerance="), {"--set \"Solver/Tolerance=\"", "not a number"});
}

TEST(ParameterOverrideTest, RefusesAValueOutOfRange) {
  expectSays(refusalOfAssignment("Solver/Tolerance=-1"),
             {"--set \"Solver/Tolerance=-1\"", "\"Tolerance\" in list \"Solver\" is -1", "> 0 and ≤ 1"});
}

TEST(ParameterOverrideTest, RefusesAListAsParameter) {
  expectSays(refusalOfAssignment("Solver=1"), {"--set \"Solver=1\"", "\"Solver\"", "must be a list"});
  expectSays(refusalOfAssignment("Title/x=1"), {"--set \"Title/x=1\"", "\"Title\"", "must be a parameter"});
  expectSays(refusalOfAssignment("Bodies/left=1"), {"--set \"Bodies/left=1\"", "<body>"});
}

TEST(ParameterOverrideTest, RefusesANewListWhoseNameLooksMisspelt) {
  EXPECT_EQ(refusalOfAssignment("Bodies/lefd/Elements={8, 8}"),
            "--set \"Bodies/lefd/Elements={8, 8}\" names the list \"Bodies/lefd\", which the scene does not "
            "have; did you mean \"left\"?");
  expectSays(refusalOfAssignment("Bodies/left/Supports/Wall/Value=1"),
             {"\"Bodies/left/Supports/Wall\"", "did you mean \"wall\"?"});
  expectSays(refusalOfAssignment("Contact/interfac/Gap=1"),
             {"\"Contact/interfac\"", "did you mean \"interface\"?"});
}

TEST(ParameterOverrideTest, AddsAListWhoseNameIsLikeNoOther) {
  ParameterList list = overridden("Bodies/right/Loads/load 1/Value=1");
  for (const char* const text : {"Bodies/right/Loads/load 2/Value=2", "Bodies/right/Loads/x/Value=0.25",
                                 "Bodies/third/Elements={1, 1}"})
    EXPECT_NO_THROW(applyOverride(list, schema(), text)) << text;
  EXPECT_EQ(bodyOf(list, "right").sublist("Loads").sublist("load 2").get<double>("Value"), 2.0);
  EXPECT_NO_THROW(applyOverride(list, schema(), "Bodies/right/Loads/load 2/Value=3")) << "there by now";
}

TEST(ParameterOverrideTest, LeavesTheListAloneWhenItRefuses) {
  ParameterList list = twoBodies();
  refusal([&] { applyOverride(list, schema(), "Bodies/third/Elements=8"); });
  EXPECT_FALSE(list.sublist("Bodies").isSublist("third"));
}

} // namespace
