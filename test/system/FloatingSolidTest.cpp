// Bodies with one, three and six rigid modes: which scenes have one solution, and what is said of the others.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace epafi {
namespace {

using namespace test;

const Vector3 origin{0, 0, 0}, upward{0, 0, 1}, upInPlane{0, 1, 0}, right{1, 0, 0};

scene::Body cube(const std::string& name, double bottom, double size = 1) {
  scene::Body body =
      block(name, {{0, 0, bottom}, {size, size, bottom + size}}, {2, 2, 2}, cutInGrid({2, 1, 1}));
  body.loads = {weight({0, 0, -1})};
  return body;
}

/// A cube that its weight presses on the plane z = 0, with some supports.
scene::Scene cubeOnPlane(const std::vector<fem::SolidSupport>& supports) {
  scene::Scene scene;
  scene.bodies = {cube("cube", 0)};
  scene.bodies[0].supports = supports;
  scene.contacts = {onPlane("floor", 0, "bottom", origin, upward)};
  return scene;
}

TEST(FloatingSolidTest, ACubeOnAPlaneSlidesAndTurns) {
  expectNotUnique(cubeOnPlane({}), {"'cube'", "slide along x", "slide along y", "turn about the axis through",
                                    "along z", "add a support"});
  expectNotUnique(cubeOnPlane({slide("left")}), {"'cube'", "slide along y"});
}

TEST(FloatingSolidTest, ACubeOnAPlaneBetweenTwoSlidingPlanesIsUnique) {
  for (const auto& cut : {cutInGrid({1, 1, 1}), cutInGrid({2, 2, 2}), cutByMetis(3)}) {
    scene::Scene scene = cubeOnPlane({slide("left"), slide("front")});
    scene.bodies[0].decomposition = cut;
    const SolidRun run(scene);
    EXPECT_EQ(run.decomposition.problem.kernelDimension, 1);
    EXPECT_EQ(run.solver.report().status, qp::Status::converged);
    EXPECT_NEAR(run.solution.contactForce, 1.0, 1e-9);
  }
}

TEST(FloatingSolidTest, AHorizontalForceMovesACubeThatOnlyStands) {
  scene::Scene scene = cubeOnPlane({slide("left")});
  scene.bodies[0].loads.push_back(weight({0, 0.25, 0}));
  expectNoSolution(scene, {"'cube'", "the load moves it", "slide along y"});
}

TEST(FloatingSolidTest, APulledBodyFliesOff) {
  scene::Scene scene = cubeOnPlane({slide("left"), slide("front")});
  scene.bodies[0].loads = {weight({0, 0, 1})};
  expectNoSolution(scene, {"'cube'", "away from its contacts", "slide along z"});
  scene.bodies[0].loads.clear();
  expectNotUnique(scene, {"'cube'", "does not press", "slide along z"});
}

/// A square on a floor, leaning against a wall at its left, with a load of 1 down at x and one against the
/// wall. Three modes, no supports.
scene::Scene leaning(double x, double unit = 1, double force = 1,
                     const scene::Decomposition& cut = cutInGrid({2, 2, 1})) {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {unit, unit, 0}}, {4, 4, 0}, cut)};
  // A force at the right and one at the left add up to 1 at x.
  scene.bodies[0].loads = {pointForce({unit, unit, 0}, {0, -x * force, 0}),
                           pointForce({0, unit, 0}, {0, -(1 - x) * force, 0}),
                           pointForce({unit, 0, 0}, {-0.5 * force, 0, 0})};
  scene.bodies[0].material.youngsModulus *= force / unit;
  scene.contacts = {onPlane("floor", 0, "bottom", origin, upInPlane),
                    onPlane("wall", 0, "left", origin, right)};
  return scene;
}

TEST(FloatingSolidTest, ALoadWithinTheBaseIsCarriedOneOutsideTipsTheBody) {
  for (const double x : {0.25, 0.75, 0.95}) {
    const SolidRun run(leaning(x));
    EXPECT_EQ(run.decomposition.problem.kernelDimension, 3);
    EXPECT_NEAR(run.solution.contactForce, 1.5, 1e-8) << x; // floor 1, wall ½
  }
  for (const double x : {1.05, 3.0})
    expectNoSolution(leaning(x), {"'square'", "away from its contacts", "turn about the point"});
}

TEST(FloatingSolidTest, ALoadExactlyOverTheEdgeIsNotUnique) {
  // The edge carries all of it; lifting the other end costs nothing.
  expectNotUnique(leaning(1), {"'square'", "does not press", "turn about the point"});
  expectNotUnique(leaning(1 + 1e-13), {"'square'", "does not press"});
  expectNotUnique(leaning(1 - 1e-13), {"'square'", "does not press"});
  EXPECT_FALSE(refusalOf(leaning(1 - 1e-4)).kind);
  EXPECT_EQ(refusalOf(leaning(1 + 1e-4)).kind, SolvabilityError::Kind::noSolution);
}

TEST(FloatingSolidTest, DecisionsDoNotDependOnUnits) {
  for (const double unit : {1e-3, 1e3})
    for (const double force : {1e-9, 1.0, 1e9}) {
      SCOPED_TRACE(testing::Message() << unit << ' ' << force);
      const SolidRun run(leaning(0.75, unit, force));
      EXPECT_EQ(run.solver.report().status, qp::Status::converged);
      EXPECT_NEAR(run.solution.contactForce / force, 1.5, 1e-8);
      EXPECT_EQ(refusalOf(leaning(1, unit, force)).kind, SolvabilityError::Kind::notUnique);
      EXPECT_EQ(refusalOf(leaning(1.05, unit, force)).kind, SolvabilityError::Kind::noSolution);
    }
}

TEST(FloatingSolidTest, ThreeStackedCubesCarryEachOther) {
  for (const bool isHeldInX : {true, false}) {
    scene::Scene scene;
    for (int level = 0; level < 3; ++level) {
      scene.bodies.push_back(cube("cube " + std::to_string(level), level));
      scene.bodies.back().supports = {slide("front")};
      if (isHeldInX || level < 2)
        scene.bodies.back().supports.push_back(slide("left"));
      scene.contacts.push_back(
          level == 0 ? onPlane("floor", 0, "bottom", origin, upward)
                     : between("joint " + std::to_string(level), level - 1, "top", level, "bottom"));
    }
    if (!isHeldInX) {
      expectNotUnique(scene, {"the floating body 'cube 2' can slide along x"});
      continue;
    }
    const SolidRun run(scene);
    EXPECT_EQ(run.decomposition.problem.kernelDimension, 3);
    EXPECT_EQ(run.solver.report().status, qp::Status::converged);
    const std::vector<double> forces = run.forces();
    for (std::size_t level = 0; level < 3; ++level) {
      const auto& contact = run.decomposition.contacts[level];
      const auto first = forces.begin() + static_cast<std::ptrdiff_t>(contact.firstRow);
      EXPECT_NEAR(std::accumulate(first, first + static_cast<std::ptrdiff_t>(contact.numRows()), 0.0),
                  3.0 - static_cast<double>(level), 1e-8);
    }
  }
}

/// A cube without load between a floor and a lid at the given distance from it.
scene::Scene cubeUnderLid(double gap) {
  scene::Scene scene = cubeOnPlane({slide("left"), slide("front")});
  scene.bodies[0].loads.clear();
  scene.contacts.push_back(onPlane("lid", 0, "top", {0, 0, 1 + gap}, {0, 0, -1}));
  return scene;
}

TEST(FloatingSolidTest, ACubeWithRoomAboveRestsAnywhere) {
  expectNotUnique(cubeUnderLid(0.25), {"'cube'", "no contact force holds", "slide along z"});
}

TEST(FloatingSolidTest, ACubeBetweenPlanesThatFitStaysWhereItIs) {
  const SolidRun run(cubeUnderLid(0));
  EXPECT_EQ(run.solver.report().status, qp::Status::converged);
  EXPECT_EQ(run.displacement(0).lpNorm<Eigen::Infinity>(), 0.0);
}

TEST(FloatingSolidTest, APressFitHoldsABodyByContactAlone) {
  scene::Scene scene = cubeUnderLid(-0.01); // free across: uniaxial stress E ε
  const SolidRun run(scene);
  EXPECT_EQ(run.solver.report().status, qp::Status::converged);
  EXPECT_NEAR(run.solution.contactForce, 2 * 200 * 0.01, 1e-7);
  const Eigen::VectorXd u = run.displacement(0);
  for (Eigen::Index node = 0; node < 9; ++node) { // in the floor's plane, then the lid's
    EXPECT_NEAR(u[3 * node + 2], 0.0, 1e-10);
    EXPECT_NEAR(u[u.size() - 1 - 3 * node], -0.01, 1e-10);
  }
}

/// A square on the top of a circle, whose top is at the origin of the square's bottom.
scene::Scene onCircle(double distance, double stiffness, double x) {
  scene::Scene scene;
  scene.bodies = {block("square", {{-0.5, 0, 0}, {0.5, 1, 0}}, {4, 4, 0}, cutInGrid({2, 1, 1}))};
  scene.bodies[0].material.youngsModulus = stiffness;
  scene.bodies[0].loads = {pointForce({x, 1, 0}, {0, -1, 0})};
  scene::SurfaceContact ball = onPlane("ball", 0, "bottom", {0, -5, 0}, upInPlane);
  ball.obstacle.kind = scene::Obstacle::Kind::sphere;
  ball.obstacle.radius = 5;
  ball.distance = distance;
  scene.contacts = {ball};
  return scene;
}

TEST(FloatingSolidTest, ABlockThatBalancesOnABallIsRefused) {
  expectNotUnique(onCircle(1e-3, 200, 0), {"'square'", "slide along x", "turn about the point"}); // one node
  expectNoSolution(onCircle(1e-3, 200, 0.5), {"'square'", "the load moves it"});
  // All normals of a ball pass through its centre.
  expectNotUnique(onCircle(std::numeric_limits<double>::infinity(), 1e6, 0),
                  {"'square'", "turn about the point (0, -5)"});
}

/// A square that its weight presses on a floor, between two walls at the given distance from it.
scene::Scene betweenWalls(double gap) {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, cutInGrid({2, 2, 1}))};
  scene.bodies[0].loads = {weight({0, -1, 0})};
  scene.contacts = {onPlane("floor", 0, "bottom", origin, upInPlane),
                    onPlane("left wall", 0, "left", {-gap, 0, 0}, right),
                    onPlane("right wall", 0, "right", {1 + gap, 0, 0}, {-1, 0, 0})};
  return scene;
}

TEST(FloatingSolidTest, WallsThatNothingPressesOnLeaveTheWayBetweenThemOpen) {
  expectNotUnique(betweenWalls(0.25), {"'square'", "no contact force holds", "free to slide along x"});
  const SolidRun tight(betweenWalls(-0.001));
  EXPECT_EQ(tight.decomposition.problem.kernelDimension, 3);
  EXPECT_EQ(tight.solver.report().status, qp::Status::converged);
  const Eigen::VectorXd u = tight.displacement(0);
  EXPECT_NEAR(u[0] + u[8], 0, 1e-9); // symmetric: the walls share what is too much
}

/// Half a ring of quadrilaterals around the origin, cut along x = 0, by its angles from −90° to 90°.
mesh::MeshArrays halfRing(int numSpokes) {
  mesh::MeshArrays arrays;
  arrays.cellType = mesh::CellType::quadrilateral;
  arrays.surfaces = {{"cut", {}}, {"rim", {}}};
  for (int i = 0; i <= numSpokes; ++i)
    for (int ring = 0; ring < 3; ++ring) {
      const double angle = (static_cast<double>(i) / numSpokes - 0.5) * M_PI, radius = 0.8 + 0.1 * ring;
      const bool isCut = i == 0 || i == numSpokes;
      arrays.points.push_back({isCut ? 0.0 : radius * std::cos(angle), radius * std::sin(angle), 0});
    }
  for (int i = 0; i < numSpokes; ++i)
    for (int ring = 0; ring < 2; ++ring) {
      const int a = 3 * i + ring;
      arrays.cells.insert(arrays.cells.end(), {a, a + 1, a + 4, a + 3});
      if (ring == 1)
        arrays.surfaces[1].nodes.insert(arrays.surfaces[1].nodes.end(), {a + 1, a + 4});
      for (const int end : {0, numSpokes})
        if (i == (end == 0 ? 0 : end - 1))
          arrays.surfaces[0].nodes.insert(arrays.surfaces[0].nodes.end(),
                                          {3 * end + ring, 3 * end + ring + 1});
    }
  return arrays;
}

/// A ring between a floor and a lid that leave it less than its height.
scene::Scene squeezedRing(const epafi::test::MeshFolder& folder, bool isCutHeld) {
  scene::Scene scene;
  scene.bodies = {block("ring", {}, {0, 0, 0}, cutByMetis(3))};
  scene.bodies[0].mesh = {};
  scene.bodies[0].mesh.file = folder.write("ring.msh", epafi::test::fileOf(halfRing(24)));
  scene.bodies[0].mesh.group = "body";
  if (isCutHeld)
    scene.bodies[0].supports = {slide("cut")};
  scene.contacts = {onPlane("floor", 0, "rim", {0, -0.99, 0}, upInPlane),
                    onPlane("lid", 0, "rim", {0, 0.99, 0}, {0, -1, 0})};
  return scene;
}

TEST(FloatingSolidTest, ARingBetweenPlatesIsSqueezedAlike) {
  const epafi::test::MeshFolder folder;
  const SolidRun run(squeezedRing(folder, true));
  EXPECT_EQ(run.decomposition.problem.kernelDimension, 1);
  EXPECT_EQ(run.solver.report().status, qp::Status::converged);
  const std::vector<double> forces = run.forces();
  const auto half = forces.begin() + static_cast<std::ptrdiff_t>(forces.size() / 2);
  const double floor = std::accumulate(forces.begin(), half, 0.0),
               lid = std::accumulate(half, forces.end(), 0.0);
  EXPECT_GT(floor, 1e-4);
  EXPECT_NEAR(floor, lid, 1e-8 * floor);
  expectNotUnique(squeezedRing(folder, false), {"'ring'", "slide along x"});
}

TEST(FloatingSolidTest, SixModesAreHeldByThreePlanesOrByTheirLoadAlone) {
  scene::Scene scene = cubeOnPlane({});
  scene.bodies[0].loads = {weight({-0.5, -0.25, -1})};
  scene.contacts.push_back(onPlane("wall", 0, "left", origin, right));
  scene.contacts.push_back(onPlane("back", 0, "front", origin, upInPlane));
  const SolidRun run(scene);
  EXPECT_EQ(run.decomposition.problem.kernelDimension, 6);
  EXPECT_EQ(run.solver.report().status, qp::Status::converged);
  EXPECT_NEAR(run.solution.contactForce, 1.75, 1e-8);
  EXPECT_LE(run.solution.feasibility, 1e-8);
  scene.bodies[0].loads = {weight({-0.5, 0.25, -1})};
  expectNoSolution(scene, {"'cube'", "away from its contacts"});
  scene.contacts.pop_back();
  expectNoSolution(scene, {"'cube'", "the load moves it"});
}

} // namespace
} // namespace epafi
