#include "UndecomposedSolution.hpp"
#include "support/Refusal.hpp"
#include "support/WholeRun.hpp"

#include "epafi/base/Errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace epafi;

/// Unit membranes in a row, the first one held at its left edge, each resting on the one before.
scene::Scene chain(const std::vector<double>& loads, int elements) {
  scene::Scene scene;
  for (std::size_t b = 0; b < loads.size(); ++b) {
    const auto x = static_cast<double>(b);
    scene::Body body;
    body.name = std::string("b").append(std::to_string(b));
    body.mesh.box = mesh::rectangle(x, x + 1, 0, 1);
    body.mesh.elements = {elements, elements, 0};
    body.loads = {fem::loadInside("all", body.mesh.box, loads[b])};
    if (b == 0)
      body.supports = {{"wall", "left", {0.0}}};
    else
      scene.contacts.push_back({std::string("c").append(std::to_string(b)), static_cast<int>(b) - 1, "right",
                                static_cast<int>(b), "left"});
    scene.bodies.push_back(body);
  }
  return scene;
}

void expectSolved(const scene::Scene& scene, const std::string& what) {
  const drivers::UndecomposedSolution expected =
      drivers::solveUndecomposed(drivers::undecomposedSystem(scene));
  const simulation::SceneRun run = test::solve(scene, 1e-10);
  EXPECT_EQ(run.solver->report().status, qp::Status::converged) << what << run.solver->report().reason;
  EXPECT_NEAR(run.solution.energy, expected.energy, 1e-8 * std::abs(expected.energy)) << what;
}

TEST(FloatingChainTest, EveryChainPressedDownHasItsSolutionHoweverItIsCut) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-2.0, 1.0);
  std::uniform_int_distribution<int> bodies(2, 7);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<double> loads(bodies(random));
    for (double& load : loads)
      load = -std::pow(10.0, exponent(random));
    const scene::Scene scene = chain(loads, 3);
    for (const scene::Scene& cut :
         {test::cutInGrid(scene, 1), test::cutInGrid(scene, 3), test::cutByMetis(scene, 4)})
      EXPECT_NO_THROW(expectSolved(cut, "chain " + std::to_string(repeat) + ": ")) << "chain " << repeat;
  }
}

TEST(FloatingChainTest, HeavyBodiesDoNotHideALightOne) {
  EXPECT_NO_THROW(expectSolved(chain({-1, -1e9, -1}, 4), "light on heavy: "));
  EXPECT_NO_THROW(expectSolved(chain({-1, -1, -1e9}, 4), "heavy on light: "));
}

TEST(FloatingChainTest, ALightBodyThatIsPulledUpIsFoundBesideHeavyOnes) {
  test::expectSays(test::unsolvable(SolvabilityError::Kind::noSolution,
                                    [] {
                                      test::solve(chain({-1, -1e6, 1e-3}, 4), 1e-6);
                                    }),
                   {"'b2'"});
}

TEST(FloatingChainTest, StiffFloatingBodiesKeepTheDigitsOfTheEnergy) {
  scene::Scene scene = chain({-1, -2}, 6);
  scene.bodies[1].material.conductivity = 1e8;
  const double whole = test::solve(test::cutInGrid(scene, 1), 1e-10).solution.energy;

  for (const scene::Scene& cut : {test::cutInGrid(scene, 3), test::cutByMetis(scene, 5)})
    EXPECT_NEAR(test::solve(cut, 1e-10).solution.energy, whole, 1e-9 * std::abs(whole));
}

TEST(FloatingChainTest, FlatElementsEndWithAnHonestStatus) {
  scene::Scene scene = chain({-1, -2}, 6);
  for (scene::Body& body : scene.bodies)
    body.mesh.box.upper[1] = 1e6;
  for (scene::Body& body : scene.bodies)
    body.loads[0].box = body.mesh.box;

  const simulation::SceneRun run = test::solve(test::cutInGrid(scene, 2), 1e-10);

  if (run.solver->report().status == qp::Status::converged) {
    EXPECT_LE(run.solution.relativeProjectedGradient, 2e-10);
  } else {
    EXPECT_TRUE(run.solution.relativeProjectedGradient > 1e-10 || run.solution.feasibility > 1e-7);
  }
}

} // namespace
