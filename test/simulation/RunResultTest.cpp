// What a run tells: the report's contract, and starts that fail.

#include "support/SolidScenes.hpp"

#include "epafi/scene/ModelProblem.hpp"
#include "epafi/simulation/AccurateRun.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace epafi::simulation {
namespace {

const std::vector<std::pair<std::string, std::vector<std::string>>> contract{
    {"Epafi", {"Version"}},
    {"Problem",
     {"Title", "Primal Dimension", "Dual Dimension", "Equality Multipliers", "Inequality Multipliers",
      "Crosspoints", "Subdomains", "Floating Bodies", "Kernel Dimension", "Ranks"}},
    {"Algorithm", {"Name", "Reason", "Preconditioner", "Dual Operator"}},
    {"Plan", {"Algorithm", "Active Sets", "Tolerance", "Adaptive Constraints"}},
    {"Iterations",
     {"Outer", "CG Steps", "Expansion Steps", "Proportioning Steps", "Hessian Multiplications",
      "Preconditioner Applications"}},
    {"Accuracy",
     {"Relative Projected Gradient", "Feasibility", "Complementarity", "Equilibrium", "Energy",
      "Active Contact Nodes", "Contact Force"}},
    {"Time", {"Assembly", "Setup", "Solve", "Recovery"}},
    {"Memory", {"Peak Bytes", "Factor Bytes"}},
    {"Status", {"Converged", "Status", "Reason"}}};

TEST(RunResultTest, TheReportHasWhatItPromises) {
  const auto comm = Tpetra::getDefaultComm();
  const SceneRun run = solveScene(scene::modelProblem(false, 2, 4), {}, comm);
  const Teuchos::ParameterList report = reportOf(run.result);
  for (const auto& [list, names] : contract) {
    ASSERT_TRUE(report.isSublist(list)) << list;
    for (const std::string& name : names)
      EXPECT_TRUE(report.sublist(list).isParameter(name)) << list << ": " << name;
  }
  EXPECT_EQ(report.sublist("Accuracy").get<double>("Energy"), run.solution.energy);
  EXPECT_EQ(report.sublist("Problem").get<int>("Ranks"), comm->getSize());
  EXPECT_EQ(report.sublist("Status").get<std::string>("Status"), "Converged");
  EXPECT_TRUE(report.sublist("Status").get<bool>("Converged"));
  EXPECT_FALSE(report.isSublist("Start"));
}

TEST(RunResultTest, DisplacementsThatAreNotSmallAreADoubtAndAFailureWhereTheyMustBe) {
  const auto comm = Tpetra::getDefaultComm();
  scene::Scene scene;
  scene.bodies.push_back(test::block("block", {{0, 0, 0}, {1, 1, 1}}, {2, 2, 2}, test::cutByMetis(2)));
  scene.bodies[0].supports = {test::slide("bottom"), test::slide("left"), test::slide("front")};
  for (const double strain : {0.05, 0.15, 0.25})
    for (const bool mustBeSmall : {false, true}) {
      const double press = strain * scene.bodies[0].material.youngsModulus;
      scene.bodies[0].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {}, {press, 0, 0}}};
      const RunResult result = solveScene(scene, {}, comm, {.requiresSmall = mustBeSmall}).result;
      const bool isSound = !mustBeSmall || strain < 0.2;
      EXPECT_NEAR(result.bodies[0].deformation.strain, strain, 1e-6);
      EXPECT_EQ(result.doubts.empty(), strain < 0.1) << result.doubts;
      EXPECT_EQ(result.status, isSound ? RunStatus::converged : RunStatus::largeDisplacements);
      EXPECT_EQ(reportOf(result).sublist("Status").get<bool>("Converged"), isSound);
    }
}

/// A fixed point that was asked for is no fallback.
TEST(RunResultTest, FrictionWithoutKnownUniquenessIsADoubt) {
  RunResult result;
  result.solve.plan.algorithm = fetidp::Algorithm::activeSets;
  EXPECT_EQ(frictionDoubts(result), "");
  result.solve.counts.negativeCurvatures = 2;
  EXPECT_NE(frictionDoubts(result).find("p'Fp < 0"), std::string::npos);
  result.solve.counts.fixedPointRounds = 7;
  EXPECT_NE(frictionDoubts(result).find("in 7 rounds"), std::string::npos);
  result.feedback = FrictionFeedback{0.6, 20};
  for (const std::string word : {"in 7 rounds", "a factor of 0.6"})
    EXPECT_NE(frictionDoubts(result).find(word), std::string::npos) << word;
  result = {};
  result.solve.plan.algorithm = fetidp::Algorithm::fixedPoint;
  result.solve.counts.fixedPointRounds = 7;
  EXPECT_EQ(frictionDoubts(result), "");
}

TEST(RunResultTest, AMissedTargetIsAStatusOfItsOwn) {
  AccuracyParameters accuracy;
  accuracy.target = 1e-3;
  accuracy.maxLevels = 2;
  accuracy.refinement = AccuracyParameters::Refinement::even;
  const AccurateRun accurate =
      solveToTarget(scene::modelProblem(true, 1, 2), {}, accuracy, Tpetra::getDefaultComm(), nullptr, {});
  const RunResult& result = accurate.run.result;
  EXPECT_EQ(result.status, RunStatus::targetMissed);
  ASSERT_TRUE(result.target && result.error);
  EXPECT_EQ(result.target->meshes.size(), 2U);
  EXPECT_NEAR(result.error->relative(), result.target->meshes.back().relative(), 1e-12);
  const Teuchos::ParameterList report = reportOf(result);
  EXPECT_EQ(report.sublist("Status").get<std::string>("Status"), "TargetMissed");
  EXPECT_FALSE(report.sublist("Status").get<bool>("Converged"));
  EXPECT_EQ(report.sublist("Levels").sublist("level 1").get<double>("Relative Error"),
            report.sublist("Accuracy").get<double>("Relative Error"));
}

/// Nodes face each other on the scene's mesh, and do not on one with elements twice as large.
TEST(RunResultTest, ACoarserMeshThatFailsIsToldAndTheRunGoesOn) {
  scene::Scene scene;
  scene.bodies = {test::block("lower", {{0, 0, 0}, {4, 1, 0}}, {4, 2, 0}, test::cutInGrid({2, 1, 1})),
                  test::block("upper", {{0, 1, 0}, {3, 2, 0}}, {3, 2, 0}, test::cutInGrid({1, 1, 1}))};
  scene.bodies[0].supports = {test::slide("bottom"), test::slide("left")};
  scene.bodies[1].supports = {test::slide("left")};
  scene.bodies[1].loads = {test::weight({0, -1, 0})};
  scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
  scene.contacts[0].coupling = scene::SurfaceContact::Coupling::nodes;
  const auto comm = Tpetra::getDefaultComm();
  const SceneRun plain = solveScene(scene, {}, comm);
  const SceneRun run = solveScene(scene, {}, comm, {.facts = {.coarserFrom = 0}});
  ASSERT_TRUE(run.result.start);
  EXPECT_NE(run.result.start->failure.find("joint"), std::string::npos) << run.result.start->failure;
  EXPECT_EQ(run.result.status, RunStatus::converged);
  EXPECT_NEAR(run.result.energy, plain.result.energy, 1e-9 * std::abs(plain.result.energy));
  EXPECT_EQ(reportOf(run.result).sublist("Start").get<std::string>("Failure"), run.result.start->failure);
}

/// There is nothing coarser than one element: what suits a good start is not chosen without one.
TEST(RunResultTest, WithoutACoarserMeshTheMethodIsTheOneForNoStart) {
  const auto methodOf = [](int elements, GlobalOrdinal coarserFrom) {
    scene::Scene scene;
    scene.bodies = {
        test::block("block", {{0, 0, 0}, {3, 1, 0}}, {elements, elements, 0}, test::cutInGrid({1, 1, 1}))};
    scene.bodies[0].supports = {test::slide("left"), test::slide("right")};
    scene.bodies[0].supports.push_back({"top", "top", {std::nullopt, -0.01, std::nullopt}});
    scene.contacts = {test::onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0})};
    const SceneRun run =
        solveScene(scene, {}, Tpetra::getDefaultComm(), {.facts = {.coarserFrom = coarserFrom}});
    EXPECT_EQ(run.result.status, RunStatus::converged);
    EXPECT_EQ(run.result.start.has_value(), elements > 1 && coarserFrom == 0);
    return run.result.solve.plan.algorithm;
  };
  const auto cold = methodOf(1, 1000000);
  EXPECT_NE(cold, fetidp::Algorithm::activeSets);
  EXPECT_EQ(methodOf(1, 0), cold);
  EXPECT_EQ(methodOf(6, 0), fetidp::Algorithm::activeSets);
}

} // namespace
} // namespace epafi::simulation
