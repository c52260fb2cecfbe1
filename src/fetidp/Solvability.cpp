#include "epafi/fetidp/Solvability.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/ContactDirections.hpp"
#include "epafi/fetidp/DualProblem.hpp"
#include "epafi/fetidp/MotionWords.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"
#include "epafi/fetidp/NonNegativeLeastSquares.hpp"

#include <Eigen/Eigenvalues>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// Is ẽ in the cone of the directions? With each body's modes measured by the load on it (by that of the least loaded
/// one where a body carries none) and the directions of length 1 again: neither changes the answer, but a heavy body
/// does not hide a light one.
struct ScaledCone {
  Eigen::VectorXd unit;       ///< by which a mode's resultant is divided
  Eigen::MatrixXd directions; ///< k × (as many as differ)
  Eigen::VectorXd resultant;  ///< k

  ScaledCone(const DecomposedProblem& problem, const Eigen::MatrixXd& contacts,
             const Eigen::VectorXd& kernelLoad, const Eigen::VectorXd& magnitudes)
      : unit(Eigen::VectorXd::Zero(magnitudes.size())) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& body : problem.bodies)
      if (body.kernelDimension > 0) {
        const double load = magnitudes.segment(body.kernelOffset, body.kernelDimension).maxCoeff();
        unit.segment(body.kernelOffset, body.kernelDimension).setConstant(load);
        least = load > 0 ? std::min(least, load) : least;
      }
    for (double& value : unit)
      value = value > 0 ? value : std::isfinite(least) ? least : 1.0;
    directions = unit.cwiseInverse().asDiagonal() * contacts;
    directions.colwise().normalize();
    resultant = kernelLoad.cwiseQuotient(unit);
  }

  /// What of `target` no forces x ≥ 0 along the directions can balance: 0 where it is below `tolerance` or within
  /// round-off of the forces that pass through.
  [[nodiscard]] Eigen::VectorXd imbalance(const Eigen::VectorXd& target, double tolerance) const {
    const NonNegativeSolution forces = nonNegativeLeastSquares(directions, target);
    const Eigen::VectorXd passing = directions.cwiseAbs() * forces.x;
    Eigen::VectorXd result = forces.residual;
    for (Eigen::Index i = 0; i < result.size(); ++i)
      if (std::abs(result[i]) <= tolerance + 1e-12 * passing[i])
        result[i] = 0;
    return result;
  }
};

[[noreturn]] void refuse(SolvabilityError::Kind kind, const std::string& text) {
  throw SolvabilityError(
      kind, (kind == SolvabilityError::Kind::noSolution ? "no solution: " : "not unique: ") + text);
}

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// `before` and what the motion is, if it is more than a move of a scalar field.
std::string along(const DecomposedProblem& problem, const Eigen::VectorXd& motion,
                  const std::string& before) {
  const std::string words = wordsOf(problem, motion);
  return words == "move" ? "" : before + words;
}

/// A motion that contacts hinder by less than this share of it, in the root mean square, they do not hinder: the rest is
/// round-off of their normals.
constexpr double hindered = 1e-6;

/// Motions that no contact hinders in either direction, orthonormal columns: G̃ᵀ free = 0.
Eigen::MatrixXd freeMotions(const Eigen::MatrixXd& directions) {
  if (directions.cols() == 0)
    return Eigen::MatrixXd::Identity(directions.rows(), directions.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(directions * directions.transpose() /
                                                                static_cast<double>(directions.cols()));
  const auto numFree = (spectrum.eigenvalues().array() <= hindered * hindered).count();
  return spectrum.eigenvectors().leftCols(numFree);
}

/// ẽᵀα must vanish for a motion α that nothing hinders, and even then α is undetermined. All measured by the modes'
/// lengths.
void refuseFreeMotion(const DecomposedProblem& problem, const Eigen::MatrixXd& directions,
                      const Eigen::VectorXd& kernelLoad, const Eigen::VectorXd& magnitudes,
                      const Eigen::VectorXd& lengths) {
  const Eigen::MatrixXd free = freeMotions(directions);
  if (free.cols() == 0)
    return;
  const Eigen::VectorXd motion = free * (free.transpose() * kernelLoad);
  if (motion.norm() > resultantTolerance * magnitudes.norm()) {
    const Eigen::VectorXd alpha = motion.cwiseQuotient(lengths);
    refuse(SolvabilityError::Kind::noSolution,
           bodiesOf(problem, alpha) +
               " can move without meeting a support or a contact, and the load moves it "
               "(resultant " +
               number(kernelLoad.dot(motion) / motion.norm()) + along(problem, alpha, " to ") +
               "); add a support or a contact pair");
  }
  refuse(SolvabilityError::Kind::notUnique,
         abilitiesOf(problem, lengths.cwiseInverse().asDiagonal() * free) +
             " without meeting a support or a contact; add a support or a contact pair");
}

} // namespace

void requireUniqueSolution(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries,
                           const Eigen::VectorXd& kernelLoad) {
  if (problem.kernelDimension == 0)
    return;
  const Eigen::VectorXd lengths = modeLengths(problem);
  const Eigen::MatrixXd directions = contactDirections(problem, entries, lengths);
  const Eigen::VectorXd load = kernelLoad.cwiseQuotient(lengths),
                        magnitudes = kernelLoadMagnitude(problem, loadsOf(problem)).cwiseQuotient(lengths);
  refuseFreeMotion(problem, directions, load, magnitudes, lengths);

  const ScaledCone cone(problem, directions, load, magnitudes);
  const Eigen::VectorXd scale = cone.unit.cwiseProduct(lengths);
  const Eigen::VectorXd pulled = cone.imbalance(cone.resultant, resultantTolerance);
  if (pulled.norm() > 0) {
    const Eigen::VectorXd motion = pulled.cwiseQuotient(scale); // allowed, and driven by the load
    refuse(SolvabilityError::Kind::noSolution,
           "the load pulls " + bodiesOf(problem, pulled.cwiseQuotient(lengths)) +
               " away from its contacts (resultant " +
               number(kernelLoad.dot(motion) / motion.cwiseProduct(lengths).norm()) +
               " along a motion that no contact hinders" + along(problem, motion, ": ") +
               "); turn the load or add a support");
  }

  // Still inside the cone when every contact direction takes away a little: ẽ is in its interior.
  const Eigen::VectorXd mean = cone.directions.rowwise().mean();
  if (mean.norm() <= 1e-12)
    return; // the contacts oppose each other: any resultant is balanced
  const bool isLoaded = magnitudes.sum() > 0;
  const Eigen::VectorXd loose =
      isLoaded ? cone.imbalance(cone.resultant - 10 * resultantTolerance * mean, resultantTolerance)
               : cone.imbalance(-mean, resultantTolerance);
  if (loose.norm() > 0)
    refuse(SolvabilityError::Kind::notUnique,
           "the load does not press " + bodiesOf(problem, loose.cwiseQuotient(lengths)) +
               " onto its contacts (zero resultant" +
               along(problem, loose.cwiseQuotient(scale), " along a motion that no contact hinders: ") +
               "), so that it may come to rest anywhere; add a load or a support");
}

void requireContactForEveryMotion(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries) {
  const SubdomainVectors load = loadsOf(problem);
  const Eigen::VectorXd lengths = modeLengths(problem);
  refuseFreeMotion(problem, contactDirections(problem, entries, lengths),
                   kernelLoad(problem, load).cwiseQuotient(lengths),
                   kernelLoadMagnitude(problem, load).cwiseQuotient(lengths), lengths);
}

void requireFeasibleGaps(const DecomposedProblem& problem) {
  MultiplierExchange exchange(rcp(new Import(problem.multiplierMap, problem.multiplierGhostMap)));
  const std::span<double> magnitude = exchange.values();
  std::fill(magnitude.begin(), magnitude.end(), 0.0);
  for (const auto& subdomain : problem.subdomains)
    for (const auto& entry : subdomain.constraint)
      magnitude[static_cast<std::size_t>(entry.multiplier)] += std::abs(entry.coefficient);
  Vector rowSum(problem.multiplierMap);
  exchange.sumToOwners(rowSum);
  // The gaps are differences of prescribed values: what is round-off of these does not overlap.
  double largest = problem.gap->normInf();
  for (const auto& subdomain : problem.subdomains)
    if (subdomain.prescribed.size() > 0)
      largest = std::max(largest, subdomain.prescribed.lpNorm<Eigen::Infinity>());
  const double roundOff = 1e-12 * maxOverRanks(*problem.comm, largest);
  collectively(*problem.comm, [&] {
    const auto sums = rowSum.getData();
    const auto gaps = problem.gap->getData();
    for (Teuchos_Ordinal i = 0; i < sums.size(); ++i)
      if (sums[i] == 0 && gaps[i] < -roundOff)
        throw SolvabilityError(
            SolvabilityError::Kind::noSolution,
            "no solution: contact row " +
                std::to_string(problem.multiplierMap->getGlobalElement(static_cast<LocalOrdinal>(i))) +
                " lies where supports hold both sides, and they overlap by " + number(-gaps[i]) +
                "; change a gap, an obstacle or a support");
  });
}

} // namespace epafi::fetidp
