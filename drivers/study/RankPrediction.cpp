#include "RankPrediction.hpp"

#include "Median.hpp"
#include "ScalingScene.hpp"

#include "epafi/base/RankGroups.hpp"
#include "epafi/fetidp/equilibrium/KernelConstraint.hpp"
#include "epafi/fetidp/equilibrium/KernelGram.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/SparseCholesky>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_Time.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace epafi::drivers {
namespace {

constexpr int elementsOfCoarse = 4; ///< H/h, of no importance for the coarse problem
constexpr double secondsOfSolves = 0.1;
/// A step's sums over the ranks, as counted (scaling.csv): scalar products, which motions of clusters go
/// along with, and contact at crosspoints in the preconditioner, whose bytes are those of each side that a
/// subdomain has in contact, in the plane and in space.
constexpr double scalarSums = 2, contactSums = 2;
constexpr double contactBytesInPlane = 350, contactBytesInSpace = 1100;
/// Products with N⁻¹ and with K a step: two projections on a face (KernelFaceInverse).
constexpr double gramProducts = 4, faceProducts = 2;
/// Crosspoint values that follow the borders of a cluster of sᵈ subdomains (fetidp/ContactCrosspoints.hpp):
/// so many times s or s²; 1392 were counted in 16 corner clusters of 4³, which have borders on half of their
/// sides.
constexpr double borderInPlane = 4, borderInSpace = 10.5;
constexpr double exchanges = 4; ///< a step: to the subdomains and back, for F and for its preconditioner
constexpr double clusterExchanges = 2; ///< and for crosspoints at the borders of clusters
constexpr double mostClusterRanks = 1024,
                 mostBytes = 2e8; ///< of clusters that are looked at, and of what a rank may hold
constexpr double bytesOfSum = 16; ///< of an AccurateSum

int dimensionOf(const std::string& problem) {
  return problem == "blocks" ? 3 : 2;
}

Row coarseRow(const std::string& problem, const char* kind, const model::Decomposition& cut, int unknowns,
              double setup, double solve, double bytes) {
  return {{"problem", problem},   {"kind", kind},           {"subdomains", cut.problem.subdomains.size()},
          {"unknowns", unknowns}, {"setup_seconds", setup}, {"solve_seconds", solve},
          {"factor_bytes", bytes}};
}

Row timeCrosspoints(const std::string& problem, const model::Decomposition& cut, const Comm& alone) {
  const fetidp::DirectSolvers solvers;
  const fetidp::GeneralizedInverse inverse(cut.problem, solvers);
  std::vector<decomposition::CoarseNumber> crosspoints; // a single rank has them all
  for (int unknown = 0; unknown < inverse.coarseProblem().size(); ++unknown)
    crosspoints.emplace_back(unknown);
  const double begin = Teuchos::Time::wallTime();
  const fetidp::CoarseProblem coarse(cut.problem, inverse.groups(), crosspoints, solvers);
  const double setup = Teuchos::Time::wallTime() - begin;
  std::vector<AccurateSum> z(coarse.size(), AccurateSum(1.0));
  Eigen::MatrixXd x(coarse.size(), 1);
  return coarseRow(problem, "crosspoints", cut, coarse.size(), setup,
                   medianSeconds(alone, secondsOfSolves, [&] { coarse.solve(z, x); }),
                   static_cast<double>(coarse.factorBytes()));
}

Row timeMotions(const std::string& problem, const model::Decomposition& cut, const Comm& alone) {
  const Eigen::SparseMatrix<double> gram =
      fetidp::kernelGram(cut.problem, fetidp::kernelConstraint(cut.problem), RankGroups(cut.problem.comm, 1));
  const double begin = Teuchos::Time::wallTime();
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(gram);
  const double setup = Teuchos::Time::wallTime() - begin;
  Eigen::VectorXd x = Eigen::VectorXd::Ones(gram.rows());
  const auto nonZeros = static_cast<double>(factor.matrixL().nestedExpression().nonZeros());
  return coarseRow(problem, "motions", cut, static_cast<int>(gram.rows()), setup,
                   medianSeconds(alone, secondsOfSolves,
                                 [&] {
                                   factor.matrixL().solveInPlace(x);
                                   factor.matrixU().solveInPlace(x);
                                 }),
                   nonZeros * (sizeof(double) + sizeof(int)));
}

/// Bytes c nᵃ of a factor through the two largest of a kind; a solve reads them as fast as the largest was
/// read.
class Extrapolation {
public:
  Extrapolation(const Table& coarse, const std::string& problem, const std::string& kind) {
    for (const Row& row : coarse.rows)
      if (row.text("problem") == problem && row.text("kind") == kind) {
        before_ = last_;
        last_ = row;
      }
  }
  [[nodiscard]] double bytes(double n) const {
    const auto logarithm = [&](const char* column) {
      return std::log(last_.number(column) / before_.number(column));
    };
    return last_.number("factor_bytes") *
           std::pow(n / last_.number("unknowns"), logarithm("factor_bytes") / logarithm("unknowns"));
  }
  [[nodiscard]] double seconds(double n) const {
    return bytes(n) / last_.number("factor_bytes") * last_.number("solve_seconds");
  }
  [[nodiscard]] double perSubdomain() const { return last_.number("unknowns") / last_.number("subdomains"); }

private:
  Row before_, last_;
};

/// What a step takes beside its local work.
struct CoarseStep {
  double unknowns = 0, sum = 0, solve = 0, bytes = 0;
  double clusterRanks = 0; ///< ranks that share a cluster
};

class Model {
public:
  Model(const LocalWork& local, const Table& coarse, const Network& network)
      : local_(local), network_(network), crosspoints_(coarse, local.problem, "crosspoints"),
        motions_(coarse, local.problem, "motions"), dimension_(dimensionOf(local.problem)) {}

  [[nodiscard]] Row step(const std::string& method, double subdomains, double ranks) const {
    const double own = subdomains * local_.secondsPerSubdomain;
    const CoarseStep coarse = coarseStep(method, subdomains, ranks);
    const bool hasClusters = method != "feti-dp";
    const double neighbours =
        ranks > 1 ? (exchanges + (hasClusters ? clusterExchanges : 0)) * exchangeSeconds(subdomains) : 0;
    const double reductions = ranks > 1 ? scalarSums * std::ceil(std::log2(ranks)) * network_.latency +
                                              (hasClusters ? 0 : contactSeconds(subdomains, ranks))
                                        : 0;
    const double total = own + neighbours + reductions + coarse.sum + coarse.solve;
    return {{"problem", local_.problem},
            {"method", method},
            {"subdomains_a_rank", subdomains},
            {"ranks", ranks},
            {"cluster_ranks", coarse.clusterRanks},
            {"coarse_unknowns", coarse.unknowns},
            {"local_seconds", own},
            {"neighbour_seconds", neighbours},
            {"reduction_seconds", reductions},
            {"coarse_sum_seconds", coarse.sum},
            {"coarse_solve_seconds", coarse.solve},
            {"total_seconds", total},
            {"efficiency", own / total},
            {"coarse_share", (coarse.sum + coarse.solve) / total},
            {"bytes_a_rank", coarse.bytes}};
  }

private:
  /// Of the multipliers on its sides a rank owns half: those it sends, the others it sends back.
  [[nodiscard]] double exchangeSeconds(double subdomains) const {
    const double components = dimension_ == 3 ? 3 : 1,
                 onSide = std::pow(std::pow(subdomains, 1.0 / dimension_) * (local_.elementsPerSide - 1),
                                   dimension_ - 1);
    return 2 * dimension_ * network_.latency +
           sizeof(double) * components * dimension_ * onSide / network_.bandwidth;
  }
  /// Of contact along a half of the problem's middle.
  [[nodiscard]] double contactSeconds(double subdomains, double ranks) const {
    const double bytes =
        onSection(subdomains * ranks / 2) * (dimension_ == 3 ? contactBytesInSpace : contactBytesInPlane);
    return contactSums * sumSeconds(ranks, bytes / contactSums);
  }
  /// Of n in a square or cube, those along a side or on a face.
  [[nodiscard]] double onSection(double n) const { return std::pow(n, (dimension_ - 1.0) / dimension_); }
  [[nodiscard]] double sumSeconds(double ranks, double bytes) const {
    return ranks > 1 ? 2 * std::ceil(std::log2(ranks)) * network_.latency + 2 * bytes / network_.bandwidth
                     : 0;
  }
  [[nodiscard]] CoarseStep coarseStep(const std::string& method, double subdomains, double ranks) const {
    if (method == "feti-dp") {
      const double n = crosspoints_.perSubdomain() * subdomains * ranks;
      return {n, sumSeconds(ranks, bytesOfSum * n), crosspoints_.seconds(n),
              crosspoints_.bytes(n) + bytesOfSum * n, ranks};
    }
    if (method == "feti-1")
      return projection(subdomains * ranks, ranks, false);
    std::optional<CoarseStep> best;
    for (double inCluster = 1; inCluster <= std::min(ranks, mostClusterRanks); inCluster *= 2) {
      CoarseStep step = projection(ranks / inCluster, ranks, method == "hybrid-spread");
      addCluster(subdomains * inCluster, inCluster, step);
      const auto rank = [](const CoarseStep& s) { return std::pair(s.bytes > mostBytes, s.sum + s.solve); };
      if (!best || rank(step) < rank(*best))
        best = step;
    }
    return *best;
  }
  /// P of so many clusters on faces, whose motions go along with the scalar products.
  [[nodiscard]] CoarseStep projection(double clusters, double ranks, bool isSpread) const {
    const double modes = dimension_ == 3 ? 6 : 1, k = modes * clusters,
                 inContact = 2 * modes * onSection(clusters / 2);
    const double faceBytes = sizeof(double) * inContact * inContact;
    CoarseStep step{k, scalarSums * 2 * bytesOfSum * k / network_.bandwidth, 0, bytesOfSum * k + faceBytes};
    if (isSpread) { // gatherings and the rank's rows
      step.sum += (gramProducts + faceProducts) * std::ceil(std::log2(ranks)) * network_.latency +
                  sizeof(double) * (gramProducts * k + faceProducts * inContact) / network_.bandwidth;
      step.solve +=
          (gramProducts * sizeof(double) * k * k + faceProducts * faceBytes) / ranks / local_.stream;
      step.bytes += (sizeof(double) * k * k + faceBytes) / ranks;
    } else {
      step.solve += gramProducts * motions_.seconds(k) + faceProducts * faceBytes / local_.stream;
      step.bytes += motions_.bytes(k) + faceBytes;
    }
    return step;
  }
  /// The coarse problem of a cluster, and how it follows the cluster's borders: each of its ranks does all of
  /// it.
  void addCluster(double subdomains, double ranks, CoarseStep& step) const {
    const double n = crosspoints_.perSubdomain() * subdomains,
                 border = (dimension_ == 3 ? borderInSpace : borderInPlane) * onSection(subdomains);
    step.clusterRanks = ranks;
    step.sum += 2 * sumSeconds(ranks, bytesOfSum * n) + sumSeconds(ranks, bytesOfSum * border);
    step.solve += crosspoints_.seconds(n) + sizeof(double) * (2 * n + border) * border / local_.stream;
    step.bytes += crosspoints_.bytes(n) + sizeof(double) * (n + border) * border + bytesOfSum * n;
  }

  LocalWork local_;
  Network network_;
  Extrapolation crosspoints_, motions_;
  int dimension_;
};

} // namespace

Table timeCoarseProblems(const std::string& problem, const std::vector<int>& subdomainsPerSide) {
  const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
  Table times("problem,kind,subdomains,unknowns,setup_seconds,solve_seconds,factor_bytes");
  for (const int cluster : {0, 1})
    for (const int counts : subdomainsPerSide) {
      scene::Scene scene = scalingScene(problem, counts, elementsOfCoarse);
      for (scene::Body& body : scene.bodies)
        body.decomposition.cluster = cluster;
      const model::Decomposition cut = model::decompose(scene, alone);
      times.rows.push_back(cluster == 0 ? timeCrosspoints(problem, cut, *alone)
                                        : timeMotions(problem, cut, *alone));
    }
  return times;
}

LocalWork LocalWork::of(const Row& run) {
  const double dimension = dimensionOf(run.text("problem"));
  const double numSubdomains = 2 * std::pow(run.number("H_inverse"), dimension);
  return {run.text("problem"),
          run.number("solve_seconds") / run.number("hessian_multiplications") / numSubdomains,
          static_cast<int>(run.number("H_over_h")), run.number("stream_bytes_per_second")};
}

Table predictedTable() {
  return Table(
      "problem,method,subdomains_a_rank,ranks,cluster_ranks,coarse_unknowns,local_seconds,neighbour_seconds,"
      "reduction_seconds,"
      "coarse_sum_seconds,coarse_solve_seconds,total_seconds,efficiency,coarse_share,bytes_a_rank");
}

Table predictSteps(const LocalWork& local, const Table& coarse, const std::vector<double>& subdomainsPerRank,
                   const Network& network) {
  const Model model(local, coarse, network);
  Table steps = predictedTable();
  for (const char* method : {"feti-dp", "feti-1", "hybrid", "hybrid-spread"})
    for (const double subdomains : subdomainsPerRank)
      for (const double ranks : {1e0, 1e1, 1e2, 1e3, 1e4, 1e5})
        steps.rows.push_back(model.step(method, subdomains, ranks));
  return steps;
}

} // namespace epafi::drivers
