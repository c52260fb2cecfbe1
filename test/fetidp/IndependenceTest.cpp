#include "support/Reference.hpp"

#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

/// Pressed together below, apart above.
scene::Scene cutMembranes(bool coercive, int elements, const scene::Decomposition& cut) {
  scene::Scene scene = twoMembranes(coercive, elements, cut);
  setHalves(scene.bodies[0], 4.0, -5.0);
  setHalves(scene.bodies[1], -3.0, 2.0);
  return scene;
}

/// The coordinates and the gap in another unit of length; `deflection` scales u alone.
scene::Scene rescaled(scene::Scene scene, double length, double load, double conductivity) {
  const auto scale = [length](mesh::Box& box) {
    for (std::size_t d = 0; d < 2; ++d) {
      box.lower[d] *= length;
      box.upper[d] *= length;
    }
  };
  for (scene::Body& body : scene.bodies) {
    scale(body.mesh.box);
    body.material.conductivity *= conductivity;
    for (fem::SolidRegion& region : body.regions) {
      scale(region.box);
      region.material.conductivity *= conductivity;
    }
    for (fem::SolidLoad& l : body.loads) {
      scale(l.box);
      l.value[0] *= load;
    }
  }
  return scene;
}

int steps(const Solved& solved) {
  const qp::StepCounts& counts = solved.solver.report().counts;
  return counts.conjugateGradient + counts.expansion + counts.proportioning;
}

TEST(IndependenceTest, TheSolutionDoesNotDependOnThePartition) {
  for (const bool coercive : {true, false}) {
    const Solved reference(cutMembranes(coercive, 6, grid(1, 1)));
    const Field u = fieldOf(reference.decomposition, reference.solution);
    for (const auto& cut : {grid(2, 2), grid(6, 6), grid(1, 3), metis(3), metis(7), clustered(grid(2, 2), 1),
                            clustered(grid(3, 3), 4), clustered(metis(4), 2)}) {
      SCOPED_TRACE(testing::Message()
                   << coercive << ' ' << cut.counts[0] << ' ' << cut.parts << ' ' << cut.cluster);
      const Solved solved(cutMembranes(coercive, 6, cut));
      EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), u), 1e-8);
      EXPECT_NEAR(solved.solution.energy, reference.solution.energy,
                  1e-9 * std::abs(reference.solution.energy));
      EXPECT_NEAR(solved.solution.contactForce, reference.solution.contactForce,
                  1e-8 * reference.solution.contactForce);
      EXPECT_EQ(solved.solution.activeContactNodes, reference.solution.activeContactNodes);
    }
  }
}

TEST(IndependenceTest, BodiesMayBeCutDifferently) {
  const Solved reference(cutMembranes(false, 6, grid(1, 1)));
  scene::Scene scene = cutMembranes(false, 6, grid(3, 2));
  scene.bodies[1].decomposition = metis(5);
  const Solved solved(scene);
  EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution),
                       fieldOf(reference.decomposition, reference.solution)),
            1e-8);
}

TEST(IndependenceTest, TheConductivityMayJumpAcrossAndInsideSubdomains) {
  for (const bool coercive : {true, false})
    for (const double jump : {1e-4, 1e4})
      for (const auto& cut : {grid(2, 2), metis(3)}) { // along the cut of the one, across that of the other
        SCOPED_TRACE(testing::Message() << coercive << ' ' << jump << ' ' << cut.parts);
        scene::Scene scene = cutMembranes(coercive, 4, cut);
        scene.bodies[0].regions = {{"corner", mesh::rectangle(0, 0.5, 0, 0.5), "", {jump}}};
        scene.bodies[1].regions = {{"right half", mesh::rectangle(1.5, 2, 0, 1), "", {jump}}};
        const Solved solved(scene);
        const PrimalSolution reference = solveUndecomposed(solved.decomposition);
        ASSERT_LE(reference.violation, 1e-10);
        EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
        EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-7);
      }
}

TEST(IndependenceTest, TheConductivityMayJumpFromBodyToBody) {
  for (const bool coercive : {true, false})
    for (const double jump : {1e-4, 1e4}) {
      SCOPED_TRACE(testing::Message() << coercive << ' ' << jump);
      scene::Scene scene = cutMembranes(coercive, 4, grid(2, 2));
      scene.bodies[1].material.conductivity = jump;
      const Solved solved(scene);
      const PrimalSolution reference = solveUndecomposed(solved.decomposition);
      ASSERT_LE(reference.violation, 1e-10);
      EXPECT_EQ(solved.solver.report().status, qp::Status::converged);
      EXPECT_LE(fieldError(fieldOf(solved.decomposition, solved.solution), reference.field), 1e-7);
    }
}

/// Solves in two systems of units; u in the second is `factor` times u in the first.
void expectScaled(const scene::Scene& first, const scene::Scene& second, double factor) {
  const Solved a(first), b(second);
  EXPECT_EQ(b.solver.report().status, qp::Status::converged);
  EXPECT_NEAR(steps(b), steps(a), 1);
  EXPECT_NEAR(b.solver.report().counts.outer, a.solver.report().counts.outer, 1);
  Field expected = fieldOf(a.decomposition, a.solution);
  for (Eigen::VectorXd& u : expected)
    u *= factor;
  EXPECT_LE(fieldError(fieldOf(b.decomposition, b.solution), expected), 1e-8);
  EXPECT_EQ(b.solution.activeContactNodes, a.solution.activeContactNodes);
  EXPECT_GT(a.solution.activeContactNodes, 0);
  EXPECT_LE(b.solution.feasibility, 1e-9);
}

TEST(IndependenceTest, TheSolutionScalesWithTheUnits) {
  for (const bool coercive : {true, false})
    for (const auto& cut : {grid(1, 1), grid(2, 2)}) {
      const scene::Scene scene = cutMembranes(coercive, 4, cut);
      for (const double unit : {1e-9, 1e9}) {
        SCOPED_TRACE(testing::Message() << coercive << ' ' << cut.counts[0] << ' ' << unit);
        expectScaled(scene, rescaled(scene, 1, unit, 1), unit);
        expectScaled(scene, rescaled(scene, 1, 1, unit), 1 / unit);
        expectScaled(scene, rescaled(scene, 1, unit, unit), 1);
      }
      for (const double unit : {1e-6, 1e6}) {
        SCOPED_TRACE(testing::Message() << coercive << ' ' << cut.counts[0] << ' ' << unit);
        expectScaled(scene, rescaled(scene, unit, 1, 1), unit * unit);
      }
    }
}

TEST(IndependenceTest, GapsScaleWithTheUnits) {
  for (const bool coercive : {true, false})
    for (const double unit : {1e-9, 1e9}) {
      SCOPED_TRACE(testing::Message() << coercive << ' ' << unit);
      scene::Scene scene = cutMembranes(coercive, 4, grid(2, 2));
      scene.contacts.front().gap = 0.02;
      scene::Scene other = rescaled(scene, 1, unit, 1);
      other.contacts.front().gap = 0.02 * unit;
      expectScaled(scene, other, unit);
    }
}

} // namespace
} // namespace epafi::fetidp
