#include "support/Gathered.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/base/Errors.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace epafi::decomposition {
namespace {

/// What `decompose` says to a wrong scene; empty if it accepts it.
std::string refusal(const scene::Scene& scene) {
  try {
    decompose(scene, world());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool mentions(const std::string& text, const std::vector<std::string>& words) {
  return std::all_of(words.begin(), words.end(),
                     [&](const std::string& word) { return text.find(word) != std::string::npos; });
}

/// Entry of row k of the contact in the given body, over all ranks: {coefficient, node}; {0, 0} if it has
/// none.
std::array<double, 2> entryOf(const DecomposedProblem& p, GlobalOrdinal row, int body) {
  std::vector<double> found{0, 0};
  for (const Subdomain& s : p.subdomains)
    for (const ConstraintEntry& entry : s.constraint)
      if (s.body == body && p.numberOf(entry.multiplier) == row) {
        found[0] += entry.coefficient;
        found[1] += nodeKey(s, entry.unknown, 1) - 1e6 * (body + 1);
      }
  sumOverRanks(*p.comm, found);
  return {found[0], found[1]};
}

/// c on every rank.
std::vector<double> gapOf(const Decomposition& cut) {
  const DecomposedProblem& p = cut.problem;
  std::vector<double> all(p.dualDimension(), 0.0);
  const auto indices = localIndices(*p.multiplierMap);
  const auto values = cut.data.gap().getData();
  for (Teuchos_Ordinal k = 0; k < values.size(); ++k)
    all[indices[static_cast<decltype(indices.size())>(k)]] = values[k];
  sumOverRanks(*p.comm, all);
  return all;
}

TEST(ContactTest, RowsJoinOppositeNodesFromBottomToTop) {
  for (const auto& cut : {grid(1, 1), grid(2, 2), metis(3)}) {
    scene::Scene scene = twoMembranes(false, 4, cut);
    scene.contacts.front().gap = 0.25;
    const auto result = decompose(scene, world());
    ASSERT_EQ(result.contacts.size(), 1u);
    EXPECT_EQ(result.contacts[0].numRows(), 5);
    for (GlobalOrdinal k = 0; k < 5; ++k) {
      EXPECT_EQ(entryOf(result.problem, k, 0),
                (std::array<double, 2>{1.0, 5.0 * static_cast<double>(k) + 4}));
      EXPECT_EQ(entryOf(result.problem, k, 1), (std::array<double, 2>{-1.0, 5.0 * static_cast<double>(k)}));
    }
    const std::vector<double> gap = gapOf(result);
    for (std::size_t row = 0; row < gap.size(); ++row)
      EXPECT_EQ(gap[row], row < 5 ? 0.25 : 0.0);
  }
}

TEST(ContactTest, ASharedNodesEntryAndRowBelongToItsLowestSubdomain) {
  const auto result = decompose(twoMembranes(false, 4, grid(2, 2)), world());
  const DecomposedProblem& p = result.problem;
  std::vector<int> holders;
  for (const Subdomain& s : p.subdomains)
    for (const ConstraintEntry& entry : s.constraint)
      if (p.numberOf(entry.multiplier) == 2) { // the middle node, a crosspoint
        EXPECT_TRUE(s.number == 1 || s.number == 4) << s.number;
        EXPECT_EQ(entry.coefficient, s.number == 1 ? 1.0 : -1.0);
        holders.push_back(s.number);
      }
  EXPECT_EQ(sumOverRanks(*p.comm, static_cast<GlobalOrdinal>(holders.size())), 2);
  const bool holdsFirst = std::find(holders.begin(), holders.end(), 1) != holders.end();
  EXPECT_EQ(p.multiplierMap->isNodeGlobalElement(2), holdsFirst);
}

TEST(ContactTest, SupportedNodesLeaveTheRowAndEnterTheGap) {
  scene::Scene scene = twoMembranes(false, 4, grid(2, 2));
  scene.contacts.front().gap = 0.5;
  scene.bodies[0].supports = {{"foot", "bottom", {0.125}}};
  scene.bodies[1].supports = {{"foot", "bottom", {-1.0}}, {"head", "top", {2.0}}};
  const auto result = decompose(scene, world());
  const std::vector<double> gap = gapOf(result);
  EXPECT_EQ(gap[0], 0.5 - 0.125 - 1.0); // both supported: the row stays, empty
  EXPECT_EQ(entryOf(result.problem, 0, 0)[0], 0);
  EXPECT_EQ(entryOf(result.problem, 0, 1)[0], 0);
  EXPECT_EQ(gap[1], 0.5);
  EXPECT_EQ(gap[4], 0.5 + 2.0); // the second one supported
  EXPECT_EQ(entryOf(result.problem, 4, 0)[0], 1);
  EXPECT_EQ(entryOf(result.problem, 4, 1)[0], 0);
}

TEST(ContactTest, TwoPairsOfABodyMayShareACorner) {
  scene::Scene scene = twoMembranes(true, 3, grid(2, 2));
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[2].name = "above";
  scene.bodies[2].mesh.box = mesh::rectangle(0, 1, 1, 2);
  scene.bodies[2].supports = {{"roof", "top", {0.0}}};
  scene.contacts.push_back({"ceiling", 0, "top", 2, "bottom", {}, 0.5});
  const auto result = decompose(scene, world());
  EXPECT_EQ(result.contacts[1].firstRow, 4);
  EXPECT_EQ(result.problem.numInequalities, 8);
  EXPECT_EQ(entryOf(result.problem, 3, 0)[1], 15); // upper right node of the first body, in both pairs
  EXPECT_EQ(entryOf(result.problem, 7, 0)[1], 15);
}

TEST(ContactTest, NonMatchingNodesAreRefusedWithBothNumbers) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.bodies[1].mesh.elements = {4, 6, 0};
  scene.contacts.front().coupling = scene::SurfaceContact::Coupling::nodes;
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "left", "right", "4", "6"})) << refusal(scene);
}

/// Whichever body has them, the nodes of order 2 have the rows; those between corners meet the middle of two
/// nodes.
TEST(ContactTest, BodiesOfOrderOneAndTwoMeetAtTheNodesOfOrderTwo) {
  for (const std::size_t quadratic : {0U, 1U}) {
    scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
    scene.bodies[quadratic].mesh.order = 2;
    const auto result = decompose(scene, world());
    const contact::ContactLayout& contact = result.contacts[0];
    EXPECT_EQ(contact.firstBody, static_cast<int>(quadratic));
    EXPECT_EQ(contact.firstSurface, quadratic == 0 ? "right" : "left");
    ASSERT_EQ(contact.numRows(), 9);
    for (std::size_t row = 0; row < 9; ++row) {
      const Point own = result.bodies[quadratic].mesh->point(contact.firstNodes[row]);
      double height = 0, weight = 0;
      for (const contact::NodeShare& share : contact.secondNodes[row]) {
        height += share.weight * result.bodies[1 - quadratic].mesh->point(share.node)[1];
        weight += share.weight;
      }
      EXPECT_EQ(contact.secondNodes[row].size(), row % 2 + 1);
      EXPECT_NEAR(height, own[1], 1e-15);
      EXPECT_NEAR(weight, 1, 1e-15);
    }
  }
}

TEST(ContactTest, EdgesThatDoNotCoincideAreRefusedWithBothPlaces) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.bodies[1].mesh.box = mesh::rectangle(1, 2, 0, 1.5);
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "coincide", "from 0 to 1,", "from 0 to 1.5"}))
      << refusal(scene);
  scene = twoMembranes(true, 4, grid(2, 2));
  scene.bodies[1].mesh.box = mesh::rectangle(1 + 1e-6, 2, 0, 1);
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "coincide", "x = 1,", "x = 1.000001,"}));
  scene.bodies[1].mesh.box = mesh::rectangle(1 + 1e-13, 2, 0, 1);
  EXPECT_EQ(refusal(scene), "");
}

TEST(ContactTest, SupportedContactEdgesAreRefused) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.bodies[1].supports = {{"glue", "left", {0.0}}};
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "glue", "right"})) << refusal(scene);
}

TEST(ContactTest, AnEdgeServesOnePairOnly) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.contacts.push_back(scene.contacts.front());
  scene.contacts.back().name = "again";
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "again", "already"})) << refusal(scene);
  scene = twoMembranes(true, 4, grid(2, 2));
  scene.contacts.front().second = 0;
  scene.contacts.front().secondSurface = "right";
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "itself"})) << refusal(scene);
}

TEST(ContactTest, UnknownBodiesAndImpossibleCutsAreRefused) {
  scene::Scene scene = twoMembranes(true, 4, grid(2, 2));
  scene.contacts.front().second = 2;
  EXPECT_TRUE(mentions(refusal(scene), {"interface", "2 bodies"})) << refusal(scene);
  EXPECT_TRUE(mentions(refusal(twoMembranes(true, 4, grid(5, 1))), {"left", "5", "4"}));
  EXPECT_TRUE(mentions(refusal(twoMembranes(true, 4, grid(0, 1))), {"left", "0"}));
  EXPECT_TRUE(mentions(refusal(twoMembranes(true, 4, metis(17))), {"left", "17", "16"}));
}

TEST(ContactTest, SupportsThatDisagreeAreRefusedOnAllRanks) {
  const scene::Scene scene = oneBody(4, 4, grid(2, 2), {{"wall", "left", {0.0}}, {"roof", "top", {1.0}}});
  EXPECT_TRUE(mentions(refusal(scene), {"wall", "roof", "plate"})) << refusal(scene);
}

} // namespace
} // namespace epafi::decomposition
