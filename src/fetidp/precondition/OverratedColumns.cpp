#include "epafi/fetidp/precondition/OverratedColumns.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/PointToPoint.hpp"
#include "epafi/fetidp/precondition/JointStiffness.hpp"
#include "epafi/fetidp/precondition/Joints.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;

/// Of S_ΔΔ and its inverse of the subdomains in some joints, on all ranks. Collective.
double bytesOfBlocks(const DecomposedProblem& problem, const GeneralizedInverse& inverse,
                     const std::vector<Joint>& joints, const std::vector<bool>& isIn) {
  std::set<int> subdomains;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (isIn[j])
      subdomains.insert(joints[j].subdomains.begin(), joints[j].subdomains.end());
  double bytes = 0;
  for (const SubdomainGroup& group : inverse.groups()) {
    const auto size = static_cast<double>(group.condensed().numBoundary());
    for (const std::size_t member : group.members())
      if (subdomains.contains(problem.subdomains[member].number))
        bytes += 2 * sizeof(double) * size * size;
  }
  return sumOverRanks(*problem.comm, bytes);
}

/// The joints to look at. Collective.
std::vector<Joint> chosenJoints(const DecomposedProblem& problem, const GeneralizedInverse& inverse,
                                RowKind kind, const JumpSearch& search) {
  const Import& plan = *inverse.multiplierPlan();
  std::vector<Joint> all = jointsOf(problem, plan, kind);
  if (search.use == JumpSearch::Use::yes)
    return all;
  std::vector<bool> always;
  if (search.betweenSubdomains)
    always = bodiesOfVaryingStiffness(problem, search.stiffnessRatio);
  std::vector<bool> varies = stiffnessVaries(problem, plan, all, search.stiffnessRatio, always);
  if (std::isfinite(search.mostBytes) && bytesOfBlocks(problem, inverse, all, varies) > search.mostBytes)
    varies = stiffnessVaries(problem, plan, all, search.ratioOfLarge);
  std::vector<Joint> chosen;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (varies[j])
      chosen.push_back(std::move(all[j]));
  return chosen;
}

/// The rank of each subdomain. Collective.
std::vector<int> ranksOfSubdomains(const DecomposedProblem& problem) {
  struct Place {
    int subdomain, rank;
  };
  std::vector<Place> mine;
  for (const auto& subdomain : problem.subdomains)
    mine.push_back({subdomain.number, problem.comm->getRank()});
  std::vector<int> ranks(problem.numSubdomains);
  for (const Place& place : gatherOnAll(*problem.comm, mine))
    ranks[place.subdomain] = place.rank;
  return ranks;
}

/// Calls action(joint, part) for each joint and each of this rank's subdomains in it. Not collective.
void forEachPart(const DecomposedProblem& problem, GeneralizedInverse& inverse,
                 const std::vector<Joint>& joints, PreconditionerParameters::Scaling scaling,
                 const std::function<void(std::size_t, JointPart)>& action) {
  std::map<int, std::vector<std::size_t>> jointsOfSubdomain;
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (const int number : joints[j].subdomains)
      jointsOfSubdomain[number].push_back(j);
  for (SubdomainGroup& group : inverse.groups()) {
    CondensedBoundary boundary; // of all members alike
    for (const std::size_t member : group.members()) {
      const auto& subdomain = problem.subdomains[member];
      const auto found = jointsOfSubdomain.find(subdomain.number);
      if (found == jointsOfSubdomain.end())
        continue;
      if (boundary.stiffness.size() == 0)
        boundary = group.condensedBoundary();
      for (const std::size_t j : found->second)
        action(j, partOf(subdomain, problem.clusterOf[subdomain.number], group.condensed(), boundary,
                         joints[j].rows, scaling));
    }
  }
}

GlobalOrdinal firstRowOf(const Joint& joint, const DecomposedProblem& problem) {
  return problem.multiplierGhostMap->getGlobalElement(joint.rows.front());
}

/// The parts of each joint whose first subdomain is on this rank, in the order of the subdomains. Collective.
std::vector<std::vector<JointPart>> gatheredParts(const DecomposedProblem& problem,
                                                  GeneralizedInverse& inverse,
                                                  const std::vector<Joint>& joints,
                                                  PreconditionerParameters::Scaling scaling) {
  const std::vector<int> rankOf = ranksOfSubdomains(problem);
  const int here = problem.comm->getRank();
  const auto rankOfFirst = [&](const Joint& joint) { return rankOf[joint.subdomains.front()]; };
  std::map<GlobalOrdinal, std::size_t> jointOf; // by its first row
  std::set<int> senders;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    jointOf[firstRowOf(joints[j], problem)] = j;
    if (rankOfFirst(joints[j]) == here)
      for (const int number : joints[j].subdomains)
        senders.insert(rankOf[number]);
  }
  senders.erase(here);
  std::vector<std::vector<JointPart>> parts(joints.size());
  std::map<int, std::vector<std::byte>> outgoing;
  collectively(*problem.comm, [&] {
    forEachPart(problem, inverse, joints, scaling, [&](std::size_t j, JointPart part) {
      if (const int rank = rankOfFirst(joints[j]); rank != here)
        pack(firstRowOf(joints[j], problem), part, outgoing[rank]);
      else
        parts[j].push_back(std::move(part));
    });
  });
  for (const auto& [rank, bytes] : exchange(*problem.comm, outgoing, senders))
    for (std::span<const std::byte> message(bytes); !message.empty();) {
      auto [firstRow, part] = unpack(message);
      parts[jointOf.at(firstRow)].push_back(std::move(part));
    }
  for (std::vector<JointPart>& list : parts)
    std::sort(list.begin(), list.end(),
              [](const JointPart& a, const JointPart& b) { return a.subdomain < b.subdomain; });
  return parts;
}

/// A column that could be made: its ratio ω, the first row of its joint (global index), its place there.
struct Candidate {
  double ratio;
  GlobalOrdinal firstRow, place;

  [[nodiscard]] auto key() const { return std::pair(firstRow, place); }
};

/// Candidates of all ranks, the worst ones if there are too many, in the order of their joints. Collective.
std::vector<Candidate> chosenCandidates(const Comm& comm, const std::vector<Candidate>& mine,
                                        std::size_t maxNumber) {
  std::vector<Candidate> candidates = gatherOnAll(comm, mine);
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

OverratedColumns findOverratedColumns(const DecomposedProblem& problem, GeneralizedInverse& inverse,
                                      RowKind kind, const JumpSearch& search,
                                      PreconditionerParameters::Scaling scaling) {
  OverratedColumns columns;
  if (search.use == JumpSearch::Use::no)
    return columns;
  const Comm& comm = *problem.comm;
  const std::vector<Joint> joints = chosenJoints(problem, inverse, kind, search);
  if (!holdsAnywhere(comm, !joints.empty()))
    return columns;
  const std::vector<std::vector<JointPart>> parts = gatheredParts(problem, inverse, joints, scaling);

  std::vector<OverratedJumps> jumps(joints.size());
  std::vector<Candidate> mine;
  collectively(comm, [&] {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (parts[j].empty())
        continue;
      ++columns.numJoints;
      // Motions of clusters are left to G.
      jumps[j] = overratedJumps(joined(parts[j]), search.threshold,
                                kind == RowKind::gluing ? motionsOf(parts[j]) : Eigen::MatrixXd());
      for (Eigen::Index k = 0; k < jumps[j].ratios.size(); ++k)
        mine.push_back({jumps[j].ratios[k], firstRowOf(joints[j], problem), k});
    }
  });
  columns.numJoints = sumOverRanks(comm, columns.numJoints);
  std::map<std::pair<GlobalOrdinal, GlobalOrdinal>, int> columnOf;
  for (const Candidate& candidate : chosenCandidates(comm, mine, search.maxNumber)) {
    columnOf.emplace(candidate.key(), columns.number++);
    columns.largestRatio = std::max(columns.largestRatio, candidate.ratio);
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Eigen::MatrixXd& values = kind == RowKind::gluing ? jumps[j].forces : jumps[j].jumps;
    for (Eigen::Index k = 0; k < jumps[j].ratios.size(); ++k)
      if (const auto found = columnOf.find({firstRowOf(joints[j], problem), k}); found != columnOf.end())
        for (std::size_t i = 0; i < joints[j].rows.size(); ++i)
          columns.entries.push_back({joints[j].rows[i], found->second, values(i, k)});
  }
  return columns;
}

qp::ColumnSpace spaceOf(const OverratedColumns& columns, const Import& plan, const Operator& a,
                        const Operator* m) {
  constexpr int batch = 32; // products at once
  qp::ColumnSpace space(plan.getSourceMap());
  for (int first = 0; first < columns.number; first += batch) {
    const std::size_t count = std::min(batch, columns.number - first);
    MultiVector made(plan.getTargetMap(), count), u(plan.getSourceMap(), count);
    for (const OverratedColumns::Entry& entry : columns.entries)
      if (const std::size_t column = entry.column - first; entry.column >= first && column < count)
        made.replaceLocalValue(entry.row, column, entry.value);
    u.doExport(made, plan, Tpetra::ADD);
    if (m != nullptr)
      m->apply(MultiVector(u, Teuchos::Copy), u);
    space.add(a, u);
  }
  if (!space.factorize()) // the same on all ranks
    throw Error("the adaptive constraints are not independent: round-off in the subdomain solves has grown "
                "too large; avoid very flat elements and very large jumps of stiffness, or set Adaptive "
                "Constraints/Use to 'no'");
  return space;
}

} // namespace epafi::fetidp
