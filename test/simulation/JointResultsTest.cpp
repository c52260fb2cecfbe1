// What joints between bodies meshed apart carry: under an even pressure all is known.

#include "epafi/simulation/JointResults.hpp"
#include "epafi/output/ContactFields.hpp"

#include "support/SolidScenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace epafi::simulation {
namespace {

constexpr double pressure = 3;

/// Two blocks of 1 × 1 × 1, one on the other and pressed onto it, on planes of symmetry.
scene::Scene pressedBlocks(scene::SurfaceContact::Kind kind) {
  scene::Scene scene;
  scene.bodies = {test::block("lower", {{0, 0, 0}, {1, 1, 1}}, {3, 4, 2}, test::cutInGrid({2, 2, 1})),
                  test::block("upper", {{0, 0, 1}, {1, 1, 2}}, {4, 2, 2}, test::cutInGrid({2, 1, 2}))};
  for (scene::Body& body : scene.bodies)
    body.supports = {test::slide("left"), test::slide("front")};
  scene.bodies[0].supports.push_back(test::slide("bottom"));
  scene.bodies[1].loads = {{"press", fem::SolidLoad::Kind::pressure, {}, "top", {0, 0, 0}, {pressure, 0, 0}}};
  scene.contacts = {test::between("joint", 0, "top", 1, "bottom")};
  scene.contacts[0].kind = kind;
  return scene;
}

TEST(JointResultsTest, ForcesOfBothSidesBalanceAndTiesCarryTheLoad) {
  using Kind = scene::SurfaceContact::Kind;
  for (const Kind kind : {Kind::contact, Kind::tied}) {
    const scene::Scene scene = pressedBlocks(kind);
    const test::SolidRun run(scene, 1e-12);
    const SolvedScene solved{scene, run.decomposition, run.solution};
    const std::vector<TieResult> ties = tieResults(solved);
    ASSERT_EQ(ties.size(), kind == Kind::tied ? 1U : 0U);
    const JointBalance balance =
        kind == Kind::tied ? ties[0].balance : balanceOf(solved, run.decomposition.contacts[0]);
    EXPECT_LE(balance.force, 1e-14);
    EXPECT_LE(balance.moment, 1e-14);
    EXPECT_EQ(balance.coupling.find("mortars"), 0U);
    if (kind == Kind::contact)
      continue;
    EXPECT_EQ(ties[0].name, "joint");
    EXPECT_NEAR(ties[0].resultant[2], -pressure, 1e-9); // pushes the lower one down
    EXPECT_NEAR(std::hypot(ties[0].resultant[0], ties[0].resultant[1]), 0, 1e-9);
    EXPECT_NEAR(ties[0].largestTraction, pressure, 1e-8);
    const TieFields fields = gatherTieFields(solved, run.decomposition.ties[0]);
    EXPECT_EQ(fields.numNodes, ties[0].nodes);
    ASSERT_EQ(fields.traction.size(), static_cast<std::size_t>(3 * fields.nodes.count));
    for (std::size_t k = 0; k < fields.traction.size(); k += 3) {
      EXPECT_NEAR(std::abs(fields.traction[k + 2]), pressure, 1e-8);
      EXPECT_EQ(fields.points[k + 2], 1.0);
    }
  }
}

TEST(JointResultsTest, TheOtherSideOfMortarsIsWholeInSlabs) {
  const scene::Scene scene = pressedBlocks(scene::SurfaceContact::Kind::contact);
  const test::SolidRun run(scene);
  const output::FacingSurface facing = output::facingSurface({scene, run.decomposition, run.solution}, 0);
  const bool isUpper = run.decomposition.contacts[0].secondBody == 1;
  EXPECT_EQ(facing.numFacets, isUpper ? 8 : 12);
  EXPECT_EQ(facing.numPoints, isUpper ? 15 : 20);
  EXPECT_EQ(facing.cornersPerFacet, 4);
  EXPECT_EQ(sumOverRanks(*Tpetra::getDefaultComm(), static_cast<GlobalOrdinal>(facing.corners.size())),
            4 * facing.numFacets);
  for (const long long corner : facing.corners)
    EXPECT_LT(corner, facing.numPoints);
}

} // namespace
} // namespace epafi::simulation
