#include "RankPrediction.hpp"

#include "Median.hpp"
#include "ScalingScene.hpp"

#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/fetidp/KernelConstraint.hpp"
#include "epafi/fetidp/KernelGram.hpp"
#include "epafi/model/Decompose.hpp"

#include <Eigen/SparseCholesky>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_Time.hpp>

#include <cmath>

namespace epafi::drivers {
namespace {

constexpr int elementsOfCoarse = 4; ///< H/h, of no importance for the coarse problem
constexpr double secondsOfSolves = 0.1;
/// A step's sums over the ranks, as counted (scaling.csv): scalar products, and contact at crosspoints in the preconditioner, whose
/// bytes are those of each side that a subdomain has in contact, in the plane and in space.
constexpr double scalarSums = 2, contactSums = 2;
constexpr double contactBytesInPlane = 350, contactBytesInSpace = 1100;
constexpr double exchanges = 4;   ///< a step: to the subdomains and back, for F and for its preconditioner
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
  std::vector<AccurateSum> z(static_cast<std::size_t>(coarse.size()), AccurateSum(1.0));
  Eigen::MatrixXd x(coarse.size(), 1);
  return coarseRow(problem, "crosspoints", cut, coarse.size(), setup,
                   medianSeconds(alone, secondsOfSolves, [&] { coarse.solve(z, x); }),
                   static_cast<double>(coarse.factorBytes()));
}

Row timeMotions(const std::string& problem, const model::Decomposition& cut, const Comm& alone) {
  const fetidp::KernelGram gram(cut.problem, fetidp::kernelConstraint(cut.problem));
  const double begin = Teuchos::Time::wallTime();
  const Eigen::SimplicialLLT<fetidp::KernelGram::Matrix> factor(gram.whole());
  const double setup = Teuchos::Time::wallTime() - begin;
  Eigen::VectorXd x = Eigen::VectorXd::Ones(gram.size());
  const auto nonZeros = static_cast<double>(factor.matrixL().nestedExpression().nonZeros());
  return coarseRow(problem, "motions", cut, gram.size(), setup,
                   medianSeconds(alone, secondsOfSolves,
                                 [&] {
                                   factor.matrixL().solveInPlace(x);
                                   factor.matrixU().solveInPlace(x);
                                 }),
                   nonZeros * (sizeof(double) + sizeof(int)));
}

/// Bytes c nᵃ of a factor through the two largest of a kind; a solve reads them as fast as the largest was read.
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
};

class Model {
public:
  Model(const LocalWork& local, const Table& coarse, const Network& network)
      : local_(local), network_(network), crosspoints_(coarse, local.problem, "crosspoints"),
        motions_(coarse, local.problem, "motions"), dimension_(dimensionOf(local.problem)) {}

  [[nodiscard]] Row step(const std::string& method, double subdomains, double ranks) const {
    const double own = subdomains * local_.secondsPerSubdomain;
    const CoarseStep coarse = coarseStep(method, subdomains, ranks);
    const double neighbours = ranks > 1 ? neighbourSeconds(subdomains) : 0;
    const double reductions = ranks > 1 ? reductionSeconds(subdomains, ranks) : 0;
    const double total = own + neighbours + reductions + coarse.sum + coarse.solve;
    return {{"problem", local_.problem},
            {"method", method},
            {"subdomains_a_rank", subdomains},
            {"ranks", ranks},
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
  [[nodiscard]] double neighbourSeconds(double subdomains) const {
    const double components = dimension_ == 3 ? 3 : 1,
                 onSide = std::pow(std::pow(subdomains, 1.0 / dimension_) * (local_.elementsPerSide - 1),
                                   dimension_ - 1);
    return exchanges * (2 * dimension_ * network_.latency +
                        sizeof(double) * components * dimension_ * onSide / network_.bandwidth);
  }
  /// Of the scalar products, and of contact along a half of the problem's middle.
  [[nodiscard]] double reductionSeconds(double subdomains, double ranks) const {
    const double sides = std::pow(subdomains * ranks / 2, (dimension_ - 1.0) / dimension_),
                 bytes = sides * (dimension_ == 3 ? contactBytesInSpace : contactBytesInPlane);
    return scalarSums * std::ceil(std::log2(ranks)) * network_.latency +
           contactSums * sumSeconds(ranks, bytes / contactSums);
  }
  [[nodiscard]] double sumSeconds(double ranks, double bytes) const {
    return ranks > 1 ? 2 * std::ceil(std::log2(ranks)) * network_.latency + 2 * bytes / network_.bandwidth
                     : 0;
  }
  [[nodiscard]] CoarseStep coarseStep(const std::string& method, double subdomains, double ranks) const {
    const double crosspoints = crosspoints_.perSubdomain() * subdomains;
    if (method == "feti-dp") {
      const double n = crosspoints * ranks;
      return {n, sumSeconds(ranks, bytesOfSum * n), crosspoints_.seconds(n),
              crosspoints_.bytes(n) + bytesOfSum * n};
    }
    const double modes = dimension_ == 3 ? 6 : 1,
                 k = modes * (method == "feti-1" ? subdomains * ranks : ranks);
    CoarseStep step{k, sumSeconds(ranks, bytesOfSum * k), motions_.seconds(k),
                    motions_.bytes(k) + bytesOfSum * k};
    if (method ==
        "hybrid-spread") { // the small vectors go to all once, each rank has the rows of its motions
      step.sum = std::ceil(std::log2(ranks)) * network_.latency + sizeof(double) * k / network_.bandwidth;
      step.solve = sizeof(double) * modes * k / local_.stream;
      step.bytes = sizeof(double) * (modes + 2) * k;
    }
    if (method != "feti-1")
      step.solve += crosspoints_.seconds(crosspoints);
    return step;
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
  return Table("problem,method,subdomains_a_rank,ranks,coarse_unknowns,local_seconds,neighbour_seconds,"
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
