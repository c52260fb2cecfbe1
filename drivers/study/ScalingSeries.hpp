#pragma once

/// Which runs the scaling study makes.

#include "ScalingTable.hpp"

#include <vector>

namespace epafi::drivers {

/// Sizes of the series; `quick` has small ones.
struct ScalingSizes {
  explicit ScalingSizes(bool quick);

  std::vector<int> subdomains;    ///< 1/H, at each of `fixedElements`
  std::vector<int> fixedElements; ///< H/h of that series
  std::vector<int> elements;      ///< H/h, at 1/H = `fixedSubdomains`
  int fixedSubdomains = 8;
  std::vector<int> allCombinations;  ///< H/h with every form of F and every preconditioner
  std::vector<int> someCombinations; ///< with every form, and every preconditioner of the shared one
  int strongSubdomains, weakSubdomains, ranksElements; ///< 1/H on any number of ranks, on one; H/h of both
  std::vector<int> coarse, coarseBlocks; ///< 1/H of coarse problems alone, of membranes and of blocks
  int blocks, blocksElements;            ///< 1/H and H/h of blocks in space
  double streamBytes, blockBytes;

  /// 1/H of the weak series: about as many subdomains a rank on any number of ranks.
  [[nodiscard]] int weakOn(double ranks) const;
};

/// Each run once.
std::vector<Row> runsOnOneRank(const ScalingSizes& sizes);
/// Strong and weak scaling; and, of membranes and blocks, FETI-DP, FETI and clusters that are ranks.
std::vector<Row> runsOnRanks(const ScalingSizes& sizes, int ranks);

} // namespace epafi::drivers
