// Friction in scenes, beside values of an independent solver on the same meshes (whole bodies by one factor,
// exact Newton on dense matrices).

#include "support/Refusal.hpp"
#include "support/SolidScenes.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/simulation/ContactState.hpp"
#include "epafi/simulation/FrictionResults.hpp"
#include "epafi/simulation/StepRun.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace epafi::simulation {
namespace {

constexpr double tolerance = 1e-10;

SceneRun solved(const scene::Scene& scene) {
  const Teuchos::ParameterList parameters =
      Teuchos::ParameterList().set("Tolerance", tolerance).set("Equilibrium Tolerance", tolerance);
  return solveScene(scene, parameters, Tpetra::getDefaultComm());
}

const FrictionResult& frictionOf(const RunResult& result) {
  return *result.contacts.front().friction;
}

scene::Body softBlock(const std::string& name, const mesh::Box& box, std::array<int, 3> elements,
                      double stiffness, const scene::Decomposition& cut) {
  scene::Body body = test::block(name, box, elements, cut);
  body.material.youngsModulus = stiffness;
  body.material.poissonsRatio = 0.3;
  return body;
}

/// A square of order 1 on a floor, its top pushed by (0.004, −0.01), μ = 0.3.
scene::Scene heldBlock(int n, const scene::Decomposition& cut) {
  scene::Scene scene;
  scene.bodies.push_back(softBlock("block", {{0, 0, 0}, {1, 1, 0}}, {n, n, 0}, 1, cut));
  scene.bodies[0].mesh.order = 1;
  scene.bodies[0].supports.push_back({"push", "top", {0.004, -0.01}});
  scene.contacts.push_back(test::onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}));
  scene.contacts[0].friction = 0.3;
  return scene;
}

TEST(FrictionSceneTest, AHeldBlockPressesAndRubsAsMuchAsAnIndependentSolverSays) {
  struct Reference {
    int n;
    double pressure, friction;
  };
  for (const Reference& reference :
       {Reference{16, 0.0115772843, 0.0010521957}, {32, 0.0115658895, 0.00104759259}})
    for (const scene::Decomposition& cut : {test::cutInGrid({2, 2, 1}), test::cutByMetis(5)}) {
      const SceneRun run = solved(heldBlock(reference.n, cut));
      ASSERT_EQ(run.result.status, RunStatus::converged) << run.result.reason;
      EXPECT_NEAR(run.result.contacts[0].force, reference.pressure, 1e-7 * reference.pressure);
      EXPECT_NEAR(frictionOf(run.result).tangentialForce[0], reference.friction, 1e-7 * reference.friction);
      EXPECT_NEAR(frictionOf(run.result).stickArea + frictionOf(run.result).slipArea, 1, 1e-12);
      EXPECT_GT(frictionOf(run.result).dissipation, 0);
    }
}

/// What the floor takes from the block is what the block's support gives it.
TEST(FrictionSceneTest, MomentsAboutOriginAndCentreAreThoseOfTheSupport) {
  scene::Scene scene = heldBlock(8, test::cutInGrid({2, 2, 1}));
  scene.bodies[0].mesh.box = {{2, 0, 0}, {3, 1, 0}};
  const SceneRun run = solved(scene);
  const FrictionResult& friction = frictionOf(run.result);
  const SupportResult& support = run.result.supports[0];
  EXPECT_NEAR(friction.centre[0], 2.5, 1e-12);
  EXPECT_NEAR(friction.centre[1], 0, 1e-12);
  EXPECT_NEAR(friction.stickArea + friction.slipArea + friction.openArea, 1, 1e-12);
  const double size = std::abs(support.moment[2]);
  EXPECT_NEAR(friction.moment[2], support.moment[2], 1e-8 * size);
  EXPECT_NEAR(friction.centreMoment[2], support.moment[2] - 2.5 * support.force[1], 1e-8 * size);
  // Friction acts along y = 0: it turns neither about the origin nor about the centre.
  EXPECT_NEAR(friction.tangentialMoment[2], 0, 1e-12);
  EXPECT_NEAR(friction.centreTangential[2], 0, 1e-12);
}

/// ‖u − v‖_K = ‖λ − λ′‖_F of two runs of one scene, where nothing floats.
double distance(const SceneRun& one, const SceneRun& other) {
  Vector off(*one.solution.multiplier, Teuchos::Copy), image(off.getMap());
  off.update(-1.0, *other.solution.multiplier, 1.0);
  one.solver->dualProblem().dualOperator()->apply(off, image);
  return std::sqrt(off.dot(image));
}

/// The error of an iteration that ends early is within its bound; on a rigid floor bounds of Coulomb's
/// friction feed back by about μβ, with Dundurs' β = (1 − 2ν)/(2(1 − ν)) = 0.286, and at corners by more.
TEST(FrictionSceneTest, TheBoundOfTheIterationsErrorHoldsAsBoundsFeedBack) {
  for (const double friction : {0.1, 0.3, 0.6})
    for (const bool isCoulomb : {true, false})
      for (const double push : {0.004, 0.05}) { // where some of it slides, and all of it
        SCOPED_TRACE(testing::Message() << friction << (isCoulomb ? ", Coulomb, " : ", Tresca, ") << push);
        scene::Scene scene = heldBlock(16, test::cutInGrid({2, 2, 1}));
        scene.contacts[0].friction = isCoulomb ? friction : 0;
        scene.contacts[0].frictionBound = isCoulomb ? 0 : 0.01 * friction;
        scene.bodies[0].supports[0].value[0] = push;
        const SceneRun exact = solved(scene);
        ASSERT_EQ(exact.result.feedback.has_value(), isCoulomb);
        if (isCoulomb && push > 0.01) {
          EXPECT_GT(exact.result.feedback->factor, 0.3 * 0.286 * friction);
          EXPECT_LT(exact.result.feedback->factor, 2.5 * 0.286 * friction);
        }
        for (const double asked : {1e-1, 1e-2, 1e-3}) {
          const SceneRun rough =
              solveScene(scene, Teuchos::ParameterList().set("Tolerance", asked), Tpetra::getDefaultComm());
          EXPECT_LE(distance(rough, exact), 1.001 * rough.solution.algebraicError) << asked;
        }
      }
}

/// A block of order 2 on one three times as stiff that is wider, pressed by 0.01 and sheared by 0.002, μ =
/// 0.3.
scene::Scene twoBlocks(int n, scene::SurfaceContact::Coupling coupling, bool isUpperFirst) {
  scene::Scene scene;
  const scene::Decomposition cut = test::cutInGrid({2, 2, 1});
  scene.bodies = {softBlock("lower", {{-0.5, 0, 0}, {1.5, 1, 0}}, {2 * n, n, 0}, 3, cut),
                  softBlock("upper", {{0, 1, 0}, {1, 2, 0}}, {n, n, 0}, 1, cut)};
  for (scene::Body& body : scene.bodies)
    body.mesh.order = 2;
  scene.bodies[0].supports.push_back({"foot", "bottom", {0.0, 0.0}});
  scene.bodies[1].loads = {test::loadOn("top", {0.002, -0.01, 0})};
  scene.contacts.push_back(isUpperFirst ? test::between("joint", 1, "bottom", 0, "top")
                                        : test::between("joint", 0, "top", 1, "bottom"));
  scene.contacts[0].coupling = coupling;
  scene.contacts[0].friction = 0.3;
  return scene;
}

TEST(FrictionSceneTest, TwoBlocksSlipAsAnIndependentSolverSaysWhoeverIsNamedFirst) {
  using Coupling = scene::SurfaceContact::Coupling;
  constexpr double strainEnergy = 7.28666145e-5, loadWork = 1.45892228e-4;
  for (const Coupling coupling : {Coupling::nodes, Coupling::mortar})
    for (const bool isUpperFirst : {true, false}) {
      SCOPED_TRACE(std::string(coupling == Coupling::nodes ? "nodes" : "mortar") +
                   (isUpperFirst ? ", upper first" : ", lower first"));
      const SceneRun run = solved(twoBlocks(8, coupling, isUpperFirst));
      ASSERT_EQ(run.result.status, RunStatus::converged) << run.result.reason;
      const double off = coupling == Coupling::nodes ? 1e-8 : 1e-3;
      EXPECT_NEAR(run.result.loadWork, loadWork, off * loadWork);
      EXPECT_NEAR(run.result.energy + run.result.loadWork, strainEnergy, off * strainEnergy);
      EXPECT_NEAR(frictionOf(run.result).tangentialForce[0], isUpperFirst ? 0.002 : -0.002, 1e-9);
      EXPECT_NEAR(run.result.contacts[0].force, 0.01, 1e-9);
    }
}

/// What friction does is the same in a scene that is turned.
TEST(FrictionSceneTest, AnInclinedFloorIsAFloor) {
  scene::Scene scene = heldBlock(8, test::cutInGrid({2, 2, 1}));
  const SceneRun level = solved(scene);
  scene::Scene turned = scene; // the block on its left side, pushed from the right
  turned.bodies[0].supports[0] = {"push", "right", {-0.01, -0.004}};
  turned.contacts[0] = test::onPlane("wall", 0, "left", {0, 0, 0}, {1, 0, 0});
  turned.contacts[0].friction = 0.3;
  const SceneRun upright = solved(turned);

  EXPECT_NEAR(upright.result.energy, level.result.energy, 1e-9 * level.result.energy);
  EXPECT_NEAR(frictionOf(upright.result).tangentialForce[1], -frictionOf(level.result).tangentialForce[0],
              1e-11);
  EXPECT_NEAR(frictionOf(upright.result).largestSlip, frictionOf(level.result).largestSlip, 1e-10);
}

/// A cube of order 1 held on its top, in space, pushed aslant.
TEST(FrictionSceneTest, InSpaceFrictionPointsAgainstTheSlip) {
  for (const double angle : {0.0, 0.4, 0.9}) {
    scene::Scene scene;
    scene.bodies.push_back(
        softBlock("cube", {{0, 0, 0}, {1, 1, 1}}, {4, 4, 4}, 1, test::cutInGrid({2, 2, 2})));
    scene.bodies[0].mesh.order = 1;
    const double push = 0.02;
    scene.bodies[0].supports.push_back(
        {"push", "top", {push * std::cos(angle), push * std::sin(angle), -0.01}});
    scene.contacts.push_back(test::onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 0, 1}));
    scene.contacts[0].friction = 0.1;
    const SceneRun run = solved(scene);
    ASSERT_EQ(run.result.status, RunStatus::converged) << run.result.reason;
    const FrictionResult& friction = frictionOf(run.result);
    // All of it slips, so that friction is μ times the pressure node by node, and nearly in one direction.
    EXPECT_EQ(friction.stickArea, 0);
    const double size = std::hypot(friction.tangentialForce[0], friction.tangentialForce[1]);
    EXPECT_LE(size, 0.1 * run.result.contacts[0].force * (1 + 1e-9));
    EXPECT_GE(size, 0.095 * run.result.contacts[0].force);
    EXPECT_NEAR(std::atan2(friction.tangentialForce[1], friction.tangentialForce[0]), angle, 0.02);
    EXPECT_GT(friction.dissipation, 0);
  }
}

/// A square of order 2 that nothing but friction holds: pressed, pushed to the right, to the left, and left
/// alone.
TEST(FrictionSceneTest, AStepThatFrictionDoesNotHoldIsNamed) {
  scene::Scene scene = heldBlock(4, test::cutInGrid({2, 1, 1}));
  scene.bodies[0].supports.clear();
  scene.bodies[0].loads = {test::loadOn("top", {0, -0.01, 0}), test::loadOn("top", {0.001, 0, 0})};
  std::vector<scene::Step> steps(2);
  steps[0].name = "held";
  steps[1].name = "slides";
  steps[1].loads[{0, 1}] = 4; // 0.004 beside 0.3 times 0.01
  test::expectSays(test::unsolvable(SolvabilityError::Kind::noSolution,
                                    [&] { solveSteps(scene, steps, {}, Tpetra::getDefaultComm(), {}, {}); }),
                   {"(in step \"slides\")"});
}

/// Elements of order 2, whose nodes are not alike.
TEST(FrictionSceneTest, WhatSlidesHasTractionsOfCoulombsLawAtEachNode) {
  scene::Scene scene = heldBlock(4, test::cutInGrid({2, 1, 1}));
  scene.bodies[0].mesh.order = 2;
  scene.bodies[0].supports[0].value[0] = 0.05;
  const SceneRun run = solved(scene);
  const contact::ContactLayout& layout = run.decomposition->contacts[0];
  const FrictionFields fields = frictionFields(run.solved(), layout);
  const ContactState state = contactState(run.solved(), 0);
  for (std::size_t node = 0; node < fields.state.size(); ++node) {
    EXPECT_NE(fields.state[node], static_cast<int>(FrictionState::stick));
    EXPECT_NEAR(fields.traction[3 * node], 0.3 * state.pressure[node], 1e-9);
  }
}

TEST(FrictionSceneTest, WhatHasSlippedIsKeptFromStepToStep) {
  scene::Scene scene = heldBlock(32, test::cutInGrid({2, 2, 1}));
  scene.bodies[0].mesh.order = 2;
  scene.bodies[0].supports.clear();
  scene.bodies[0].loads = {test::loadOn("top", {0, -0.01, 0}),
                           test::loadOn("left", {0.0027, 0, 0}, fem::SolidLoad::Kind::pressure)};
  std::vector<scene::Step> steps(4);
  const double factors[] = {0, 1, -1, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    steps[k].name = std::string(1, static_cast<char>('a' + k));
    steps[k].loads[{0, 1}] = factors[k];
  }
  int told = 0;
  const SceneRun run =
      solveSteps(scene, steps,
                 Teuchos::ParameterList().set("Tolerance", tolerance).set("Equilibrium Tolerance", tolerance),
                 Tpetra::getDefaultComm(), {},
                 [&](SceneRun& soFar) { EXPECT_EQ(std::ssize(soFar.result.steps), ++told); });

  ASSERT_EQ(run.result.steps.size(), 4U);
  EXPECT_EQ(told, 3);
  const double energies[] = {4.44047407e-5, 4.67729504e-5, 5.6118295e-5, 4.46103813e-5};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(run.result.steps[k].status, RunStatus::converged) << run.result.steps[k].reason;
    EXPECT_NEAR(run.result.steps[k].strainEnergy, energies[k], 1e-7 * energies[k]) << steps[k].name;
  }
  EXPECT_NEAR(run.result.steps[2].loadWork, 1.14205344e-4, 1e-7 * 1.14205344e-4);
  EXPECT_NEAR(run.result.steps[2].dissipation, 2.08925e-6, 1e-4 * 2.08925e-6);
}

} // namespace
} // namespace epafi::simulation
