#include "support/WholeRun.hpp"

#include "epafi/scene/ModelProblem.hpp"

#include <gtest/gtest.h>

namespace {

using namespace epafi;

/// All ranks together, and each rank for itself: the same to the last digit, see AccurateSum.hpp.
void expectTheAnswerOfOneRank(const scene::Scene& scene) {
  const simulation::SceneRun alone = test::solve(scene, 1e-12, test::thisRankOnly());

  const simulation::SceneRun together = test::solve(scene, 1e-12);

  EXPECT_EQ(together.solver->report().status, qp::Status::converged);
  for (int body = 0; body < static_cast<int>(scene.bodies.size()); ++body) {
    const Eigen::VectorXd expected = test::deflection(alone, body);
    EXPECT_EQ((test::deflection(together, body) - expected).lpNorm<Eigen::Infinity>(), 0.0)
        << scene.bodies[body].name;
  }
  EXPECT_EQ(together.solution.energy, alone.solution.energy);
  const qp::StepCounts &here = together.solver->report().counts, &there = alone.solver->report().counts;
  EXPECT_EQ(here.conjugateGradient, there.conjugateGradient);
  EXPECT_EQ(here.expansion, there.expansion);
  EXPECT_EQ(here.proportioning, there.proportioning);
  EXPECT_EQ(here.outer, there.outer);
}

TEST(RanksTest, CoerciveMembranesAreTheSame) {
  expectTheAnswerOfOneRank(scene::modelProblem(true, 4, 32));
  expectTheAnswerOfOneRank(scene::modelProblem(true, 8, 64));
}

TEST(RanksTest, SemicoerciveMembranesAreTheSame) {
  expectTheAnswerOfOneRank(scene::modelProblem(false, 4, 32));
  expectTheAnswerOfOneRank(scene::modelProblem(false, 8, 64));
}

TEST(RanksTest, MetisPartsAreTheSame) {
  expectTheAnswerOfOneRank(test::cutByMetis(scene::modelProblem(true, 1, 32), 7));
  expectTheAnswerOfOneRank(test::cutByMetis(scene::modelProblem(false, 1, 32), 7));
}

TEST(RanksTest, OneSubdomainABodyIsFewerThanTheRanksAndTheSame) {
  expectTheAnswerOfOneRank(scene::modelProblem(true, 1, 16));
  expectTheAnswerOfOneRank(scene::modelProblem(false, 1, 16));
}

} // namespace
