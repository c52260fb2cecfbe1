// Bolts that are tightened, springs, and what comes and goes with load steps, beside closed forms.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"

#include "epafi/simulation/StepRun.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace epafi::simulation {
namespace {

constexpr double rodStiffness = 200 * 0.5 / 4; // E A / l

Teuchos::ParameterList exactly() {
  return Teuchos::ParameterList().set("Tolerance", 1e-12).set("Equilibrium Tolerance", 1e-12);
}

SceneRun solvedInSteps(const scene::Scene& scene, const std::vector<scene::Step>& steps) {
  return solveSteps(scene, steps, exactly(), Tpetra::getDefaultComm(), {}, {});
}

scene::Preload preload(scene::Preload::Kind kind, double value = 0) {
  return {kind, value};
}

/// A rod along z between two walls, in two parts that are meshed apart unless `areAlike`; sideways free to
/// breathe, but for the planes x = 0 and y = 0. Poisson's ratio is 0.3: the closed forms have none of it.
scene::Scene rod(bool areAlike, const scene::Decomposition& cut) {
  scene::Scene scene;
  const int n = areAlike ? 2 : 3;
  scene.bodies = {test::block("lower", {{0, 0, 0}, {0.5, 1, 1.5}}, {2, 2, 3}, cut),
                  test::block("upper", {{0, 0, 1.5}, {0.5, 1, 4}}, {n, n, 4}, cut)};
  for (scene::Body& body : scene.bodies) {
    body.material.poissonsRatio = 0.3;
    for (const char* const plane : {"left", "front"})
      body.supports.push_back(test::slide(plane));
  }
  scene.bodies[0].supports.push_back(test::slide("bottom"));
  scene.bodies[1].supports.push_back({"wall", "top", {std::nullopt, std::nullopt, 0.001}});
  scene.contacts.push_back(test::between("bolt", 0, "top", 1, "bottom"));
  scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
  return scene;
}

TEST(PreloadTest, ATensionAndTheLengthThatItTakesAreThoseOfARod) {
  using Kind = scene::Preload::Kind;
  for (const bool areAlike : {true, false})
    for (const int order : {1, 2}) {
      SCOPED_TRACE(std::string(areAlike ? "alike, " : "apart, ") + "order " + std::to_string(order));
      scene::Scene scene = rod(areAlike, areAlike ? test::cutByMetis(3) : test::cutInGrid({1, 1, 2}));
      for (scene::Body& body : scene.bodies)
        body.mesh.order = order;
      scene.bodies[1].supports.back().value[2] = 0;
      scene.contacts[0].preload = preload(Kind::force, 3);
      const SceneRun tightened = solveScene(scene, exactly(), Tpetra::getDefaultComm());
      scene.contacts[0].preload = preload(Kind::shortening, 0.1);
      const SceneRun shortened = solveScene(scene, exactly(), Tpetra::getDefaultComm());

      ASSERT_EQ(tightened.result.preloads.size(), 1U);
      EXPECT_NEAR(tightened.result.preloads[0].shortening, 3 / rodStiffness, 1e-8);
      EXPECT_EQ(tightened.result.preloads[0].force, 3);
      EXPECT_NEAR(shortened.result.preloads[0].force, 0.1 * rodStiffness, 1e-8);
      EXPECT_NEAR(shortened.result.energy + shortened.result.loadWork, 0.5 * 0.01 * rodStiffness, 1e-8);
    }
}

TEST(PreloadTest, ALockedBoltIsPulledAsIfItWereWhole) {
  using Kind = scene::Preload::Kind;
  for (const bool areAlike : {true, false}) {
    scene::Scene scene = rod(areAlike, test::cutInGrid({1, 1, 2}));
    scene.contacts[0].preload = preload(Kind::force, 3);
    std::vector<scene::Step> steps(4);
    const double walls[] = {0, 50, 50, 100}; // by 0, 0.05, 0.05, 0.1
    for (std::size_t k = 0; k < steps.size(); ++k) {
      steps[k].name = std::string(1, static_cast<char>('a' + k));
      steps[k].supports[{1, 2}] = walls[k];
    }
    steps[1].preloads[0] = preload(Kind::locked);
    steps[2].preloads[0] = preload(Kind::force, 3);
    steps[3].preloads[0] = preload(Kind::locked);
    const SceneRun run = solvedInSteps(scene, steps);

    ASSERT_EQ(run.result.steps.size(), 4U);
    const double tensions[] = {3, 3 + 0.05 * rodStiffness, 3, 3 + 0.05 * rodStiffness};
    const double lengths[] = {3 / rodStiffness, 3 / rodStiffness, 3 / rodStiffness - 0.05,
                              3 / rodStiffness - 0.05};
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(run.result.steps[k].preloads[0].force, tensions[k], 1e-8) << k;
      EXPECT_NEAR(run.result.steps[k].preloads[0].shortening, lengths[k], 1e-8) << k;
    }
  }
}

TEST(PreloadTest, ASectionMayBeTightenedAcrossItsNormal) {
  scene::Scene scene = rod(true, test::cutInGrid({1, 1, 1}));
  scene.bodies[1].supports.back().value[2] = 0;
  scene.contacts[0].preload = preload(scene::Preload::Kind::shortening, 0.1);
  scene.contacts[0].preloadDirection = Vector3{0, 0, -2}; // the other way round: it is lengthened
  const SceneRun run = solveScene(scene, exactly(), Tpetra::getDefaultComm());
  EXPECT_NEAR(run.result.preloads[0].force, 0.1 * rodStiffness, 1e-8);
}

/// A block on a floor, its top moved by −0.01.
scene::Scene blockOnFloor() {
  scene::Scene scene;
  scene.bodies = {test::block("block", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, test::cutInGrid({2, 2, 1}))};
  scene.bodies[0].mesh.order = 1;
  scene.bodies[0].supports = {test::slide("left"), {"press", "top", {std::nullopt, -0.01}}};
  scene.contacts.push_back(test::onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}));
  return scene;
}

TEST(PreloadTest, AContactComesAndGoesWithSteps) {
  std::vector<scene::Step> steps(3);
  steps[0].isOn[0] = false;
  steps[1].isOn[0] = true;
  steps[2].isOn[0] = false;
  const SceneRun run = solvedInSteps(blockOnFloor(), steps);
  ASSERT_EQ(run.result.steps.size(), 3U);
  EXPECT_NEAR(run.result.steps[0].strainEnergy, 0, 1e-15);
  EXPECT_NEAR(run.result.steps[2].strainEnergy, 0, 1e-15);
  const double strain = 0.01, nu = 0.3; // in the plane, free across
  const double energy = 0.5 * 200 / (1 - nu * nu) * strain * strain;
  EXPECT_NEAR(run.result.steps[1].strainEnergy, energy, 1e-9);
  EXPECT_NEAR(run.result.steps[1].contacts.at(0).force, 2 * energy / strain, 1e-8);
}

TEST(PreloadTest, AFixedSupportHoldsWhatALoadHasMovedUntilItIsOff) {
  scene::Scene scene = blockOnFloor();
  scene.contacts.clear();
  scene.bodies[0].supports = {{"foot", "bottom", {0.0, 0.0}}, {"grip", "top", {0.0, 0.0}}};
  scene.bodies[0].loads = {test::loadOn("top", {0.3, -0.5, 0})};
  std::vector<scene::Step> steps(4);
  steps[0].states[{0, 1}] = scene::SupportState::off;
  steps[1].states[{0, 1}] = scene::SupportState::fixed;
  steps[1].loads[{0, 0}] = 0;
  steps[3].states[{0, 1}] = scene::SupportState::off;
  const SceneRun run = solvedInSteps(scene, steps);
  ASSERT_EQ(run.result.steps.size(), 4U);
  const double energy = run.result.steps[0].strainEnergy;
  EXPECT_GT(energy, 1e-4);
  EXPECT_NEAR(run.result.steps[1].strainEnergy, energy, 1e-9 * energy);
  EXPECT_NEAR(run.result.steps[2].strainEnergy, energy, 1e-9 * energy);
  EXPECT_NEAR(run.result.steps[3].strainEnergy, 0, 1e-12);
}

/// A square of one element with names for its nodes and two of its sides.
const char* const namedSquare =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n8\n0 1 \"a\"\n0 2 \"b\"\n0 3 \"c\"\n0 4 \"d\"\n"
    "1 5 \"left\"\n1 6 \"top\"\n1 7 \"bottom\"\n2 8 \"square\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n8\n1 15 2 1 1 1\n2 15 2 2 2 2\n3 15 2 3 3 3\n4 15 2 4 4 4\n"
    "5 1 2 5 5 4 1\n6 1 2 6 6 3 4\n7 1 2 7 7 1 2\n8 3 2 8 8 1 2 3 4\n$EndElements\n";

/// A square that 0.5 presses onto springs at its lower corners, on a square on the ground or on the ground.
scene::Scene squareOnSprings(const std::string& file, bool onAnother) {
  scene::Scene scene;
  for (const char* const name : {"upper", "lower"}) {
    scene::Body body;
    body.name = name;
    body.physics = fem::Physics::planeStrain;
    body.material.youngsModulus = 200;
    body.mesh.file = file;
    body.mesh.order = 1;
    body.decomposition = test::cutByMetis(1);
    body.supports = {test::slide("left")};
    scene.bodies.push_back(body);
  }
  scene.bodies[0].loads = {test::loadOn("top", {0, -0.5, 0})};
  scene.bodies[1].supports.push_back(test::slide("bottom"));
  for (const auto& [upper, lower] : {std::pair("a", "d"), {"b", "c"}}) {
    scene::Equation spring{"spring", {{1, 0, upper, 1}}, 0.01, 4};
    if (onAnother)
      spring.terms.push_back({-1, 1, lower, 1});
    scene.equations.push_back(spring);
  }
  return scene;
}

TEST(PreloadTest, SpringsToTheGroundAndBetweenPointsGiveWayByTheirStiffness) {
  const test::MeshFolder folder; // of each rank
  const std::string file = folder.write("square.msh", namedSquare);
  for (const bool onAnother : {false, true}) {
    const SceneRun run = solveScene(squareOnSprings(file, onAnother), exactly(), Tpetra::getDefaultComm());
    ASSERT_EQ(run.result.status, RunStatus::converged) << run.result.reason;
    const double sunk = 0.25 / 4 - 0.01 + (onAnother ? 0.5 * (1 - 0.3 * 0.3) / 200 : 0);
    for (const Eigen::Vector3d& u : displacementsAt(run.solved(), 0, std::array<GlobalOrdinal, 2>{0, 1}))
      EXPECT_NEAR(u[1], -sunk, 1e-10);
  }
}

/// The square 0.02 above a floor that its left corner is said to touch, its top moved by 0.01.
TEST(PreloadTest, GapsAtNodesThatAreAdjustedCountAsNone) {
  const test::MeshFolder folder;
  scene::Scene scene = squareOnSprings(folder.write("square.msh", namedSquare), false);
  scene.equations.clear();
  scene.bodies.pop_back();
  scene.bodies[0].loads.clear();
  scene.bodies[0].supports.push_back({"press", "top", {std::nullopt, -0.01}});
  scene.contacts.push_back(test::onPlane("floor", 0, "bottom", {0, -0.02, 0}, {0, 1, 0}));
  EXPECT_EQ(solveScene(scene, exactly(), Tpetra::getDefaultComm()).result.activeContactNodes, 0);
  scene.contacts[0].adjustNodes = "a";
  EXPECT_EQ(solveScene(scene, exactly(), Tpetra::getDefaultComm()).result.activeContactNodes, 1);
  scene.contacts[0].adjustNodes = "e";
  EXPECT_THROW(solveScene(scene, exactly(), Tpetra::getDefaultComm()), InputError);
}

/// A hanger inside a column, whose tops are tied: both are pulled and pressed by the same force.
TEST(PreloadTest, ATieOfSurfacesThatLookOneWayHoldsThemTogether) {
  for (const int elements : {2, 3}) {
    scene::Scene scene;
    scene.bodies = {
        test::block("column", {{0, 0, 0}, {1, 1, 0}}, {2, 2, 0}, test::cutInGrid({1, 1, 1})),
        test::block("hanger", {{0, 0.5, 0}, {1, 1, 0}}, {elements, 1, 0}, test::cutInGrid({1, 1, 1}))};
    for (scene::Body& body : scene.bodies)
      body.material.poissonsRatio = 0;
    scene.bodies[0].supports.push_back({"foot", "bottom", {0.0, 0.0}});
    scene.bodies[1].loads = {test::loadOn("bottom", {0, -2, 0})};
    scene.contacts.push_back(test::between("joint", 1, "top", 0, "top"));
    scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
    scene.contacts[0].distance = 0.1;
    const SceneRun run = solveScene(scene, exactly(), Tpetra::getDefaultComm());
    EXPECT_NEAR(run.result.energy + run.result.loadWork, 0.5 * 2 * 2 * 1.5 / 200, 1e-10);
    EXPECT_NEAR(run.result.ties.at(0).resultant[1], 2, 1e-9);
  }
}

TEST(PreloadTest, ASectionThatSupportsHoldIsRefused) {
  scene::Scene scene = rod(true, test::cutInGrid({1, 1, 1}));
  scene.bodies[0].supports.push_back({"hold", "top", {0.0, 0.0, 0.0}});
  scene.bodies[1].supports.push_back({"hold", "bottom", {0.0, 0.0, 0.0}});
  scene.contacts[0].preload = preload(scene::Preload::Kind::force, 3);
  EXPECT_THROW(solveScene(scene, exactly(), Tpetra::getDefaultComm()), Error);
}

} // namespace
} // namespace epafi::simulation
