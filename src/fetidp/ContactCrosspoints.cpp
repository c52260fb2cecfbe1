#include "epafi/fetidp/ContactCrosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <iterator>

namespace epafi::fetidp {
namespace {

using Unknowns = std::vector<decomposition::CoarseNumber>;

/// The union over the ranks, ascending. Collective.
Unknowns unionOverRanks(const Comm& comm, const Unknowns& mine) {
  Unknowns unknowns = gatherOnAll(comm, mine);
  std::sort(unknowns.begin(), unknowns.end());
  unknowns.erase(std::unique(unknowns.begin(), unknowns.end()), unknowns.end());
  return unknowns;
}

/// Coarse unknowns that rows of contact touch, and those that follow faces at their edges' ends, which are added to them; all those
/// of the clusters that these belong to. Collective.
void findUnknowns(const decomposition::DecomposedProblem& problem, Unknowns& touched, Unknowns& following,
                  Unknowns& near) {
  Unknowns myTouched, myFollowing, myNear;
  std::vector<int> isTouched(problem.clusters.size(), 0); // of each cluster
  const auto clusterOf = [&problem](const decomposition::Subdomain& subdomain) {
    return static_cast<std::size_t>(problem.clusterOf[static_cast<std::size_t>(subdomain.number)]);
  };
  std::vector<int> crosspointOf;
  for (const auto& subdomain : problem.subdomains) {
    crosspointOf.assign(static_cast<std::size_t>(subdomain.stiffness->rows()), -1);
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      crosspointOf[static_cast<std::size_t>(subdomain.crosspointUnknowns[i])] = static_cast<int>(i);
    for (const auto& entry : subdomain.constraint)
      if (const int i = crosspointOf[static_cast<std::size_t>(entry.unknown)]; i >= 0) {
        myTouched.push_back(subdomain.crosspointIndices[static_cast<std::size_t>(i)]);
        isTouched[clusterOf(subdomain)] = 1;
      }
    for (const decomposition::EdgeEnd& end : subdomain.edgeEnds) {
      myFollowing.push_back(end.average);
      isTouched[clusterOf(subdomain)] = 1;
    }
  }
  touched = unionOverRanks(*problem.comm, myTouched);
  const Unknowns ends = unionOverRanks(*problem.comm, myFollowing);
  std::set_difference(ends.begin(), ends.end(), touched.begin(), touched.end(),
                      std::back_inserter(following));
  touched.insert(touched.end(), following.begin(), following.end());
  std::sort(touched.begin(), touched.end());
  sumOverRanks(*problem.comm, std::span(isTouched));
  for (const auto& subdomain : problem.subdomains)
    if (isTouched[clusterOf(subdomain)] > 0)
      myNear.insert(myNear.end(), subdomain.crosspointIndices.begin(), subdomain.crosspointIndices.end());
  near = unionOverRanks(*problem.comm, myNear);
}

int positionIn(const Unknowns& unknowns, decomposition::CoarseNumber unknown) {
  const auto found = std::lower_bound(unknowns.begin(), unknowns.end(), unknown);
  return found != unknowns.end() && *found == unknown ? static_cast<int>(found - unknowns.begin()) : -1;
}

} // namespace

ContactCrosspoints::ContactCrosspoints(const decomposition::DecomposedProblem& problem,
                                       const GeneralizedInverse& inverse) {
  findUnknowns(problem, touched_, following_, near_);
  const auto n = static_cast<Eigen::Index>(touched_.size());
  if (n == 0)
    return;
  // S_cc⁺ at the near ones, which the touched ones are among; each value from the rank that owns it.
  std::vector<double> values(near_.size() * touched_.size(), 0.0);
  constexpr std::size_t batch =
      16; // columns at once: work space stays small beside the coarse problem's factor
  for (std::size_t first = 0; first < touched_.size(); first += batch) {
    const auto unknowns = std::span(touched_).subspan(first, std::min(batch, touched_.size() - first));
    std::vector<bool> isOwner;
    for (const decomposition::CoarseNumber unknown : unknowns)
      isOwner.push_back(problem.crosspointMap->isNodeGlobalElement(unknown));
    const Eigen::MatrixXd columns = inverse.coarseColumns(unknowns, isOwner);
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (problem.crosspointMap->isNodeGlobalElement(near_[i]))
        for (std::size_t j = 0; j < unknowns.size(); ++j)
          values[i + (first + j) * near_.size()] =
              columns(inverse.coarseIndexOf(near_[i]), static_cast<Eigen::Index>(j));
  }
  sumOverRanks(*problem.comm, std::span<double>(values));
  const Eigen::Map<const Eigen::MatrixXd> response(values.data(), static_cast<Eigen::Index>(near_.size()), n);
  Eigen::MatrixXd flexibility(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    flexibility.row(i) = response.row(nearIndexOf(touched_[static_cast<std::size_t>(i)]));
  collectively(*problem.comm, [&] {
    stiffness_ = direct::inverseOfSpd((0.5 * (flexibility + flexibility.transpose())).eval());
  });
  extension_ = response * stiffness_;
}

int ContactCrosspoints::indexOf(decomposition::CoarseNumber coarseUnknown) const {
  return positionIn(touched_, coarseUnknown);
}

int ContactCrosspoints::indexOf(const decomposition::Subdomain& subdomain,
                                decomposition::Unknown unknown) const {
  const auto& all = subdomain.crosspointUnknowns; // ascending
  const auto found = std::lower_bound(all.begin(), all.end(), unknown);
  if (found == all.end() || *found != unknown)
    return -1;
  return indexOf(subdomain.crosspointIndices[static_cast<std::size_t>(found - all.begin())]);
}

bool ContactCrosspoints::follows(decomposition::CoarseNumber coarseUnknown) const {
  return positionIn(following_, coarseUnknown) >= 0;
}

int ContactCrosspoints::nearIndexOf(decomposition::CoarseNumber coarseUnknown) const {
  return positionIn(near_, coarseUnknown);
}

} // namespace epafi::fetidp
