#include "support/WholeRun.hpp"

#include "epafi/model/Decompose.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace epafi;

/// Two membranes whose data do not depend on y: −u₁'' = f₁ on (0,1), u₁(0) = 0; −u₂'' = f₂ on (1,2) with
/// u₂(2) = 0 (coercive) or u₂'(2) = 0 (semicoercive); contact force λ per length on x = 1. Q1 elements are
/// exact at the nodes.
struct Column {
  bool coercive;
  double f1, f2;

  double force() const { return coercive ? std::max(0.0, (f1 - f2) / 4) : -f2; }
  /// u₁ = a x − f₁x²/2 with the slope −λ at x = 1; u₂ likewise from its right end.
  double left(double x) const { return (f1 - force()) * x - 0.5 * f1 * x * x; }
  double right(double x) const {
    const double s = 2 - x;
    if (coercive)
      return (f2 + force()) * s - 0.5 * f2 * s * s;
    return left(1) - 0.5 * f2 * (s * s - 1);
  }
};

scene::Scene sceneOf(const Column& column, int elements) {
  scene::Scene scene = scene::modelProblem(column.coercive, 2, elements);
  const double loads[] = {column.f1, column.f2};
  for (std::size_t b = 0; b < 2; ++b)
    scene.bodies[b].loads = {fem::loadInside("everywhere", scene.bodies[b].mesh.box, loads[b])};
  return scene;
}

void expectExact(const Column& column, const scene::Scene& scene) {
  const simulation::SceneRun run = test::solve(scene, 1e-12);

  EXPECT_EQ(run.solver->report().status, qp::Status::converged) << run.solver->report().reason;
  EXPECT_NEAR(run.solution.contactForce, column.force(), 1e-9);
  for (int body = 0; body < 2; ++body) {
    const Eigen::VectorXd u = test::deflection(run, body);
    const auto& mesh = *run.decomposition->bodies[body].mesh;
    double error = 0;
    for (Eigen::Index node = 0; node < u.size(); ++node) {
      const double x = mesh.point(node)[0];
      error = std::max(error, std::abs(u[node] - (body == 0 ? column.left(x) : column.right(x))));
    }
    EXPECT_LE(error, 1e-9) << "body " << body << ", f1 = " << column.f1 << ", f2 = " << column.f2;
  }
}

class ClosedFormTest : public testing::TestWithParam<Column> {};

TEST_P(ClosedFormTest, IsExactAtTheNodes) {
  expectExact(GetParam(), sceneOf(GetParam(), 8));
}

TEST_P(ClosedFormTest, IsExactAtTheNodesWithMetisParts) {
  expectExact(GetParam(), test::cutByMetis(sceneOf(GetParam(), 12), 5));
}

TEST_P(ClosedFormTest, IsExactAtTheNodesWithOneSubdomainABody) {
  expectExact(GetParam(), test::cutInGrid(sceneOf(GetParam(), 6), 1));
}

INSTANTIATE_TEST_SUITE_P(Coercive, ClosedFormTest,
                         testing::Values(Column{true, -1, -3}, Column{true, -3, -1}, Column{true, 2, -2},
                                         Column{true, -1, -1}, // degenerate: neither force nor gap
                                         Column{true, 0, 0}, Column{true, 0, -1}));
INSTANTIATE_TEST_SUITE_P(Semicoercive, ClosedFormTest,
                         testing::Values(Column{false, -5, -1}, Column{false, 0, -1}, Column{false, 3, -0.25},
                                         Column{false, -1, -1}));

TEST(SmallResultantTest, ABodyThatBarelyRestsOnItsContactIsSolvedInFewOuterIterations) {
  // The load on the floating membrane nearly balances itself: the contact force is 1e-2 … 1e-7 of it.
  for (const double rest : {1e-2, 1e-4, 1e-6, 1e-7, 1e-8})
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      scene::Scene scene = scene::modelProblem(false, 4, 32);
      scene.bodies[1].loads = {fem::loadInside("down", mesh::rectangle(1, 2, 0, 0.25), -1),
                               fem::loadInside("up", mesh::rectangle(1, 2, 0.75, 1), 1 - 4 * rest)};

      const simulation::SceneRun run = test::solve(scene, tolerance);

      EXPECT_EQ(run.solver->report().status, qp::Status::converged) << run.solver->report().reason;
      EXPECT_NEAR(run.solution.contactForce, rest, 1e-12);
      EXPECT_LE(run.solver->report().counts.outer, 40) << "rest " << rest << ", tolerance " << tolerance;
    }
}

} // namespace
