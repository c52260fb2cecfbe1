#include "epafi/fetidp/operator/CostModel.hpp"

#include <cmath>

namespace epafi::fetidp {
namespace {

// Measured by `epafi-study scaling` on subdomains with H/h from 8 to 64 (docs/performance.md); within a
// factor of two.
constexpr double solveRate = 1.3e9;     ///< entries of a factor a second
constexpr double streamRate = 3e9;      ///< entries of a dense block a second, one vector
constexpr double productRate = 2.2e10;  ///< multiplications and additions a second, several vectors
constexpr double inverseRate = 8e9;     ///< the same when the block is made
constexpr double callSeconds = 1e-7;    ///< what a product costs, however small, and each half of a solve
constexpr double blockSeconds = 1.5e-6; ///< what making a block costs, however small

} // namespace

DualCosts expectedCosts(const SubdomainGroup& group) {
  const auto members = static_cast<double>(group.numOnAllRanks());
  const auto size = static_cast<double>(group.condensed().numBoundary());
  const auto entries = static_cast<double>(group.condensed().factor().numKeptEntries());
  const bool isAlone = group.use() == direct::SymmetricBlock::Use::alone;
  DualCosts costs;
  costs.implicitProduct = members * (2 * callSeconds + 2 * entries / solveRate);
  costs.explicitProduct =
      callSeconds + (isAlone ? size * size / streamRate : 2 * members * size * size / productRate);
  costs.explicitSetup = blockSeconds + 2.0 / 3.0 * std::pow(size, 3) / inverseRate;
  return costs;
}

bool explicitPays(const SubdomainGroup& group, int products) {
  const DualCosts costs = expectedCosts(group);
  return costs.explicitSetup + products * costs.explicitProduct < products * costs.implicitProduct;
}

} // namespace epafi::fetidp
