#include "support/Preconditioned.hpp"

#include "epafi/base/EigenCompatibility.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/precondition/JointStiffness.hpp"
#include "epafi/fetidp/precondition/Joints.hpp"

#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <utility>

namespace epafi::fetidp {
namespace {

/// The parts of a joint, all on this rank.
std::vector<JointPart> partsOf(const Preconditioned& p, const Joint& joint,
                               Scaling scaling = Scaling::stiffness) {
  std::vector<JointPart> parts;
  for (const int number : joint.subdomains)
    for (const SubdomainGroup& group : p.inverse->groups())
      for (const std::size_t member : group.members())
        if (p.problem.subdomains[member].number == number)
          parts.push_back(partOf(
              p.problem.subdomains[member], p.problem.clusterOf[number], group.condensed(),
              {group.condensed().factor().schurComplement(), group.condensed().factor().inverseOfKept()},
              joint.rows, scaling));
  return parts;
}

std::vector<int> globalRows(const Preconditioned& p, const Joint& joint) {
  std::vector<int> rows;
  for (const int row : joint.rows)
    rows.push_back(static_cast<int>(p.problem.multiplierGhostMap->getGlobalElement(row)));
  return rows;
}

scene::Scene elasticBar(int cutsAlong, int cutsAcross) {
  scene::Scene scene;
  scene::Body body;
  body.name = "bar";
  body.physics = fem::Physics::planeStrain;
  body.mesh.box = {{0, 0, 0}, {2, 1, 0}};
  body.mesh.elements = {8, 4, 0};
  body.supports = {{"wall", "left", {0.0, 0.0, std::nullopt}}};
  body.decomposition.counts = {cutsAlong, cutsAcross, 1};
  scene.bodies = {body};
  return scene;
}

scene::Scene membranesWithAChannel() {
  scene::Scene scene = twoMembranes(true, 8, grid(2, 2));
  scene.bodies[0].regions = {{"channel", mesh::rectangle(0, 1, 0.125, 0.25), "", {1e3}}};
  return scene;
}

TEST(JointStiffnessTest, TheStiffnessOfThePreconditionerIsItsDiagonalBlock) {
  for (const Scaling scaling : {Scaling::stiffness, Scaling::multiplicity})
    for (const scene::Scene& scene : {membranesWithAChannel(), elasticBar(4, 2)}) {
      const Preconditioned p(scene, {Type::dirichlet, scaling, false}, thisRankOnly());
      const Eigen::MatrixXd m = matrixOf(p.m);
      for (const Joint& joint : jointsOf(p.problem, *p.inverse->multiplierPlan(), RowKind::gluing)) {
        const std::vector<int> rows = globalRows(p, joint);
        EXPECT_LE(relativeError(joined(partsOf(p, joint, scaling)).preconditioner, m(rows, rows)), 1e-12);
      }
    }
}

TEST(JointStiffnessTest, TheFlexibilityIsThatOfFWhereTheSubdomainsAreTheWholeBody) {
  scene::Scene scene = decomposition::oneBody(8, 4, grid(2, 1), {{"wall", "left", {0.0}}});
  for (const scene::Scene& body : {scene, elasticBar(2, 1)}) {
    const Preconditioned p(body, {}, thisRankOnly());
    const auto joints = jointsOf(p.problem, *p.inverse->multiplierPlan(), RowKind::gluing);
    ASSERT_EQ(joints.size(), 1U);
    EXPECT_LE(relativeError(joined(partsOf(p, joints[0])).flexibility(), matrixOf(p.f)), 1e-9);
  }
}

/// The other subdomains only hold back.
TEST(JointStiffnessTest, TheFlexibilityIsAboveThatOfF) {
  for (const scene::Scene& scene : {membranesWithAChannel(), elasticBar(4, 2)}) {
    const Preconditioned p(scene, {}, thisRankOnly());
    const Eigen::MatrixXd f = matrixOf(p.f);
    for (const Joint& joint : jointsOf(p.problem, *p.inverse->multiplierPlan(), RowKind::gluing)) {
      const std::vector<int> rows = globalRows(p, joint);
      const Eigen::MatrixXd local = joined(partsOf(p, joint)).flexibility();
      const Eigen::VectorXd difference = direct::eigenOf(local - f(rows, rows)).values;
      EXPECT_GE(difference.minCoeff(), -1e-9 * local.norm());
    }
  }
}

TEST(JointStiffnessTest, OverratedJumpsAreThoseAboveTheThreshold) {
  const JointStiffness joint{Eigen::Vector4d(5, 50, 2, 7.5).asDiagonal(),
                             Eigen::Vector4d(1, 1, 1, 4).asDiagonal(), Eigen::MatrixXd(4, 0)};
  const OverratedJumps jumps = overratedJumps(joint, 10); // ω = 5, 50, 2, 30
  ASSERT_EQ(jumps.ratios.size(), 2);
  EXPECT_NEAR(jumps.ratios[0], 50, 1e-12);
  EXPECT_NEAR(jumps.ratios[1], 30, 1e-12);
  EXPECT_LE((jumps.forces.col(0).cwiseAbs() - Eigen::Vector4d(0, 1, 0, 0)).norm(), 1e-12);
  EXPECT_LE((jumps.forces.col(1).cwiseAbs() - Eigen::Vector4d(0, 0, 0, 2)).norm(), 1e-12);
  EXPECT_LE((jumps.jumps.col(1).cwiseAbs() - Eigen::Vector4d(0, 0, 0, 0.5)).norm(), 1e-12); // yᵀM_E y = 1
  EXPECT_EQ(overratedJumps(joint, 51).forces.cols(), 0);
  EXPECT_EQ(overratedJumps(joint, 51).forces.rows(), 4);
}

TEST(JointStiffnessTest, ForcesThatMotionsForbidAreLeftOut) {
  const JointStiffness joint{Eigen::Vector4d(5, 50, 2, 7.5).asDiagonal(),
                             Eigen::Vector4d(1, 1, 1, 4).asDiagonal(),
                             Eigen::MatrixXd(4, 0)}; // ω = 5, 50, 2, 30
  Eigen::MatrixXd motions(4, 2);
  motions << 0, 0, 1, 2, 0, 0, 0, 0; // one motion twice
  const OverratedJumps jumps = overratedJumps(joint, 10, motions);
  ASSERT_EQ(jumps.ratios.size(), 1);
  EXPECT_NEAR(jumps.ratios[0], 30, 1e-12);
  motions << 0, 1, 1, 0, 0, 0, 0, 1;
  const OverratedJumps mixed = overratedJumps(joint, 9, motions); // u = (2, 0, 0, −2) is left of 5 and 30
  ASSERT_EQ(mixed.ratios.size(), 1);
  EXPECT_NEAR(mixed.ratios[0], (4 * 5 + 30) / 5.0, 1e-12);
  EXPECT_LE((motions.transpose() * mixed.forces).norm(), 1e-15);
}

/// What nothing holds but springs is forbidden, and its round-off is no jump.
TEST(JointStiffnessTest, SpringsOfForbiddenMotionsLeaveNoRoundOff) {
  const Eigen::Index size = 12;
  Eigen::VectorXd stiffness = Eigen::VectorXd::Ones(size);
  stiffness.head(3).setConstant(1e8);
  Eigen::MatrixXd motions(size, 2);
  for (Eigen::Index i = 0; i < size; ++i)
    motions.row(i) << 1, static_cast<double>(i) / 3;
  const JointStiffness joint{2 * stiffness.cwiseInverse().asDiagonal().toDenseMatrix(),
                             stiffness.asDiagonal(), 1e6 * motions};
  EXPECT_EQ(overratedJumps(joint, 2.1, motions).ratios.size(), 0);
  EXPECT_GE(overratedJumps(joint, 2.1).ratios.size(), 2);
  EXPECT_EQ(overratedJumps(joint, 1e-3, Eigen::MatrixXd::Identity(size, size)).forces.cols(), 0);
}

TEST(JointStiffnessTest, MotionsJumpBetweenClustersAlone) {
  for (const int size : {0, 1, 2}) {
    scene::Scene scene = elasticBar(4, 1);
    scene.bodies[0].decomposition.cluster = size;
    const Preconditioned p(scene, {}, thisRankOnly());
    const Eigen::MatrixXd rows = kernelRows(p.problem); // G̃ᵀ
    for (const Joint& joint : jointsOf(p.problem, *p.inverse->multiplierPlan(), RowKind::gluing)) {
      const Eigen::MatrixXd motions = motionsOf(partsOf(p, joint)),
                            expected = rows(globalRows(p, joint), allOf);
      EXPECT_LE((motions * motions.transpose() - expected * expected.transpose()).norm(),
                1e-12 * (1 + expected.squaredNorm()));
      EXPECT_EQ(motions.cols() > 0, expected.norm() > 1e-12);
    }
  }
}

TEST(JointStiffnessTest, RefusesAPreconditionerThatIsNotPositive) {
  const JointStiffness joint{Eigen::Vector2d(1, 1).asDiagonal(), Eigen::Vector2d(1, -1).asDiagonal(),
                             Eigen::MatrixXd(2, 0)};
  EXPECT_THROW(overratedJumps(joint, 10), Error);
}

/// Two elastic subdomains joined at one crosspoint, the second one otherwise free, turn about it against no
/// stiffness at all.
TEST(JointStiffnessTest, AHingeIsOneJumpWithoutEnergy) {
  const Preconditioned p(elasticBar(2, 1), {}, thisRankOnly());
  const Joint joint = jointsOf(p.problem, *p.inverse->multiplierPlan(), RowKind::gluing).front();
  std::vector<JointPart> parts = partsOf(p, joint);
  EXPECT_EQ(overratedJumps(joined(parts), 30).ratios.size(), 0);
  const GlobalOrdinal hinge = parts[1].crosspoints.front();
  GlobalOrdinal number = 1000;
  for (decomposition::CoarseNumber& crosspoint : parts[1].crosspoints)
    if (crosspoint > hinge + 1) // both components of the first one stay joined
      crosspoint = number++;

  const JointStiffness hinged = joined(parts);
  const OverratedJumps jumps = overratedJumps(hinged, 30);

  ASSERT_EQ(jumps.ratios.size(), 1);
  EXPECT_GE(jumps.ratios[0], 1e8);
  const Eigen::VectorXd v = jumps.forces.col(0);
  const Eigen::MatrixXd rest = kernelOf(v); // jumps with vᵀy = 0
  const Eigen::MatrixXd stiffness = direct::inverseOfSpd(
                            hinged.flexibility()), // kappa: the largest with M y = kappa S y
      largest = 30 * stiffness - hinged.preconditioner;
  EXPECT_GE(direct::eigenOf(rest.transpose() * largest * rest).values[0], 0);
}

TEST(JointStiffnessTest, PartsSurviveAMessage) {
  const Preconditioned p(elasticBar(4, 2), {}, thisRankOnly());
  std::vector<std::byte> message;
  std::vector<JointPart> sent;
  for (const Joint& joint : jointsOf(p.problem, *p.inverse->multiplierPlan(), RowKind::gluing))
    for (const JointPart& part : partsOf(p, joint)) {
      pack(static_cast<GlobalOrdinal>(sent.size()), part, message);
      sent.push_back(part);
    }
  std::span<const std::byte> rest(message);
  GlobalOrdinal number = 0;
  for (const JointPart& part : sent) {
    const auto [firstRow, received] = unpack(rest);
    EXPECT_EQ(firstRow, number++);
    EXPECT_EQ(received.subdomain, part.subdomain);
    EXPECT_EQ(received.cluster, part.cluster);
    EXPECT_EQ(received.crosspoints, part.crosspoints);
    EXPECT_EQ(received.flexibility, part.flexibility);
    EXPECT_EQ(received.response, part.response);
    EXPECT_EQ(received.crosspointStiffness, part.crosspointStiffness);
    EXPECT_EQ(received.crosspointDiagonal, part.crosspointDiagonal);
    EXPECT_EQ(received.weightedStiffness, part.weightedStiffness);
    EXPECT_EQ(received.motions, part.motions);
    EXPECT_EQ(received.weights, part.weights);
  }
  EXPECT_TRUE(rest.empty());
}

} // namespace
} // namespace epafi::fetidp
