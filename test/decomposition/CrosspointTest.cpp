#include "support/Gathered.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/decomposition/Crosspoints.hpp"

#include <Tpetra_Map.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace epafi::decomposition {
namespace {

TEST(CrosspointTest, EverySubdomainIsRegularOnceItsCrosspointsAreHeld) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    EXPECT_GT(smallestPivot(decompose(c.scene, world()).problem), 1e-6);
  }
}

TEST(CrosspointTest, MergedBodiesHaveNoKernelButTheirOwn) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    EXPECT_EQ(kernelDimension(mergedStiffness(result.problem)), result.problem.kernelDimension);
  }
}

TEST(CrosspointTest, AnIndexMeansTheSameNodeInEverySubdomain) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    const DecomposedProblem& p = result.problem;
    const std::size_t n = p.crosspointMap->getGlobalNumElements();
    std::vector<double> copies(n, 0), sum(n, 0), sumOfSquares(n, 0);
    for (const Subdomain& s : p.subdomains)
      for (std::size_t k = 0; k < s.crosspointUnknowns.size(); ++k) {
        const std::size_t index = s.crosspointIndices[k];
        ASSERT_LT(index, n);
        const double key = nodeKey(s, s.crosspointUnknowns[k], p.components);
        copies[index] += 1;
        sum[index] += key;
        sumOfSquares[index] += key * key;
      }
    for (auto* values : {&copies, &sum, &sumOfSquares})
      sumOverRanks(*p.comm, *values);
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_GE(copies[k], 1);
      EXPECT_EQ(copies[k] * sumOfSquares[k], sum[k] * sum[k]) << k; // no spread: whole numbers, exact
      if (k > 0) {
        EXPECT_LT(sum[k - 1] / copies[k - 1], sum[k] / copies[k]); // numbered by body, then node
      }
    }
  }
}

TEST(CrosspointTest, UnknownsAreSplitWithoutLossOrOverlap) {
  for (const Case& c : smallCases()) {
    SCOPED_TRACE(c.name);
    const auto result = decompose(c.scene, world());
    for (const Subdomain& s : result.problem.subdomains) {
      std::vector<int> all = s.remainderUnknowns;
      all.insert(all.end(), s.crosspointUnknowns.begin(), s.crosspointUnknowns.end());
      std::sort(all.begin(), all.end());
      ASSERT_EQ(all.size(), s.unknownPosition.size());
      for (std::size_t k = 0; k < all.size(); ++k)
        EXPECT_EQ(all[k], static_cast<int>(k));
      EXPECT_TRUE(std::is_sorted(s.remainderUnknowns.begin(), s.remainderUnknowns.end()));
      EXPECT_TRUE(std::is_sorted(s.crosspointUnknowns.begin(), s.crosspointUnknowns.end()));
    }
  }
}

TEST(CrosspointTest, AGridHasItsInnerAndEdgeCornersOnlyWhateverIsSupported) {
  const fem::SolidSupport left{"left", "left", {0.0}}, right{"right", "right", {0.0}},
      top{"top", "top", {0.0}}, bottom{"bottom", "bottom", {0.0}};
  for (const std::vector<fem::SolidSupport>& supports :
       {std::vector<fem::SolidSupport>{}, {left}, {left, right}, {bottom}, {left, right, top, bottom}})
    for (const auto& [nx, ny] : {std::pair{2, 2}, {3, 2}, {4, 4}, {1, 2}, {2, 1}}) {
      const auto result = decompose(oneBody(8, 8, grid(nx, ny), supports), world());
      EXPECT_EQ(result.problem.numCrosspoints, (nx + 1) * (ny + 1) - 4)
          << nx << " x " << ny << ", " << supports.size() << " supports";
    }
}

TEST(CrosspointTest, AMiddleRowBetweenSupportedEndsIsHeldByItsOwnSupports) {
  // Both ends of each interface are supported, and so are both sides of it: nothing is added.
  const fem::SolidSupport left{"left", "left", {0.0}}, right{"right", "right", {0.0}};
  EXPECT_EQ(decompose(oneBody(4, 6, grid(1, 3), {left, right}), world()).problem.numCrosspoints, 4);
}

TEST(CrosspointTest, AFloatingBodyInOnePieceIsHeldAtItsCentre) {
  const auto result = decompose(oneBody(4, 4, grid(1, 1), {}), world());
  EXPECT_EQ(result.problem.numCrosspoints, 1);
  for (const Subdomain& s : result.problem.subdomains) {
    ASSERT_EQ(s.crosspointUnknowns.size(), 1u);
    EXPECT_EQ(nodeKey(s, s.crosspointUnknowns.front(), 1), 1e6 + 12); // node (2,2) of 5 × 5
  }
  const auto held = decompose(oneBody(4, 4, grid(1, 1), {{"left", "left", {0.0}}}), world());
  EXPECT_EQ(held.problem.numCrosspoints, 0);
}

/// Part 1 is a box of elements inside part 0.
class InclusionPartition final : public Partition {
public:
  InclusionPartition(const mesh::StructuredMesh& mesh, int margin)
      : elements_(mesh.elements()), margin_(margin) {}
  [[nodiscard]] int numParts() const override { return 2; }
  [[nodiscard]] int partOf(GlobalOrdinal element) const override {
    const GlobalOrdinal i = element % elements_[0], j = element / elements_[0];
    const bool inside =
        i >= margin_ && j >= margin_ && i < elements_[0] - margin_ && j < elements_[1] - margin_;
    return inside ? 1 : 0;
  }
  [[nodiscard]] std::vector<GlobalOrdinal> elementsOf(int part) const override {
    std::vector<GlobalOrdinal> elements;
    for (GlobalOrdinal e = 0; e < static_cast<GlobalOrdinal>(elements_[0]) * elements_[1]; ++e)
      if (partOf(e) == part)
        elements.push_back(e);
    return elements;
  }

private:
  std::array<int, 3> elements_;
  int margin_;
};

TEST(CrosspointTest, AnInterfaceThatIsAClosedLoopGetsOnePoint) {
  const scene::Body body = oneBody(6, 6, grid(1, 1), {{"left", "left", {0.0}}}).bodies.front();
  std::vector<BodyLayout> bodies(1);
  auto mesh = std::make_unique<const mesh::StructuredMesh>(body.mesh.box, body.mesh.elements);
  bodies[0].partition = std::make_unique<InclusionPartition>(*mesh, 2);
  bodies[0].mesh = std::move(mesh);
  bodies[0].name = body.name;
  scene::Scene scene;
  scene.bodies = {body};
  const DecomposedProblem problem = std::move(model::decompose(scene, std::move(bodies), world()).problem);
  EXPECT_EQ(problem.numCrosspoints, 1);
  EXPECT_EQ(problem.crosspointMap->getGlobalNumElements(), 1U);
  for (const Subdomain& subdomain : problem.subdomains) // both sides know it
    EXPECT_EQ(subdomain.crosspointUnknowns.size(), 1U) << subdomain.number;
}

} // namespace
} // namespace epafi::decomposition
