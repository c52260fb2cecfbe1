// A contact's Distance: too small a one is found out, and what the reason asks for is enough.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/simulation/AccurateRun.hpp"
#include "epafi/simulation/SceneRun.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace epafi::simulation {
namespace {

RunResult solved(scene::Scene scene, double distance, double gap) {
  scene.contacts[0].distance = distance;
  scene.contacts[0].gap = gap;
  return solveScene(scene, Teuchos::ParameterList().set("Tolerance", 1e-11), Tpetra::getDefaultComm()).result;
}

/// The distance that a reason asks for, and a little more, as it is rounded.
double askedFor(const std::string& reason) {
  const std::string before = "up to ";
  const std::size_t at = reason.find(before);
  EXPECT_NE(at, std::string::npos) << reason;
  return 1.01 * std::stod(reason.substr(at + before.size()));
}

/// Too small a distance is told until it is enlarged to what is asked for, and then the answer is that
/// without any.
void expectFound(const scene::Scene& scene, double distance, double gap = 0) {
  const RunResult whole = solved(scene, std::numeric_limits<double>::infinity(), gap);
  ASSERT_EQ(whole.status, RunStatus::converged) << whole.reason;
  RunResult result = solved(scene, distance, gap);
  EXPECT_EQ(result.status, RunStatus::missedContact);
  EXPECT_NE(result.reason.find("contact 'touch'"), std::string::npos) << result.reason;
  EXPECT_GT(std::abs(result.energy - whole.energy), 1e-6 * std::abs(whole.energy));
  for (int times = 0; result.status == RunStatus::missedContact && times < 5; ++times)
    result = solved(scene, askedFor(result.reason), gap);
  EXPECT_EQ(result.status, RunStatus::converged) << result.reason;
  EXPECT_NEAR(result.energy, whole.energy, 1e-9 * std::abs(whole.energy));
}

TEST(LeftOutNodesTest, OfABlockPressedOntoAnObstacle) {
  for (const int dimension : {2, 3})
    for (const int order : {1, 2}) {
      SCOPED_TRACE(std::to_string(dimension) + "-D, order " + std::to_string(order));
      const bool isPlane = dimension == 2;
      scene::Scene scene;
      scene.bodies = {test::block("block", {{0, 0, 0}, {1, 1, isPlane ? 0.0 : 1.0}},
                                  {isPlane ? 16 : 6, isPlane ? 4 : 3, isPlane ? 0 : 6}, test::cutByMetis(2))};
      scene.bodies[0].mesh.order = order;
      scene.bodies[0].supports = {test::slide("left")};
      if (!isPlane)
        scene.bodies[0].supports.push_back(test::slide("front"));
      scene.bodies[0].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {0.5, 0, 0}}};
      const Vector3 centre = isPlane ? Vector3{0, -20, 0} : Vector3{0, 0, -20};
      scene.contacts = {test::onPlane("touch", 0, "bottom", centre, {0, 1, 0})};
      scene.contacts[0].obstacle.kind = scene::Obstacle::Kind::sphere;
      scene.contacts[0].obstacle.radius = 20;
      expectFound(scene, 1e-4);
      expectFound(scene, 1e-4, 1e-3); // a gap that is not of geometry does not count
    }
}

TEST(LeftOutNodesTest, OfARunToATarget) {
  scene::Scene scene;
  scene.bodies = {test::block("block", {{0, 0, 0}, {1, 1, 0}}, {8, 4, 0}, test::cutByMetis(2))};
  scene.bodies[0].supports = {test::slide("left")};
  scene.bodies[0].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {0.5, 0, 0}}};
  scene.contacts = {test::onPlane("touch", 0, "bottom", {0, -20, 0}, {0, 1, 0})};
  scene.contacts[0].obstacle.kind = scene::Obstacle::Kind::sphere;
  scene.contacts[0].obstacle.radius = 20;
  for (const double distance : {1e-3, std::numeric_limits<double>::infinity()})
    for (const int meshes : {1, 6}) { // the target is missed, and met
      scene.contacts[0].distance = distance;
      AccuracyParameters accuracy;
      accuracy.target = 0.1;
      accuracy.maxLevels = meshes;
      accuracy.refinement = AccuracyParameters::Refinement::even;
      const RunResult result =
          solveToTarget(scene, {}, accuracy, Tpetra::getDefaultComm(), nullptr, {}).run.result;
      EXPECT_EQ(result.status, std::isfinite(distance) ? RunStatus::missedContact
                               : meshes == 1           ? RunStatus::targetMissed
                                                       : RunStatus::converged)
          << result.reason;
    }
}

/// Its bodies are two blocks, the upper one turned by a small angle about the edge on which it stands.
class LeftOutBetween : public testing::TestWithParam<bool> {
protected:
  [[nodiscard]] scene::Scene scene(int dimension) const {
    const bool isPlane = dimension == 2;
    const std::array<int, 3> elements = isPlane ? std::array{8, 4, 0} : std::array{8, 2, 4};
    const auto between = [&](double low, double high) {
      return isPlane ? mesh::rectangle(0, 1, low, high) : mesh::Box{{0, 0, low}, {1, 0.5, high}};
    };
    scene::Scene scene;
    scene.bodies = {test::block("lower", between(-1, 0), elements, test::cutByMetis(2)),
                    test::block("upper", between(0, 1), elements, test::cutByMetis(2))};
    scene.bodies[0].supports = {{"hold", "bottom", {0.0, 0.0, 0.0}}};
    scene::Body& upper = scene.bodies[1];
    const test::Placement turned{
        Eigen::AngleAxisd(isPlane ? 2e-3 : -2e-3, Eigen::Vector3d::Unit(isPlane ? 2 : 1)).toRotationMatrix()};
    const mesh::StructuredMesh grid(upper.mesh.box, elements);
    upper.mesh = {};
    upper.mesh.file = folder_.write("upper.msh", test::fileOf(test::arraysOf(grid, turned, false)));
    upper.mesh.order = 0;
    upper.mesh.group = "body";
    upper.supports = {test::slide("left")};
    if (!isPlane)
      upper.supports.push_back(test::slide("front"));
    upper.loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {0.3, 0, 0}}};
    scene.contacts = {test::between("touch", 0, "top", 1, "bottom")};
    if (GetParam())
      scene.contacts[0].coupling = scene::SurfaceContact::Coupling::mortar;
    return scene;
  }

private:
  test::MeshFolder folder_;
};

TEST_P(LeftOutBetween, Bodies) {
  for (const int dimension : {2, 3}) {
    SCOPED_TRACE(dimension);
    expectFound(scene(dimension), 5e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(LeftOutNodesTest, LeftOutBetween, testing::Bool(),
                         [](const auto& of) { return std::string(of.param ? "ByMortars" : "ByPairs"); });

TEST(LeftOutNodesTest, OfAMembraneOnACylinder) {
  scene::Scene scene;
  scene::Body& body = scene.bodies.emplace_back();
  body.name = "strip";
  body.mesh.box = mesh::rectangle(0, 1, 0, 0.25);
  body.mesh.elements = {32, 2, 0};
  body.supports = {{"left", "left", {0.0}}, {"right", "right", {0.0}}};
  body.loads = {fem::loadInside("weight", body.mesh.box, -4)};
  body.decomposition = test::cutInGrid({2, 1, 1});
  scene::SurfaceContact& contact = scene.contacts.emplace_back();
  contact.name = "touch";
  contact.obstacle = {scene::Obstacle::Kind::cylinder, {0.5, 0, -2}, {0, 1, 0}, 1.9};
  expectFound(scene, 0.101);
}

} // namespace
} // namespace epafi::simulation
