// Scenes turned by any angle and moved far away have turned solutions.

#include "support/MeshFiles.hpp"
#include "support/SolidScenes.hpp"
#include "support/TurnedMesh.hpp"

#include "epafi/mesh/MeshOrder.hpp"

#include <cmath>

namespace epafi {
namespace {

using namespace test;
using epafi::test::MeshFolder;
using epafi::test::Placement;

struct TurnedCase {
  int dimension;
  bool simplices, coercive;
  int parts;
  int order = 1;
};

/// Two blocks in files, one on the other, all supports along normals; a load that is not symmetric.
scene::Scene stack(const TurnedCase& c, const Placement& placement, const MeshFolder& folder) {
  const bool isSpace = c.dimension == 3;
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    const double low = level, high = 1.0 + level;
    const mesh::StructuredMesh mesh(isSpace ? mesh::Box{{0, 0, low}, {1, 1.5, high}}
                                            : mesh::rectangle(0, 1.5, low, high),
                                    isSpace ? std::array{3, 3, 2} : std::array{6, 4, 0});
    mesh::MeshArrays arrays = arraysOf(mesh, placement, c.simplices);
    if (c.order == 2) {
      arrays = completed(std::move(arrays), false);
      for (std::size_t node = 0; node < arrays.nodeTags.size(); ++node)
        arrays.nodeTags[node] = static_cast<GlobalOrdinal>(node) + 1;
    }
    const std::string name = level == 0 ? "lower" : "upper";
    scene::Body body = block(name, {}, {0, 0, isSpace ? 1 : 0}, cutByMetis(c.parts));
    body.mesh = {};
    body.mesh.file = folder.write(name + ".msh", epafi::test::fileOf(arrays));
    body.mesh.order = 0;
    body.mesh.group = "body";
    body.supports = {slide("left")};
    if (isSpace)
      body.supports.push_back(slide("front"));
    if (level == 0)
      body.supports.push_back(slide("bottom"));
    scene.bodies.push_back(body);
  }
  scene::Body& upper = scene.bodies[1];
  if (c.coercive)
    upper.supports.push_back(slide("top", -0.02));
  const Eigen::Vector3d force =
      placement.turn * (isSpace ? Eigen::Vector3d(0.25, 0.5, -1) : Eigen::Vector3d(0.25, -1, 0));
  upper.loads = {weight({force[0], force[1], force[2]})};
  upper.loads.push_back({"press", fem::SolidLoad::Kind::pressure, {}, "right", {}, {0.3, 0, 0}});
  scene.contacts = {between("joint", 0, "top", 1, "bottom")};
  return scene;
}

class TurnedSolidTest : public testing::TestWithParam<TurnedCase> {};

TEST_P(TurnedSolidTest, TurnsItsSolution) {
  const TurnedCase& c = GetParam();
  const MeshFolder folder, turnedFolder;
  const SolidRun straight(stack(c, {}, folder), 1e-12);
  ASSERT_EQ(straight.solver.report().status, qp::Status::converged) << straight.solver.report().reason;
  EXPECT_EQ(straight.decomposition.problem.kernelDimension, c.coercive ? 0 : 1);
  EXPECT_GT(straight.solution.contactForce, 0.1);
  for (const double angle : {0.3, 2.0}) {
    const Placement placement =
        epafi::test::placed(c.dimension, angle, {12, -9, c.dimension == 3 ? 10.0 : 0.0});
    const SolidRun turned(stack(c, placement, turnedFolder), 1e-12);
    ASSERT_EQ(turned.solver.report().status, qp::Status::converged) << turned.solver.report().reason;
    EXPECT_EQ(turned.decomposition.problem.kernelDimension, c.coercive ? 0 : 1);
    const Eigen::MatrixXd q = placement.turn.topLeftCorner(c.dimension, c.dimension);
    for (int body = 0; body < 2; ++body) {
      const Eigen::VectorXd u = straight.displacement(body), v = turned.displacement(body);
      const Eigen::MatrixXd expected = q * u.reshaped(c.dimension, u.size() / c.dimension);
      EXPECT_LE((v - expected.reshaped()).norm(), 1e-9 * u.norm()) << angle;
    }
    EXPECT_NEAR(turned.solution.energy, straight.solution.energy, 1e-9 * std::abs(straight.solution.energy));
    const std::vector<double> forces = straight.forces(), turnedForces = turned.forces();
    ASSERT_EQ(forces.size(), turnedForces.size());
    for (std::size_t row = 0; row < forces.size(); ++row)
      EXPECT_NEAR(turnedForces[row], forces[row], 1e-9 * straight.solution.contactForce) << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Stacks, TurnedSolidTest,
                         testing::Values(TurnedCase{2, false, true, 3}, TurnedCase{2, true, true, 5},
                                         TurnedCase{2, true, false, 3}, TurnedCase{2, false, false, 5},
                                         TurnedCase{3, false, true, 3}, TurnedCase{3, true, false, 4},
                                         TurnedCase{2, true, false, 3, 2}, TurnedCase{2, false, true, 3, 2},
                                         TurnedCase{3, false, false, 3, 2}, TurnedCase{3, true, false, 4, 2}),
                         [](const auto& instance) {
                           const TurnedCase& c = instance.param;
                           return std::string(c.dimension == 2 ? "Plane" : "Space") +
                                  (c.simplices ? "Simplices" : "Cubes") + (c.coercive ? "Held" : "Floating") +
                                  std::to_string(c.order);
                         });

TEST(TurnedContactTest, TheCutOfATurnedSceneDoesNotMatter) {
  const Placement placement = epafi::test::placed(3, 0.8, {4, 7, -3});
  const MeshFolder folder;
  const SolidRun whole(stack({3, false, false, 1}, placement, folder), 1e-12),
      cut(stack({3, false, false, 9}, placement, folder), 1e-12);
  ASSERT_EQ(whole.solver.report().status, qp::Status::converged);
  ASSERT_EQ(cut.solver.report().status, qp::Status::converged);
  double sharedFrames = 0; // of nodes that several subdomains have: copies beyond those of the whole
  for (const auto* run : {&whole, &cut})
    for (const auto& subdomain : run->decomposition.problem.subdomains)
      sharedFrames += (run == &cut ? 1.0 : -1.0) * static_cast<double>(subdomain.frames.size());
  EXPECT_GT(sumOverRanks(*cut.decomposition.problem.comm, sharedFrames), 10);
  for (int body = 0; body < 2; ++body) {
    const Eigen::VectorXd u = whole.displacement(body);
    EXPECT_LE((cut.displacement(body) - u).norm(), 1e-8 * u.norm());
  }
  EXPECT_NEAR(cut.solution.energy, whole.solution.energy, 1e-10 * std::abs(whole.solution.energy));
}

TEST(TurnedContactTest, AFloatingBlockOnATurnedPlaneKeepsItsModes) {
  for (const int dimension : {2, 3}) {
    const Placement placement = epafi::test::placed(dimension, 0.8, {20, 7, dimension == 3 ? -3.0 : 0.0});
    const MeshFolder folder;
    const TurnedCase c{dimension, true, false, 3};
    scene::Scene scene = stack(c, placement, folder);
    scene.bodies.erase(scene.bodies.begin()); // the upper one on an obstacle in the lower one's place
    const Eigen::Vector3d up = placement.turn.col(dimension - 1),
                          point = placement.of(dimension == 3 ? Point{0, 0, 1} : Point{0, 1, 0});
    scene.contacts = {onPlane("floor", 0, "bottom", {point[0], point[1], point[2]}, {up[0], up[1], up[2]})};
    const SolidRun run(scene);
    EXPECT_EQ(run.decomposition.problem.kernelDimension, 1);
    EXPECT_NEAR(run.solution.contactForce, 1.5, 1e-8); // the weight's part across the plane
    scene.bodies[0].supports.clear();
    const Refusal refusal = refusalOf(scene);
    EXPECT_EQ(refusal.kind, SolvabilityError::Kind::noSolution); // it slides down the slope
    EXPECT_TRUE(refusal.says("'upper'") && refusal.says("the load moves it")) << refusal.text;
  }
}

} // namespace
} // namespace epafi
