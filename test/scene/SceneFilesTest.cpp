// The files under xml/ are read by every release's users: each must say what its comment promises.

#include "epafi/scene/ModelProblem.hpp"
#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_Comm.hpp>
#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <filesystem>

namespace {

using namespace epafi;
using scene::Body;
using scene::readParameterFile;
using scene::readScene;
using scene::Scene;

std::string pathOf(const std::string& file) {
  return EPAFI_SOURCE_DIR "/xml/" + file;
}

Scene sceneOf(const std::string& file) {
  return readScene(readParameterFile(pathOf(file), *Tpetra::getDefaultComm()), file);
}

void expectSame(const mesh::Box& a, const mesh::Box& b) {
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
}

void expectSame(const Body& a, const Body& b) {
  EXPECT_EQ(a.name, b.name);
  expectSame(a.mesh.box, b.mesh.box);
  EXPECT_EQ(a.mesh.elements, b.mesh.elements);
  EXPECT_EQ(a.material.conductivity, b.material.conductivity);
  EXPECT_EQ(a.regions.size(), b.regions.size());
  ASSERT_EQ(a.supports.size(), b.supports.size());
  for (std::size_t i = 0; i < a.supports.size(); ++i) {
    EXPECT_EQ(a.supports[i].surface, b.supports[i].surface);
    EXPECT_EQ(a.supports[i].value, b.supports[i].value);
  }
  ASSERT_EQ(a.loads.size(), b.loads.size());
  for (std::size_t i = 0; i < a.loads.size(); ++i) {
    expectSame(a.loads[i].box, b.loads[i].box);
    EXPECT_EQ(a.loads[i].value, b.loads[i].value);
  }
  EXPECT_EQ(a.decomposition.method, b.decomposition.method);
  EXPECT_EQ(a.decomposition.counts, b.decomposition.counts);
}

void expectSame(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.title, b.title);
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    expectSame(a.bodies[i], b.bodies[i]);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].name, b.contacts[i].name);
    EXPECT_EQ(a.contacts[i].first, b.contacts[i].first);
    EXPECT_EQ(a.contacts[i].firstSurface, b.contacts[i].firstSurface);
    EXPECT_EQ(a.contacts[i].second, b.contacts[i].second);
    EXPECT_EQ(a.contacts[i].secondSurface, b.contacts[i].secondSurface);
    EXPECT_EQ(a.contacts[i].gap, b.contacts[i].gap);
  }
}

TEST(SceneFilesTest, AllCanBeReadAndSurviveBeingWrittenByTeuchos) {
  int numFiles = 0;
  for (const auto& file : std::filesystem::directory_iterator(EPAFI_SOURCE_DIR "/xml")) {
    if (file.path().extension() != ".xml")
      continue; // geometries
    const std::string path = file.path().string();
    SCOPED_TRACE(path);
    const auto list = scene::readParameterFile(path, *Tpetra::getDefaultComm());
    if (!list.isSublist("Bodies"))
      continue;
    ++numFiles;
    std::ostringstream text;
    Teuchos::writeParameterListToXmlOStream(list, text);
    const auto again = scene::parseParameters(text.str(), path);
    EXPECT_TRUE(Teuchos::haveSameValues(list, again));
    expectSame(readScene(list, path), readScene(again, path));
  }
  EXPECT_GE(numFiles, 16);
}

TEST(SceneFilesTest, CoerciveIsTheModelProblemOfThePaper) {
  expectSame(sceneOf("coercive.xml"), scene::modelProblem(true, 4, 32));
}

TEST(SceneFilesTest, SemicoerciveIsTheModelProblemOfThePaper) {
  expectSame(sceneOf("semicoercive.xml"), scene::modelProblem(false, 4, 32));
}

TEST(SceneFilesTest, GapIsTheCoerciveProblemWithAnInitialGap) {
  Scene expected = scene::modelProblem(true, 4, 32);
  expected.title = "Coercive membranes with an initial gap";
  expected.contacts[0].gap = 0.1;
  expectSame(sceneOf("gap.xml"), expected);
}

TEST(SceneFilesTest, MetisCutsEachBodyIntoSevenParts) {
  for (const Body& body : sceneOf("metis.xml").bodies) {
    EXPECT_EQ(body.decomposition.method, scene::Decomposition::Method::metis);
    EXPECT_EQ(body.decomposition.parts, 7);
  }
}

TEST(SceneFilesTest, TheMiddleOneOfThreeBodiesFloatsBetweenTwoContacts) {
  const Scene scene = sceneOf("three_bodies.xml");
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.bodies[1].name, "middle");
  EXPECT_TRUE(scene.bodies[1].supports.empty());
  ASSERT_EQ(scene.contacts.size(), 2u);
  EXPECT_EQ(scene.contacts[0].second, 1);
  EXPECT_EQ(scene.contacts[1].first, 1);
}

TEST(SceneFilesTest, SingleMembranesHaveNoContact) {
  EXPECT_TRUE(sceneOf("no_contact.xml").contacts.empty());
  EXPECT_TRUE(sceneOf("single_subdomain.xml").contacts.empty());
  EXPECT_EQ(sceneOf("single_subdomain.xml").bodies.at(0).decomposition.counts, (std::array<int, 3>{1, 1, 1}));
}

TEST(SceneFilesTest, RegionsReplaceTheConductivityInBoxes) {
  const Scene scene = sceneOf("regions.xml");
  ASSERT_EQ(scene.bodies[0].regions.size(), 1u);
  EXPECT_EQ(scene.bodies[0].regions[0].material.conductivity, 1e3);
  EXPECT_EQ(scene.bodies[1].regions.at(0).material.conductivity, 1e-2);
}

TEST(SceneFilesTest, ChannelsRunThroughBothBlocksAtTheSameHeights) {
  const Scene scene = sceneOf("channels.xml");
  const auto &left = scene.bodies.at(0).regions, &right = scene.bodies.at(1).regions;
  ASSERT_EQ(left.size(), 6u);
  ASSERT_EQ(right.size(), 6u);
  for (std::size_t k = 0; k < left.size(); ++k) {
    EXPECT_EQ(left[k].material.youngsModulus, 210000);
    EXPECT_EQ(left[k].box.upper[0], right[k].box.lower[0]) << "no matrix between the ends";
    EXPECT_EQ(left[k].box.lower[1], right[k].box.lower[1]);
    EXPECT_EQ(left[k].box.upper[1], right[k].box.upper[1]);
  }
}

} // namespace
