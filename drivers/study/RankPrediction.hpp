#pragma once

/// How long an iteration would take on many ranks: a model, with what was measured on one.

#include "ScalingTable.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// scaling_coarse.csv: what of a step is of the whole problem's size, on this rank alone; medians. For each
/// 1/H in the list the coarse problem of FETI-DP (`kind` crosspoints) and G̃G̃ᵀ of FETI (motions),
/// `solve_seconds` once through the factor and back.
/// \param problem  of scalingScene(). Not collective.
Table timeCoarseProblems(const std::string& problem, const std::vector<int>& subdomainsPerSide);

/// A network where a message of n bytes takes latency + n / bandwidth, and a sum over p ranks of n bytes
/// 2 log₂ p latency + 2 n / bandwidth (Rabenseifner's algorithm; log₂ p latency where n is small).
struct Network {
  double latency = 1.5e-6;   ///< s a message
  double bandwidth = 12.5e9; ///< bytes/s a rank
};

/// What one rank does for itself, as measured on one.
struct LocalWork {
  std::string problem;
  double secondsPerSubdomain = 0; ///< and product with F: all of the solve
  int elementsPerSide = 0;        ///< H/h
  double stream = 1e10;           ///< bytes/s from memory

  /// From a run of the study.
  static LocalWork of(const Row& run);
};

/// scaling_prediction.csv without rows.
Table predictedTable();

/// Weak scaling: 1/h grows with the ranks, each of which has a square or cube of subdomains and a neighbour
/// on every side. Methods: feti-dp; feti-1, whose clusters are subdomains; hybrid, whose clusters are those
/// of one rank or of as many as is fastest within 200 MB a rank (cluster_ranks), every rank with the factor
/// of G̃G̃ᵀ; hybrid-spread, with rows of its inverse on each rank (fetidp/GramInverse.hpp). Sizes of coarse
/// problems are extrapolated as c nᵃ through the two largest of `coarse`, and read as fast as the largest.
/// Columns of scaling_prediction.csv; bytes_a_rank: of the coarse problem on every rank. Precondition: two
/// rows of each kind in `coarse`.
Table predictSteps(const LocalWork& local, const Table& coarse, const std::vector<double>& subdomainsPerRank,
                   const Network& network = {});

} // namespace epafi::drivers
