#pragma once

/// What the scaling study says to people: tables in markdown.

#include "DualCostTimes.hpp"
#include "MemoryRates.hpp"
#include "RankPrediction.hpp"
#include "ScalingSeries.hpp"
#include "ScalingTable.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// Growing 1/H and H/h; forms of F and preconditioners; memory: rows of one rank. Strong and weak scaling
/// with efficiencies, as far as the table has rows of one rank to compare with; messages.
std::string scalingReport(const Table& table, const ScalingSizes& sizes);

std::string blockReport(const Table& products, double streamRate);
std::string costReport(const Table& times);
std::string predictionReport(const Table& steps);

} // namespace epafi::drivers
