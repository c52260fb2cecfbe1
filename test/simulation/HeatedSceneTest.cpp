// Scenes that temperatures strain, beside closed forms: cut into subdomains, on any number of ranks.

#include "epafi/accuracy/ErrorEstimate.hpp"
#include "epafi/simulation/Evaluation.hpp"

#include "support/SolidScenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace epafi::simulation {
namespace {

constexpr double modulus = 200, ratio = 0.3, expansion = 1e-4, degrees = 30, free = expansion * degrees;

fem::SolidLoad heated(const std::string& where, double change) {
  return {"heat " + where, fem::SolidLoad::Kind::temperature, {}, where, {}, {change, 0, 0}};
}

/// A bar of 4 × 1 × 1 that expands, on planes of symmetry, warmer by some degrees.
scene::Scene heatedBar(int order) {
  scene::Scene scene;
  scene.bodies = {test::block("bar", {{0, 0, 0}, {4, 1, 1}}, {6, 2, 2}, test::cutInGrid({3, 1, 2}))};
  scene.bodies[0].mesh.order = order;
  scene.bodies[0].material.expansion = expansion;
  scene.bodies[0].supports = {test::slide("left"), test::slide("front"), test::slide("bottom")};
  scene.bodies[0].loads = {heated("", degrees)};
  return scene;
}

/// Stress along x at all nodes, if there is no other.
void expectStress(const scene::Scene& scene, const test::SolidRun& run, double expected) {
  for (const fem::SymmetricTensor& stress : stressesAtNodes({scene, run.decomposition, run.solution}, 0)) {
    EXPECT_NEAR(stress[0], expected, 1e-9);
    for (std::size_t k = 1; k < stress.size(); ++k)
      EXPECT_NEAR(stress[k], 0, 1e-9);
  }
}

TEST(HeatedSceneTest, ABarBetweenWallsHasTheStressOfItsHinderedExpansion) {
  for (const int order : {1, 2}) {
    scene::Scene scene = heatedBar(order);
    scene.bodies[0].supports.push_back(test::slide("right"));
    const test::SolidRun run(scene, 1e-12);
    expectStress(scene, run, -modulus * free);
    accuracy::ErrorEstimator estimator(scene, run.decomposition);
    const accuracy::ErrorEstimate estimate = estimator(run.solution.displacement);
    EXPECT_NEAR(estimate.energyNorm, std::sqrt(4 * modulus) * free, 1e-10);
    EXPECT_LT(estimate.relative(), 1e-9);
    // The strain (1 + ν)αΔT in y and z alone, ε:C:ε = 2E(1 + ν)²α²ΔT²/((1 + ν)(1 − 2ν)).
    EXPECT_NEAR(estimator.normOf(run.solution.displacement),
                std::sqrt(4 * modulus * 2 * (1 + ratio) / (1 - 2 * ratio)) * free, 1e-9);
  }
}

TEST(HeatedSceneTest, ABarThatMayExpandHasNoStress) {
  const scene::Scene scene = heatedBar(1);
  const test::SolidRun run(scene, 1e-12);
  expectStress(scene, run, 0);
  EXPECT_LT(accuracy::ErrorEstimator(scene, run.decomposition)(run.solution.displacement).relative(), 1e-9);
  const Eigen::VectorXd u = run.displacement(0);
  EXPECT_NEAR(u.maxCoeff(), 4 * free, 1e-11);
  EXPECT_NEAR(u.minCoeff(), 0, 1e-11);
}

/// Held at its sides it has −EαΔT(z)/(1 − ν) along both, and expands upwards by a quadratic function of z.
TEST(HeatedSceneTest, ABarThatIsWarmerAboveThanBelowHasTheStressOfEachHeight) {
  scene::Scene scene = heatedBar(2);
  scene::Body& bar = scene.bodies[0];
  bar.mesh.elements = {4, 2, 1}; // nodes at z = 0, ½ and 1
  bar.decomposition = test::cutInGrid({2, 2, 1});
  bar.loads = {heated("", degrees / 2), heated("top", degrees / 2), heated("bottom", -degrees / 2)};
  bar.supports.push_back(test::slide("right"));
  bar.supports.push_back(test::slide("back"));
  const test::SolidRun run(scene, 1e-12);
  const double most = modulus * free / (1 - ratio);
  for (const fem::SymmetricTensor& stress : stressesAtNodes({scene, run.decomposition, run.solution}, 0)) {
    EXPECT_LT(std::min({std::abs(stress[0]), std::abs(stress[0] + most / 2), std::abs(stress[0] + most)}),
              1e-9);
    EXPECT_NEAR(stress[1], stress[0], 1e-9);
    EXPECT_NEAR(stress[2], 0, 1e-9);
  }
  const accuracy::ErrorEstimate estimate =
      accuracy::ErrorEstimator(scene, run.decomposition)(run.solution.displacement);
  EXPECT_NEAR(estimate.energyNorm, std::sqrt(8.0 / 3 * modulus / (1 - ratio)) * free, 1e-10);
  EXPECT_LT(estimate.relative(), 1e-9);
  EXPECT_NEAR(run.displacement(0).maxCoeff(), (1 + ratio) / (1 - ratio) * free / 2, 1e-11);
}

/// The gap closes by part of the expansion; what is left of it presses.
TEST(HeatedSceneTest, ABarThatExpandsAgainstAWallPressesOnIt) {
  scene::Scene scene = heatedBar(2);
  const double gap = 0.25 * 4 * free;
  scene.contacts = {test::onPlane("wall", 0, "right", {4 + gap, 0, 0}, {-1, 0, 0})};
  const test::SolidRun run(scene, 1e-12);
  expectStress(scene, run, -modulus * 0.75 * free);
  double force = 0;
  for (const double each : run.forces())
    force += each;
  EXPECT_NEAR(force, modulus * 0.75 * free, 1e-9);
}

/// Two layers in a box, ν = 0: the upper one, which alone expands, presses on the sides by EαΔT, and both on
/// top and bottom by half of that.
TEST(HeatedSceneTest, LayersExpandByTheirOwnCoefficients) {
  scene::Scene scene = heatedBar(1);
  scene::Body& bar = scene.bodies[0];
  bar.material.poissonsRatio = 0;
  fem::Material cold = bar.material;
  cold.expansion = 0;
  bar.regions = {{"cold", {{0, 0, 0}, {4, 1, 0.5}}, "", cold}};
  for (const char* const side : {"right", "back", "top"})
    bar.supports.push_back(test::slide(side));
  const test::SolidRun run(scene, 1e-12);
  const accuracy::ErrorEstimate estimate =
      accuracy::ErrorEstimator(scene, run.decomposition)(run.solution.displacement);
  EXPECT_NEAR(estimate.energyNorm, std::sqrt(modulus * (2 * (1 + 1 + 0.25) + 2 * 0.25)) * free, 1e-10);
  EXPECT_LT(estimate.relative(), 1e-9);
}

} // namespace
} // namespace epafi::simulation
