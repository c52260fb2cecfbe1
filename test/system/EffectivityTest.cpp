// The estimate of order 2 beside errors that are known from two more meshes: clamped edges, where stresses
// are infinite, and the edge of a punch.

#include "support/SolidScenes.hpp"

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/accuracy/Refinement.hpp"

#include <cmath>
#include <memory>
#include <vector>

namespace epafi {
namespace {

using namespace test;

fem::SolidSupport clamp(const std::string& surface) {
  return {"clamp " + surface, surface, {0.0, 0.0, 0.0}};
}

scene::Scene clampedBlock(bool isSpace) {
  scene::Scene scene;
  scene.bodies = {isSpace ? block("block", {{0, 0, 0}, {1, 1, 1}}, {4, 4, 4}, cutInGrid({2, 2, 1}))
                          : block("block", {{0, 0, 0}, {1, 1, 0}}, {8, 8, 0}, cutInGrid({2, 2, 1}))};
  scene::Body& body = scene.bodies[0];
  body.mesh.order = 2;
  body.supports = {clamp("bottom")};
  if (!isSpace)
    body.supports[0].value[2].reset();
  body.loads = {loadOn("top", isSpace ? Vector3{0.2, 0, 1} : Vector3{0.2, 1, 0})};
  return scene;
}

scene::Scene punchOnBlock() {
  scene::Scene scene;
  scene.bodies = {block("block", {{0, -4, 0}, {4, 0, 0}}, {16, 16, 0}, cutInGrid({2, 2, 1})),
                  block("punch", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, cutInGrid({1, 1, 1}))};
  for (scene::Body& body : scene.bodies) {
    body.mesh.order = 2;
    body.supports = {slide("left")};
  }
  scene.bodies[0].supports.push_back(slide("bottom"));
  scene.bodies[1].loads = {loadOn("top", {1, 0, 0}, fem::SolidLoad::Kind::pressure)};
  scene.contacts = {between("joint", 0, "top", 1, "bottom")};
  return scene;
}

/// η beside the error on the scene's mesh; errors of three meshes, each halved, form a geometric series.
double effectivityOf(scene::Scene scene) {
  std::vector<std::unique_ptr<SolidRun>> runs;
  std::vector<scene::Scene> scenes;
  for (int level = 0; level < 3; ++level) {
    runs.push_back(std::make_unique<SolidRun>(scene, 1e-9));
    scenes.push_back(scene);
    scene = accuracy::refined(std::move(scene));
  }
  std::vector<double> distances; // squared, of the first mesh
  for (const std::size_t level : {1, 2})
    distances.push_back(std::pow(
        accuracy::errorAgainst(scenes[level], runs[level]->decomposition, runs[level]->solution.displacement,
                               runs[0]->decomposition, runs[0]->solution.displacement)
            .energy,
        2));
  const double decay = distances[1] / distances[0] - 1, error = std::sqrt(distances[0] / (1 - decay));
  EXPECT_GT(decay, 0.1); // of a smooth solution 1/16
  EXPECT_LT(decay, 0.6);
  return accuracy::ErrorEstimator(scenes[0], runs[0]->decomposition)(runs[0]->solution.displacement)
             .discretisation /
         error;
}

TEST(EffectivityTest, OfOrderTwoIsNearOneWhereStressesAreInfinite) {
  for (const scene::Scene& scene : {clampedBlock(false), clampedBlock(true), punchOnBlock()}) {
    const double effectivity = effectivityOf(scene);
    EXPECT_GT(effectivity, 0.9) << scene.bodies[0].mesh.elements[2] << ' ' << scene.bodies.size();
    EXPECT_LT(effectivity, 1.3) << scene.bodies[0].mesh.elements[2] << ' ' << scene.bodies.size();
  }
}

} // namespace
} // namespace epafi
