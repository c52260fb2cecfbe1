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

/// What the resultant along a motion is compared with: |R|ᵀ|f| of the motion's modes.
double loadAlong(const Eigen::VectorXd& magnitudes, const Eigen::VectorXd& motion) {
  return magnitudes.dot(motion.cwiseAbs());
}

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
  const bool isPulled = motion.norm() > 0 &&
                        std::abs(kernelLoad.dot(motion)) > resultantTolerance * loadAlong(magnitudes, motion);
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

  const Eigen::VectorXd motion =
      nonNegativeLeastSquares(directions, kernelLoad).residual; // allowed, and pulled along
  if (motion.norm() > 0 && kernelLoad.dot(motion) > resultantTolerance * loadAlong(magnitudes, motion))
    refuse(SolvabilityError::Kind::noSolution,
           "the load pulls " + bodiesOf(problem, motion) + " away from its contacts (resultant " +
               number(kernelLoad.dot(motion) / motion.norm()) +
               " along a motion that no contact hinders); turn the load or add a support");

  // Still inside the cone when every contact direction takes away a little: ẽ is in its interior.
  Eigen::VectorXd all = directions.rowwise().sum();
  const double load = magnitudes.sum();
  if (all.norm() == 0)
    return; // the contacts oppose each other: any resultant is balanced
  const double margin = 10 * resultantTolerance * load / all.norm();
  const Eigen::VectorXd loose = nonNegativeLeastSquares(directions, kernelLoad - margin * all).residual;
  if (load == 0 || loose.norm() > 0.1 * margin)
    refuse(SolvabilityError::Kind::notUnique,
           "the load does not press " + bodiesOf(problem, load == 0 || loose.norm() == 0 ? all : loose) +
               " onto its contacts (zero resultant), so that it may come to rest anywhere; add a load or a "
               "support");
}

void requireContactForEveryMotion(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries) {
  const SubdomainVectors load = loadsOf(problem);
  refuseFreeMotion(problem, contactDirections(problem, entries), kernelLoad(problem, load),
                   kernelLoadMagnitude(problem, load));
}

void requireFeasibleGaps(const DecomposedProblem& problem) {
  MultiplierExchange exchange(problem);
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
