#include "UndecomposedSolution.hpp"
#include "support/WholeRun.hpp"

#include "epafi/scene/ParameterFile.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace {

using namespace epafi;

std::vector<std::string> sceneFiles() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(EPAFI_SOURCE_DIR "/xml"))
    if (file.path().extension() == ".xml")
      names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The scene on meshes that a solver without decomposition is quick on, without friction and bolts that are
/// tightened, which that one does not know (test_friction.py and PreloadTest.cpp have closed forms).
scene::Scene coarsened(scene::Scene scene) {
  for (scene::Body& body : scene.bodies) {
    meshing::MeshSource& mesh = body.mesh;
    if (!mesh.file.empty()) {
      mesh.sizeFactor = componentsOf(body.physics) == 3 ? 8 : 4;
      if (componentsOf(body.physics) == 3)
        mesh.order = 1; // what costs here is the undecomposed reference
      body.decomposition.parts = std::min(body.decomposition.parts, 4);
    } else if (mesh.elements[2] > 0) {
      for (int& count : mesh.elements)
        count = 4;
    }
  }
  for (scene::SurfaceContact& contact : scene.contacts) {
    contact.friction = contact.frictionBound = 0;
    contact.preload.reset();
  }
  return scene;
}

/// Every scene in xml/, against a solver that knows nothing of FETI-DP.
class SceneFilesTest : public testing::TestWithParam<std::string> {};

TEST_P(SceneFilesTest, AgreesWithTheUndecomposedSolution) {
  const std::string file = EPAFI_SOURCE_DIR "/xml/" + GetParam() + ".xml";
  const scene::Scene scene =
      coarsened(scene::readScene(scene::readParameterFile(file, *Tpetra::getDefaultComm()), file));
  const drivers::UndecomposedSolution expected =
      drivers::solveUndecomposed(drivers::undecomposedSystem(scene));

  const simulation::SceneRun run = test::solve(scene, 1e-10);

  EXPECT_EQ(run.solver->report().status, qp::Status::converged);
  EXPECT_NEAR(run.solution.energy, expected.energy, 1e-8 * std::abs(expected.energy));
  EXPECT_NEAR(run.solution.contactForce, expected.contactForce, 1e-8 * (1 + std::abs(expected.contactForce)));
  EXPECT_EQ(run.solution.activeContactNodes, expected.activeContactNodes);
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    const Eigen::VectorXd& u = expected.deflection[body];
    EXPECT_LE((test::deflection(run, static_cast<int>(body)) - u).lpNorm<Eigen::Infinity>(),
              1e-7 * u.lpNorm<Eigen::Infinity>())
        << scene.bodies[body].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Xml, SceneFilesTest, testing::ValuesIn(sceneFiles()),
                         [](const auto& file) { return file.param; });

} // namespace
