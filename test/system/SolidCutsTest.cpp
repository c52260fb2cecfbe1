// Elastic contacts that are partly open: how the bodies are cut and how many ranks share them changes
// nothing.

#include "support/MeshFiles.hpp"
#include "support/OneRank.hpp"
#include "support/SolidScenes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace epafi {
namespace {

using namespace test;
using epafi::test::MeshFolder;

/// How the upper of two blocks is held: its lid pressed down, or by a plane along which it slides up and
/// down; it weighs down at the left and is pulled up at the right.
enum class Upper { held, floating };

struct Case {
  int dimension;
  Upper upper;
  bool isGmsh;
};

/// Two cubes of tetrahedra whose nodes fit at the joint.
std::string cubes() {
  return R"(SetFactory("OpenCASCADE");
Mesh.CharacteristicLengthMax = 0.4;
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {0, 0, 1, 1, 1, 1};
Periodic Surface {11} = {6} Translate {0, 0, 0};
Physical Volume("lower") = {1}; Physical Volume("upper") = {2};
Physical Surface("bottom") = {5, 11}; Physical Surface("top") = {6, 12};
Physical Surface("left") = {1, 7}; Physical Surface("front") = {3, 9};
)";
}

scene::Scene halfOpen(const Case& c, const MeshFolder& folder) {
  const bool isSpace = c.dimension == 3;
  const std::size_t up = c.dimension - 1;
  scene::Scene scene;
  for (int level = 0; level < 2; ++level) {
    const mesh::Box box = isSpace ? mesh::Box{{0, 0, 1.0 * level}, {1, 1, 1.0 + level}}
                                  : mesh::Box{{0, 1.0 * level, 0}, {1, 1.0 + level, 0}};
    scene::Body body = block(level == 0 ? "lower" : "upper", box,
                             isSpace ? std::array{4, 4, 3} : std::array{10, 10, 0}, cutByMetis(1));
    if (c.isGmsh) {
      body.mesh = {};
      body.mesh.file = level == 0 ? folder.write("cubes.geo", cubes()) : folder.path("cubes.geo");
      body.mesh.group = body.name;
    }
    scene.bodies.push_back(body);
  }
  scene::Body &lower = scene.bodies[0], &upper = scene.bodies[1];
  lower.supports = {{"floor", "bottom", {0.0, 0.0, 0.0}}};
  if (!isSpace)
    lower.supports[0].value[2].reset();
  upper.material.youngsModulus = 350;
  if (c.upper == Upper::held) {
    fem::SolidSupport lid = lower.supports[0];
    lid.surface = "top";
    lid.value[up] = -0.002;
    upper.supports = {lid};
  } else {
    upper.supports = {slide("left")};
    if (isSpace)
      upper.supports.push_back(slide("front"));
  }
  fem::SolidLoad down = weight({0, 0, 0}), lift = down;
  down.value[up] = -5;
  lift.value[up] = c.upper == Upper::held ? 8 : 4;
  lift.box.lower[0] = 0.5;
  down.box.upper[0] = 0.5;
  upper.loads = {down, lift};
  scene.contacts = {between("joint", 0, "top", 1, "bottom")};
  return scene;
}

void cutAlike(scene::Scene& scene, const scene::Decomposition& cut) {
  for (scene::Body& body : scene.bodies)
    body.decomposition = cut;
}

void expectSame(const SolidRun& run, const SolidRun& expected, double accuracy) {
  EXPECT_EQ(run.solver.report().status, qp::Status::converged) << run.solver.report().reason;
  for (int body = 0; body < 2; ++body) {
    const Eigen::VectorXd u = expected.displacement(body);
    EXPECT_LE((run.displacement(body) - u).norm(), accuracy * u.norm()) << body;
  }
  const std::vector<double> forces = run.forces(), expectedForces = expected.forces();
  ASSERT_EQ(forces.size(), expectedForces.size());
  for (std::size_t row = 0; row < forces.size(); ++row)
    EXPECT_NEAR(forces[row], expectedForces[row], accuracy * expected.solution.contactForce) << row;
  EXPECT_EQ(run.active(), expected.active());
  EXPECT_NEAR(run.solution.energy, expected.solution.energy, accuracy * std::abs(expected.solution.energy));
}

class SolidCutsTest : public testing::TestWithParam<Case> {
protected:
  MeshFolder folder_;
  scene::Scene scene_ = halfOpen(GetParam(), folder_);
};

TEST_P(SolidCutsTest, TheAnswerIsThatOfOneSubdomainABody) {
  const SolidRun whole(scene_, 1e-12, thisRankOnly());
  ASSERT_EQ(whole.solver.report().status, qp::Status::converged) << whole.solver.report().reason;
  EXPECT_EQ(whole.decomposition.problem.numEqualities, 0);
  EXPECT_EQ(whole.decomposition.problem.kernelDimension, GetParam().upper == Upper::held ? 0 : 1);
  const std::vector<double> active = whole.active();
  const auto closed = std::count(active.begin(), active.end(), 1.0);
  EXPECT_GT(closed, 3);
  EXPECT_LT(closed, static_cast<std::ptrdiff_t>(active.size()) - 3);
  std::vector<scene::Decomposition> cuts;
  for (const int parts : {1, 2, 3, 5, 8, 16, 32}) // one part a body: fewer than three or four ranks
    cuts.push_back(cutByMetis(parts));
  if (!GetParam().isGmsh) {
    cuts.push_back(cutInGrid({2, 2, GetParam().dimension == 3 ? 2 : 1}));
    cuts.push_back(cutInGrid({4, 3, 1}));
  }
  std::vector<std::pair<int, int>> clusters{{2, 1}}; // FETI and, where subdomains are large enough, hybrid
  if (GetParam().isGmsh)
    clusters.insert(clusters.end(), {{16, 4}, {16, 8}});
  else if (GetParam().dimension == 2)
    clusters.emplace_back(4, 2);
  for (const auto& [parts, size] : clusters) {
    cuts.push_back(cutByMetis(parts));
    cuts.back().cluster = size;
  }
  for (const scene::Decomposition& cut : cuts) {
    SCOPED_TRACE(testing::Message() << cut.counts[0] << '.' << cut.counts[1] << '.' << cut.counts[2] << ' '
                                    << cut.parts << ' ' << cut.cluster);
    cutAlike(scene_, cut);
    expectSame(SolidRun(scene_, 1e-12), whole, 1e-9);
  }
}

/// In the plane to the last digit; in space nodes of three subdomains and more have rows whose few terms are
/// added rank by rank.
TEST_P(SolidCutsTest, AllRanksTogetherSayWhatOneSays) {
  for (const int parts : {1, 7}) {
    cutAlike(scene_, cutByMetis(parts));
    const SolidRun alone(scene_, 1e-12, thisRankOnly()), together(scene_, 1e-12);
    expectSame(together, alone, GetParam().dimension == 2 ? 0 : 1e-11);
    if (GetParam().dimension == 3)
      continue;
    const qp::StepCounts &here = together.solver.report().counts, &there = alone.solver.report().counts;
    EXPECT_EQ(here.hessianMultiplications, there.hessianMultiplications);
    EXPECT_EQ(here.outer, there.outer);
  }
}

INSTANTIATE_TEST_SUITE_P(Blocks, SolidCutsTest,
                         testing::Values(Case{2, Upper::held, false}, Case{2, Upper::floating, false},
                                         Case{3, Upper::held, false}, Case{3, Upper::floating, false},
                                         Case{3, Upper::held, true}, Case{3, Upper::floating, true}),
                         [](const auto& instance) {
                           const Case& c = instance.param;
                           return std::string(c.isGmsh           ? "Gmsh"
                                              : c.dimension == 2 ? "Plane"
                                                                 : "Space") +
                                  (c.upper == Upper::held ? "Held" : "Floating");
                         });

} // namespace
} // namespace epafi
