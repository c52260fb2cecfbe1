#include "epafi/fetidp/equilibrium/RigidMotion.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"
#include "epafi/direct/DenseSymmetric.hpp"
#include "epafi/fetidp/equilibrium/ContactDirections.hpp"
#include "epafi/fetidp/equilibrium/Friction.hpp"
#include "epafi/fetidp/equilibrium/LooseMotion.hpp"
#include "epafi/fetidp/equilibrium/MotionWords.hpp"
#include "epafi/fetidp/equilibrium/ProblemScales.hpp"
#include "epafi/fetidp/equilibrium/SlippingMotions.hpp"

#include <Eigen/SparseCholesky>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::ProblemData;
using Rows = std::map<int, Eigen::VectorXd>; // of G̃ᵀ, this rank's, by local index

constexpr double closedUpTo = 1e-6; ///< narrower than this beside the largest gap, a gap counts as closed

/// [G̃_A G̃_Aᵀ, G̃_A slack_A] of the rows A that hold. Collective.
Eigen::MatrixXd normalEquations(const DecomposedProblem& problem, const Rows& rows,
                                const std::set<int>& holding, const Vector& slack) {
  const Eigen::Index k = problem.numRigidModes();
  const auto gap = slack.getData();
  Eigen::MatrixXd normal(k, k + 1);
  std::vector<AccurateSum> sums(normal.size());
  for (const auto& [row, vector] : rows)
    if (holding.contains(row))
      for (Eigen::Index i = 0; i < k; ++i)
        for (Eigen::Index j = 0; j <= k; ++j)
          sums[i + k * j].add(vector[i] * (j < k ? vector[j] : gap[row]));
  sumOverRanks(*problem.comm, sums, normal.data());
  return normal;
}

/// How far clusters move until they fit together: the least squares of G̃ᵀα = slack over the rows that glue
/// them, where the bodies' own motions are left open the one that leaves a cluster of each in its place.
/// Collective.
Eigen::VectorXd fittedClusters(const DecomposedProblem& problem, const std::vector<KernelEntry>& entries,
                               const Vector& slack) {
  std::map<int, std::vector<KernelEntry>> rows;
  for (const KernelEntry& entry : entries)
    if (problem.kindOf(decomposition::OwnedMultiplier(entry.row)) == decomposition::RowKind::gluing)
      rows[entry.row].push_back(entry);
  const Eigen::Index k = problem.kernelDimension;
  Eigen::VectorXd alpha = Eigen::VectorXd::Zero(k);
  if (!holdsAnywhere(*problem.comm, !rows.empty()))
    return alpha;
  const auto gap = slack.getData();
  std::map<std::pair<int, int>, double> sums;
  for (const auto& [row, all] : rows)
    for (const KernelEntry& a : all) {
      alpha[a.mode] += a.value * gap[row];
      for (const KernelEntry& b : all)
        sums[{a.mode, b.mode}] += a.value * b.value;
    }
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto& [place, value] : sums)
    triplets.emplace_back(place.first, place.second, value);
  triplets = gatherOnAll(*problem.comm, triplets);
  sumOverRanks(*problem.comm, std::span<double>(alpha.data(), k));
  std::vector<bool> isHeld(problem.bodies.size(), false);
  for (const decomposition::Cluster& cluster : problem.clusters) {
    if (cluster.ofBody.cols() == 0 || isHeld[cluster.body])
      continue;
    isHeld[cluster.body] = true;
    const Eigen::MatrixXd motions = direct::orthonormalBasis(cluster.ofBody);
    const Eigen::MatrixXd hold = motions * motions.transpose();
    for (int i = 0; i < cluster.kernelDimension; ++i)
      for (int j = 0; j < cluster.kernelDimension; ++j)
        triplets.emplace_back(cluster.kernelOffset + i, cluster.kernelOffset + j, hold(i, j));
  }
  decomposition::SparseMatrix normal(k, k);
  normal.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::SimplicialLDLT<decomposition::SparseMatrix> factor(normal);
  if (factor.info() != Eigen::Success)
    throw Error("the gluing of clusters does not tell how they lie to each other; make them larger");
  return factor.solve(alpha);
}

/// How far whole bodies move until the rows close that hold.
struct Closing {
  Eigen::VectorXd alpha; ///< k, measured by the problem's scales
  Eigen::MatrixXd open;  ///< motions that these leave open, as columns
};

/// Collective.
Closing closing(const DecomposedProblem& problem, const Rows& rows, const std::set<int>& holding,
                const Vector& slack) {
  const Eigen::Index k = problem.numRigidModes();
  const Eigen::MatrixXd normal = normalEquations(problem, rows, holding, slack);
  const direct::SymmetricEigen spectrum = direct::eigenOf(normal.leftCols(k));
  const Eigen::Index numOpen = spectrum.numUpTo(ProblemScales::roundOff * spectrum.values.maxCoeff());
  const Eigen::MatrixXd held = spectrum.vectors.rightCols(k - numOpen);
  return {held * (held.transpose() * normal.col(k)).cwiseQuotient(spectrum.values.tail(k - numOpen)),
          spectrum.vectors.leftCols(numOpen)};
}

constexpr double clearForce = 1e-3; ///< a force that is more than this beside the largest one is no noise

/// Collective.
double largestForce(const DecomposedProblem& problem, const Rows& rows, const Vector& lambda) {
  const auto force = lambda.getData();
  double largest = 0;
  for (const auto& [row, vector] : rows)
    largest = std::max(largest, isTied(problem, row) ? 0.0 : force[row]);
  return maxOverRanks(*problem.comm, largest);
}

/// Drops rows whose force is none: those that are none beside the others, however loose the tolerance, and
/// those that close less than their gap, where one of the two is 0 in a solution. Returns whether there are
/// any. Collective.
bool dropIdleRows(const DecomposedProblem& problem, const Rows& rows, const Vector& lambda,
                  const Vector& slack, const RestCheck& check, const Eigen::VectorXd& alpha,
                  std::set<int>& holding) {
  const auto force = lambda.getData(), gap = slack.getData();
  const double closed = closedUpTo * slack.normInf(),
               least = std::min(check.leastForce, clearForce * largestForce(problem, rows, lambda));
  const auto dropped = std::erase_if(holding, [&](int row) {
    if (isTied(problem, row))
      return false;
    const double room = gap[row] - rows.at(row).dot(alpha);
    return force[row] <= least || (room > closed && check.flexibility * force[row] <= room);
  });
  return holdsAnywhere(*problem.comm, dropped > 0);
}

/// What is left to contacts beside those that hold, directions of length 1 and the room along them.
/// Collective.
DistinctDirections roomOf(const DecomposedProblem& problem, const Rows& rows, const Vector& slack,
                          const Eigen::VectorXd& alpha, double length) {
  const auto gap = slack.getData();
  DistinctDirections contacts(problem.numRigidModes());
  for (const auto& [row, vector] : rows) {
    const double room = (gap[row] - vector.dot(alpha)) / length;
    contacts.add(vector, room);
    if (isTied(problem, row))
      contacts.add(-vector, -room);
  }
  contacts.gather(*problem.comm);
  return contacts;
}

[[noreturn]] void refuseLoose(const MotionWords& words) {
  throw SolvabilityError(SolvabilityError::Kind::notUnique,
                         "not unique: no contact force holds " + words.bodies +
                             ", which may come to rest anywhere between its contacts" +
                             (words.motion.empty() ? "" : " (free to " + words.motion + ")") +
                             "; add a load or a support");
}

/// Motions in the span of `open` that the loads do not work on.
Eigen::MatrixXd acrossLoads(const DecomposedProblem& problem, const ProblemData& data,
                            const ProblemScales& scales, const Eigen::MatrixXd& open) {
  const Eigen::VectorXd load = onBodies(problem, kernelLoad(problem, data)).cwiseQuotient(scales.motions());
  const Eigen::VectorXd works = open.transpose() * load, terms = open.transpose().cwiseAbs() * scales.loads();
  if ((works.array().abs() <= ProblemScales::resultant * terms.array()).all())
    return open;
  return open * direct::orthogonalComplement(works);
}

/// Small forces may be what the iteration has left of none, however well it has converged. Whether they are
/// does not need their values: a motion β that ties and the larger forces allow, that opens no contact's
/// other side, and that the loads do not work on, 0 = ẽᵀβ = Σ λ_i G̃_iᵀβ, opens only contacts without force.
void refuseUnpressed(const DecomposedProblem& problem, const ProblemData& data, const Rows& rows,
                     const ProblemScales& scales, const Vector& lambda, const Vector& slack,
                     const RestCheck& check, const Eigen::VectorXd& alpha, double length) {
  const auto force = lambda.getData();
  const double least =
      std::max(clearForce * largestForce(problem, rows, lambda), check.leastForce / clearForce);
  std::set<int> pressing;
  for (const auto& [row, vector] : rows)
    if (isTied(problem, row) || force[row] > least)
      pressing.insert(row);
  const Eigen::MatrixXd open =
      acrossLoads(problem, data, scales, closing(problem, rows, pressing, slack).open);
  const DistinctDirections contacts = roomOf(problem, rows, slack, alpha, length);
  if (const auto loose = looseMotion(contacts.matrix(), contacts.values().array() - check.margin, open,
                                     ProblemScales::hindered))
    refuseLoose(wordsOf(problem, loose->cwiseQuotient(scales.motions())));
}

/// What holds a body must be more than the facets of smooth surfaces where these have closed, too.
void refuseSlipping(const DecomposedProblem& problem, const Rows& rows, const ProblemScales& scales,
                    const std::set<int>& closed) {
  const Eigen::MatrixXd slipping =
      slippingMotions(problem, rows, scales.motions(), [&](int row) { return closed.contains(row); });
  if (slipping.cols() > 0)
    throw SolvabilityError(
        SolvabilityError::Kind::notUnique,
        "not unique: where contact is closed, " +
            abilitiesOf(problem, scales.motions().cwiseInverse().asDiagonal() * slipping, facetNoise) +
            facetsAlone);
}

/// The same of whole bodies. \param entries  see kernelConstraintOfBodies
Eigen::VectorXd motionOfBodies(const DecomposedProblem& problem, const ProblemData& data,
                               const std::vector<KernelEntry>& entries, const Vector& lambda,
                               const Vector& slack, const RestCheck& check) {
  const ProblemScales scales(problem, data);
  const Rows rows = scales.hinderingRows(entries);
  const auto force = lambda.getData();
  std::set<int> holding;
  for (const auto& [row, vector] : rows)
    if (force[row] > 0 || isTied(problem, row))
      holding.insert(row);
  Closing found = closing(problem, rows, holding, slack);
  if (check.isWanted && dropIdleRows(problem, rows, lambda, slack, check, found.alpha, holding))
    found = closing(problem, rows, holding, slack);
  Eigen::VectorXd& alpha = found.alpha;
  const double length = slack.normInf();
  if (found.open.cols() > 0 && length > 0) {
    const DistinctDirections contacts = roomOf(problem, rows, slack, alpha, length);
    const Eigen::MatrixXd directions = contacts.matrix();
    const Eigen::VectorXd room = contacts.values();
    if (check.isWanted)
      if (const auto loose =
              looseMotion(directions, room.array() - closedUpTo, found.open, ProblemScales::hindered))
        refuseLoose(wordsOf(problem, loose->cwiseQuotient(scales.motions())));
    if (const ShortestMotion further = shortestMotion(found.open.transpose() * directions, room); further.x)
      alpha += length * (found.open * *further.x);
  }
  if (check.isWanted) {
    if (length > 0)
      refuseUnpressed(problem, data, rows, scales, lambda, slack, check, alpha, length);
    const auto gap = slack.getData();
    for (const auto& [row, vector] : rows)
      if (gap[row] - vector.dot(alpha) <= closedUpTo * length)
        holding.insert(row);
    refuseSlipping(problem, rows, scales, holding);
  }
  return alpha.cwiseQuotient(scales.motions());
}

} // namespace

Eigen::VectorXd rigidMotion(const DecomposedProblem& problem, const ProblemData& data,
                            const std::vector<KernelEntry>& entries, const Vector& lambda,
                            const Vector& slack, const RestCheck& check) {
  Eigen::VectorXd alpha = fittedClusters(problem, entries, slack);
  if (problem.numRigidModes() == 0)
    return alpha;
  Vector left(slack, Teuchos::Copy);
  {
    const auto values = left.getDataNonConst();
    for (const KernelEntry& entry : entries)
      values[entry.row] -= entry.value * alpha[entry.mode];
  }
  const std::vector<KernelEntry> held = withoutSlip(problem, data, lambda, entries, left);
  const Eigen::VectorXd motion =
      motionOfBodies(problem, data, kernelConstraintOfBodies(problem, held), lambda, left, check);
  for (const decomposition::Cluster& cluster : problem.clusters)
    alpha.segment(cluster.kernelOffset, cluster.kernelDimension) +=
        cluster.ofBody * motion.segment(problem.bodies[cluster.body].kernelOffset, cluster.ofBody.cols());
  return alpha;
}

} // namespace epafi::fetidp
