// What is decided does not depend on what happens to be exactly 0: not on the axes, on the place, on units,
// on the cut or on the algorithm.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

#include <cmath>
#include <optional>

namespace epafi {
namespace {

using namespace test;
using epafi::test::MeshFolder;
using epafi::test::Placement;
using Kind = SolvabilityError::Kind;

enum class Verdict { solved, noSolution, notUnique, stopped };

struct Outcome {
  Verdict verdict = Verdict::solved;
  std::string text;
  double energy = 0, equilibrium = 0;
};

Outcome outcomeOf(const scene::Scene& scene, const std::string& algorithm = "auto",
                  double tolerance = 1e-6) try {
  const auto decomposition = model::decompose(scene, Tpetra::getDefaultComm());
  ContactSolver solver(Teuchos::ParameterList().set("Algorithm", algorithm).set("Tolerance", tolerance));
  solver.setup(decomposition.problem, decomposition.data);
  const fetidp::ContactSolution solution = solver.solve(decomposition.data);
  return {solver.report().status == qp::Status::converged ? Verdict::solved : Verdict::stopped,
          solver.report().reason, solution.energy, solution.equilibrium};
} catch (const SolvabilityError& error) {
  return {error.kind() == Kind::noSolution ? Verdict::noSolution : Verdict::notUnique, error.what()};
}

/// A block of side 1 (2 × 2 elements, in space 2 × 2 × 2) at some place, in a file.
scene::Body turnedBlock(const std::string& name, int dimension, double low, const Placement& placement,
                        const MeshFolder& folder, const scene::Decomposition& cut) {
  const bool isSpace = dimension == 3;
  const mesh::StructuredMesh mesh(isSpace ? mesh::Box{{0, 0, low}, {1, 1, low + 1}}
                                          : mesh::rectangle(0, 1, low, low + 1),
                                  isSpace ? std::array{2, 2, 2} : std::array{2, 2, 0});
  scene::Body body = block(name, {}, {0, 0, isSpace ? 1 : 0}, cut);
  body.mesh = {};
  body.mesh.file = folder.write(name + ".msh", epafi::test::fileOf(arraysOf(mesh, placement, false)));
  body.mesh.order = 0;
  body.mesh.group = "body";
  return body;
}

Vector3 vectorOf(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

fem::SolidLoad pressureOn(const std::string& surface, double value) {
  return {"pressure on " + surface, fem::SolidLoad::Kind::pressure, {}, surface, {}, {value, 0, 0}};
}

const std::vector<double> angles{0, 0.3, 0.25 * M_PI, M_PI / 3, 75 * M_PI / 180, 2.0};

std::vector<scene::Decomposition> cuts() {
  std::vector<scene::Decomposition> all{cutByMetis(1), cutByMetis(3), cutByMetis(1), cutByMetis(2)};
  all[0].cluster = all[1].cluster = 0;
  all[2].cluster = all[3].cluster = 1;
  return all;
}

TEST(VerdictsTest, WhatSlidesBetweenParallelPlanesHasNoSolutionWhateverItsAngle) {
  const MeshFolder folder;
  for (const int dimension : {2, 3})
    for (const double angle : angles)
      for (const auto& cut : cuts()) {
        const Placement placement =
            epafi::test::placed(dimension, angle, {3, -2, dimension == 3 ? 1.0 : 0.0});
        scene::Scene scene;
        scene.bodies = {turnedBlock("block", dimension, 0, placement, folder, cut)};
        scene.bodies[0].supports = {slide("bottom")};
        if (dimension == 3)
          scene.bodies[0].supports.push_back(slide("front"));
        scene.bodies[0].loads = {pressureOn("right", -1e-3)};
        const Eigen::Vector3d up = placement.turn.col(dimension - 1);
        scene.contacts = {
            onPlane("ceiling", 0, "top", vectorOf(placement.of({0, 0, 0}) + up), vectorOf(-up))};
        const Outcome outcome = outcomeOf(scene);
        EXPECT_EQ(outcome.verdict, Verdict::noSolution)
            << dimension << ' ' << angle << ' ' << cut.parts << ' ' << cut.cluster << ' ' << outcome.text;
      }
}

TEST(VerdictsTest, ABodyWhoseLoadsCancelHidesNoOther) {
  const MeshFolder folder;
  std::optional<double> energy;
  for (const double angle : angles)
    for (const double unit : {1.0, 1e-9, 1e9}) {
      const Placement placement = epafi::test::placed(2, angle, {-4, 1, 0});
      scene::Scene scene;
      for (int level = 0; level < 2; ++level) {
        scene.bodies.push_back(
            turnedBlock(level == 0 ? "lower" : "upper", 2, level, placement, folder, cutByMetis(2)));
        scene.bodies.back().supports = {slide("left")};
        scene.bodies.back().material.youngsModulus = 200 * unit;
      }
      scene.bodies[0].loads = {
          pressureOn("left", unit)}; // against its own support: nothing along it but round-off
      scene.bodies[1].loads = {pressureOn("top", unit)};
      const Eigen::Vector3d up = placement.turn.col(1);
      scene.contacts = {onPlane("floor", 0, "bottom", vectorOf(placement.of({0, 0, 0})), vectorOf(up)),
                        between("joint", 0, "top", 1, "bottom")};
      const Outcome outcome = outcomeOf(scene);
      EXPECT_EQ(outcome.verdict, Verdict::solved) << angle << ' ' << unit << ' ' << outcome.text;
      energy = energy.value_or(outcome.energy / unit);
      EXPECT_NEAR(outcome.energy / unit, *energy, 1e-6 * std::abs(*energy)) << angle << ' ' << unit;
    }
}

/// A square between a floor and a circle that overlaps it, pushed to the left by its right side.
scene::Scene squeezed(double poissonsRatio) {
  scene::Scene scene;
  scene.bodies = {block("block", mesh::rectangle(0, 1, 0, 1), {4, 4, 0}, cutInGrid({1, 1, 1}))};
  scene::Body& body = scene.bodies[0];
  body.mesh.order = 2;
  body.material = {1, 1, poissonsRatio, 1};
  body.supports = {{"right", "right", {7.5e-5, std::nullopt, std::nullopt}}};
  scene.contacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}),
                    onPlane("ceiling", 0, "top", {0.7, 10.9998, 0}, {0, 0, 0})};
  scene.contacts[1].obstacle.kind = scene::Obstacle::Kind::sphere;
  scene.contacts[1].obstacle.radius = 10;
  return scene;
}

TEST(VerdictsTest, ResultantsOfRoundOffAreNoMeasure) {
  for (const double poissonsRatio : {0.0, 0.3}) {
    const Outcome outcome = outcomeOf(squeezed(poissonsRatio));
    EXPECT_EQ(outcome.verdict, Verdict::solved) << outcome.text;
    EXPECT_LE(outcome.equilibrium, 1e-6);
  }
}

TEST(VerdictsTest, ForcesWithinTheToleranceHoldNothing) {
  const MeshFolder folder;
  for (const double angle : {0.0, 0.3, 2.0})
    for (const double unit : {1.0, 1e9})
      for (const std::string algorithm : {"auto", "MPRGP"})
        for (const auto& cut : cuts()) {
          const Placement placement = epafi::test::placed(2, angle, {0, 0, 0});
          const Eigen::Vector3d up = placement.turn.col(1);
          scene::Scene scene;
          scene.bodies = {turnedBlock("block", 2, 0, placement, folder, cut)};
          scene.bodies[0].material.youngsModulus = unit;
          scene.bodies[0].supports = {slide("left")};
          scene.contacts = {onPlane("floor", 0, "bottom", vectorOf(-0.003 * up), vectorOf(up)),
                            onPlane("ceiling", 0, "top", vectorOf(1.007 * up), vectorOf(-up))};
          const Outcome outcome = outcomeOf(scene, algorithm);
          EXPECT_EQ(outcome.verdict, Verdict::notUnique)
              << angle << ' ' << unit << ' ' << algorithm << ' ' << cut.parts << ' ' << cut.cluster << ' '
              << outcome.text;
          scene.contacts[1].gap = -0.02; // now they squeeze it
          EXPECT_EQ(outcomeOf(scene, algorithm).verdict, Verdict::solved);
        }
}

/// Each node carries less than the tolerance of the whole.
TEST(VerdictsTest, SmallForcesOfManyNodesHoldABodyWhateverTheTolerance) {
  for (const int dimension : {2, 3})
    for (const double tolerance : {1.0, 0.3, 0.1})
      for (const std::string algorithm : {"auto", "MPRGP"}) {
        scene::Scene scene;
        const int n = dimension == 2 ? 32 : 8;
        scene.bodies = {block("block",
                              dimension == 2 ? mesh::rectangle(0, 1, 0, 1) : mesh::Box{{0, 0, 0}, {1, 1, 1}},
                              {n, 4, dimension == 2 ? 0 : 4}, cutByMetis(2))};
        scene.bodies[0].supports = {slide("left")};
        if (dimension == 3)
          scene.bodies[0].supports.push_back(slide("front"));
        const Vector3 up = dimension == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1};
        scene.contacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, up)};
        EXPECT_EQ(outcomeOf(scene, algorithm, tolerance).verdict, Verdict::notUnique); // without a load
        scene.bodies[0].loads = {weight({-up[0], -up[1], -up[2]})};
        const Outcome outcome = outcomeOf(scene, algorithm, tolerance);
        EXPECT_EQ(outcome.verdict, Verdict::solved) << tolerance << ' ' << algorithm << ' ' << outcome.text;
      }
}

/// Two squares, one tied onto the other; the lower one's left side is held `apart` from that of the upper
/// one.
scene::Scene tiedApart(double apart, bool floats, bool isOverlap) {
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    scene.bodies.push_back(block(level == 0 ? "lower" : "upper", mesh::rectangle(0, 1, level, level + 1),
                                 {2, 2, 0}, cutInGrid({1, 1, 1})));
    scene.bodies.back().loads = {weight({0, -1, 0})};
  }
  scene.bodies[1].supports = {slide("left")};
  scene.contacts = {between("joint", 0, "top", 1, "bottom")};
  scene.contacts[0].kind = scene::SurfaceContact::Kind::tied;
  if (isOverlap) // only the tie holds the corner that the wall pushes
    scene.contacts.push_back(onPlane("wall", 0, "left", {apart, 0, 0}, {1, 0, 0}));
  else
    scene.bodies[0].supports = {slide("left", apart)};
  if (floats)
    scene.contacts.push_back(onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}));
  else
    scene.bodies[1].supports.push_back(slide("top"));
  return scene;
}

TEST(VerdictsTest, ContradictionsThroughTiesAreProved) {
  for (const bool floats : {false, true})
    for (const bool isOverlap : {false, true})
      for (const double apart : {1e-9, 0.01, 1e9}) {
        const Outcome outcome = outcomeOf(tiedApart(apart, floats, isOverlap));
        EXPECT_EQ(outcome.verdict, Verdict::noSolution)
            << floats << ' ' << isOverlap << ' ' << apart << ' ' << outcome.text;
        EXPECT_NE(outcome.text.find("contradict"), std::string::npos) << outcome.text;
        EXPECT_NE(outcome.text.find("tied row"), std::string::npos) << outcome.text;
        if (isOverlap) {
          EXPECT_EQ(outcomeOf(tiedApart(-apart, floats, isOverlap)).verdict, Verdict::solved);
        }
      }
}

TEST(VerdictsTest, OverlapsThatBodiesCanMakeRoomForAreNoContradiction) {
  scene::Scene scene = tiedApart(0, false, false);
  scene.contacts.push_back(onPlane("wall", 0, "right", {0.99, 0, 0}, {-1, 0, 0}));
  EXPECT_EQ(outcomeOf(scene).verdict, Verdict::solved);
}

TEST(VerdictsTest, ABodyOfOnePartMayBeStiffInside) {
  std::optional<double> energy;
  for (const int parts : {1, 2, 4})
    for (const double jump : {1e-7, 1e7}) {
      scene::Scene scene;
      scene.bodies = {block("block", mesh::rectangle(0, 1, 0, 1), {8, 8, 0}, cutByMetis(parts))};
      scene::Body& body = scene.bodies[0];
      body.regions = {{"inside", {{0.3, 0.3, 0}, {0.7, 0.7, 0}}, "", body.material}};
      body.regions[0].material.youngsModulus *= jump;
      body.supports = {slide("left")};
      body.loads = {weight({0, -1, 0})};
      scene.contacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0})};
      const Outcome outcome = outcomeOf(scene);
      EXPECT_EQ(outcome.verdict, Verdict::solved) << parts << ' ' << jump << ' ' << outcome.text;
      if (jump > 1) {
        energy = energy.value_or(outcome.energy);
        EXPECT_NEAR(outcome.energy, *energy, 1e-6 * std::abs(*energy)) << parts;
      }
    }
}

} // namespace
} // namespace epafi
