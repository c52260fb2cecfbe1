#pragma once

/// How long an iteration would take on many ranks: a model, with what was measured on one.

#include "ScalingTable.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

/// The coarse problem of the coercive model problem, which every rank solves alike.
struct CoarseTimes {
  double unknowns = 0, setupSeconds = 0, solveSeconds = 0, bytes = 0;
};

/// For 1/H in the list, on this rank alone; medians. Not collective.
std::vector<CoarseTimes> timeCoarseProblems(const std::vector<int>& subdomainsPerSide);

/// A network where a message of n bytes takes latency + n / bandwidth, and a sum over p ranks of n bytes
/// 2 log₂ p latency + 2 n / bandwidth (Rabenseifner's algorithm; log₂ p latency where n is small).
struct Network {
  double latency = 1.5e-6;   ///< s a message
  double bandwidth = 12.5e9; ///< bytes/s a rank
};

/// Seconds of one iteration.
struct PredictedStep {
  double ranks = 0, subdomainsPerRank = 0, coarseUnknowns = 0;
  double local = 0;      ///< products with the rank's subdomains, preconditioner, vectors: as measured
  double neighbours = 0; ///< messages between neighbours
  double reductions = 0; ///< of scalar products
  double coarseSum = 0, coarseSolve = 0;
  double coarseBytes = 0; ///< factor, on every rank
  [[nodiscard]] double total() const { return local + neighbours + reductions + coarseSum + coarseSolve; }
  [[nodiscard]] double efficiency() const { return local / total(); }
  [[nodiscard]] double coarseShare() const { return (coarseSum + coarseSolve) / total(); }
};

/// Weak scaling of the coercive problem: `like` on one rank gives the local time a subdomain, 1/h grows with the ranks.
/// Each rank has a square of subdomains with four neighbours. The coarse problem has one unknown a subdomain; its time
/// and size are extrapolated as c nᵃ through the two largest of `coarse`.
/// Precondition: two different entries in `coarse`.
std::vector<PredictedStep> predictSteps(const ScalingRow& like, const std::vector<CoarseTimes>& coarse,
                                        const std::vector<double>& subdomainsPerRank,
                                        const Network& network = {});

std::string coarseCsv(const std::vector<CoarseTimes>& coarse);
std::string predictionCsv(const std::vector<PredictedStep>& steps);

} // namespace epafi::drivers
