#include "epafi/fetidp/CostModel.hpp"

#include <cmath>

namespace epafi::fetidp {
namespace {

constexpr double solveRate = 2e9;    ///< entries of a sparse factor a second, one right-hand side
constexpr double batchRate = 6e9;    ///< the same, several right-hand sides at once
constexpr double streamRate = 1.5e9; ///< entries of a dense block a second, one vector
constexpr double productRate = 1e10; ///< multiplications and additions a second, several vectors
constexpr double inverseRate = 4e9;  ///< the same when the block is made
constexpr double callSeconds = 5e-7; ///< what a call costs, however small

} // namespace

DualCosts expectedCosts(const SubdomainGroup& group) {
  const auto members = static_cast<double>(group.numOnAllRanks());
  const auto size = static_cast<double>(group.condensed().numBoundary());
  const auto entries = static_cast<double>(group.condensed().factor().numEntries());
  const bool isAlone = group.use() == direct::SymmetricBlock::Use::alone;
  DualCosts costs;
  costs.implicitProduct = callSeconds + 2 * members * entries / (isAlone ? solveRate : batchRate);
  costs.explicitProduct =
      callSeconds + (isAlone ? size * size / streamRate : 2 * members * size * size / productRate);
  costs.explicitSetup = callSeconds + 2.0 / 3.0 * std::pow(size, 3) / inverseRate;
  return costs;
}

bool explicitPays(const SubdomainGroup& group, int products) {
  const DualCosts costs = expectedCosts(group);
  return costs.explicitSetup + products * costs.explicitProduct < products * costs.implicitProduct;
}

} // namespace epafi::fetidp
