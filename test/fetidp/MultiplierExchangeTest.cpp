#include "support/DenseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Compatibility.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>
#include <gtest/gtest.h>

#include <random>

namespace epafi::fetidp {
namespace {

TEST(MultiplierExchangeTest, BringsEveryTouchedMultiplierToItsSubdomains) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const DecomposedProblem& problem = decomposition.problem;
    MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
    const Eigen::VectorXd lambda = randomVector(static_cast<Eigen::Index>(problem.dualDimension()), 3);
    const std::span<const double> mine = exchange.toSubdomains(*spread(problem.multiplierMap, lambda));
    ASSERT_EQ(mine.size(), numLocal(*problem.multiplierGhostMap));
    for (std::size_t i = 0; i < mine.size(); ++i)
      EXPECT_EQ(mine[i], lambda[problem.multiplierGhostMap->getGlobalElement(static_cast<LocalOrdinal>(i))]);
  }
}

TEST(MultiplierExchangeTest, SumsTheContributionsOfAllRanks) {
  const auto decomposition = decompose(twoMembranes(true, 6, grid(2, 2)), world());
  const DecomposedProblem& problem = decomposition.problem;
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  Eigen::VectorXd touching = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.dualDimension()));
  for (const GlobalOrdinal row : localIndices(*problem.multiplierGhostMap))
    touching[row] += 1; // ranks that touch a multiplier
  sumOverRanks(*problem.comm, {touching.data(), static_cast<std::size_t>(touching.size())});
  for (double& value : exchange.values())
    value = 1.0;
  Vector owned(problem.multiplierMap);
  owned.putScalar(-3.0); // overwritten
  exchange.sumToOwners(owned);
  EXPECT_EQ(gathered(owned), touching);
}

TEST(MultiplierExchangeTest, BothDirectionsAreAdjoint) {
  for (const ContactCase& c : contactCases()) {
    SCOPED_TRACE(c.name);
    const auto decomposition = decompose(c.scene, world());
    const DecomposedProblem& problem = decomposition.problem;
    MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
    const Eigen::VectorXd x = randomVector(static_cast<Eigen::Index>(problem.dualDimension()), 5);
    std::mt19937 random(static_cast<unsigned>(11 + world()->getRank()));
    std::normal_distribution<double> normal;
    std::vector<double> y(numLocal(*problem.multiplierGhostMap));
    for (double& value : y)
      value = normal(random);

    const std::span<const double> there = exchange.toSubdomains(*spread(problem.multiplierMap, x));
    double left = 0; // (E x)ᵀ y
    for (std::size_t i = 0; i < y.size(); ++i)
      left += there[i] * y[i];
    left = sumOverRanks(*problem.comm, left);
    std::copy(y.begin(), y.end(), exchange.values().begin());
    Vector back(problem.multiplierMap);
    exchange.sumToOwners(back); // Eᵀ y
    EXPECT_NEAR(left, x.dot(gathered(back)), 1e-13 * x.norm() * gathered(back).norm());
  }
}

} // namespace
} // namespace epafi::fetidp
