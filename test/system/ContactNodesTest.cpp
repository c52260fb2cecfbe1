// Nodes that take part in several contacts, or carry supports as well.

#include "support/SolidScenes.hpp"

#include <cmath>

namespace epafi {
namespace {

using namespace test;

const Vector3 corner{0, 0, 0};

/// A square in the corner of a floor and a wall, pressed into it.
scene::Scene inCorner(const scene::Decomposition& cut) {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, cut)};
  scene.bodies[0].loads = {weight({-0.5, -1, 0})};
  scene.contacts = {onPlane("floor", 0, "bottom", corner, {0, 1, 0}),
                    onPlane("wall", 0, "left", corner, {1, 0, 0})};
  return scene;
}

/// Both solutions agree in what is unique: displacements, energy, total force.
void expectSameRun(const SolidRun& a, const SolidRun& b) {
  EXPECT_EQ(a.solver.report().status, qp::Status::converged);
  EXPECT_EQ(b.solver.report().status, qp::Status::converged);
  EXPECT_LE((a.displacement(0) - b.displacement(0)).norm(), 1e-7 * a.displacement(0).norm());
  EXPECT_NEAR(a.solution.energy, b.solution.energy, 1e-9 * std::abs(a.solution.energy));
}

TEST(ContactNodesTest, ANodeInACornerHasARowForEachWall) {
  const SolidRun reference(inCorner(cutInGrid({1, 1, 1})));
  EXPECT_EQ(reference.decomposition.problem.numInequalities, 10);
  EXPECT_NEAR(reference.solution.contactForce, 1.5, 1e-8);
  const Eigen::VectorXd u = reference.displacement(0);
  EXPECT_GE(std::min(u[0], u[1]), -1e-8); // the corner stays in front of both
  for (const auto& cut : {cutInGrid({2, 2, 1}), cutByMetis(4)})
    expectSameRun(reference, SolidRun(inCorner(cut)));
}

TEST(ContactNodesTest, ARowThatTwoContactsBringCountsOnce) {
  const SolidRun reference(inCorner(cutInGrid({2, 2, 1})), 1e-11); // energies err by λᵀ(c − Bu)
  scene::Scene scene = inCorner(cutInGrid({2, 2, 1}));
  scene::SurfaceContact foot = onPlane("foot", 0, "bottom", {0, -1, 0}, {0, 1, 0});
  foot.obstacle.kind = scene::Obstacle::Kind::sphere; // the corner again, and lower beside it
  foot.obstacle.radius = 1;
  scene.contacts.push_back(foot);
  const SolidRun run(scene, 1e-11);
  EXPECT_EQ(run.decomposition.problem.numInequalities, 14);
  EXPECT_EQ(run.solution.activeContactNodes, reference.solution.activeContactNodes);
  EXPECT_NEAR(run.solution.contactForce, reference.solution.contactForce, 1e-8);
  expectSameRun(reference, run);
}

/// The distance of what stays open is no measure of what is solved: held and floating, in the plane and in
/// space.
TEST(ContactNodesTest, AContactThatStaysOpenDoesNotSpoilTheOthers) {
  constexpr double tolerance = 1e-6;
  for (const int dimension : {2, 3})
    for (const bool isFloating : {false, true}) {
      SCOPED_TRACE(testing::Message() << dimension << "-D, " << (isFloating ? "floating" : "held"));
      const bool isPlane = dimension == 2;
      const Vector3 up = isPlane ? Vector3{0, 1, 0} : Vector3{0, 0, 1}, down{0, -up[1], -up[2]};
      scene::Scene scene;
      scene.bodies = {block("block", {{0, 0, 0}, {2, 1, isPlane ? 0.0 : 1.0}}, {8, 4, isPlane ? 0 : 2},
                            cutInGrid({2, 1, 1}))};
      scene.bodies[0].supports = {slide("left")};
      if (!isPlane)
        scene.bodies[0].supports.push_back(slide("front"));
      if (!isFloating)
        scene.bodies[0].supports = {{"left", "left", {0.0, 0.0, 0.0}}};
      scene.bodies[0].loads = {weight(isPlane ? Vector3{0.3, -1, 0} : Vector3{0.3, 0, -1})};
      scene.contacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, up)};
      const SolidRun alone(scene, tolerance);
      ASSERT_GT(alone.solution.contactForce, 0.1);
      for (const double gap : {1e1, 1e3, 1e6}) {
        scene::Scene both = scene;
        both.contacts.push_back(onPlane("roof", 0, "top", {0, isPlane ? 1 + gap : 0, 1 + gap}, down));
        const SolidRun run(both, tolerance);
        EXPECT_EQ(run.solver.report().status, qp::Status::converged);
        EXPECT_NEAR(run.solution.contactForce / alone.solution.contactForce, 1, 2e-4) << gap;
        EXPECT_NEAR(run.solution.energy / alone.solution.energy, 1, 2e-4) << gap;
        EXPECT_EQ(run.solution.activeContactNodes, alone.solution.activeContactNodes) << gap;
      }
    }
}

/// Where motions of bodies alone fix all forces, F between projectors is 0.
TEST(ContactNodesTest, ASingleRowThatCarriesTheLoadIsClosed) {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, cutInGrid({1, 1, 1}))};
  scene.bodies[0].supports = {slide("left")};
  scene.bodies[0].loads = {weight({0, -1, 0})};
  scene.contacts = {onPlane("dome", 0, "bottom", {0, -1, 0}, {0, 1, 0})};
  scene.contacts[0].obstacle.kind = scene::Obstacle::Kind::sphere;
  scene.contacts[0].obstacle.radius = 1;
  scene.contacts[0].distance = 0.02; // of the others there is no row
  const SolidRun run(scene);
  ASSERT_EQ(run.decomposition.problem.numInequalities, 1);
  EXPECT_EQ(run.solution.activeContactNodes, 1);
  EXPECT_NEAR(run.solution.contactForce, 1, 1e-9);
}

/// Weight in a bore or a cup that meets the lower corners, at 45° or along the diagonal of a cube.
TEST(ContactNodesTest, ABodyInAHollowStandsOnItsCorners) {
  using Kind = scene::Obstacle::Kind;
  for (const auto& [dimension, kind, corners] :
       {std::tuple(2, Kind::sphere, 2), std::tuple(3, Kind::cylinder, 4), std::tuple(3, Kind::sphere, 4)})
    for (const int order : {1, 2}) {
      SCOPED_TRACE(testing::Message() << dimension << "-D, " << corners << " corners, order " << order);
      const double half = 1, across = kind == Kind::sphere && dimension == 3 ? std::sqrt(3) : std::sqrt(2);
      const bool isPlane = dimension == 2;
      scene::Scene scene;
      scene.bodies = {block("block", {{-half, -half, isPlane ? 0 : -half}, {half, half, isPlane ? 0 : half}},
                            {2, 2, isPlane ? 0 : 2}, cutInGrid({2, 1, 1}))};
      scene.bodies[0].mesh.order = order;
      scene.bodies[0].supports = {{"guide", "top", {0.0, {}, {}}}};
      if (!isPlane)
        scene.bodies[0].supports[0].value[1] = 0.0;
      scene.bodies[0].loads = {weight(isPlane ? Vector3{0, -1, 0} : Vector3{0, 0, -1})};
      scene.contacts = {onPlane("hollow", 0, "bottom", {0, 0, 0}, {0, 1, 0})}; // the cylinder's axis: y
      scene.contacts[0].obstacle.kind = kind;
      scene.contacts[0].obstacle.radius = across;
      scene.contacts[0].obstacle.isHollow = true;
      const SolidRun run(scene);
      const double load = isPlane ? 4 : 8;
      EXPECT_NEAR(run.solution.contactForce, load * across, 1e-8 * load);
      EXPECT_EQ(run.solution.activeContactNodes,
                kind == Kind::cylinder ? (order == 1 ? 6 : 10) : corners); // all along two edges
    }
}

/// A platen, meshed finer than what it presses: forces on nodes that do not give would not be unique.
TEST(ContactNodesTest, ASideThatASupportHoldsCarriesNoMultipliers) {
  for (const int dimension : {2, 3})
    for (const int order : {1, 2})
      for (const bool isHeldFirst : {false, true}) {
        SCOPED_TRACE(testing::Message() << dimension << "-D, order " << order << ", " << isHeldFirst);
        const bool isPlane = dimension == 2;
        const auto stacked = [&](const std::string& name, double low, int elements) {
          scene::Body body = block(
              name,
              isPlane ? mesh::Box{{0, low, 0}, {2, low + 1, 0}} : mesh::Box{{0, 0, low}, {2, 1, low + 1}},
              {elements, isPlane ? 2 : elements / 2, isPlane ? 0 : 2}, cutInGrid({1, 1, 1}));
          body.mesh.order = order;
          body.supports = {slide("left")};
          if (!isPlane)
            body.supports.push_back(slide("front"));
          return body;
        };
        scene::Scene scene;
        scene.bodies = {stacked("platen", 0, 6), stacked("block", 1, 4)};
        scene.bodies[0].supports.push_back(slide("bottom", -0.01));
        scene.bodies[0].supports.push_back(slide("top", 0.01));
        scene.bodies[0].material.poissonsRatio = 0;
        scene.bodies[1].supports.push_back(slide("top"));
        scene.contacts = {isHeldFirst ? between("c", 0, "top", 1, "bottom")
                                      : between("c", 1, "bottom", 0, "top")};
        const SolidRun run(scene);
        const double nu = scene.bodies[1].material.poissonsRatio,
                     pressure = 0.01 * 200 / (isPlane ? 1 - nu * nu : 1);
        const contact::ContactLayout& layout = run.decomposition.contacts.at(0);
        EXPECT_EQ(layout.firstBody, 1);
        const std::vector<double> forces = run.forces();
        for (std::size_t row = 0; row < forces.size(); ++row)
          EXPECT_NEAR(forces[row] / layout.areas[row], pressure, 1e-7 * pressure);
      }
}

TEST(ContactNodesTest, AContactThatSaysNothingNewIsRefused) {
  scene::Scene scene = inCorner(cutInGrid({2, 2, 1}));
  scene.contacts.push_back(scene.contacts[0]);
  scene.contacts.back().name = "again";
  try {
    SolidRun run(scene);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'again'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("'floor'"), std::string::npos) << error.what();
  }
}

TEST(ContactNodesTest, APairSeenFromBothSidesIsTheSamePair) {
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    scene.bodies.push_back(block(level == 0 ? "lower" : "upper", {{0, 1.0 * level, 0}, {1, 1.0 + level, 0}},
                                 {4, 4, 0}, cutInGrid({2, 1, 1})));
    scene.bodies.back().supports = {slide("left")};
  }
  scene.bodies[0].supports.push_back(slide("bottom"));
  scene.bodies[1].loads = {weight({0, -1, 0})};
  scene.contacts = {between("joint", 0, "top", 1, "bottom"), between("again", 1, "bottom", 0, "top")};
  EXPECT_THROW(SolidRun{scene}, InputError);
}

TEST(ContactNodesTest, RedundantRowsAtANodeDoNoHarm) {
  const double s = std::sqrt(0.5);
  for (const auto& cut : {cutInGrid({1, 1, 1}), cutInGrid({2, 2, 1})}) {
    const SolidRun reference(inCorner(cut), 1e-11); // energies err by λᵀ(c − Bu), a few tolerances
    scene::Scene scene = inCorner(cut);
    scene::SurfaceContact edge = onPlane("edge", 0, "left", corner, {s, s, 0}); // meets the corner alone
    scene.contacts.push_back(edge);
    const SolidRun run(scene, 1e-11);
    EXPECT_EQ(run.decomposition.problem.numInequalities, 15);
    expectSameRun(reference, run);
  }
}

TEST(ContactNodesTest, SupportsThatHoldAContactNodeDecideItsRow) {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, cutInGrid({2, 2, 1}))};
  scene.bodies[0].supports = {slide("bottom", 0.125), slide("left")}; // moved down by ⅛
  scene.contacts = {onPlane("floor", 0, "bottom", {0, -0.25, 0}, {0, 1, 0})};
  const SolidRun run(scene); // nothing left to decide: no row has a free unknown
  EXPECT_EQ(run.solution.contactForce, 0);
  EXPECT_NEAR(run.displacement(0)[1], -0.125, 1e-12);
  scene.contacts[0].obstacle.point[1] = -0.0625;
  const Refusal refusal = refusalOf(scene);
  EXPECT_EQ(refusal.kind, SolvabilityError::Kind::noSolution);
  EXPECT_TRUE(refusal.says("overlap by 0.0625")) << refusal.text;
}

} // namespace
} // namespace epafi
