#pragma once

/// How long an iteration would take on many ranks: a model, with what was measured on one.

#include "ScalingTable.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// scaling_coarse.csv: the coarse problem of the coercive model problem, which every rank solves alike, for 1/H in the list, on
/// this rank alone; medians. Not collective.
Table timeCoarseProblems(const std::vector<int>& subdomainsPerSide);

/// A network where a message of n bytes takes latency + n / bandwidth, and a sum over p ranks of n bytes
/// 2 log₂ p latency + 2 n / bandwidth (Rabenseifner's algorithm; log₂ p latency where n is small).
struct Network {
  double latency = 1.5e-6;   ///< s a message
  double bandwidth = 12.5e9; ///< bytes/s a rank
};

/// Weak scaling of the coercive problem: `like` on one rank gives the local time a subdomain, 1/h grows with the ranks.
/// Each rank has a square of subdomains with four neighbours. The coarse problem has one unknown a subdomain; its time
/// and size are extrapolated as c nᵃ through the two largest of `coarse`.
/// Columns of scaling_prediction.csv; coarse_bytes of the factor, on every rank. Precondition: two rows in `coarse`.
Table predictSteps(const Row& like, const Table& coarse, const std::vector<double>& subdomainsPerRank,
                   const Network& network = {});

} // namespace epafi::drivers
