#pragma once

/// Which form of F is less work.

#include "epafi/fetidp/operator/SubdomainGroup.hpp"

namespace epafi::fetidp {

/// Seconds that a group's share of F is expected to take, if one rank had all that are like its members: so
/// the choice, and with it the last digit of F, is the same on any number of ranks. The rates are those of
/// one core of a present machine and only their ratios matter (how they were measured: docs/performance.md).
struct DualCosts {
  double implicitProduct = 0, explicitProduct = 0, explicitSetup = 0;
};
DualCosts expectedCosts(const SubdomainGroup& group);

/// Whether a dense block, its making included, is expected to be faster over so many products.
bool explicitPays(const SubdomainGroup& group, int products);

} // namespace epafi::fetidp
