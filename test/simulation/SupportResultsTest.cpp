// What supports hold: forces known by hand, balance with loads and contacts, whatever the cut and the ranks.

#include "support/SolidScenes.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Slab.hpp"
#include "epafi/scene/ModelProblem.hpp"
#include "epafi/simulation/RunResult.hpp"
#include "epafi/simulation/SceneRun.hpp"
#include "epafi/simulation/StepRun.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace epafi::simulation {
namespace {

using Load = fem::SolidLoad::Kind;

class SupportResultsTest : public testing::Test {
protected:
  [[nodiscard]] std::vector<SupportResult> supports(const scene::Scene& scene) const {
    Teuchos::ParameterList solver;
    solver.set("Tolerance", 1e-12);
    return solveScene(scene, solver, comm_).result.supports;
  }
  static void expectNear(const std::array<double, 3>& value, const std::array<double, 3>& expected,
                         double upTo) {
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_NEAR(value[d], expected[d], upTo) << d;
  }
  RCP<const Comm> comm_ = Tpetra::getDefaultComm();
};

scene::Body cube(const scene::Decomposition& cut = test::cutByMetis(3)) {
  return test::block("cube", {{0, 0, 0}, {2, 1, 1}}, {4, 2, 2}, cut);
}

TEST_F(SupportResultsTest, AClampHoldsForceAndMomentOfTheLoads) {
  scene::Scene scene;
  scene.bodies = {cube()};
  scene.bodies[0].supports = {{"clamp", "left", {0.0, 0.0, 0.0}}};
  scene.bodies[0].loads = {{"pull", Load::traction, {}, "right", {}, {3, 5, 7}},
                           test::weight({0, 0, -2}),
                           {"at the clamp", Load::traction, {}, "left", {}, {11, 0, 13}}};
  for (const auto& cut : {test::cutByMetis(1), test::cutByMetis(3), test::cutInGrid({2, 1, 2})}) {
    scene.bodies[0].decomposition = cut;
    const std::vector<SupportResult> held = supports(scene);
    ASSERT_EQ(held.size(), 1U);
    EXPECT_EQ(held[0].body + '/' + held[0].name, "cube/clamp");
    expectNear(held[0].force, {-14, -5, -16}, 1e-9);
    // Resultants act at (2, ½, ½), (1, ½, ½) and (0, ½, ½).
    const double x = 0.5 * 7 - 0.5 * 5, y = 0.5 * 3 - 2 * 7, z = 2 * 5 - 0.5 * 3;
    expectNear(held[0].moment, {-(x - 0.5 * 4 + 0.5 * 13), -(y + 4 + 0.5 * 11), -(z - 0.5 * 11)}, 1e-9);
  }
}

TEST_F(SupportResultsTest, ForcesAtNodesAddUpToThoseOfTheSupports) {
  scene::Scene scene;
  scene.bodies = {cube()};
  scene.bodies[0].supports = {{"clamp", "left", {0.0, 0.0, 0.0}}};
  scene.bodies[0].loads = {{"pull", Load::traction, {}, "right", {}, {3, 5, 7}}};
  SceneRun run = solveScene(scene, {}, comm_);
  const mesh::Mesh& mesh = *run.decomposition->bodies[0].mesh;
  const std::vector<Vector3> forces = supportForcesAtNodes(run.solved(), 0);
  const RowRange slab = evenShare(mesh.numNodes(), *comm_);
  ASSERT_EQ(std::ssize(forces), slab.count);
  std::array<double, 3> sum{};
  for (GlobalOrdinal k = 0; k < slab.count; ++k)
    for (std::size_t d = 0; d < 3; ++d) {
      EXPECT_TRUE(forces[k][d] == 0 || mesh.point(slab.first + k)[0] == 0);
      sum[d] += forces[k][d];
    }
  sumOverRanks(*comm_, std::span(sum));
  expectNear(sum, {-3, -5, -7}, 1e-8);
}

TEST_F(SupportResultsTest, PrescribedDisplacementsAreHeldByWhatTheyStrain) {
  scene::Scene scene;
  scene.bodies = {cube()};
  scene.bodies[0].supports = {
      test::slide("left"), test::slide("front"), test::slide("bottom"), {"stretch", "right", {0.02, {}, {}}}};
  const std::vector<SupportResult> held = supports(scene); // E ε = 200 · 0.01 on an area of 1
  expectNear(held[0].force, {-2, 0, 0}, 1e-9);
  expectNear(held[1].force, {0, 0, 0}, 1e-9);
  expectNear(held[2].force, {0, 0, 0}, 1e-9);
  expectNear(held[3].force, {2, 0, 0}, 1e-9);
  expectNear(held[3].moment, {0, 1, -1}, 1e-9);
}

TEST_F(SupportResultsTest, SupportsInAxesOfTheirOwnHoldAlongThem) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  scene::Scene scene;
  scene.bodies = {cube()};
  fem::SolidSupport along{"along", "left", {0.0, {}, {}}},
      across{"across", "right", {std::nullopt, 0.0, std::nullopt}};
  along.axes = across.axes = fem::LocalAxes{false, {c, s, 0}, {-s, c, 0}};
  scene.bodies[0].supports = {along, across, test::slide("bottom")};
  scene.bodies[0].loads = {{"pull", Load::traction, {}, "right", {}, {3, 1, 0}}};
  const std::vector<SupportResult> held = supports(scene);
  const double alongs = 3 * c + s, acrosses = c - 3 * s;
  expectNear(held[0].force, {-alongs * c, -alongs * s, 0}, 1e-9);
  expectNear(held[1].force, {acrosses * s, -acrosses * c, 0}, 1e-9);
}

TEST_F(SupportResultsTest, ABodyOnAnotherOneHandsItsLoadDownAlsoWhereContactMeetsWhatIsHeld) {
  for (const int dimension : {2, 3})
    for (const std::optional<double> friction : {std::optional<double>(), std::optional(0.4)}) {
      SCOPED_TRACE(std::to_string(dimension) + (friction ? " with friction" : ""));
      const int up = dimension - 1, across = dimension == 3 ? 2 : 0;
      mesh::Box lower{{0, 0, 0}, {1, 1, 1}}, upper{{0, 0, 0}, {1, 1, 1}};
      if (dimension == 2)
        lower.upper[2] = upper.upper[2] = 0;
      upper.lower[up] = 1;
      upper.upper[up] = 2;
      scene::Scene scene;
      scene.bodies = {test::block("lower", lower, {2, 2, across}, test::cutByMetis(2)),
                      test::block("upper", upper, {3, 3, across == 0 ? 0 : 3}, test::cutByMetis(2))};
      // All nodes of the lower one's left side are held, those in contact too.
      scene.bodies[0].supports = {{"base", "bottom", {0.0, 0.0, 0.0}}, {"side", "left", {0.0, 0.0, 0.0}}};
      scene.bodies[1].supports = {test::slide("left")};
      if (dimension == 3)
        scene.bodies[1].supports.push_back(test::slide("front"));
      scene.bodies[1].loads = {{"press", Load::pressure, {}, "top", {}, {6, 0, 0}}};
      scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
      if (friction)
        scene.contacts[0].friction = *friction;
      const std::vector<SupportResult> held = supports(scene);
      std::array<double, 3> sum{};
      for (const SupportResult& support : held)
        for (std::size_t d = 0; d < 3; ++d)
          sum[d] += support.force[d];
      std::array<double, 3> expected{};
      expected[up] = 6;
      expectNear(sum, expected, 1e-8);
      EXPECT_GT(held[1].force[up], 0.1); // the held side carries a part of it
    }
}

TEST_F(SupportResultsTest, ABlockThatIsHeldEverywhereBearsAsAnObstacleDoes) {
  for (const int dimension : {2, 3})
    for (const int across : {1, 3}) { // nodes that face each other, then mortars
      SCOPED_TRACE(std::to_string(dimension) + ", " + std::to_string(across));
      const int up = dimension - 1, deep = dimension == 3 ? 1 : 0;
      mesh::Box lower{{0, 0, 0}, {1, 1, dimension - 2.0}}, upper = lower;
      upper.lower[up] = 1;
      upper.upper[up] = 2;
      scene::Scene scene;
      scene.bodies = {test::block("lower", lower, {1, 1, deep}, test::cutByMetis(1)),
                      test::block("upper", upper, {across, 2, deep * 2}, test::cutByMetis(2))};
      scene.bodies[0].supports = {{"base", "bottom", {0.0, 0.0, 0.0}}, {"roof", "top", {0.0, 0.0, 0.0}}};
      scene.bodies[1].supports = {test::slide("left")};
      if (dimension == 3)
        scene.bodies[1].supports.push_back(test::slide("front"));
      scene.bodies[1].loads = {{"press", Load::pressure, {}, "top", {}, {6, 0, 0}}};
      scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
      const std::vector<SupportResult> held = supports(scene);
      std::array<double, 3> none{}, expected{};
      expected[up] = 6;
      expectNear(held[0].force, none, 1e-8);
      expectNear(held[1].force, expected, 1e-8);
    }
}

TEST_F(SupportResultsTest, WallsHoldTheTensionOfATiedRodInTwoParts) {
  for (const int across : {2, 3}) // beside 2: meshed alike, then apart
    for (const int order : {1, 2}) {
      SCOPED_TRACE(std::to_string(across) + ", order " + std::to_string(order));
      scene::Scene scene;
      scene.bodies = {test::block("lower", {{0, 0, 0}, {1, 1, 1}}, {2, 2, 2}, test::cutByMetis(2)),
                      test::block("upper", {{0, 0, 1}, {1, 1, 2}}, {across, across, 2}, test::cutByMetis(2))};
      for (scene::Body& body : scene.bodies) { // planes that hold nodes of the joint, too
        body.mesh.order = order;
        body.supports = {test::slide("left"), test::slide("front")};
      }
      scene.bodies[0].supports.push_back(test::slide("bottom"));
      scene.bodies[1].supports.push_back({"pull", "top", {std::nullopt, std::nullopt, 0.02}});
      scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
      scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
      const std::vector<SupportResult> held = supports(scene); // E ε = 200 · 0.01 on an area of 1
      for (std::size_t s = 0; s < held.size(); ++s)
        expectNear(held[s].force, {0, 0, s == 2 ? -2.0 : s == 5 ? 2.0 : 0}, 1e-8);
    }
}

TEST_F(SupportResultsTest, SolidsOfRevolutionAreHeldAllAround) {
  for (const int order : {1, 2}) {
    scene::Scene scene;
    scene.bodies = {test::block("disc", mesh::rectangle(0, 2, 0, 1), {4, 2, 0}, test::cutByMetis(2))};
    scene.bodies[0].physics = fem::Physics::axisymmetric;
    scene.bodies[0].mesh.order = order;
    scene.bodies[0].supports = {test::slide("bottom")};
    scene.bodies[0].loads = {{"press", Load::pressure, {}, "top", {}, {3, 0, 0}}};
    expectNear(supports(scene)[0].force, {0, 3 * std::numbers::pi * 4, 0}, 1e-9);
  }
}

TEST_F(SupportResultsTest, WallsHoldWhatHeatWouldExpand) {
  scene::Scene scene;
  scene.bodies = {cube()};
  scene.bodies[0].material.expansion = 1e-3;
  scene.bodies[0].supports = {test::slide("left"), test::slide("right"), test::slide("front"),
                              test::slide("bottom")};
  scene.bodies[0].loads = {{"heat", Load::temperature, {}, "", {}, {10, 0, 0}}};
  const std::vector<SupportResult> held = supports(scene); // E α ΔT = 2 on an area of 1
  expectNear(held[0].force, {2, 0, 0}, 1e-9);
  expectNear(held[1].force, {-2, 0, 0}, 1e-9);
  expectNear(held[2].force, {0, 0, 0}, 1e-9);
}

TEST_F(SupportResultsTest, ASupportThatComesWithAStepHoldsWhatTheLoadHasStrained) {
  scene::Scene scene;
  scene.bodies = {cube()};
  scene.bodies[0].supports = {
      test::slide("left"), test::slide("front"), test::slide("bottom"), {"grip", "right", {0.0, {}, {}}}};
  scene.bodies[0].loads = {{"pull", Load::traction, {}, "right", {}, {3, 0, 0}}};
  const scene::Step::Place grip{0, 3}, pull{0, 0};
  scene::Step stretch, hold;
  stretch.name = "stretch";
  stretch.states = {{grip, scene::SupportState::off}};
  hold.name = "hold";
  hold.states = {{grip, scene::SupportState::fixed}};
  hold.loads = {{pull, 0.0}};
  const SceneRun run =
      solveSteps(scene, {stretch, hold}, Teuchos::ParameterList().set("Tolerance", 1e-12), comm_, {}, {});
  const std::vector<StepResult>& steps = run.result.steps;
  ASSERT_EQ(steps.size(), 2U);
  ASSERT_EQ(steps[0].supports.size(), 3U); // the grip is not there
  expectNear(steps[0].supports[0].force, {-3, 0, 0}, 1e-9);
  expectNear(steps[1].supports[0].force, {-3, 0, 0}, 1e-9);
  expectNear(steps[1].supports[3].force, {3, 0, 0}, 1e-9);
}

TEST_F(SupportResultsTest, MembranesAreHeldAlongZ) {
  const scene::Scene scene = scene::modelProblem(true, 2, 4);
  const SceneRun run = solveScene(scene, {}, comm_);
  double sum = 0, loads = 0;
  for (const SupportResult& support : run.result.supports)
    sum += support.force[2];
  for (const decomposition::SubdomainData& data : run.decomposition->data.subdomains())
    loads += data.load.sum() + data.heldForces.sum();
  loads = sumOverRanks(*comm_, loads);
  EXPECT_GT(std::abs(loads), 0.1);
  EXPECT_NEAR(sum, -loads, 1e-6);
}

} // namespace
} // namespace epafi::simulation
