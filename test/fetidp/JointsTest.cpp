#include "support/DenseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/fetidp/precondition/Joints.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace epafi::fetidp {
namespace {

struct Found {
  explicit Found(const scene::Scene& scene, RowKind kind = RowKind::gluing)
      : decomposition(decompose(scene, world())), problem(decomposition.problem),
        plan(problem.multiplierMap, problem.multiplierGhostMap), joints(jointsOf(problem, plan, kind)) {}

  [[nodiscard]] GlobalOrdinal rowOf(int ghost) const {
    return problem.multiplierGhostMap->getGlobalElement(ghost);
  }
  [[nodiscard]] std::vector<bool> varies(double ratio = 100) const {
    return stiffnessVaries(problem, plan, joints, ratio);
  }

  model::Decomposition decomposition;
  const DecomposedProblem& problem;
  Import plan;
  std::vector<Joint> joints;
};

scene::Scene cube(int elements, int cuts) {
  scene::Scene scene;
  scene::Body body;
  body.name = "cube";
  body.physics = fem::Physics::elasticity3d;
  body.mesh.box = {{0, 0, 0}, {1, 1, 1}};
  body.mesh.elements = {elements, elements, elements};
  body.supports = {{"floor", "bottom", {0.0, 0.0, 0.0}}};
  body.decomposition.counts = {cuts, cuts, cuts};
  scene.bodies = {body};
  return scene;
}

/// Joints of the whole problem by their subdomains, with their rows. Collective.
std::map<std::vector<int>, std::set<GlobalOrdinal>> allJoints(const Found& found) {
  std::vector<double> mine; // number of subdomains, these, number of rows, these
  for (const Joint& joint : found.joints) {
    mine.push_back(static_cast<double>(joint.subdomains.size()));
    mine.insert(mine.end(), joint.subdomains.begin(), joint.subdomains.end());
    mine.push_back(static_cast<double>(joint.rows.size()));
    for (const int row : joint.rows)
      mine.push_back(static_cast<double>(found.rowOf(row)));
  }
  const std::vector<double> all = gatherOnAll(*found.problem.comm, mine);
  std::map<std::vector<int>, std::set<GlobalOrdinal>> joints;
  for (auto value = all.begin(); value != all.end();) {
    const auto numbers = value + 1, rows = numbers + static_cast<std::ptrdiff_t>(*value) + 1;
    const std::set<GlobalOrdinal> here(rows, rows + static_cast<std::ptrdiff_t>(*(rows - 1)));
    const auto [entry, isNew] = joints.try_emplace({numbers, rows - 1}, here);
    EXPECT_EQ(entry->second, here); // each rank that has a joint has all of it
    value = rows + static_cast<std::ptrdiff_t>(*(rows - 1));
  }
  return joints;
}

TEST(JointsTest, EveryGluingRowIsInOneJointWithTheSubdomainsThatTouchIt) {
  for (const scene::Scene& scene :
       {twoMembranes(false, 6, grid(3, 3)), twoMembranes(true, 8, metis(5)), cube(4, 2)}) {
    const Found found(scene);
    std::map<GlobalOrdinal, std::vector<int>> touching; // rows of gluing
    std::vector<double> mine;
    for (const auto& subdomain : found.problem.subdomains)
      for (const auto& entry : subdomain.constraint)
        mine.insert(mine.end(), {static_cast<double>(found.rowOf(entry.multiplier)),
                                 static_cast<double>(subdomain.number)});
    const std::vector<double> all = gatherOnAll(*found.problem.comm, mine);
    for (std::size_t k = 0; k < all.size(); k += 2)
      if (const auto row = static_cast<GlobalOrdinal>(all[k]); row >= found.problem.numInequalities)
        touching[row].push_back(static_cast<int>(all[k + 1]));
    std::size_t numRows = 0;
    for (const auto& [subdomains, rows] : allJoints(found)) {
      numRows += rows.size();
      for (const GlobalOrdinal row : rows) {
        std::vector<int> numbers = touching.at(row);
        std::sort(numbers.begin(), numbers.end());
        EXPECT_EQ(numbers, subdomains) << row;
      }
    }
    EXPECT_EQ(numRows, touching.size());
    EXPECT_EQ(numRows, static_cast<std::size_t>(found.problem.numEqualities));
  }
}

TEST(JointsTest, AGridHasOneForEachPairOfNeighbours) {
  const auto joints = allJoints(Found(twoMembranes(true, 6, grid(3, 3))));
  EXPECT_EQ(joints.size(), 2U * 12U);
  for (const auto& [subdomains, rows] : joints) {
    EXPECT_EQ(subdomains.size(), 2U);
    EXPECT_EQ(rows.size(), 1U); // the middle of an edge of two elements; its ends are crosspoints
  }
}

TEST(JointsTest, InSpaceThereAreFacesAndEdges) {
  std::map<std::size_t, int> numOf; // by the number of subdomains
  for (const auto& [subdomains, rows] : allJoints(Found(cube(6, 2))))
    ++numOf[subdomains.size()];
  // 12 faces; along each of the 6 inner half edges rows of 2, 3 and 4 subdomains, those of 2 with the face.
  EXPECT_EQ(numOf, (std::map<std::size_t, int>{{2, 12}, {3, 6}, {4, 6}}));
}

TEST(JointsTest, StiffnessVariesAlongTheJointsThatAChannelCrosses) {
  scene::Scene scene = twoMembranes(true, 8, grid(2, 2));
  EXPECT_EQ(Found(scene).varies(), std::vector<bool>(Found(scene).joints.size(), false));
  scene.bodies[0].regions = {
      {"channel", mesh::rectangle(0, 1, 0.125, 0.25), "", {1e3}}}; // through subdomains 0 and 1
  const Found found(scene);
  const std::vector<bool> varies = found.varies(), never = found.varies(1e4);
  for (std::size_t j = 0; j < varies.size(); ++j) {
    EXPECT_EQ(varies[j], found.joints[j].subdomains == (std::vector<int>{0, 1})) << j;
    EXPECT_FALSE(never[j]);
  }
}

TEST(JointsTest, StiffnessDoesNotVaryAlongJumpsThatFollowTheCut) {
  scene::Scene scene = twoMembranes(true, 8, grid(2, 2));
  scene.bodies[0].regions = {{"corner", mesh::rectangle(0, 0.5, 0, 0.5), "", {1e6}},
                             {"opposite", mesh::rectangle(0.5, 1, 0.5, 1), "", {1e6}}};
  const Found found(scene);
  EXPECT_EQ(found.varies(2.1),
            std::vector<bool>(found.joints.size(), false)); // ends of edges have half the elements
}

TEST(JointsTest, BodiesVaryWhereOneSubdomainIsStifferThanAnother) {
  scene::Scene scene = twoMembranes(true, 8, grid(2, 2));
  const auto vary = [&](double ratio) { return bodiesOfVaryingStiffness(Found(scene).problem, ratio); };
  EXPECT_EQ(vary(2.1), (std::vector<bool>{false, false}));
  scene.bodies[1].regions = {{"corner", mesh::rectangle(1, 1.5, 0, 0.5), "", {1e-3}}};
  EXPECT_EQ(vary(100), (std::vector<bool>{false, true}));
  EXPECT_EQ(vary(1e4), (std::vector<bool>{false, false}));
}

TEST(JointsTest, ContactOfABodyThatVariesIsAlwaysLookedAt) {
  scene::Scene scene = twoMembranes(true, 8, grid(2, 2));
  scene.bodies[1].regions = {{"far from the contact", mesh::rectangle(1.5, 2, 0, 1), "", {1e3}}};
  const Found found(scene, RowKind::contact);
  EXPECT_EQ(found.varies(10), std::vector<bool>(found.joints.size(), false));
  const std::vector<bool> always = bodiesOfVaryingStiffness(found.problem, 10);
  EXPECT_EQ(stiffnessVaries(found.problem, found.plan, found.joints, 10, always),
            std::vector<bool>(found.joints.size(), true));
}

/// The deviations from an average have the stiffness of the node that carries it in them.
TEST(JointsTest, StiffnessThatVariesIsSeenBehindAverages) {
  for (const double place : {0.1, 0.3, 0.5, 0.6}) {
    scene::Scene scene = cube(10, 1);
    scene.bodies[0].physics = fem::Physics::planeStrain;
    scene.bodies[0].mesh.elements = {10, 10, 0};
    scene.bodies[0].decomposition.counts = {2, 1, 1};
    scene.bodies[0].supports = {{"wall", "left", {0.0, 0.0, std::nullopt}}};
    EXPECT_EQ(Found(scene).varies(10), std::vector<bool>(Found(scene).joints.size(), false));
    fem::SolidRegion channel;
    channel.name = "channel";
    channel.box.lower[1] = place;
    channel.box.upper[1] = place + 0.1;
    channel.material.youngsModulus = 1e4;
    scene.bodies[0].regions = {channel};
    const Found found(scene);
    EXPECT_EQ(found.varies(), std::vector<bool>(found.joints.size(), true)) << place;
  }
}

TEST(JointsTest, ContactJoinsTheSubdomainsThatFaceEachOther) {
  const auto joints = allJoints(Found(twoMembranes(true, 12, grid(3, 3)), RowKind::contact));
  ASSERT_EQ(joints.size(), 3U);
  for (const auto& [subdomains, rows] : joints) {
    ASSERT_EQ(subdomains.size(), 2U);
    EXPECT_EQ(subdomains[1], subdomains[0] + 7); // 2, 5, 8 of the left body, 9, 12, 15 of the right one
    const bool isAtTheEnd = subdomains[0] != 5;
    EXPECT_EQ(rows.size(),
              isAtTheEnd ? 4U : 3U); // rows at the crosspoints are left out, ends of the line are none
  }
}

} // namespace
} // namespace epafi::fetidp
