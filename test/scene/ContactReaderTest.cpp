#include "SceneLists.hpp"

#include "epafi/scene/ContactReader.hpp"

#include <limits>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

/// What readScene says if a parameter of the pair has another value.
template <class Value>
std::string refusalOfPair(const std::string& name, const Value& value) {
  return sceneRefusal([&](ParameterList& list) { pairOf(list).set(name, value); });
}

TEST(ContactReaderTest, RefusesAPairWithAParameterMissing) {
  for (const char* const name : {"First Body", "First Edge", "Second Body", "Second Edge"})
    expectSays(sceneRefusal([&](ParameterList& list) { pairOf(list).remove(name); }),
               {"a.xml: ", "\"Contact/interface\"", '"' + std::string(name) + '"', "must be given"});
}

TEST(ContactReaderTest, RefusesAnUnknownBodyAndSuggestsTheNearest) {
  expectSays(refusalOfPair("Second Body", "rigth"),
             {"a.xml: ", "\"Second Body\"", "\"Contact/interface\"", "\"rigth\"", "did you mean \"right\"?"});
  EXPECT_TRUE(refusalOfPair("Second Body", "rigth").ends_with("?"));
  expectSays(refusalOfPair("First Body", "xyzxyzxyz"),
             {"\"xyzxyzxyz\"", "the bodies are \"left\", \"right\""});
}

TEST(ContactReaderTest, RefusesAnUnknownEdge) {
  expectSays(refusalOfPair("First Edge", "north"), {"a.xml: ", "\"First Edge\"", "\"Contact/interface\"",
                                                    "\"north\"", "\"left\", \"right\", \"bottom\", \"top\""});
}

TEST(ContactReaderTest, RefusesABodyInContactWithItself) {
  expectSays(refusalOfPair("Second Body", "left"), {"a.xml: ", "\"Second Body\"", "\"left\"", "with itself"});
}

TEST(ContactReaderTest, RefusesAnEdgeThatIsSupported) {
  const auto change = [](ParameterList& list) {
    bodyOf(list, "right").sublist("Supports").sublist("post").set("Edge", "left");
  };
  expectSays(sceneRefusal(change),
             {"a.xml: ", "\"Second Edge\"", "\"Contact/interface\"", "\"right\"", "\"post\""});
}

TEST(ContactReaderTest, RefusesAnEdgeInTwoPairs) {
  const auto change = [](ParameterList& list) {
    const ParameterList first = pairOf(list);
    list.sublist("Contact").sublist("again").setParameters(first);
  };
  expectSays(sceneRefusal(change),
             {"a.xml: ", "\"First Edge\"", "\"Contact/again\"", "\"interface\" already"});
}

TEST(ContactReaderTest, RefusesFrictionWhereNothingCanSlip) {
  expectSays(refusalOfPair("Friction", 0.3),
             {"a.xml: ", "\"Friction\"", "\"Contact/interface\"", "0.3", "membranes", "elastic bodies"});
  expectSays(refusalOfPair("Friction", -0.3), {"a.xml: ", "\"Friction\"", "-0.3"});
  expectSays(refusalOfPair("Friction Bound", 2.0), {"\"Friction Bound\"", "membranes"});
}

TEST(ContactReaderTest, APreloadIsAForceOrALengthAndAStepMayLockIt) {
  using Kind = scene::Preload::Kind;
  EXPECT_EQ(scene::preloadOf("force 20")->kind, Kind::force);
  EXPECT_EQ(scene::preloadOf("shortening  -0.5")->value, -0.5);
  EXPECT_EQ(scene::preloadOf("locked")->kind, Kind::locked);
  for (const char* const text : {"", "force", "force x", "force 1 2", "torque 3", "lock"})
    EXPECT_FALSE(scene::preloadOf(text)) << text;
  expectSays(refusalOfPair("Preload", "force 20"), {"\"Preload\"", "\"Contact/interface\"", "tied joints"});
}

TEST(ContactReaderTest, RefusesAGapThatIsNotFinite) {
  expectSays(refusalOfPair("Gap", std::numeric_limits<double>::infinity()),
             {"a.xml: ", "\"Gap\"", "inf", "finite"});
}

TEST(ContactReaderTest, RefusesAGapWhoseSquareIsNoNumber) {
  expectSays(refusalOfPair("Gap", 1e-200),
             {"a.xml: parameter \"Gap\" in list \"Contact/interface\" is 1e-200", "choose other units."});
}

TEST(ContactReaderTest, RefusesEdgesThatDoNotCoincide) {
  expectSays(refusalOfPair("Second Edge", "right"), {"a.xml: ", "\"Contact/interface\"", "do not coincide",
                                                     "x = 1, y from 0 to 1", "x = 2, y from 0 to 1"});
  expectSays(refusalOfPair("Second Edge", "top"), {"do not coincide", "y = 1, x from 1 to 2"});
}

TEST(ContactReaderTest, RefusesPairsOfNodesOnEdgesWithDifferentNumbersOfElements) {
  const auto change = [](ParameterList& list) {
    bodyOf(list, "right").set("Elements", counts({4, 5}));
    list.sublist("Contact").sublist("interface").set("Coupling", "nodes");
  };
  expectSays(sceneRefusal(change),
             {"a.xml: ", "\"Contact/interface\"", "4 on body \"left\"", "5 on body \"right\""});
}

TEST(ContactReaderTest, ShowsInWhatEdgesDiffer) {
  const auto change = [](ParameterList& list) {
    bodyOf(list, "right").set("Rectangle", numbers({1.00000001, 2, 0, 1}));
  };
  expectSays(sceneRefusal(change), {"do not coincide", "is x = 1, y", "is x = 1.00000001, y"});
}

TEST(ContactReaderTest, ForgivesEdgesThatDifferByRounding) {
  ParameterList list = twoBodies();
  bodyOf(list, "right").set("Rectangle", numbers({1 + 1e-14, 2, -1e-14, 1}));
  EXPECT_EQ(scene::readScene(list, "a.xml").contacts.size(), 1u);
}

TEST(ContactReaderTest, ReadsHowSidesAreCoupled) {
  ParameterList list = twoBodies();
  EXPECT_EQ(scene::readScene(list, "a.xml").contacts[0].coupling, scene::SurfaceContact::Coupling::automatic);
  pairOf(list).set("Kind", "tied").set("Coupling", "mortar").set("Multipliers", "second");
  bodyOf(list, "right").set("Elements", counts({4, 5})); // meshed apart
  const scene::SurfaceContact tie = scene::readScene(list, "a.xml").contacts[0];
  EXPECT_EQ(tie.kind, scene::SurfaceContact::Kind::tied);
  EXPECT_EQ(tie.coupling, scene::SurfaceContact::Coupling::mortar);
  EXPECT_EQ(tie.multipliers, scene::SurfaceContact::Side::second);
}

TEST(ContactReaderTest, RefusesWhatCouplingsHaveNoUseFor) {
  const auto refused = [](const std::string& name, const auto& value, const std::string& beside,
                          const auto& other) {
    return sceneRefusal([&](ParameterList& list) {
      list.sublist("Contact").sublist("interface").set(name, value).set(beside, other);
    });
  };
  expectSays(refused("Coupling", "nodes", "Multipliers", "first"), {"\"Multipliers\"", "pairs of nodes"});
  expectSays(refused("Kind", "tied", "Gap", 0.5), {"\"Gap\"", "keeps the gap"});
  expectSays(refused("Kind", "tied", "Friction", 0.3), {"\"Friction\"", "tied joint does not slip"});
  expectSays(refused("Kind", "glued", "Gap", 0.0), {"\"Kind\"", "glued", "tied"});
}

/// Supports along the top of both bodies, at the heights `lower` and `upper`.
ParameterList twoRoofs(double lower, double upper, double gap) {
  ParameterList list = twoBodies();
  bodyOf(list, "left").sublist("Supports").remove("wall");
  for (const auto& [name, height] : {std::pair{"left", lower}, {"right", upper}})
    bodyOf(list, name).sublist("Supports").sublist("roof").set("Edge", "top").set("Value", height);
  pairOf(list).set("Gap", gap);
  return list;
}

TEST(ContactReaderTest, FindsNoSolutionWhereSupportedNodesOverlap) {
  expectSays(test::unsolvable(SolvabilityError::Kind::noSolution,
                              [] { scene::readScene(twoRoofs(0.5, 0.125, 0.25), "a.xml"); }),
             {"no solution", "'interface'", "overlap by 0.125 at (1, 1)", "'left'", "'right'"});
}

TEST(ContactReaderTest, AllowsSupportedNodesThatTouch) {
  EXPECT_NO_THROW(scene::readScene(twoRoofs(0.5, 0.125, 0.375), "a.xml"));
  EXPECT_NO_THROW(scene::readScene(twoRoofs(0.3, 0.1, 0.2), "a.xml")) << "0.2 − 0.3 + 0.1 is 2.8e-17";
  EXPECT_NO_THROW(scene::readScene(twoRoofs(0.4, 0.1, 0.3), "a.xml")) << "0.3 − 0.4 + 0.1 is −2.8e-17";
  ParameterList list = twoRoofs(5, 0, 0);
  bodyOf(list, "right").sublist("Supports").remove("roof");
  EXPECT_NO_THROW(scene::readScene(list, "a.xml")) << "one node is free";
}

} // namespace
