#include "SceneLists.hpp"

#include <limits>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

/// What readScene says if a parameter of the body `right` has another value.
template <class Value>
std::string refusalOfBody(const std::string& name, const Value& value) {
  return sceneRefusal([&](ParameterList& list) { bodyOf(list, "right").set(name, value); });
}

/// … of a new sublist, such as Loads/new.
template <class Change>
std::string refusalIn(const std::string& kind, const Change& change) {
  return sceneRefusal(
      [&](ParameterList& list) { change(bodyOf(list, "right").sublist(kind).sublist("new")); });
}

TEST(BodyReaderTest, ReadsRegionsSupportsAndLoads) {
  ParameterList list = twoBodies();
  ParameterList& body = bodyOf(list, "right");
  body.set("Conductivity", 2.0);
  body.sublist("Regions").sublist("soft").set("Box", numbers({1.5, 3, 0, 1})).set("Conductivity", 0.1);
  body.sublist("Supports").sublist("roof").set("Edge", "top").set("Value", -0.5);
  body.sublist("Loads").sublist("strip").set("Box", numbers({1, 2, 0, 0.25})).set("Value", -3.0);
  body.sublist("Loads").sublist("weight").set("Value", -1.0);
  const scene::Body right = scene::readScene(list, "a.xml").bodies[1];
  EXPECT_EQ(right.material.conductivity, 2.0);
  ASSERT_EQ(right.regions.size(), 1u);
  EXPECT_EQ(right.regions[0].material.conductivity, 0.1);
  ASSERT_EQ(right.supports.size(), 1u);
  EXPECT_EQ(right.supports[0].value[0], -0.5);
  ASSERT_EQ(right.loads.size(), 2u);
  EXPECT_EQ(right.loads[0].box.upper[1], 0.25);
  EXPECT_FALSE(right.loads[0].wholeElements) << "a membrane's load cuts elements";
  EXPECT_LE(right.loads[1].box.lower[0], 1.0) << "a load without a box covers the body";
  EXPECT_GE(right.loads[1].box.upper[1], 1.0);
}

TEST(BodyReaderTest, TakesDefaultsForWhatMayBeLeftOut) {
  ParameterList list = twoBodies();
  const scene::Body left = scene::readScene(list, "a.xml").bodies[0];
  EXPECT_EQ(left.material.conductivity, 1.0);
  EXPECT_EQ(left.decomposition.counts, (std::array<int, 3>{2, 2, 1}));
}

TEST(BodyReaderTest, RefusesABodyWithoutElements) {
  expectSays(sceneRefusal([](ParameterList& list) { bodyOf(list, "right").remove("Elements"); }),
             {"a.xml: ", "\"Bodies/right\"", "\"Elements\"", "must be given"});
}

TEST(BodyReaderTest, RefusesABodyWithoutRectangle) {
  expectSays(sceneRefusal([](ParameterList& list) { bodyOf(list, "right").remove("Rectangle"); }),
             {"a.xml: ", "\"Bodies/right\"", "\"Rectangle\"", "must be given"});
  expectSays(refusalOfBody("Rectangle", numbers({})), {"\"Bodies/right\"", "\"Rectangle\"", "must be given"});
}

TEST(BodyReaderTest, RefusesARectangleOfTheWrongLength) {
  expectSays(refusalOfBody("Rectangle", numbers({0, 1, 0})),
             {"a.xml: ", "\"Rectangle\"", "\"Bodies/right\"", "{0, 1, 0}", "4 entries"});
}

TEST(BodyReaderTest, RefusesARectangleWithoutSize) {
  expectSays(refusalOfBody("Rectangle", numbers({1, 1, 0, 1})),
             {"a.xml: ", "\"Rectangle\"", "{1, 1, 0, 1}", "x0 < x1"});
  expectSays(refusalOfBody("Rectangle", numbers({1, 2, 1, 0})), {"{1, 2, 1, 0}", "y0 < y1"});
}

TEST(BodyReaderTest, RefusesNumbersWhoseSquaresAreNone) {
  const auto load = [](double value) {
    return refusalIn("Loads", [&](ParameterList& list) { list.set("Value", value); });
  };
  const auto support = [](double value) {
    return refusalIn("Supports", [&](ParameterList& list) { list.set("Edge", "top").set("Value", value); });
  };
  const std::string range = "0 or between 1e-30 and 1e30 in magnitude; choose other units.";
  for (const double value : {1e-200, -9e-31, 2e30, -1e300, 5e-324}) {
    expectSays(load(value), {"a.xml: parameter \"Value\" in list \"Bodies/right/Loads/new\"", range});
    expectSays(support(value), {"a.xml: parameter \"Value\" in list \"Bodies/right/Supports/new\"", range});
  }
  expectSays(load(1e-200), {" is 1e-200, but"});
  for (const double value : {1e-200, 1e200}) {
    const std::string message = refusalOfBody("Conductivity", value);
    expectSays(message, {"\"Conductivity\"", "\"Bodies/right\"", "between 1e-30 and 1e30", "other units"});
    EXPECT_EQ(message.find("0 or"), std::string::npos) << message;
  }
}

TEST(BodyReaderTest, RefusesRectanglesWhoseSquaresAreNone) {
  for (const auto& box :
       {numbers({-1e308, 1e308, 0, 1}), numbers({0, 1e-31, 0, 1}), numbers({1e-200, 1, 0, 1})})
    expectSays(refusalOfBody("Rectangle", box), {"a.xml: ", "\"Rectangle\"", "\"Bodies/right\"",
                                                 "its entries", "0 or between", "other units."});
  for (const auto& box : {numbers({-9e29, 9e29, 0, 1}), numbers({1e-30, 1.5e-30, 0, 1})})
    expectSays(refusalOfBody("Rectangle", box),
               {"its sides", "between 1e-30 and 1e30", "choose other units."});
  expectSays(refusalIn("Loads",
                       [](ParameterList& load) {
                         load.set("Box", numbers({1, 2, 0, 1e31})).set("Value", 1.0);
                       }),
             {"\"Box\"", "\"Bodies/right/Loads/new\"", "other units"});
}

TEST(BodyReaderTest, TakesZeroAndTheEndsOfTheRange) {
  for (const double value : {0.0, -0.0, 1e-30, -1e30}) {
    ParameterList list = twoBodies();
    bodyOf(list, "right").sublist("Loads").sublist("new").set("Value", value);
    EXPECT_EQ(scene::readScene(list, "a.xml").bodies[1].loads[0].value[0], value);
  }
}

TEST(BodyReaderTest, RefusesARectangleWithNaN) {
  const double notANumber = std::numeric_limits<double>::quiet_NaN();
  expectSays(refusalOfBody("Rectangle", numbers({1, notANumber, 0, 1})),
             {"a.xml: ", "\"Rectangle\"", "\"Bodies/right\"", "{1, nan, 0, 1}", "finite"});
}

TEST(BodyReaderTest, RefusesARectangleTooThinToBeCut) {
  expectSays(refusalOfBody("Rectangle", numbers({1e9, 1e9 + 1e-6, 0, 1})), {"\"Rectangle\"", "too thin"});
}

TEST(BodyReaderTest, RefusesNumbersOfElementsBelowOne) {
  expectSays(refusalOfBody("Elements", counts({4, 0})),
             {"a.xml: ", "\"Elements\"", "\"Bodies/right\"", "{4, 0}", "at least 1"});
  expectSays(refusalOfBody("Elements", counts({-4, 4})), {"{-4, 4}", "at least 1"});
  expectSays(refusalOfBody("Elements", counts({4})), {"{4}", "2 entries"});
}

TEST(BodyReaderTest, RefusesMoreNodesThanAnIntCounts) {
  expectSays(refusalOfBody("Elements", counts({50000, 50000})),
             {"a.xml: ", "\"Elements\"", "{50000, 50000}", "10000200001 nodes", "2147483647"});
  expectSays(refusalOfBody("Elements", counts({2147483647, 2147483647})),
             {"\"Elements\"", "18446744065119617024 nodes"});
}

TEST(BodyReaderTest, RefusesConductivityThatIsNotPositive) {
  expectSays(refusalOfBody("Conductivity", 0.0),
             {"a.xml: ", "\"Conductivity\"", "\"Bodies/right\"", "is 0", "> 0"});
  expectSays(refusalIn("Regions", [](ParameterList& region) { region.set("Conductivity", -2.0); }),
             {"\"Bodies/right/Regions/new\"", "is -2", "> 0"});
}

TEST(BodyReaderTest, RefusesUnknownPhysics) {
  expectSays(refusalOfBody("Physics", "elasticity"),
             {"a.xml: ", "\"Physics\"", "\"elasticity\"", "\"membrane\""});
}

TEST(BodyReaderTest, RefusesARegionWithoutBoxOrConductivity) {
  expectSays(refusalIn("Regions", [](ParameterList& region) { region.set("Conductivity", 2.0); }),
             {"\"Bodies/right/Regions/new\"", "\"Box\"", "must be given"});
  expectSays(refusalIn("Regions",
                       [](ParameterList& region) {
                         region.set("Box", numbers({1, 2, 0, 1}));
                       }),
             {"\"Bodies/right/Regions/new\"", "\"Conductivity\"", "must be given"});
}

TEST(BodyReaderTest, RefusesARegionOutsideOfItsBody) {
  const auto outside = [](ParameterList& region) {
    region.set("Box", numbers({0, 1, 0, 1})).set("Conductivity", 2.0);
  };
  expectSays(refusalIn("Regions", outside), {"a.xml: ", "\"Box\"", "\"Bodies/right/Regions/new\"",
                                             "{0, 1, 0, 1}", "overlap", "from 1 to 2"});
}

TEST(BodyReaderTest, RefusesALoadOutsideOfItsBody) {
  const auto outside = [](ParameterList& load) { load.set("Box", numbers({5, 6, 0, 1})).set("Value", 2.0); };
  expectSays(refusalIn("Loads", outside),
             {"a.xml: ", "\"Box\"", "\"Bodies/right/Loads/new\"", "{5, 6, 0, 1}", "overlap", "from 1 to 2"});
}

TEST(BodyReaderTest, RefusesALoadBoxThatIsNone) {
  const auto flat = [](ParameterList& load) { load.set("Box", numbers({1, 2, 0, 0})).set("Value", 2.0); };
  expectSays(refusalIn("Loads", flat), {"\"Bodies/right/Loads/new\"", "{1, 2, 0, 0}", "positive size"});
  const auto two = [](ParameterList& load) { load.set("Box", numbers({1, 2})).set("Value", 2.0); };
  expectSays(refusalIn("Loads", two), {"{1, 2}", "4 entries"});
}

TEST(BodyReaderTest, RefusesALoadWithoutValue) {
  expectSays(refusalIn("Loads", [](ParameterList&) {}),
             {"\"Bodies/right/Loads/new\"", "\"Value\"", "must be given"});
}

TEST(BodyReaderTest, RefusesASupportWithoutEdgeOrWithAnUnknownOne) {
  expectSays(refusalIn("Supports", [](ParameterList&) {}),
             {"\"Bodies/right/Supports/new\"", "\"Edge\"", "must be given"});
  expectSays(refusalIn("Supports", [](ParameterList& support) { support.set("Edge", "rigth"); }),
             {"a.xml: ", "\"Edge\"", "\"rigth\"", "did you mean \"right\"?"});
}

TEST(BodyReaderTest, RefusesAnEdgeSupportedTwice) {
  const auto change = [](ParameterList& list) {
    bodyOf(list, "left").sublist("Supports").sublist("again").set("Edge", "left");
  };
  expectSays(sceneRefusal(change),
             {"a.xml: ", "\"Edge\"", "\"Bodies/left/Supports/again\"", "\"left\"", "\"wall\""});
}

TEST(BodyReaderTest, RefusesSupportsThatDisagreeAtTheirCorner) {
  const auto change = [](ParameterList& list) {
    bodyOf(list, "left").sublist("Supports").sublist("roof").set("Edge", "top").set("Value", 1.0);
  };
  expectSays(sceneRefusal(change),
             {"a.xml: ", "\"Value\"", "\"Bodies/left/Supports/roof\"", "is 1", "\"wall\"", "corner"});
}

TEST(BodyReaderTest, RefusesMoreSubdomainsThanElements) {
  const auto grid = [](ParameterList& list) {
    bodyOf(list, "right").sublist("Decomposition").set("Grid", counts({2, 5}));
  };
  expectSays(sceneRefusal(grid), {"a.xml: ", "\"Grid\"", "\"Bodies/right/Decomposition\"", "{2, 5}",
                                  "body \"right\" has only {4, 4} elements"});
  const auto metis = [](ParameterList& list) {
    list.sublist("Decomposition").set("Method", "metis").set("Parts", 17);
  };
  expectSays(sceneRefusal(metis), {"\"Parts\"", "is 17", "body \"left\" has only {4, 4} elements"});
}

TEST(BodyReaderTest, CutsTheDefaultGridDownToTheElementsThatThereAre) {
  for (const auto& [elements, grid] : {std::pair{counts({1, 1}), std::array{1, 1, 1}},
                                       {counts({1, 4}), std::array{1, 2, 1}},
                                       {counts({3, 1}), std::array{2, 1, 1}}}) {
    ParameterList list = twoBodies();
    bodyOf(list, "right").set("Elements", elements);
    EXPECT_EQ(scene::readScene(list, "a.xml").bodies[1].decomposition.counts, grid);
  }
}

TEST(BodyReaderTest, RefusesCountsOfSubdomainsBelowOne) {
  const auto grid = [](ParameterList& list) { list.sublist("Decomposition").set("Grid", counts({0, 2})); };
  expectSays(sceneRefusal(grid), {"\"Grid\"", "{0, 2}", "at least 1"});
  const auto metis = [](ParameterList& list) { list.sublist("Decomposition").set("Parts", -1); };
  expectSays(sceneRefusal(metis), {"a.xml: ", "\"Parts\"", "\"Decomposition\"", "is -1", "≥ 0"});
}

TEST(BodyReaderTest, RefusesAnUnknownMethodOfDecomposition) {
  const auto change = [](ParameterList& list) { list.sublist("Decomposition").set("Method", "metsi"); };
  expectSays(sceneRefusal(change), {"a.xml: ", "\"Method\"", "\"metsi\"", "did you mean \"metis\"?"});
}

} // namespace
