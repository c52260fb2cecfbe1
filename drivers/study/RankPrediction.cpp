#include "RankPrediction.hpp"

#include "Median.hpp"

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

namespace epafi::drivers {
namespace {

constexpr double smallReductions = 4; ///< a step: two of MPRGP, two of contact at crosspoints
constexpr double exchanges = 4; ///< a step: to the subdomains and back, for F and for its preconditioner

CoarseTimes timeCoarseProblem(int subdomainsPerSide) {
  constexpr int elementsPerSide = 4; // of no importance for the coarse problem
  const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  const decomposition::Decomposition cut = decomposition::decompose(
      scene::modelProblem(true, subdomainsPerSide, subdomainsPerSide * elementsPerSide), alone);
  const fetidp::DirectSolvers solvers;
  const fetidp::GeneralizedInverse inverse(cut.problem, solvers);
  std::vector<GlobalOrdinal> crosspoints(static_cast<std::size_t>(inverse.coarseProblem().size()));
  std::iota(crosspoints.begin(), crosspoints.end(), GlobalOrdinal{0}); // a single rank has them all
  const double begin = Teuchos::Time::wallTime();
  const fetidp::CoarseProblem coarse(cut.problem, inverse.groups(), crosspoints, solvers);
  CoarseTimes times;
  times.setupSeconds = Teuchos::Time::wallTime() - begin;
  times.unknowns = coarse.size();
  times.bytes = static_cast<double>(coarse.factorBytes());
  std::vector<AccurateSum> z(static_cast<std::size_t>(coarse.size()), AccurateSum(1.0));
  Eigen::MatrixXd x(coarse.size(), 1);
  times.solveSeconds = medianSeconds(*alone, 0.1, [&] { coarse.solve(z, x); });
  return times;
}

/// y(n) = c nᵃ through two points.
double extrapolated(double n, const std::array<double, 2>& sizes, const std::array<double, 2>& values) {
  const double exponent = std::log(values[1] / values[0]) / std::log(sizes[1] / sizes[0]);
  return values[1] * std::pow(n / sizes[1], exponent);
}

} // namespace

std::vector<CoarseTimes> timeCoarseProblems(const std::vector<int>& subdomainsPerSide) {
  std::vector<CoarseTimes> times;
  for (const int counts : subdomainsPerSide)
    times.push_back(timeCoarseProblem(counts));
  return times;
}

std::vector<PredictedStep> predictSteps(const ScalingRow& like, const std::vector<CoarseTimes>& coarse,
                                        const std::vector<double>& subdomainsPerRank,
                                        const Network& network) {
  const CoarseTimes &last = coarse.back(), &before = coarse[coarse.size() - 2];
  const auto coarseAt = [&](double n, double CoarseTimes::*value) {
    return extrapolated(n, {before.unknowns, last.unknowns}, {before.*value, last.*value});
  };
  std::vector<PredictedStep> steps;
  for (const double subdomains : subdomainsPerRank)
    for (const double ranks : {1e0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
      PredictedStep step;
      step.ranks = ranks;
      step.subdomainsPerRank = subdomains;
      step.coarseUnknowns = ranks * subdomains;
      step.local = subdomains * like.solve / like.hessianMultiplications / like.numSubdomains();
      step.coarseSolve = coarseAt(step.coarseUnknowns, &CoarseTimes::solveSeconds);
      step.coarseBytes = coarseAt(step.coarseUnknowns, &CoarseTimes::bytes);
      if (ranks > 1) {
        const double rounds = std::ceil(std::log2(ranks));
        // Of the multipliers on its four sides a rank owns half: those it sends, the others it sends back.
        const double sent = sizeof(double) * 2 * std::sqrt(subdomains) * (like.elementsPerSide - 1);
        step.neighbours = exchanges * (4 * network.latency + sent / network.bandwidth);
        step.reductions = smallReductions * rounds * network.latency;
        step.coarseSum =
            2 * rounds * network.latency + 2 * step.coarseUnknowns * sizeof(AccurateSum) / network.bandwidth;
      }
      steps.push_back(step);
    }
  return steps;
}

std::string coarseCsv(const std::vector<CoarseTimes>& coarse) {
  std::ostringstream csv;
  csv << "coarse_unknowns,setup_seconds,solve_seconds,factor_bytes\n";
  for (const CoarseTimes& row : coarse)
    csv << row.unknowns << ',' << row.setupSeconds << ',' << row.solveSeconds << ',' << row.bytes << '\n';
  return csv.str();
}

std::string predictionCsv(const std::vector<PredictedStep>& steps) {
  std::ostringstream csv;
  csv << "ranks,subdomains_per_rank,coarse_unknowns,local_seconds,neighbour_seconds,reduction_seconds,"
         "coarse_sum_seconds,coarse_solve_seconds,total_seconds,efficiency,coarse_share,coarse_bytes\n";
  for (const PredictedStep& step : steps)
    csv << step.ranks << ',' << step.subdomainsPerRank << ',' << step.coarseUnknowns << ',' << step.local
        << ',' << step.neighbours << ',' << step.reductions << ',' << step.coarseSum << ','
        << step.coarseSolve << ',' << step.total() << ',' << step.efficiency() << ',' << step.coarseShare()
        << ',' << step.coarseBytes << '\n';
  return csv.str();
}

} // namespace epafi::drivers
