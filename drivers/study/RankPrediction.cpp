#include "RankPrediction.hpp"

#include "Median.hpp"

#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <array>
#include <cmath>

namespace epafi::drivers {
namespace {

constexpr double smallReductions = 4; ///< a step: two of MPRGP, two of contact at crosspoints
constexpr double exchanges = 4; ///< a step: to the subdomains and back, for F and for its preconditioner

Row timeCoarseProblem(int subdomainsPerSide) {
  constexpr int elementsPerSide = 4; // of no importance for the coarse problem
  const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  const model::Decomposition cut = model::decompose(
      scene::modelProblem(true, subdomainsPerSide, subdomainsPerSide * elementsPerSide), alone);
  const fetidp::DirectSolvers solvers;
  const fetidp::GeneralizedInverse inverse(cut.problem, solvers);
  std::vector<decomposition::CoarseNumber> crosspoints; // a single rank has them all
  for (int unknown = 0; unknown < inverse.coarseProblem().size(); ++unknown)
    crosspoints.emplace_back(unknown);
  const double begin = Teuchos::Time::wallTime();
  const fetidp::CoarseProblem coarse(cut.problem, inverse.groups(), crosspoints, solvers);
  const double setup = Teuchos::Time::wallTime() - begin;
  std::vector<AccurateSum> z(static_cast<std::size_t>(coarse.size()), AccurateSum(1.0));
  Eigen::MatrixXd x(coarse.size(), 1);
  return {{"coarse_unknowns", coarse.size()},
          {"setup_seconds", setup},
          {"solve_seconds", medianSeconds(*alone, 0.1, [&] { coarse.solve(z, x); })},
          {"factor_bytes", coarse.factorBytes()}};
}

/// y(n) = c nᵃ through two points.
double extrapolated(double n, const std::array<double, 2>& sizes, const std::array<double, 2>& values) {
  const double exponent = std::log(values[1] / values[0]) / std::log(sizes[1] / sizes[0]);
  return values[1] * std::pow(n / sizes[1], exponent);
}

} // namespace

Table timeCoarseProblems(const std::vector<int>& subdomainsPerSide) {
  Table times("coarse_unknowns,setup_seconds,solve_seconds,factor_bytes");
  for (const int counts : subdomainsPerSide)
    times.rows.push_back(timeCoarseProblem(counts));
  return times;
}

Table predictSteps(const Row& like, const Table& coarse, const std::vector<double>& subdomainsPerRank,
                   const Network& network) {
  const Row &last = coarse.rows.back(), &before = coarse.rows[coarse.rows.size() - 2];
  const auto coarseAt = [&](double n, const char* column) {
    return extrapolated(n, {before.number("coarse_unknowns"), last.number("coarse_unknowns")},
                        {before.number(column), last.number(column)});
  };
  const double numSubdomains = 2 * std::pow(like.number("H_inverse"), 2);
  const double perSubdomain =
      like.number("solve_seconds") / like.number("hessian_multiplications") / numSubdomains;
  Table steps("ranks,subdomains_per_rank,coarse_unknowns,local_seconds,neighbour_seconds,reduction_seconds,"
              "coarse_sum_seconds,coarse_solve_seconds,total_seconds,efficiency,coarse_share,coarse_bytes");
  for (const double subdomains : subdomainsPerRank)
    for (const double ranks : {1e0, 1e1, 1e2, 1e3, 1e4, 1e5}) {
      const double unknowns = ranks * subdomains, rounds = std::ceil(std::log2(ranks));
      const double local = subdomains * perSubdomain, solve = coarseAt(unknowns, "solve_seconds");
      double neighbours = 0, sum = 0;
      if (ranks > 1) {
        // Of the multipliers on its four sides a rank owns half: those it sends, the others it sends back.
        const double sent = sizeof(double) * 2 * std::sqrt(subdomains) * (like.number("H_over_h") - 1);
        neighbours = exchanges * (4 * network.latency + sent / network.bandwidth);
        sum = 2 * rounds * network.latency + 2 * unknowns * sizeof(AccurateSum) / network.bandwidth;
      }
      const double reductions = smallReductions * rounds * network.latency;
      const double total = local + neighbours + reductions + sum + solve;
      steps.rows.push_back({{"ranks", ranks},
                            {"subdomains_per_rank", subdomains},
                            {"coarse_unknowns", unknowns},
                            {"local_seconds", local},
                            {"neighbour_seconds", neighbours},
                            {"reduction_seconds", reductions},
                            {"coarse_sum_seconds", sum},
                            {"coarse_solve_seconds", solve},
                            {"total_seconds", total},
                            {"efficiency", local / total},
                            {"coarse_share", (sum + solve) / total},
                            {"coarse_bytes", coarseAt(unknowns, "factor_bytes")}});
    }
  return steps;
}

} // namespace epafi::drivers
