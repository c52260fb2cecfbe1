#include "epafi/base/Parameters.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include "SceneLists.hpp"

namespace {

using namespace epafi;
using namespace epafi::test;
using scene::readScene;
using scene::Scene;
using Teuchos::ParameterList;

TEST(SceneReaderTest, ReadsTwoBodiesAndTheirContact) {
  ParameterList list = twoBodies();
  list.set("Title", "two");
  pairOf(list).set("Gap", 0.5);
  const Scene scene = readScene(list, "a.xml");
  EXPECT_EQ(scene.title, "two");
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[1].name, "right");
  EXPECT_EQ(scene.bodies[1].mesh.box.upper[0], 2.0);
  ASSERT_EQ(scene.bodies[0].supports.size(), 1u);
  EXPECT_EQ(scene.bodies[0].supports[0].surface, "left");
  ASSERT_EQ(scene.contacts.size(), 1u);
  EXPECT_EQ(scene.contacts[0].name, "interface");
  EXPECT_EQ(scene.contacts[0].first, 0);
  EXPECT_EQ(scene.contacts[0].second, 1);
  EXPECT_EQ(scene.contacts[0].secondSurface, "left");
  EXPECT_EQ(scene.contacts[0].gap, 0.5);
}

TEST(SceneReaderTest, KeepsBodiesInTheOrderOfTheFile) {
  ParameterList list;
  double x = 0;
  for (const char* const name : {"zeta", "alpha", "mu"}) {
    list.sublist("Bodies")
        .sublist(name)
        .set("Rectangle", numbers({x, x + 1, 0, 1}))
        .set("Elements", counts({2, 2}));
    x += 1;
  }
  const Scene scene = readScene(list, "a.xml");
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.bodies[0].name, "zeta");
  EXPECT_EQ(scene.bodies[1].name, "alpha");
  EXPECT_EQ(scene.bodies[2].name, "mu");
}

TEST(SceneReaderTest, LeavesTheSolverToOthers) {
  ParameterList list = twoBodies();
  list.sublist("Solver").set("Tolerance", 1e-3);
  EXPECT_EQ(readScene(list, "a.xml").bodies.size(), 2u);
}

TEST(SceneReaderTest, RefusesASceneWithoutBodies) {
  expectSays(refusal([] { readScene(ParameterList(), "a.xml"); }), {"a.xml: ", "\"Bodies\"", "at least one"});
}

TEST(SceneReaderTest, RefusesAMisspeltListAtTheTop) {
  expectSays(sceneRefusal([](ParameterList& list) { list.sublist("Contcat"); }),
             {"a.xml: ", "\"Contcat\"", "did you mean \"Contact\"?"});
  expectSays(sceneRefusal([](ParameterList& list) { list.sublist("Output").set("File", "x"); }),
             {"a.xml: ", "\"Output\"", "unknown; allowed are \"Title\""});
}

TEST(SceneReaderTest, GivesEachBodyTheDecompositionOfTheScene) {
  ParameterList list = twoBodies();
  list.sublist("Decomposition").set("Grid", counts({3, 1}));
  for (const auto& body : readScene(list, "a.xml").bodies)
    EXPECT_EQ(body.decomposition.counts, (std::array<int, 3>{3, 1, 1}));
}

TEST(SceneReaderTest, LetsABodyOverrideSingleEntriesOfTheDecomposition) {
  ParameterList list = twoBodies();
  list.sublist("Decomposition").set("Method", "metis").set("Parts", 3).set("Grid", counts({1, 2}));
  bodyOf(list, "left").sublist("Decomposition").set("Parts", 5);
  bodyOf(list, "right").sublist("Decomposition").set("Method", "grid");
  const Scene scene = readScene(list, "a.xml");
  EXPECT_EQ(scene.bodies[0].decomposition.method, scene::Decomposition::Method::metis);
  EXPECT_EQ(scene.bodies[0].decomposition.parts, 5);
  EXPECT_EQ(scene.bodies[1].decomposition.method, scene::Decomposition::Method::grid);
  EXPECT_EQ(scene.bodies[1].decomposition.counts, (std::array<int, 3>{1, 2, 1}));
}

TEST(SceneReaderTest, InheritsAlsoInAListThatWasValidatedBefore) {
  ParameterList list = twoBodies();
  list.sublist("Decomposition").set("Grid", counts({3, 1}));
  const ParameterList complete = validated(list, scene::sceneSchema(), "a.xml");
  EXPECT_EQ(readScene(complete, "a.xml").bodies[0].decomposition.counts, (std::array<int, 3>{3, 1, 1}));
}

TEST(SceneReaderTest, FindsMissingParametersInAListThatWasValidatedBefore) {
  ParameterList list = twoBodies();
  pairOf(list).remove("First Edge");
  const ParameterList partial = validated(list, scene::sceneSchema(), "a.xml", Completeness::part);
  expectSays(refusal([&] { readScene(partial, "a.xml"); }),
             {"a.xml: ", "\"Contact/interface\"", "\"First Edge\""});
}

} // namespace
