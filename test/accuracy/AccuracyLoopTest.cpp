// Mesh after mesh until an error is small enough, of problems whose errors are known.

#include "epafi/accuracy/AccuracyLoop.hpp"

#include "KnownErrors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace epafi::accuracy {
namespace {

using test::Corner;
using test::Patches;
using test::Peak;

double sumOfUnknowns(const LoopResult& result) {
  double sum = 0;
  for (const MeshResult& mesh : result.meshes)
    sum += static_cast<double>(mesh.unknowns);
  return sum;
}

bool says(const LoopResult& result, const std::string& part) {
  return result.reason.find(part) != std::string::npos;
}

/// At least 2.5 times smaller than the first mesh's, which is 0.25 and 0.0625.
TEST(AccuracyLoopTest, ReachesTheTargetOfASmoothSolutionWithLittleMoreThanItsLastMesh) {
  for (const int dimension : {2, 3})
    for (const int order : {1, 2})
      for (const double target : {0.025, 0.01, 0.004, 0.001}) {
        Patches problem(dimension);
        const LoopResult result = refineToTarget(problem, {.target = target, .order = order});
        EXPECT_TRUE(result.isMet);
        EXPECT_EQ(result.reason, "");
        EXPECT_EQ(result.choice, "");
        EXPECT_LE(problem.errors.back(), target);
        EXPECT_GE(problem.errors.back(), 0.8 * target); // no more than was asked for
        EXPECT_LE(sumOfUnknowns(result), 1.6 * static_cast<double>(result.meshes.back().unknowns));
        for (std::size_t m = 0; m < result.meshes.size(); ++m) {
          EXPECT_NEAR(result.meshes[m].relative(), problem.errors[m], 1e-12);
          EXPECT_NEAR(result.meshes[m].effectivity, 1, 1e-9);
          EXPECT_EQ(result.meshes[m].order, order);
        }
      }
}

TEST(AccuracyLoopTest, ANumberThatGrowsByTheSamePowerFromMeshToMeshIsGivenUp) {
  for (const double power : {0.2, 0.5}) {
    Peak sharp(power, 0), round(power, 0.3);
    const LoopGoal goal{.maxMeshes = 6, .order = 1};
    const LoopResult endless = refineToTarget(sharp, goal), ended = refineToTarget(round, goal);
    EXPECT_TRUE(endless.isEndless);
    EXPECT_TRUE(says(endless, "grows with every mesh, from ")) << endless.reason;
    EXPECT_EQ(endless.meshes.size(), 3U);
    EXPECT_FALSE(ended.isEndless) << ended.reason;
  }
}

TEST(AccuracyLoopTest, AMeshThatIsGoodEnoughIsNotRefined) {
  Patches problem;
  const LoopResult result = refineToTarget(problem, {.target = 0.26, .order = 1});
  EXPECT_TRUE(result.isMet);
  EXPECT_EQ(result.meshes.size(), 1U);
  EXPECT_TRUE(problem.goals.empty());
}

TEST(AccuracyLoopTest, TellsOfEveryMeshAndKeepsTheElementsOfTheLastAlone) {
  Patches problem;
  std::vector<double> told;
  const LoopResult result = refineToTarget(problem, {.target = 0.02, .order = 1},
                                           [&](const MeshResult& mesh) { told.push_back(mesh.relative()); });
  ASSERT_GT(result.meshes.size(), 2U);
  ASSERT_EQ(told.size(), result.meshes.size());
  for (std::size_t m = 0; m < told.size(); ++m) {
    EXPECT_EQ(told[m], result.meshes[m].relative());
    const bool isLast = m + 1 == told.size();
    EXPECT_EQ(result.meshes[m].elements.squared.size(), isLast ? 16U : 0U);
    EXPECT_EQ(result.meshes[m].elements.orders.size(), isLast ? 16U : 0U);
  }
}

/// The error of a quantity is the square of the solution's; estimates are wrong by a factor that the meshes
/// tell.
TEST(AccuracyLoopTest, ReachesATargetOfAQuantity) {
  for (const int order : {1, 2})
    for (const double estimateByError : {1.0, 0.7})
      for (const double target : {0.02, 0.001, 1e-5}) {
        Patches problem;
        problem.hasQuantity = true;
        problem.estimateByError = estimateByError;
        problem.believed = estimateByError;
        const LoopResult result = refineToTarget(problem, {.target = target, .order = order});
        EXPECT_TRUE(result.isMet) << result.reason;
        ASSERT_GT(result.meshes.size(), 1U);
        const MeshResult& last = result.meshes.back();
        const double error = 1 - last.quantity->value; // of 1
        EXPECT_LE(error, target);
        EXPECT_GE(last.quantity->discretisation, (1 - 1e-9) * error);
        EXPECT_LE(last.quantity->discretisation, 5 * error);
        EXPECT_NEAR(last.relative(), last.quantity->discretisation / last.quantity->value, 1e-12);
      }
}

/// Such as a displacement that supports prescribe: no element adds to its bar.
TEST(AccuracyLoopTest, AQuantityWithoutErrorNeedsNoOtherMesh) {
  Patches problem;
  problem.hasQuantity = true;
  problem.estimateByError = 0;
  const LoopResult result = refineToTarget(problem, {.target = 0.01});
  EXPECT_TRUE(result.isMet && result.meshes.size() == 1U) << result.reason;
}

/// The estimate is a tenth of the error: the change tells.
TEST(AccuracyLoopTest, ABarIsNoSmallerThanTheLastChangeLetsExpect) {
  Patches problem;
  problem.hasQuantity = true;
  problem.knowsChange = false;
  problem.estimateByError = std::sqrt(0.1);
  const LoopResult result = refineToTarget(problem, {.target = 0.004, .maxMeshes = 2, .order = 1});
  ASSERT_EQ(result.meshes.size(), 2U);
  const double error = 1 - result.meshes.back().quantity->value;
  EXPECT_GE(result.meshes.back().quantity->discretisation, error);
  EXPECT_LE(result.meshes.back().quantity->discretisation, 2.5 * error);
}

/// On its way to 1 a number comes nearer by 0.7 from mesh to mesh, and each bar is a third of the last one.
TEST(AccuracyLoopTest, ABarIsNoSmallerThanChangesThatGoOneWayLetExpect) {
  for (const int order : {0, 1, 2}) {
    test::Drift problem(0.7);
    const LoopResult result = refineToTarget(problem, {.target = 0.05, .order = order});
    EXPECT_TRUE(result.isMet) << result.reason;
    const MeshResult::Quantity& found = *result.meshes.back().quantity;
    EXPECT_GT(result.meshes.size(), 3U);
    EXPECT_EQ((result.meshes.end() - 2)->order, result.meshes.back().order);
    EXPECT_GE(found.discretisation, (1 - 1e-9) * (found.value - 1));
  }
}

/// One per cent less than the last mesh took, and one more.
TEST(AccuracyLoopTest, StopsBeforeAMeshThatPassesALimitAndSaysWhichOne) {
  constexpr double target = 0.004;
  constexpr int alike = 1; // so that it is known how many unknowns a mesh will have
  Patches unlimited(2, alike);
  const LoopResult whole = refineToTarget(unlimited, {.target = target, .order = 1});
  ASSERT_GT(whole.meshes.size(), 2U);
  const MeshResult& last = whole.meshes.back();
  double seconds = 0;
  for (const MeshResult& mesh : whole.meshes)
    seconds += mesh.seconds;
  for (const double share : {0.99, 1.01}) {
    LoopGoal unknowns{.target = target, .order = 1}, time = unknowns, memory = unknowns, meshes = unknowns;
    unknowns.maxUnknowns = share * static_cast<double>(last.unknowns);
    time.maxSeconds = share * seconds;
    memory.maxBytes = share * last.bytes;
    meshes.maxMeshes = static_cast<int>(whole.meshes.size()) - (share < 1 ? 1 : 0);
    for (const auto& [goal, word] :
         {std::pair{unknowns, "unknowns"}, {time, " s "}, {memory, "GB of memory"}, {meshes, "meshes are"}}) {
      Patches problem(2, alike);
      const LoopResult result = refineToTarget(problem, goal);
      SCOPED_TRACE(result.reason);
      EXPECT_EQ(result.isMet, share > 1);
      EXPECT_EQ(result.meshes.size(), whole.meshes.size() - (share < 1 ? 1 : 0));
      EXPECT_EQ(says(result, word), share < 1);
      EXPECT_EQ(result.reason.empty(), share > 1);
      EXPECT_EQ(problem.errors.size(), result.meshes.size()); // nothing was solved in vain
    }
  }
}

TEST(AccuracyLoopTest, AnIterationThatFailsEndsIt) {
  for (const std::size_t failing : {0U, 1U})
    for (const int order : {0, 1}) {
      Patches problem;
      problem.failing = failing;
      const LoopResult result = refineToTarget(problem, {.target = 0.001, .order = order});
      EXPECT_FALSE(result.isMet);
      EXPECT_EQ(result.meshes.size(), failing + 1);
      EXPECT_TRUE(says(result, "it stagnated")) << result.reason;
    }
  Patches accurate; // whatever its error
  accurate.failing = 0;
  EXPECT_FALSE(refineToTarget(accurate, {.target = 0.5, .order = 1}).isMet);
}

TEST(AccuracyLoopTest, BothErrorsCount) {
  MeshResult mesh;
  EXPECT_EQ(mesh.relative(), 0); // nothing is loaded
  mesh.energyNorm = 12;
  mesh.discretisation = 3;
  mesh.algebraic = 4;
  EXPECT_NEAR(mesh.relative(), 5.0 / 13, 1e-15);
  Patches problem;
  problem.algebraic = 0.2;
  const LoopResult result = refineToTarget(problem, {.target = 0.26, .maxMeshes = 1, .order = 1});
  EXPECT_FALSE(result.isMet);
  EXPECT_NEAR(result.meshes[0].relative(), std::hypot(0.25, 0.2) / std::hypot(1, 0.2), 1e-12);
}

/// θ² = (η_{k−1}² − η_k²) / ‖u_k − u_{k−1}‖²
TEST(AccuracyLoopTest, AnEstimatorThatIsWrongIsMeasuredAndCorrected) {
  for (const double truth : {0.45, 0.6, 0.8, 1.05})
    for (const double believed : {1.0, 0.75})
      for (const int order : {1, 2}) {
        Patches problem;
        problem.estimateByError = truth;
        problem.believed = believed;
        constexpr double target = 0.01;
        const LoopResult result = refineToTarget(problem, {.target = target, .order = order});
        EXPECT_TRUE(result.isMet);
        EXPECT_LE(problem.errors.back(), target * (1 + 1e-9));
        EXPECT_NEAR(result.meshes[0].effectivity, believed, 1e-15);
        ASSERT_GT(result.meshes.size(), 1U);
        for (std::size_t m = 1; m < result.meshes.size(); ++m) {
          EXPECT_NEAR(result.meshes[m].effectivity, truth, 1e-9);
          EXPECT_NEAR(result.meshes[m].discretisation, problem.errors[m], 1e-9 * problem.errors[m]);
        }
        // The goal is one of the estimate: it was told what it makes of an error.
        const std::size_t next = problem.goals.size() - 1;
        EXPECT_LE(problem.goals[next].error, 1.05 * result.meshes[next].effectivity * 0.9 * target);
      }
}

TEST(AccuracyLoopTest, AMeasuredEffectivityStaysWithinWhatAnEstimatorCanBe) {
  for (const auto& [truth, taken] : {std::pair{0.1, 0.4}, {3.0, 1.1}}) {
    Patches problem;
    problem.estimateByError = truth;
    const LoopResult result = refineToTarget(problem, {.target = 0.01, .order = 1});
    ASSERT_GT(result.meshes.size(), 1U);
    EXPECT_EQ(result.meshes[1].effectivity, taken);
  }
}

TEST(AccuracyLoopTest, WhereMeshesDoNotTellTheEffectivityIsAsBefore) {
  Patches blind;
  blind.knowsChange = false;
  blind.estimateByError = 0.6;
  blind.believed = 0.8;
  for (const MeshResult& mesh : refineToTarget(blind, {.target = 0.01, .order = 1}).meshes)
    EXPECT_EQ(mesh.effectivity, 0.8);
  Patches near; // a little finer is enough: the estimates hardly differ
  near.estimateByError = 0.6;
  near.believed = 0.8;
  const LoopResult result = refineToTarget(near, {.target = 0.24 * 0.6 / 0.8, .order = 1});
  ASSERT_EQ(result.meshes.size(), 2U);
  EXPECT_EQ(result.meshes[1].effectivity, 0.8);
}

TEST(AccuracyLoopTest, OrderOneStaysWhereItIsEnough) {
  for (const int dimension : {2, 3}) {
    Patches met(dimension), near(dimension);
    const LoopResult first = refineToTarget(met, {.target = 0.3});
    EXPECT_TRUE(first.isMet);
    EXPECT_EQ(first.meshes.size(), 1U);
    EXPECT_NE(first.choice.find("no more error than is allowed"), std::string::npos) << first.choice;
    const LoopResult second =
        refineToTarget(near, {.target = 0.13}); // half the error: as many unknowns as order 2
    EXPECT_TRUE(second.isMet);
    EXPECT_NE(second.choice.find("order 1 needs"), std::string::npos) << second.choice;
    for (const MeshResult& mesh : second.meshes)
      EXPECT_EQ(mesh.order, 1);
  }
}

TEST(AccuracyLoopTest, OrderTwoIsTakenWhereOrderOneWouldNeedMoreUnknownsThanItHasOnTheFirstMesh) {
  for (const int dimension : {2, 3}) {
    Patches problem(dimension);
    const LoopResult result = refineToTarget(problem, {.target = 0.12});
    EXPECT_TRUE(result.isMet);
    EXPECT_NE(result.choice.find("order 1 would need"), std::string::npos) << result.choice;
    ASSERT_EQ(result.meshes.size(), 2U);
    EXPECT_EQ(result.meshes[0].order, 1);
    EXPECT_EQ(result.meshes[1].order, 2);
    EXPECT_EQ(result.meshes[1].effectivity, 1); // meshes of two orders tell nothing
    Patches finer(dimension);
    const LoopResult fine = refineToTarget(finer, {.target = 0.001});
    EXPECT_TRUE(fine.isMet);
    for (std::size_t m = 1; m < fine.meshes.size(); ++m)
      EXPECT_EQ(fine.meshes[m].order, 2);
    for (const double order : fine.meshes.back().elements.orders)
      EXPECT_EQ(order, 2);
  }
}

TEST(AccuracyLoopTest, LimitsHoldForTheFirstMeshWithOrderTwoToo) {
  Patches few, small;
  EXPECT_EQ(refineToTarget(few, {.target = 0.001, .maxMeshes = 1}).meshes.size(), 1U);
  const LoopResult result =
      refineToTarget(small, {.target = 0.001, .maxUnknowns = 20000}); // 16000, then 64000
  for (const MeshResult& mesh : result.meshes)
    EXPECT_LE(mesh.unknowns, 20000);
}

/// The mesh is fine enough, the iteration is not: the same mesh once more does not help.
TEST(AccuracyLoopTest, NoMeshIsSolvedOnAgainAndAgain) {
  Patches problem;
  problem.algebraic = 0.3;
  const LoopResult result = refineToTarget(problem, {.target = 0.28, .order = 1});
  EXPECT_FALSE(result.isMet);
  EXPECT_LE(result.meshes.size(), 2U);
}

/// 0.9 of the target is the mesh's; if that was missed by a factor the next is asked for as much more, within
/// reason.
TEST(AccuracyLoopTest, AimsFurtherAfterAMiss) {
  for (const auto& [surprise, more] : {std::pair{1.0, 1.0}, {1.1, 1.1}, {1.3, 1.15}, {2.0, 1.15}}) {
    Patches problem;
    problem.surprise = surprise;
    constexpr double target = 0.01;
    const LoopResult result = refineToTarget(problem, {.target = target, .order = 1});
    EXPECT_TRUE(result.isMet);
    ASSERT_GT(problem.goals.size(), 1U);
    EXPECT_NEAR(problem.goals[0].error, 0.9 * target, 1e-12);
    EXPECT_NEAR(problem.goals[1].error, 0.9 * target / more, 1e-9);
  }
}

TEST(AccuracyLoopTest, AProblemMayBeRefinedAlikeEverywhere) {
  class Even final : public Patches {
  public:
    [[nodiscard]] WantedSizes plan(const MeshResult& /*result*/, const RefinementGoal& goal) const override {
      return {{}, std::exp2(goal.dimension)};
    }
    std::vector<LocalOrdinal> refine(const WantedSizes& /*wanted*/) override {
      Patches::refine({std::vector<double>(16, 1.0)});
      return {};
    }
  };
  Even problem;
  const LoopResult result = refineToTarget(problem, {.target = 0.02, .order = 1});
  EXPECT_TRUE(result.isMet);
  EXPECT_EQ(result.meshes.size(), 5U); // 1/4, 1/8, 1/16, 1/32, 1/64
}

/// Halved alike everywhere, η falls like h^α: N has to grow by the factor (η/target)^(2/α).
TEST(AccuracyLoopTest, ASingularityIsFoundAndRefinedTowards) {
  for (const int order : {1, 2}) {
    constexpr double target = 0.05;
    Corner problem;
    const LoopResult result = refineToTarget(problem, {.target = target, .order = order});
    EXPECT_TRUE(result.isMet) << result.reason;
    const MeshResult &first = result.meshes.front(), &last = result.meshes.back();
    const double even =
        static_cast<double>(first.unknowns) * std::pow(first.relative() / target, 2 / Corner::alpha);
    EXPECT_LT(static_cast<double>(last.unknowns), 0.05 * even);
    double most = 0;
    for (std::size_t e = 0; e < problem.elements.size(); ++e) {
      if (problem.elements[e].x == 0 && problem.elements[e].y == 0) {
        EXPECT_NEAR(last.elements.orders[e], Corner::alpha, 0.15);
      }
      most = std::max(most, last.elements.orders[e]);
    }
    EXPECT_NEAR(most, order, 0.05);
  }
}

} // namespace
} // namespace epafi::accuracy
