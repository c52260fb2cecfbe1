// Clusters of subdomains: what joins them inside, what glues them, and how they move.

#include "support/Gathered.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"

#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace epafi::decomposition {
namespace {

scene::Scene solid(int dimension, const scene::Decomposition& cut, bool isHeld) {
  scene::Scene scene;
  scene::Body body;
  body.name = "block";
  body.physics = dimension == 3 ? fem::Physics::elasticity3d : fem::Physics::planeStrain;
  body.mesh.box = {{3, 5, 7}, {5, 6, 8}};
  body.mesh.elements = dimension == 3 ? std::array{6, 6, 6} : std::array{12, 6, 0};
  body.decomposition = cut;
  if (isHeld)
    body.supports = {{"foot", "left", {0.0, 0.0, dimension == 3 ? std::optional(0.0) : std::nullopt}}};
  scene.bodies = {body};
  return scene;
}

/// \param inSpace  with bodies in space, too large for dense matrices
std::vector<Case> clusteredCases(bool inSpace) {
  std::vector<Case> cases;
  for (const bool isHeld : {false, true})
    for (const int size : {1, 2, 3, 4}) {
      const std::string kind =
          (isHeld ? "held, clusters of " : "floating, clusters of ") + std::to_string(size);
      cases.push_back({"membranes " + kind, twoMembranes(isHeld, 12, clustered(grid(4, 2), size))});
      cases.push_back({"membranes by METIS " + kind, twoMembranes(isHeld, 12, clustered(metis(6), size))});
      cases.push_back({"plane " + kind, solid(2, clustered(grid(4, 2), size), isHeld)});
      scene::Decomposition cut = clustered(grid(2, 2), size);
      cut.counts[2] = 2;
      if (inSpace)
        cases.push_back({"space " + kind, solid(3, cut, isHeld)});
    }
  return cases;
}

TEST(ClustersTest, EachIsARunOfSubdomainsOfOneBodyNoLongerThanAskedFor) {
  for (const Case& c : clusteredCases(true)) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    const DecomposedProblem& p = result.problem;
    ASSERT_EQ(static_cast<int>(p.clusterOf.size()), p.numSubdomains);
    std::vector<int> size(p.clusters.size(), 0);
    for (const int cluster : p.clusterOf)
      ++size[cluster];
    EXPECT_GE(*std::min_element(size.begin(), size.end()), 1);
    EXPECT_LE(*std::max_element(size.begin(), size.end()), c.scene.bodies.front().decomposition.cluster);
    for (const Subdomain& s : p.subdomains) {
      EXPECT_EQ(p.clusterAt(s).body, s.body);
      EXPECT_EQ(s.kernel.cols(), p.clusterAt(s).kernelDimension);
    }
    EXPECT_EQ(p.kernelDimension, p.clusters.back().kernelOffset + p.clusters.back().kernelDimension);
  }
}

/// As the start on a coarser mesh has it: whole bodies on ranks that were given clusters.
TEST(ClustersTest, TheSceneSaysWhatSharesCrosspointsAndTheLayoutWhatRanksHave) {
  scene::Scene scene = twoMembranes(true, 12, clustered(grid(3, 4), 4));
  const auto dealtOut = decompose(scene, world());
  std::vector<BodyLayout> layout = layoutBodies(scene, *world());
  for (scene::Body& body : scene.bodies)
    body.decomposition.cluster = 0;
  const auto joined = decompose(scene, std::move(layout), world());
  EXPECT_EQ(dealtOut.problem.clusters.size(), 6U);
  EXPECT_EQ(joined.problem.clusters.size(), 2U);
  ASSERT_EQ(joined.problem.subdomains.size(), dealtOut.problem.subdomains.size());
  for (std::size_t s = 0; s < joined.problem.subdomains.size(); ++s)
    EXPECT_EQ(joined.problem.subdomains[s].number, dealtOut.problem.subdomains[s].number);
}

TEST(ClustersTest, NoCrosspointBelongsToTwo) {
  for (const Case& c : clusteredCases(true)) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    const DecomposedProblem& p = result.problem;
    struct Sighting {
      GlobalOrdinal unknown;
      int cluster;
    };
    std::vector<Sighting> mine;
    for (const Subdomain& s : p.subdomains)
      for (const CoarseNumber unknown : s.crosspointIndices)
        mine.push_back({unknown, p.clusterOf[s.number]});
    std::map<GlobalOrdinal, int> cluster;
    for (const Sighting& sighting : gatherOnAll(*p.comm, mine))
      EXPECT_EQ(cluster.try_emplace(sighting.unknown, sighting.cluster).first->second, sighting.cluster);
    EXPECT_GT(smallestPivot(p), 1e-6);
  }
}

TEST(ClustersTest, MergedTheyHaveNoKernelButTheirOwn) {
  for (const Case& c : clusteredCases(false)) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    EXPECT_EQ(kernelDimension(mergedStiffness(result.problem)), result.problem.kernelDimension);
  }
}

TEST(ClustersTest, TheirMotionsCostNothingAndAmongThemAreThoseOfTheBodies) {
  for (const Case& c : clusteredCases(true)) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    scene::Scene plain = c.scene;
    for (scene::Body& body : plain.bodies) // the same numbers of subdomains
      body.decomposition.cluster = 0;
    const auto whole = decompose(plain, world());
    for (const Subdomain& s : result.problem.subdomains) {
      const double scale = Eigen::VectorXd(s.stiffness->diagonal()).maxCoeff();
      if (s.kernel.size() > 0) {
        EXPECT_LE((*s.stiffness * s.kernel).cwiseAbs().maxCoeff(),
                  1e-9 * scale * s.kernel.cwiseAbs().maxCoeff());
      }
      EXPECT_EQ(result.problem.clusterAt(s).ofBody.cols(), result.problem.bodies[s.body].kernelDimension);
    }
    EXPECT_EQ(result.problem.numRigidModes(), whole.problem.kernelDimension);
    // A motion of a body does not tear its gluing, R X of the clusters' modes.
    const DecomposedProblem& p = result.problem;
    std::vector<double> jumps(p.dualDimension() * std::max(1, p.numRigidModes()), 0.0);
    for (const Subdomain& s : p.subdomains) {
      const Eigen::MatrixXd modes = s.kernel * p.clusterAt(s).ofBody;
      const int first = p.bodies[s.body].kernelOffset;
      for (const ConstraintEntry& entry : s.constraint)
        for (Eigen::Index mode = 0; mode < modes.cols(); ++mode)
          jumps[p.numberOf(entry.multiplier) * p.numRigidModes() + first + mode] +=
              entry.coefficient * modes(entry.unknown, mode);
    }
    sumOverRanks(*p.comm, std::span(jumps));
    for (GlobalOrdinal row = p.numInequalities; row < p.dualDimension(); ++row)
      for (int mode = 0; mode < p.numRigidModes(); ++mode)
        EXPECT_NEAR(jumps[row * p.numRigidModes() + mode], 0, 1e-9) << row;
  }
}

/// Σ b²/δ of each row of gluing over its entries, δ = diag K^s. Collective.
std::map<GlobalOrdinal, double> lengthsOfRows(const DecomposedProblem& problem) {
  struct Square {
    GlobalOrdinal row;
    double value;
  };
  std::vector<Square> mine;
  for (const Subdomain& s : problem.subdomains)
    for (const auto& entry : s.constraint)
      if (problem.kindOf(TouchedMultiplier(entry.multiplier)) == RowKind::gluing)
        mine.push_back(
            {problem.multiplierGhostMap->getGlobalElement(entry.multiplier),
             entry.coefficient * entry.coefficient / s.stiffness->coeff(entry.unknown, entry.unknown)});
  std::map<GlobalOrdinal, double> lengths;
  for (const Square& square : gatherOnAll(*problem.comm, mine))
    lengths[square.row] += square.value;
  return lengths;
}

TEST(ClustersTest, RowsBetweenThemAreOfOneLengthHoweverTheStiffnessJumps) {
  for (const auto& [cut, isEach] :
       {std::pair(clustered(grid(3, 3), 1), true), {clustered(grid(3, 2), 2), false}}) {
    scene::Scene scene = oneBody(12, 12, cut, {{"wall", "left", {0.0}}});
    scene.bodies[0].regions = {{"stiff", mesh::rectangle(0.2, 0.6, 0.1, 0.9), "", {1e5}}};
    const Decomposition cutScene = decompose(scene, world());
    const std::map<GlobalOrdinal, double> lengths = lengthsOfRows(cutScene.problem);
    ASSERT_GT(lengths.size(), 20U);
    const auto [least, largest] = std::minmax_element(
        lengths.begin(), lengths.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (isEach)
      EXPECT_LE(largest->second, (1 + 1e-12) * least->second);
    else // within a cluster entries are 1 and −1
      EXPECT_GE(largest->second, 1e3 * least->second);
  }
}

TEST(ClustersTest, GluingHoldsThemTogether) {
  for (const Case& c : clusteredCases(false)) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    const Eigen::MatrixXd b = mergedConstraint(result.problem);
    EXPECT_EQ(kernelDimension(b * b.transpose()), 0); // no row is redundant
    const Eigen::MatrixXd gluing = b.bottomRows(result.problem.numEqualities),
                          k = mergedStiffness(result.problem);
    EXPECT_EQ(kernelDimension(k + k.diagonal().maxCoeff() * gluing.transpose() * gluing),
              result.problem.numRigidModes());
  }
}

TEST(ClustersTest, OneSubdomainAClusterIsFeti) {
  const auto result = decompose(twoMembranes(true, 12, clustered(grid(3, 3), 1)), world());
  EXPECT_EQ(result.problem.clusters.size(), 18u);
  EXPECT_EQ(result.problem.kernelDimension, 18 - 6); // three of each body are held
  EXPECT_EQ(result.problem.numCrosspoints, 12);      // one inside each that floats
}

TEST(ClustersTest, SubdomainsTooSmallToBeHeldInsideAreRefused) {
  for (const auto& cut : {clustered(grid(6, 3), 1), clustered(grid(12, 6), 4)}) // 2 × 2 elements, one
    EXPECT_THROW((void)decompose(solid(2, cut, true), world()), InputError);
}

} // namespace
} // namespace epafi::decomposition
