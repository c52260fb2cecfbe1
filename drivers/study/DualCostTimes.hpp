#pragma once

/// What the two forms of F cost beside what src/fetidp/operator/CostModel.cpp expects, from which 'auto'
/// chooses.

#include "Table.hpp"

#include "epafi/fetidp/operator/CostModel.hpp"

namespace epafi::drivers {

/// After how many products explicit blocks have paid off; infinite if they never do.
double payoffOf(const fetidp::DualCosts& costs);

/// scaling_costs.csv, of all subdomains of the coercive model problem with 1/H = `subdomainsPerSide`, on this
/// rank alone; medians. `boundary` is n_Δ, the largest; rates are numbers a second, in the units of
/// CostModel.cpp: entries of factors, entries of blocks or additions and multiplications with them, the same
/// when blocks are made. Not collective.
Table timeDualCosts(int subdomainsPerSide, const std::vector<int>& elementsPerSide);

} // namespace epafi::drivers
