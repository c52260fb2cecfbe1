#include "epafi/fetidp/solve/Plan.hpp"

#include "epafi/base/Errors.hpp"
#include "support/Refusal.hpp"

#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

using Method = DualParameters::Method;
using Type = PreconditionerParameters::Type;
using Use = AdaptiveConstraintParameters::Use;

/// Contact of elastic bodies that supports hold.
PlanFacts held() {
  PlanFacts facts;
  facts.numInequalities = 10;
  facts.numEqualities = 20;
  facts.primalDimension = 1000;
  facts.isElastic = true;
  return facts;
}

/// And of one that they do not.
PlanFacts floating() {
  PlanFacts facts = held();
  facts.kernelDimension = 3;
  facts.floatingBodies = {"cloth"};
  return facts;
}

/// Bodies that are worth a coarser mesh.
PlanFacts large(bool hasStart) {
  PlanFacts facts = held();
  facts.run.coarserFrom = 1000;
  facts.run.hasStart = hasStart;
  return facts;
}

DualParameters withoutPreconditioner() {
  DualParameters parameters;
  parameters.preconditioner.type = Type::none;
  return parameters;
}

DualParameters with(Method method) {
  DualParameters parameters;
  parameters.method = method;
  return parameters;
}

TEST(PlanTest, TheLeastAlgorithmFollowsFromTheRows) {
  PlanFacts facts;
  EXPECT_EQ(plan(facts, {}).algorithm, Algorithm::direct);
  facts.numEqualities = 5;
  EXPECT_EQ(plan(facts, {}).algorithm, Algorithm::conjugateGradient);
  facts.kernelDimension = 1; // ties hold what supports do not
  EXPECT_EQ(plan(facts, with(Method::activeSets)).algorithm, Algorithm::conjugateGradient);
  EXPECT_EQ(plan(held(), {}).algorithm, Algorithm::mprgp);
  EXPECT_EQ(plan(floating(), with(Method::mprgp)).algorithm, Algorithm::smalbe);
}

TEST(PlanTest, ActiveSetsSolveForFloatingBodiesAlone) {
  EXPECT_EQ(plan(floating(), {}).algorithm, Algorithm::activeSets);
  EXPECT_EQ(plan(floating(), withoutPreconditioner()).algorithm, Algorithm::smalbe);
  EXPECT_EQ(plan(held(), with(Method::activeSets)).algorithm, Algorithm::activeSets);
}

TEST(PlanTest, AFixedPointIsForFrictionAlone) {
  PlanFacts facts = floating();
  EXPECT_EQ(plan(facts, with(Method::fixedPoint)).algorithm, Algorithm::activeSets);
  facts.numFriction = 1;
  EXPECT_EQ(plan(facts, with(Method::fixedPoint)).algorithm, Algorithm::fixedPoint);
  EXPECT_EQ(plan(facts, {}).algorithm, Algorithm::activeSets);
}

TEST(PlanTest, LargeElasticBodiesBeginOnACoarserMesh) {
  EXPECT_TRUE(plan(large(false), {}).beginsOnCoarserMesh);
  EXPECT_TRUE(plan(large(false), with(Method::activeSets)).beginsOnCoarserMesh);
  EXPECT_FALSE(plan(large(true), {}).beginsOnCoarserMesh);
  EXPECT_FALSE(plan(large(false), with(Method::mprgp)).beginsOnCoarserMesh);
  EXPECT_FALSE(plan(large(false), withoutPreconditioner()).beginsOnCoarserMesh);
  EXPECT_FALSE(plan(held(), {}).beginsOnCoarserMesh);
  PlanFacts small = large(false), membranes = small, glued = small;
  small.primalDimension = 999;
  membranes.isElastic = false;
  glued.numInequalities = 0;
  for (const PlanFacts& facts : {small, membranes, glued})
    EXPECT_FALSE(plan(facts, {}).beginsOnCoarserMesh);
}

TEST(PlanTest, FromAGoodStartAloneActiveSetsSolveForHeldBodies) {
  EXPECT_EQ(plan(large(true), {}).algorithm, Algorithm::activeSets);
  EXPECT_EQ(plan(large(false), {}).algorithm, Algorithm::mprgp); // there is no coarser mesh
  EXPECT_EQ(plan(large(true), withoutPreconditioner()).algorithm, Algorithm::mprgp);
  EXPECT_EQ(plan(large(true), with(Method::mprgp)).algorithm, Algorithm::mprgp);
  PlanFacts small = large(true);
  small.primalDimension = 999;
  EXPECT_EQ(plan(small, {}).algorithm, Algorithm::mprgp);
}

TEST(PlanTest, ThePurposeSaysTheToleranceThatIsNotGiven) {
  const auto planFor = [](Purpose purpose, const DualParameters& parameters) {
    PlanFacts facts;
    facts.run.purpose = purpose;
    return plan(facts, parameters);
  };
  DualParameters given, balanced, fraction;
  given.tolerance = 1e-3;
  balanced.isBalanced = true;
  fraction.algebraicFraction = 0.5;
  EXPECT_EQ(planFor(Purpose::solution, {}).tolerance, 1e-6);
  EXPECT_EQ(planFor(Purpose::quantity, {}).tolerance, 1e-8);
  EXPECT_TRUE(planFor(Purpose::mesh, {}).isBalanced);
  EXPECT_EQ(planFor(Purpose::mesh, {}).algebraicFraction, 0.02);
  EXPECT_EQ(planFor(Purpose::mesh, fraction).algebraicFraction, 0.5);
  EXPECT_EQ(planFor(Purpose::mesh, balanced).algebraicFraction, 0.1);
  for (const Purpose purpose : {Purpose::solution, Purpose::quantity, Purpose::mesh}) {
    EXPECT_EQ(planFor(purpose, given).tolerance, 1e-3);
    EXPECT_FALSE(planFor(purpose, given).isBalanced);
    EXPECT_TRUE(planFor(purpose, balanced).isBalanced);
  }
  for (const DualParameters& parameters : {given, balanced}) { // other meshes' zones are off by more
    EXPECT_EQ(planFor(Purpose::start, parameters).tolerance, 1e-4);
    EXPECT_FALSE(planFor(Purpose::start, parameters).isBalanced);
  }
}

TEST(PlanTest, NothingIsBalancedWithoutAPreconditioner) {
  PlanFacts facts = held();
  EXPECT_NO_THROW(plan(facts, withoutPreconditioner()));
  facts.run.purpose = Purpose::mesh;
  test::expectSays(test::refusal([&] { plan(facts, withoutPreconditioner()); }),
                   {"balanced", "Solver/Preconditioner", "none"});
}

TEST(PlanTest, ProportioningIsEarlyWhereFacesTakeFewSteps) {
  const auto constant = [](const PlanFacts& facts, const DualParameters& parameters = {}) {
    return plan(facts, parameters).mprgp.proportioningConstant;
  };
  EXPECT_EQ(constant(held()), 0); // left to MPRGP
  PlanFacts averages = held(), corrected = held();
  averages.hasAverages = corrected.hasAverages = corrected.isCorrected = true;
  EXPECT_EQ(constant(averages), 0.1);
  EXPECT_EQ(constant(averages, withoutPreconditioner()), 0);
  EXPECT_EQ(constant(corrected), 0);
  EXPECT_EQ(constant(floating()), 0.1);
  DualParameters parameters;
  parameters.smalbe.penalty = 10;
  EXPECT_EQ(constant(floating(), parameters), 0);
  parameters.mprgp.proportioningConstant = 2;
  EXPECT_EQ(constant(averages, parameters), 2);
}

TEST(PlanTest, AQuarterOfAStepIsEnoughWithAPreconditioner) {
  DualParameters given;
  given.mprgp.sufficientShare = 0.5;
  EXPECT_EQ(plan(held(), {}).mprgp.sufficientShare, 0.25);
  EXPECT_EQ(plan(held(), withoutPreconditioner()).mprgp.sufficientShare, 0);
  EXPECT_EQ(plan(held(), given).mprgp.sufficientShare, 0.5);
}

TEST(PlanTest, AllContactIsClosedFirstWhereThePreconditionerKnowsNoBetter) {
  PlanFacts dependent = floating();
  dependent.hasDependentRows = true;
  DualParameters blind = withoutPreconditioner();
  blind.method = Method::activeSets;
  EXPECT_TRUE(plan(dependent, {}).beginsClosed);
  EXPECT_TRUE(plan(floating(), blind).beginsClosed);
  EXPECT_FALSE(plan(floating(), {}).beginsClosed);
  EXPECT_FALSE(plan(dependent, with(Method::mprgp)).beginsClosed);
}

TEST(PlanTest, FacesAreSolvedFurtherBetweenClustersOfElasticBodies) {
  const double usual = plan(held(), {}).faceReduction;
  PlanFacts clusters = floating(), membranes;
  clusters.hasClusters = true;
  membranes = clusters;
  membranes.isElastic = false;
  EXPECT_LT(plan(clusters, {}).faceReduction, usual);
  EXPECT_EQ(plan(membranes, {}).faceReduction, usual);
  EXPECT_EQ(plan(floating(), {}).faceReduction, usual);
}

TEST(PlanTest, TheNormIsEstimatedForBoundsAndBalance) {
  PlanFacts facts;
  EXPECT_FALSE(plan(facts, {}).estimatesNorm);
  facts.numEqualities = 5;
  EXPECT_FALSE(plan(facts, {}).estimatesNorm);
  DualParameters balanced;
  balanced.isBalanced = true;
  EXPECT_TRUE(plan(facts, balanced).estimatesNorm);
  EXPECT_TRUE(plan(held(), {}).estimatesNorm);
}

TEST(PlanTest, JumpsAreLookedForWhereThePreconditionerMindsThem) {
  const auto usesOf = [](Use use, const PlanFacts& facts, DualParameters parameters) {
    parameters.adaptiveConstraints.use = use;
    const Plan chosen = plan(facts, parameters);
    return std::pair(chosen.gluing.use, chosen.contact.use);
  };
  PlanFacts uniform = held();
  uniform.run.isUniform = true;
  for (const Use use : {Use::automatic, Use::yes, Use::no})
    EXPECT_EQ(usesOf(use, held(), {}), std::pair(use, use));
  EXPECT_EQ(usesOf(Use::automatic, uniform, {}), std::pair(Use::no, Use::no));
  EXPECT_EQ(usesOf(Use::yes, uniform, {}), std::pair(Use::yes, Use::yes));
  PlanFacts slipping = uniform, stepped = uniform;
  slipping.numFriction = 8;
  stepped.run.solvesAgain = true;
  for (const PlanFacts& takesMany : {slipping, stepped})
    EXPECT_EQ(usesOf(Use::automatic, takesMany, {}), std::pair(Use::automatic, Use::automatic));
  slipping.run.purpose = Purpose::mesh; // which begins on the last mesh's faces
  EXPECT_EQ(usesOf(Use::automatic, slipping, {}), std::pair(Use::no, Use::no));
  EXPECT_EQ(usesOf(Use::automatic, held(), withoutPreconditioner()), std::pair(Use::no, Use::no));
  EXPECT_EQ(usesOf(Use::yes, held(), withoutPreconditioner()), std::pair(Use::yes, Use::no));
}

TEST(PlanTest, AtContactJumpsHaveToBeLargerAndMayBeBetweenSubdomainsOfElasticBodies) {
  DualParameters parameters;
  parameters.adaptiveConstraints = {.threshold = 7, .stiffnessRatio = 3, .maxNumber = 5};
  PlanFacts membranes = held();
  membranes.isElastic = false;
  const Plan elastic = plan(held(), parameters);
  EXPECT_EQ(elastic.gluing.stiffnessRatio, 3);
  EXPECT_EQ(elastic.gluing.ratioOfLarge, 30);
  EXPECT_EQ(elastic.gluing.mostBytes, 1e9);
  EXPECT_EQ(elastic.contact.stiffnessRatio, 30);
  EXPECT_FALSE(elastic.gluing.betweenSubdomains);
  EXPECT_TRUE(elastic.contact.betweenSubdomains);
  EXPECT_FALSE(plan(membranes, parameters).contact.betweenSubdomains);
  for (const JumpSearch& search : {elastic.gluing, elastic.contact}) {
    EXPECT_EQ(search.threshold, 7);
    EXPECT_EQ(search.maxNumber, 5);
  }
}

TEST(PlanTest, EveryChoiceHasAReason) {
  EXPECT_NE(plan(floating(), {}).reasons.at("Algorithm").find("cloth"), std::string::npos);
  for (const PlanFacts& facts : {PlanFacts(), held(), floating(), large(true), large(false)})
    for (const DualParameters& parameters : {DualParameters(), withoutPreconditioner(), with(Method::mprgp)})
      for (const auto& [choice, reason] : plan(facts, parameters).reasons)
        EXPECT_FALSE(reason.empty()) << choice;
}

} // namespace
} // namespace epafi::fetidp
