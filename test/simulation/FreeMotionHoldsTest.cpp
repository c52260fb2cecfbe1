// Bodies that are free to move, and held where they would, beside the same with supports that take nothing.

#include "support/SolidScenes.hpp"

#include "epafi/simulation/StepRun.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace epafi::simulation {
namespace {

SceneRun solvedHolding(const scene::Scene& scene) {
  const auto exactly = Teuchos::ParameterList().set("Tolerance", 1e-11).set("Equilibrium Tolerance", 1e-11);
  return solveScene(scene, exactly, Tpetra::getDefaultComm());
}

/// Blocks of an edge of 1, one on the other, on a floor; what is across (ν = 0) does not move.
scene::Scene stack(int dimension, int number, const Vector3& force) {
  scene::Scene scene;
  for (int k = 0; k < number; ++k) {
    const double low = k, high = k + 1;
    const mesh::Box box =
        dimension == 3 ? mesh::Box{{0, 0, low}, {1, 1, high}} : mesh::Box{{0, low, 0}, {1, high, 0}};
    scene.bodies.push_back(test::block("block " + std::to_string(k), box, {2, 2, dimension == 3 ? 2 : 0},
                                       test::cutByMetis(k + 1)));
    scene.bodies.back().material.poissonsRatio = 0;
    scene.bodies.back().loads = {test::weight(force)};
  }
  const std::string top = "top", bottom = "bottom";
  const Vector3 up = dimension == 3 ? Vector3{0, 0, 1} : Vector3{0, 1, 0};
  scene.contacts = {test::onPlane("floor", 0, bottom, {0, 0, 0}, up)};
  for (int k = 1; k < number; ++k)
    scene.contacts.push_back(test::between("joint " + std::to_string(k), k, bottom, k - 1, top));
  return scene;
}

Vector3 downwards(int dimension, double aside = 0) {
  return dimension == 3 ? Vector3{aside, 0, -1} : Vector3{aside, -1, 0};
}

TEST(FreeMotionHoldsTest, WithBalancedLoadsTheyTakeNothing) {
  for (const int dimension : {2, 3})
    for (const int number : {1, 2}) {
      SCOPED_TRACE(std::to_string(dimension) + "-D, " + std::to_string(number));
      scene::Scene scene = stack(dimension, number, downwards(dimension));
      EXPECT_THROW(solvedHolding(scene), SolvabilityError);
      scene.holdsFreeMotions = true;
      const SceneRun held = solvedHolding(scene);
      scene.holdsFreeMotions = false;
      for (scene::Body& body : scene.bodies) {
        body.supports.push_back(test::slide("left"));
        if (dimension == 3)
          body.supports.push_back(test::slide("front"));
      }
      const SceneRun supported = solvedHolding(scene);

      EXPECT_EQ(held.result.status, RunStatus::converged) << held.result.reason;
      EXPECT_EQ(held.result.holds.size(), static_cast<std::size_t>(number * (dimension == 3 ? 3 : 1)));
      for (const HoldResult& hold : held.result.holds)
        EXPECT_LE(std::hypot(hold.force[0], hold.force[1], hold.force[2]), 1e-8) << hold.motion;
      EXPECT_NEAR(held.result.energy, supported.result.energy, 1e-9 * std::abs(supported.result.energy));
      EXPECT_EQ(held.result.doubts.find("takes a force"), std::string::npos) << held.result.doubts;
    }
}

TEST(FreeMotionHoldsTest, WhatLoadsPushIsHeldAndTold) {
  for (const int dimension : {2, 3}) {
    scene::Scene scene = stack(dimension, 1, downwards(dimension, 0.2));
    EXPECT_THROW(solvedHolding(scene), SolvabilityError);
    scene.holdsFreeMotions = true;
    const SceneRun held = solvedHolding(scene);

    Vector3 sum{};
    double moment = 0; // about the vertical axis, that of the centre
    for (const HoldResult& hold : held.result.holds) {
      for (std::size_t d = 0; d < 3; ++d)
        sum[d] += hold.force[d];
      moment += (hold.place[0] - 0.5) * hold.force[1] - (hold.place[1] - 0.5) * hold.force[0];
    }
    EXPECT_NEAR(sum[0], -0.2, 1e-9);
    EXPECT_NEAR(sum[1], 0, 1e-9);
    EXPECT_NEAR(sum[2], 0, 1e-9);
    EXPECT_NEAR(dimension == 3 ? moment : 0, 0, 1e-9);
    EXPECT_NEAR(held.result.contactForce, 1, 1e-9);
    EXPECT_NE(held.result.doubts.find("takes a force"), std::string::npos) << held.result.doubts;
  }
}

TEST(FreeMotionHoldsTest, WithoutContactTheyTakeNothingEither) {
  for (const int dimension : {2, 3}) {
    scene::Scene scene = stack(dimension, 1, {0, 0, 0});
    scene.contacts.clear();
    scene.bodies[0].material.poissonsRatio = 0.3;
    scene.bodies[0].loads.clear();
    scene.bodies[0].supports = {test::slide("bottom"), test::slide("top", -0.1)};
    scene.holdsFreeMotions = true;
    const SceneRun held = solvedHolding(scene);
    EXPECT_EQ(held.result.holds.size(), dimension == 3 ? 3U : 1U);
    EXPECT_GT(held.result.energy, 0);
    EXPECT_EQ(held.result.doubts.find("takes a force"), std::string::npos) << held.result.doubts;
  }
}

/// In the second step the floor has an edge, against which the block is pushed: it is not held along that.
TEST(FreeMotionHoldsTest, WhereRowsChangeTheyAreLookedForAnew) {
  scene::Scene scene = stack(3, 1, downwards(3, 0.2));
  scene.contacts.push_back(test::onPlane("edge", 0, "right", {1, 0, 0}, {-1, 0, 0}));
  scene.holdsFreeMotions = true;
  std::vector<scene::Step> steps(2);
  steps[0].name = "free";
  steps[0].isOn[1] = false;
  steps[1].name = "edge";
  steps[1].isOn[1] = true;
  const SceneRun run = solveSteps(scene, steps, {}, Tpetra::getDefaultComm(), {}, {});
  EXPECT_EQ(run.result.status, RunStatus::converged) << run.result.reason;
  EXPECT_EQ(run.result.holds.size(), 1U); // along y: two faces hinder its turning
  EXPECT_NEAR(run.result.steps[1].contacts[1].force, 0.2, 1e-6);
}

TEST(FreeMotionHoldsTest, TheyStayThroughLoadSteps) {
  scene::Scene scene = stack(3, 2, downwards(3));
  scene.holdsFreeMotions = true;
  std::vector<scene::Step> steps(2);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    steps[k].name = std::string(1, static_cast<char>('a' + k));
    steps[k].loads[{1, 0}] = 1 + static_cast<double>(k);
  }
  const SceneRun run = solveSteps(scene, steps, {}, Tpetra::getDefaultComm(), {}, {});
  EXPECT_EQ(run.result.status, RunStatus::converged) << run.result.reason;
  EXPECT_EQ(run.result.holds.size(), 6U);
  EXPECT_NEAR(run.result.steps[0].contacts[0].force, 2, 1e-6);
  EXPECT_NEAR(run.result.steps[1].contacts[0].force, 3, 1e-6);
}

/// What pushes in one step has none of its doubts taken away by a later one without it.
TEST(FreeMotionHoldsTest, WhatIsHeldInAStepBeforeTheLastIsTold) {
  for (const int dimension : {2, 3}) {
    scene::Scene scene = stack(dimension, 1, downwards(dimension));
    scene.bodies[0].loads.push_back(test::weight({0.2, 0, 0}));
    scene.holdsFreeMotions = true;
    std::vector<scene::Step> steps(3);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      steps[k].name = std::string(1, static_cast<char>('a' + k));
      steps[k].loads[{0, 1}] = k == 1 ? 1 : 0;
    }
    const RunResult result = solveSteps(scene, steps, {}, Tpetra::getDefaultComm(), {}, {}).result;
    EXPECT_EQ(result.status, RunStatus::converged) << result.reason;
    for (std::size_t k = 0; k < steps.size(); ++k) {
      double sum = 0;
      for (const HoldResult& hold : result.steps[k].holds)
        sum += hold.force[0];
      EXPECT_NEAR(sum, k == 1 ? -0.2 : 0, 1e-9);
      EXPECT_EQ(result.steps[k].doubts.find("takes a force") != std::string::npos, k == 1);
    }
    EXPECT_NE(result.doubts.find("takes a force"), std::string::npos) << result.doubts;
    EXPECT_NE(result.doubts.find("(in step \"b\")"), std::string::npos) << result.doubts;
    EXPECT_TRUE(reportOf(result).sublist("Steps").sublist("b").isSublist("Holds"));
  }
}

TEST(FreeMotionHoldsTest, WhatIsPulledAwayOrTipsIsRefusedAsBefore) {
  for (const Vector3& force : {Vector3{1.5, 0, -1}, Vector3{0, 0, 1}}) {
    scene::Scene scene = stack(3, 1, force);
    scene.holdsFreeMotions = true;
    EXPECT_THROW(solvedHolding(scene), SolvabilityError);
  }
}

} // namespace
} // namespace epafi::simulation
