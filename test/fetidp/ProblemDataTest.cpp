/// Loads, prescribed values and gaps that change while the matrices stay, beside scenes that say the same.

#include "support/Reference.hpp"
#include "support/Refusal.hpp"
#include "support/SolidScenes.hpp"

#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::ProblemData;

/// A block on a floor, pushed aside at its left and loaded on its top, in the plane and in space.
scene::Scene pushedBlock(int dimension) {
  const bool isPlane = dimension == 2;
  scene::Scene scene;
  scene.bodies = {test::block("block", {{0, 0, 0}, {2, 1, isPlane ? 0.0 : 1.0}}, {8, 4, isPlane ? 0 : 4},
                              test::cutInGrid({2, 2, isPlane ? 1 : 2}))};
  scene::Body& block = scene.bodies.front();
  block.supports = {{"wall", "left", {0.01, 0.003, 0.0}}};
  Vector3 force{0.5, 0, 0}, point{}, up{};
  force[dimension - 1] = -1;
  point[dimension - 1] = -0.002;
  up[dimension - 1] = 1;
  block.loads = {test::weight(force)};
  scene.contacts = {test::onPlane("floor", 0, "bottom", point, up)};
  return scene;
}

scene::Scene heldMembranes() {
  scene::Scene scene = twoMembranes(true, 6, decomposition::grid(2, 2));
  setHalves(scene.bodies[0], 4.0, -5.0);
  setHalves(scene.bodies[1], -3.0, 2.0);
  scene.bodies[0].supports.front().value = {0.125};
  return scene;
}

std::vector<scene::Scene> scenes() {
  return {heldMembranes(), pushedBlock(2), pushedBlock(3)};
}

using Change = std::function<void(scene::Scene&)>;

Change loadsTimes(double factor) {
  return [factor](scene::Scene& scene) {
    for (scene::Body& body : scene.bodies)
      for (fem::SolidLoad& load : body.loads)
        for (double& component : load.value)
          component *= factor;
  };
}

Change supportsTimes(double factor) {
  return [factor](scene::Scene& scene) {
    for (scene::Body& body : scene.bodies)
      for (fem::SolidSupport& support : body.supports)
        for (auto& component : support.value)
          if (component)
            *component *= factor;
  };
}

double largest(const std::vector<Eigen::VectorXd>& values) {
  double result = 0;
  for (const Eigen::VectorXd& u : values)
    result = std::max(result, u.size() > 0 ? u.lpNorm<Eigen::Infinity>() : 0.0);
  return maxOverRanks(*world(), result);
}

void expectSame(const ContactSolution& found, const ContactSolution& expected) {
  std::vector<Eigen::VectorXd> difference;
  for (std::size_t s = 0; s < expected.displacement.size(); ++s)
    difference.emplace_back(found.displacement[s] - expected.displacement[s]);
  EXPECT_LE(largest(difference), 1e-9 * largest(expected.displacement));
  EXPECT_NEAR(found.energy, expected.energy, 1e-9 * std::abs(expected.energy));
  EXPECT_NEAR(found.contactForce, expected.contactForce, 1e-8 * std::abs(expected.contactForce));
}

TEST(ProblemDataTest, ScaledLoadsAndSupportsAreThoseOfAScaledScene) {
  for (const scene::Scene& scene : scenes()) {
    Solved solved(scene, 1e-12);
    for (const auto& [loads, supports] : {std::pair(3.0, 1.0), {1.0, -0.5}, {0.25, 2.0}, {0.0, 1.0}}) {
      SCOPED_TRACE(std::to_string(loads) + ", " + std::to_string(supports));
      scene::Scene other = scene;
      loadsTimes(loads)(other);
      supportsTimes(supports)(other);
      ProblemData data = solved.decomposition.data;
      data.scaleLoads(loads);
      data.scaleSupports(supports);
      expectSame(solved.solver.solve(data), Solved(other, 1e-12).solution);
    }
    expectSame(solved.solver.solve(solved.decomposition.data), solved.solution); // copies were changed
  }
}

/// All data times t: displacements and forces too, the energy times t².
TEST(ProblemDataTest, TheProblemIsHomogeneous) {
  constexpr double t = 7;
  for (const scene::Scene& scene : scenes()) {
    Solved solved(scene, 1e-12);
    ProblemData data = solved.decomposition.data;
    const RCP<Vector> gaps = data.contactGaps(solved.decomposition.problem);
    gaps->scale(t);
    data.setGaps(*gaps);
    data.scaleLoads(t);
    data.scaleSupports(t);
    const ContactSolution found = solved.solver.solve(data);
    EXPECT_NEAR(found.energy, t * t * solved.solution.energy,
                1e-9 * t * t * std::abs(solved.solution.energy));
    EXPECT_NEAR(found.contactForce, t * solved.solution.contactForce, 1e-8 * solved.solution.contactForce);
  }
}

TEST(ProblemDataTest, ForcesAtAllPositionsDoTheirWork) {
  for (const scene::Scene& scene : scenes()) {
    const model::Decomposition cut = decompose(scene, world());
    ProblemData data = cut.data;
    for (std::size_t s = 0; s < cut.problem.subdomains.size(); ++s) {
      const decomposition::Subdomain& subdomain = cut.problem.subdomains[s];
      const Eigen::VectorXd forces = Eigen::VectorXd::Random(cut.problem.numPositions(subdomain)),
                            u = Eigen::VectorXd::Random(subdomain.stiffness->rows());
      data.setLoad(cut.problem, s, forces);
      const decomposition::SubdomainData& own = data.subdomains()[s];
      EXPECT_NEAR(own.load.dot(u) + own.heldWork,
                  forces.dot(decomposition::atAllPositions(subdomain, u, own.prescribed)),
                  1e-12 * forces.norm() * u.norm());
      EXPECT_EQ(own.reaction, cut.data.subdomains()[s].reaction);
    }
    if (!cut.problem.subdomains.empty()) {
      test::expectSays(test::refusal([&] { data.setLoad(cut.problem, 0, Eigen::VectorXd::Zero(1)); }),
                       {"forces of 1 numbers", "subdomain 0"});
    }
  }
}

/// None, those of another problem, and those from before the rows changed.
TEST(ProblemDataTest, DataOfAnotherProblemAreRefused) {
  Solved solved(heldMembranes(), 1e-6);
  const Solved other(pushedBlock(2), 1e-6);
  scene::Scene without = heldMembranes();
  without.contacts.clear();
  const model::Decomposition fewer = decompose(without, world());
  for (const ProblemData& data : {ProblemData(), other.decomposition.data, fewer.data}) {
    test::expectSays(test::refusal([&] { solved.solver.solve(data); }), {"not those of the problem"});
    ContactSolver fresh(toleranceOf(1e-6));
    test::expectSays(test::refusal([&] { fresh.setup(solved.decomposition.problem, data); }),
                     {"not those of the problem"});
  }
  expectSame(solved.solver.solve(solved.decomposition.data), solved.solution);
}

} // namespace
} // namespace epafi::fetidp
