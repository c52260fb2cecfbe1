#include "epafi/fetidp/operator/CostModel.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

namespace epafi::fetidp {
namespace {

/// The model problem with 1/H = 4.
struct Factorised {
  explicit Factorised(int elementsPerSide, bool share = false)
      : cut(model::decompose(scene::modelProblem(true, 4, 4 * elementsPerSide), Tpetra::getDefaultComm())),
        inverse(cut.problem, {"CHOLMOD", "CHOLMOD", share}) {}

  model::Decomposition cut;
  GeneralizedInverse inverse;
};

TEST(CostModelTest, BlocksInThePlanePayOffWhenUsedOften) {
  for (const int elements : {4, 8, 16, 32})
    for (const bool share : {false, true})
      for (Factorised problem(elements, share); const SubdomainGroup& group : problem.inverse.groups())
        EXPECT_TRUE(explicitPays(group, 40)) << elements;
}

/// Subdomains at the border of a body have a smaller block, which is made sooner.
TEST(CostModelTest, BlocksOfSubdomainsAmidOthersDoNotPayOffForOneProduct) {
  for (const int elements : {8, 16, 32})
    for (Factorised problem(elements); const SubdomainGroup& group : problem.inverse.groups()) {
      const bool isSurrounded = group.condensed().numBoundary() == 4 * (elements - 1);
      EXPECT_FALSE(isSurrounded && explicitPays(group, 1)) << elements;
    }
}

TEST(CostModelTest, PayingOffOnceMeansPayingOffForMoreProducts) {
  for (Factorised problem(16); const SubdomainGroup& group : problem.inverse.groups())
    for (int products = 1; products < 40; ++products)
      EXPECT_LE(explicitPays(group, products), explicitPays(group, products + 1)) << products;
}

TEST(CostModelTest, AutoFollowsTheModel) {
  for (const int products : {1, 40}) {
    Factorised problem(16);
    problem.inverse.prepareDual({DualOperatorParameters::Mode::automatic, products});
    for (const SubdomainGroup& group : problem.inverse.groups())
      EXPECT_EQ(group.isExplicit(), explicitPays(group, products)) << products;
  }
}

} // namespace
} // namespace epafi::fetidp
