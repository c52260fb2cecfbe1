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

/// Growing 1/H and H/h; forms of F and preconditioners; memory. Rows of one rank.
std::string growthReport(const ScalingTable& table, const ScalingSizes& sizes);
std::string combinationReport(const ScalingTable& table, const ScalingSizes& sizes);
/// Strong and weak scaling with efficiencies, as far as the table has rows of one rank to compare with; messages.
std::string ranksReport(const ScalingTable& table, const ScalingSizes& sizes);

std::string blockReport(const std::vector<BlockProduct>& products, double streamRate);
std::string costReport(const std::vector<DualCostTimes>& times);
std::string predictionReport(const std::vector<PredictedStep>& steps, const ScalingRow& like);

std::string blocksCsv(const std::vector<BlockProduct>& products, double streamRate);

} // namespace epafi::drivers
