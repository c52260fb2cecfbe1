#include "epafi/fetidp/Solvability.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/fetidp/DualProblem.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"
#include "epafi/fetidp/NonNegativeLeastSquares.hpp"

#include <Eigen/QR>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// The distinct directions among the columns of G̃, of length 1, from all ranks: k × (a few).
Eigen::MatrixXd contactDirections(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries) {
  const Eigen::Index k = problem.kernelDimension;
  std::map<int, Eigen::VectorXd> rows;
  for (const KernelEntry& entry : entries)
    rows.try_emplace(entry.row, Eigen::VectorXd::Zero(k)).first->second[entry.mode] += entry.value;
  const auto isNew = [](const std::vector<Eigen::VectorXd>& known, const Eigen::VectorXd& direction) {
    return std::none_of(known.begin(), known.end(),
                        [&](const Eigen::VectorXd& other) { return (other - direction).norm() < 1e-12; });
  };
  std::vector<Eigen::VectorXd> directions;
  for (const auto& [row, vector] : rows)
    if (vector.norm() > 0 && isNew(directions, vector.normalized()))
      directions.push_back(vector.normalized());

  std::vector<double> mine;
  for (const auto& direction : directions)
    mine.insert(mine.end(), direction.begin(), direction.end());
  const std::vector<double> all = gatherOnAll(*problem.comm, mine);
  directions.clear();
  for (std::size_t first = 0; first < all.size(); first += static_cast<std::size_t>(k)) {
    const Eigen::VectorXd direction = Eigen::Map<const Eigen::VectorXd>(all.data() + first, k);
    if (isNew(directions, direction))
      directions.push_back(direction);
  }
  Eigen::MatrixXd result(k, static_cast<Eigen::Index>(directions.size()));
  for (std::size_t j = 0; j < directions.size(); ++j)
    result.col(static_cast<Eigen::Index>(j)) = directions[j];
  return result;
}

/// Is ẽ in the cone of the directions? With each body's mode measured by its own load (one of the lightest where a
/// mode carries none) and the directions of length 1 again: neither changes the answer, but a heavy body does not
/// hide a light one.
struct ScaledCone {
  Eigen::VectorXd unit;       ///< by which a mode's resultant is divided
  Eigen::MatrixXd directions; ///< k × (a few)
  Eigen::VectorXd resultant;  ///< k

  ScaledCone(const Eigen::MatrixXd& contacts, const Eigen::VectorXd& kernelLoad,
             const Eigen::VectorXd& magnitudes)
      : unit(magnitudes) {
    double least = std::numeric_limits<double>::infinity();
    for (const double magnitude : magnitudes)
      least = magnitude > 0 ? std::min(least, magnitude) : least;
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

/// A motion that no contact hinders in either direction: ẽᵀα must vanish, and even then α is undetermined.
void refuseFreeMotion(const DecomposedProblem& problem, const Eigen::MatrixXd& directions,
                      const Eigen::VectorXd& kernelLoad, const Eigen::VectorXd& magnitudes) {
  const Eigen::Index k = problem.kernelDimension;
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(k, std::max<Eigen::Index>(directions.cols(), 1));
  padded.leftCols(directions.cols()) = directions;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(padded);
  if (qr.rank() == k)
    return;
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd free = q.rightCols(k - qr.rank()); // G̃ᵀ free = 0
  Eigen::VectorXd motion = free * (free.transpose() * kernelLoad);
  const bool isPulled = motion.norm() > resultantTolerance * magnitudes.norm();
  if (!isPulled)
    motion = free.col(0);
  const std::string who = bodiesOf(problem, motion);
  if (isPulled)
    refuse(SolvabilityError::Kind::noSolution,
           who + " can move without meeting a support or a contact, and the load moves it (resultant " +
               number(kernelLoad.dot(motion) / motion.norm()) + "); add a support or a contact pair");
  refuse(SolvabilityError::Kind::notUnique,
         who + " can move without meeting a support or a contact; add a support or a contact pair");
}

} // namespace

std::string bodiesOf(const DecomposedProblem& problem, const Eigen::VectorXd& motion) {
  std::string names;
  int count = 0;
  for (const auto& body : problem.bodies)
    if (body.kernelDimension > 0 &&
        motion.segment(body.kernelOffset, body.kernelDimension).norm() > 1e-6 * motion.norm()) {
      names += (count > 0 ? "', '" : "'") + body.name;
      ++count;
    }
  return (count > 1 ? "the floating bodies " : "the floating body ") + names + "'";
}

void requireUniqueSolution(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries,
                           const Eigen::VectorXd& kernelLoad) {
  if (problem.kernelDimension == 0)
    return;
  const Eigen::MatrixXd directions = contactDirections(problem, entries);
  const Eigen::VectorXd magnitudes = kernelLoadMagnitude(problem, loadsOf(problem));
  refuseFreeMotion(problem, directions, kernelLoad, magnitudes);

  const ScaledCone cone(directions, kernelLoad, magnitudes);
  const Eigen::VectorXd pulled = cone.imbalance(cone.resultant, resultantTolerance);
  if (pulled.norm() > 0) {
    const Eigen::VectorXd motion = pulled.cwiseQuotient(cone.unit); // allowed, and driven by the load
    refuse(SolvabilityError::Kind::noSolution,
           "the load pulls " + bodiesOf(problem, pulled) + " away from its contacts (resultant " +
               number(kernelLoad.dot(motion) / motion.norm()) +
               " along a motion that no contact hinders); turn the load or add a support");
  }

  // Still inside the cone when every contact direction takes away a little: ẽ is in its interior.
  const Eigen::VectorXd all = cone.directions.rowwise().sum();
  if (all.norm() <= 1e-12)
    return; // the contacts oppose each other: any resultant is balanced
  const bool isLoaded = magnitudes.sum() > 0;
  const Eigen::VectorXd loose =
      isLoaded ? cone.imbalance(cone.resultant - 10 * resultantTolerance * all, resultantTolerance) : all;
  if (loose.norm() > 0)
    refuse(SolvabilityError::Kind::notUnique,
           "the load does not press " + bodiesOf(problem, loose) +
               " onto its contacts (zero resultant), so that it may come to rest anywhere; add a load or a "
               "support");
}

void requireContactForEveryMotion(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries) {
  const SubdomainVectors load = loadsOf(problem);
  refuseFreeMotion(problem, contactDirections(problem, entries), kernelLoad(problem, load),
                   kernelLoadMagnitude(problem, load));
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
                " joins two supported nodes that overlap by " + number(-gaps[i]));
  });
}

} // namespace epafi::fetidp
