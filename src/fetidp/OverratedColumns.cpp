#include "epafi/fetidp/OverratedColumns.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/PointToPoint.hpp"
#include "epafi/fetidp/JointStiffness.hpp"
#include "epafi/fetidp/Joints.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// The joints to look at. Collective.
std::vector<Joint> chosenJoints(const DecomposedProblem& problem, const Import& plan, JointKind kind,
                                const AdaptiveConstraintParameters& parameters) {
  std::vector<Joint> all = jointsOf(problem, plan, kind);
  if (parameters.use == AdaptiveConstraintParameters::Use::yes)
    return all;
  // Where a stiff subdomain touches a stiff one, and soft ones hold them, both would rather move: M, which stretches the
  // contact alone, knows nothing of it. Scaling takes care of gluing. Membranes do without: they gain with checkerboards and
  // lose with stripes.
  std::vector<bool> always;
  if (kind == JointKind::contact && problem.components > 1)
    always = bodiesOfVaryingStiffness(problem, parameters.stiffnessRatio);
  const std::vector<bool> varies = stiffnessVaries(problem, plan, all, parameters.stiffnessRatio, always);
  std::vector<Joint> chosen;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (varies[j])
      chosen.push_back(std::move(all[j]));
  return chosen;
}

/// The rank of each subdomain. Collective.
std::vector<int> ranksOfSubdomains(const DecomposedProblem& problem) {
  std::vector<double> mine;
  for (const auto& subdomain : problem.subdomains)
    mine.insert(mine.end(),
                {static_cast<double>(subdomain.number), static_cast<double>(problem.comm->getRank())});
  const std::vector<double> all = gatherOnAll(*problem.comm, mine);
  std::vector<int> ranks(static_cast<std::size_t>(problem.numSubdomains));
  for (std::size_t k = 0; k < all.size(); k += 2)
    ranks[static_cast<std::size_t>(all[k])] = static_cast<int>(all[k + 1]);
  return ranks;
}

/// Calls action(joint, part) for each joint and each of this rank's subdomains in it. Not collective.
void forEachPart(const DecomposedProblem& problem, const GeneralizedInverse& inverse,
                 const std::vector<Joint>& joints, PreconditionerParameters::Scaling scaling,
                 const std::function<void(std::size_t, JointPart)>& action) {
  std::map<int, std::vector<std::size_t>> jointsOfSubdomain;
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (const int number : joints[j].subdomains)
      jointsOfSubdomain[number].push_back(j);
  for (const SubdomainGroup& group : inverse.groups()) {
    CondensedBoundary boundary; // of all members alike
    for (const std::size_t member : group.members()) {
      const auto& subdomain = problem.subdomains[member];
      const auto found = jointsOfSubdomain.find(subdomain.number);
      if (found == jointsOfSubdomain.end())
        continue;
      if (boundary.stiffness.size() == 0)
        boundary = {group.condensed().factor().schurComplement(), group.condensed().factor().inverseOfKept()};
      for (const std::size_t j : found->second)
        action(j, partOf(subdomain, group.condensed(), boundary, joints[j].rows, scaling));
    }
  }
}

/// The parts of each joint whose first subdomain is on this rank, in the order of the subdomains. Collective.
std::vector<std::vector<JointPart>> gatheredParts(const DecomposedProblem& problem,
                                                  const GeneralizedInverse& inverse,
                                                  const std::vector<Joint>& joints,
                                                  PreconditionerParameters::Scaling scaling) {
  const std::vector<int> rankOf = ranksOfSubdomains(problem);
  const int here = problem.comm->getRank();
  const auto rankOfFirst = [&](const Joint& joint) {
    return rankOf[static_cast<std::size_t>(joint.subdomains.front())];
  };
  const Map& ghosts = *problem.multiplierGhostMap;
  const auto key = [&](const Joint& joint) { return ghosts.getGlobalElement(joint.rows.front()); };
  std::map<GlobalOrdinal, std::size_t> jointOf;
  std::set<int> senders;
  std::map<int, std::vector<double>> outgoing;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    jointOf[key(joints[j])] = j;
    for (const int number : joints[j].subdomains) {
      const int rank = rankOf[static_cast<std::size_t>(number)];
      if (rankOfFirst(joints[j]) == here && rank != here)
        senders.insert(rank);
      if (rank == here && rankOfFirst(joints[j]) != here)
        outgoing[rankOfFirst(joints[j])];
    }
  }
  std::vector<std::vector<JointPart>> parts(joints.size());
  collectively(*problem.comm, [&] {
    forEachPart(problem, inverse, joints, scaling, [&](std::size_t j, JointPart part) {
      if (rankOfFirst(joints[j]) == here) {
        parts[j].push_back(std::move(part));
        return;
      }
      std::vector<double>& message = outgoing[rankOfFirst(joints[j])];
      message.push_back(static_cast<double>(key(joints[j])));
      pack(part, message);
    });
  });
  for (const auto& [rank, values] : exchangeMessages(*problem.comm, outgoing, senders)) {
    std::span<const double> message(values);
    while (!message.empty()) {
      const std::size_t j = jointOf.at(static_cast<GlobalOrdinal>(message.front()));
      message = message.subspan(1);
      parts[j].push_back(unpack(message));
    }
  }
  for (std::vector<JointPart>& list : parts)
    std::sort(list.begin(), list.end(),
              [](const JointPart& a, const JointPart& b) { return a.subdomain < b.subdomain; });
  return parts;
}

/// A column that could be made: its ratio ω, the first row of its joint (global index), its place there.
struct Candidate {
  double ratio;
  GlobalOrdinal firstRow;
  int place;

  [[nodiscard]] std::pair<GlobalOrdinal, int> key() const { return {firstRow, place}; }
};

/// Candidates of all ranks, the worst ones if there are too many, in the order of their joints. Collective.
std::vector<Candidate> chosenCandidates(const Comm& comm, const std::vector<double>& mine,
                                        std::size_t maxNumber) {
  const std::vector<double> all = gatherOnAll(comm, mine);
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < all.size(); k += 3)
    candidates.push_back({all[k], static_cast<GlobalOrdinal>(all[k + 1]), static_cast<int>(all[k + 2])});
  if (candidates.size() > maxNumber) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.ratio != b.ratio ? a.ratio > b.ratio : a.key() < b.key();
    });
    candidates.resize(maxNumber);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); });
  return candidates;
}

} // namespace

OverratedColumns findOverratedColumns(const DecomposedProblem& problem, const GeneralizedInverse& inverse,
                                      JointKind kind, const AdaptiveConstraintParameters& parameters,
                                      PreconditionerParameters::Scaling scaling) {
  OverratedColumns columns;
  const std::vector<Joint> joints = chosenJoints(problem, *inverse.multiplierPlan(), kind, parameters);
  if (maxOverRanks(*problem.comm, static_cast<double>(joints.size())) == 0)
    return columns;
  const std::vector<std::vector<JointPart>> parts = gatheredParts(problem, inverse, joints, scaling);

  std::vector<OverratedJumps> jumps(joints.size());
  std::vector<double> mine; // ratio, first row, place of each candidate
  const auto firstRow = [&](std::size_t j) {
    return problem.multiplierGhostMap->getGlobalElement(joints[j].rows.front());
  };
  double numJoints = 0;
  collectively(*problem.comm, [&] {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (parts[j].empty())
        continue;
      ++numJoints;
      jumps[j] = overratedJumps(joined(parts[j]), parameters.threshold);
      for (Eigen::Index k = 0; k < jumps[j].ratios.size(); ++k)
        mine.insert(mine.end(),
                    {jumps[j].ratios[k], static_cast<double>(firstRow(j)), static_cast<double>(k)});
    }
  });
  columns.numJoints = static_cast<int>(sumOverRanks(*problem.comm, numJoints));
  const std::vector<Candidate> chosen =
      chosenCandidates(*problem.comm, mine, static_cast<std::size_t>(parameters.maxNumber));
  std::map<std::pair<GlobalOrdinal, int>, int> columnOf;
  for (const Candidate& candidate : chosen) {
    columnOf.emplace(candidate.key(), columns.number++);
    columns.largestRatio = std::max(columns.largestRatio, candidate.ratio);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Eigen::MatrixXd& values = kind == JointKind::gluing ? jumps[j].forces : jumps[j].jumps;
    for (Eigen::Index k = 0; k < jumps[j].ratios.size(); ++k)
      if (const auto found = columnOf.find({firstRow(j), static_cast<int>(k)}); found != columnOf.end())
        for (std::size_t i = 0; i < joints[j].rows.size(); ++i)
          columns.entries.push_back(
              {joints[j].rows[i], found->second, values(static_cast<Eigen::Index>(i), k)});
  }
  return columns;
}

} // namespace epafi::fetidp
