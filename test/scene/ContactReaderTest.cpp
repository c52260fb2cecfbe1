#include "SceneLists.hpp"

#include <limits>

namespace {

using namespace epafi;
using namespace epafi::test;
using Teuchos::ParameterList;

/// What readScene says if a parameter of the pair has another value.
template <class Value>
std::string refusalOf(const std::string& name, const Value& value) {
  return sceneRefusal([&](ParameterList& list) { pairOf(list).set(name, value); });
}

TEST(ContactReaderTest, RefusesAPairWithAParameterMissing) {
  for (const char* const name : {"First Body", "First Edge", "Second Body", "Second Edge"})
    expectSays(sceneRefusal([&](ParameterList& list) { pairOf(list).remove(name); }),
               {"a.xml: ", "\"Contact/interface\"", '"' + std::string(name) + '"', "must be given"});
}

TEST(ContactReaderTest, RefusesAnUnknownBodyAndSuggestsTheNearest) {
  expectSays(refusalOf("Second Body", "rigth"),
             {"a.xml: ", "\"Second Body\"", "\"Contact/interface\"", "\"rigth\"", "did you mean \"right\"?"});
  expectSays(refusalOf("First Body", "xyzxyzxyz"), {"\"xyzxyzxyz\"", "the bodies are \"left\", \"right\""});
}

TEST(ContactReaderTest, RefusesAnUnknownEdge) {
  expectSays(refusalOf("First Edge", "north"), {"a.xml: ", "\"First Edge\"", "\"Contact/interface\"",
                                                "\"north\"", "\"left\", \"right\", \"bottom\", \"top\""});
}

TEST(ContactReaderTest, RefusesABodyInContactWithItself) {
  expectSays(refusalOf("Second Body", "left"), {"a.xml: ", "\"Second Body\"", "\"left\"", "with itself"});
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

TEST(ContactReaderTest, RefusesAGapThatIsNotFinite) {
  expectSays(refusalOf("Gap", std::numeric_limits<double>::infinity()),
             {"a.xml: ", "\"Gap\"", "inf", "finite"});
}

TEST(ContactReaderTest, RefusesEdgesThatDoNotCoincide) {
  expectSays(refusalOf("Second Edge", "right"), {"a.xml: ", "\"Contact/interface\"", "do not coincide",
                                                 "x = 1, y from 0 to 1", "x = 2, y from 0 to 1"});
  expectSays(refusalOf("Second Edge", "top"), {"do not coincide", "y = 1, x from 1 to 2"});
}

TEST(ContactReaderTest, RefusesEdgesWithDifferentNumbersOfElements) {
  const auto change = [](ParameterList& list) { bodyOf(list, "right").set("Elements", counts({4, 5})); };
  expectSays(sceneRefusal(change),
             {"a.xml: ", "\"Contact/interface\"", "4 on body \"left\"", "5 on body \"right\""});
}

TEST(ContactReaderTest, ForgivesEdgesThatDifferByRounding) {
  ParameterList list = twoBodies();
  bodyOf(list, "right").set("Rectangle", numbers({1 + 1e-14, 2, -1e-14, 1}));
  EXPECT_EQ(scene::readScene(list, "a.xml").contacts.size(), 1u);
}

} // namespace
