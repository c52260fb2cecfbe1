#pragma once

/// What the two forms of F cost beside what src/fetidp/CostModel.cpp expects, from which 'auto' chooses.

#include "epafi/base/Types.hpp"
#include "epafi/fetidp/CostModel.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// Of all subdomains of a problem on one rank.
struct DualCostTimes {
  int elementsPerSide = 0;              ///< H/h
  bool isShared = false;                ///< identical subdomains share factor and block
  double boundary = 0;                  ///< n_Δ, the largest
  fetidp::DualCosts measured, expected; ///< seconds

  /// Numbers a second, in the units of CostModel.cpp: entries of factors, entries of blocks or additions and
  /// multiplications with them, the same when blocks are made.
  double factorRate = 0, blockRate = 0, inverseRate = 0;
  /// After how many products explicit blocks have paid off; infinite if they never do.
  [[nodiscard]] static double payoff(const fetidp::DualCosts& costs);
};

/// The coercive model problem with 1/H = `subdomainsPerSide`, on this rank alone; medians. Not collective.
std::vector<DualCostTimes> timeDualCosts(int subdomainsPerSide, const std::vector<int>& elementsPerSide);

/// As a table: H_over_h, shared (0/1), …
std::string costsCsv(const std::vector<DualCostTimes>& times);

} // namespace epafi::drivers
