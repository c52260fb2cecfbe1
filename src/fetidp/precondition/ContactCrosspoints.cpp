#include "epafi/fetidp/precondition/ContactCrosspoints.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/direct/DenseSymmetric.hpp"

#include <Teuchos_Comm.hpp>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace epafi::fetidp {
namespace {

using Unknowns = std::vector<decomposition::CoarseNumber>;

/// The union over the ranks, ascending. Collective.
Unknowns unionOverRanks(const Comm& comm, const Unknowns& mine) {
  Unknowns unknowns = gatherOnAll(comm, mine);
  sortUnique(unknowns);
  return unknowns;
}

/// Coarse unknowns that rows of contact touch, and those that follow faces at their edges' ends, which are
/// added to them; all those of the clusters that these belong to. Collective over `comm`.
/// \param clusters  of the last ones
void findUnknowns(const decomposition::DecomposedProblem& problem, const Comm& comm, Unknowns& touched,
                  Unknowns& following, Unknowns& near, std::vector<int>& clusters) {
  Unknowns myTouched, myFollowing;
  std::vector<int> isTouched(problem.clusters.size(), 0); // of each cluster
  const auto clusterOf = [&problem](const decomposition::Subdomain& subdomain) {
    return problem.clusterOf[subdomain.number];
  };
  std::vector<int> crosspointOf;
  for (const auto& subdomain : problem.subdomains) {
    crosspointOf.assign(subdomain.stiffness->rows(), -1);
    for (int i = 0; i < std::ssize(subdomain.crosspointUnknowns); ++i)
      crosspointOf[subdomain.crosspointUnknowns[i]] = i;
    for (const auto& entry : subdomain.constraint)
      if (const int i = crosspointOf[entry.unknown]; i >= 0) {
        myTouched.push_back(subdomain.crosspointIndices[i]);
        isTouched[clusterOf(subdomain)] = 1;
      }
    for (const decomposition::EdgeEnd& end : subdomain.edgeEnds) {
      myFollowing.push_back(end.average);
      isTouched[clusterOf(subdomain)] = 1;
    }
  }
  touched = unionOverRanks(comm, myTouched);
  const Unknowns ends = unionOverRanks(comm, myFollowing);
  std::set_difference(ends.begin(), ends.end(), touched.begin(), touched.end(),
                      std::back_inserter(following));
  touched.insert(touched.end(), following.begin(), following.end());
  std::sort(touched.begin(), touched.end());
  sumOverRanks(comm, std::span(isTouched));
  std::map<decomposition::CoarseNumber, int> found; // the clusters of the near ones
  for (const auto& subdomain : problem.subdomains)
    if (isTouched[clusterOf(subdomain)] > 0)
      for (const decomposition::CoarseNumber unknown : subdomain.crosspointIndices)
        found[unknown] = clusterOf(subdomain);
  struct Near {
    decomposition::CoarseNumber unknown;
    int cluster;
  };
  std::vector<Near> mine;
  for (const auto& [unknown, cluster] : found)
    mine.push_back({unknown, cluster});
  for (const auto& [unknown, cluster] : gatherOnAll(comm, mine))
    found[unknown] = cluster;
  for (const auto& [unknown, cluster] : found) {
    near.push_back(unknown);
    clusters.push_back(cluster);
  }
}

int positionIn(const Unknowns& unknowns, decomposition::CoarseNumber unknown) {
  const auto found = std::lower_bound(unknowns.begin(), unknowns.end(), unknown);
  return found != unknowns.end() && *found == unknown ? static_cast<int>(found - unknowns.begin()) : -1;
}

} // namespace

ContactCrosspoints::ContactCrosspoints(const decomposition::DecomposedProblem& problem,
                                       const GeneralizedInverse& inverse, RCP<const Comm> comm)
    : comm_(std::move(comm)) {
  std::vector<int> clusters;
  findUnknowns(problem, *comm_, touched_, following_, near_, clusters);
  findBlocks(clusters);
  fillBlocks(problem, inverse);
}

/// \param clusters  of the near ones
void ContactCrosspoints::findBlocks(const std::vector<int>& clusters) {
  std::map<int, Block> blocks; // by cluster
  for (int i = 0; i < std::ssize(near_); ++i) {
    Block& block = blocks[clusters[i]];
    block.near.push_back(i);
    if (const int touched = indexOf(near_[i]); touched >= 0)
      block.touched.push_back(touched);
  }
  Eigen::Index mostTouched = 0, mostNear = 0;
  for (auto& [cluster, block] : blocks) {
    mostTouched = std::max<Eigen::Index>(mostTouched, block.touched.size());
    mostNear = std::max<Eigen::Index>(mostNear, block.near.size());
    blocks_.push_back(std::move(block));
  }
  touchedWork_.resize(mostTouched);
  sumWork_.resize(mostTouched);
  nearWork_.resize(mostNear);
}

/// S_cc⁺ at the near ones, which the touched ones are among; each value from the rank that owns it. A column
/// has one of each cluster.
void ContactCrosspoints::fillBlocks(const decomposition::DecomposedProblem& problem,
                                    const GeneralizedInverse& inverse) {
  std::size_t numValues = 0, numColumns = 0;
  for (const Block& block : blocks_) {
    numValues += block.near.size() * block.touched.size();
    numColumns = std::max(numColumns, block.touched.size());
  }
  std::vector<double> values(numValues, 0.0); // block by block, column by column
  constexpr std::size_t batch =
      16; // columns at once: work space stays small beside the coarse problem's factor
  for (std::size_t first = 0; first < numColumns; first += batch) {
    std::vector<Unknowns> unknowns(std::min(batch, numColumns - first));
    for (std::size_t j = 0; j < unknowns.size(); ++j)
      for (const Block& block : blocks_)
        if (first + j < block.touched.size())
          unknowns[j].push_back(touched_[block.touched[first + j]]);
    const Eigen::MatrixXd columns = inverse.coarseColumns(unknowns);
    auto value = values.begin();
    for (const Block& block : blocks_) {
      for (std::size_t i = 0; i < block.near.size(); ++i)
        if (const auto unknown = near_[block.near[i]]; problem.crosspointMap->isNodeGlobalElement(unknown))
          for (std::size_t j = 0; j < unknowns.size() && first + j < block.touched.size(); ++j)
            value[i + (first + j) * block.near.size()] = columns(inverse.coarseIndexOf(unknown), j);
      value += block.near.size() * block.touched.size();
    }
  }
  sumOverRanks(*comm_, std::span<double>(values));
  collectively(*problem.comm, [&] {
    const double* value = values.data();
    for (Block& block : blocks_) {
      const Eigen::Index numNear = block.near.size(), n = block.touched.size();
      const Eigen::Map<const Eigen::MatrixXd> response(value, numNear, n);
      value += response.size();
      Eigen::MatrixXd flexibility(n, n);
      for (Eigen::Index i = 0, t = 0; i < numNear; ++i)
        if (indexOf(near_[block.near[i]]) >= 0)
          flexibility.row(t++) = response.row(i);
      block.stiffness = direct::inverseOfSpd((0.5 * (flexibility + flexibility.transpose())).eval());
      block.extension = response * block.stiffness;
    }
  });
}

void ContactCrosspoints::extend(const Eigen::MatrixXd& u, Eigen::MatrixXd& near) const {
  for (const Block& block : blocks_)
    for (Eigen::Index column = 0; column < u.cols(); ++column) {
      auto atTouched = touchedWork_.head(block.stiffness.rows());
      auto atNear = nearWork_.head(block.extension.rows());
      atTouched = u.col(column)(block.touched);
      atNear.noalias() = block.extension * atTouched;
      near.col(column)(block.near) = atNear;
    }
}

void ContactCrosspoints::forcesOf(const Eigen::MatrixXd& u, const Eigen::MatrixXd& near,
                                  Eigen::MatrixXd& forces) const {
  for (const Block& block : blocks_)
    for (Eigen::Index column = 0; column < u.cols(); ++column) {
      auto atTouched = touchedWork_.head(block.stiffness.rows()), sum = sumWork_.head(atTouched.size());
      auto atNear = nearWork_.head(block.extension.rows());
      atTouched = u.col(column)(block.touched);
      atNear = near.col(column)(block.near);
      sum.noalias() = block.stiffness * atTouched;
      sum.noalias() += block.extension.transpose() * atNear;
      forces.col(column)(block.touched) = sum;
    }
}

Eigen::MatrixXd ContactCrosspoints::extension() const {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(numNear(), size());
  for (const Block& block : blocks_)
    whole(block.near, block.touched) = block.extension;
  return whole;
}

Eigen::MatrixXd ContactCrosspoints::stiffness() const {
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size(), size());
  for (const Block& block : blocks_)
    whole(block.touched, block.touched) = block.stiffness;
  return whole;
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
  return indexOf(subdomain.crosspointIndices[found - all.begin()]);
}

bool ContactCrosspoints::follows(decomposition::CoarseNumber coarseUnknown) const {
  return positionIn(following_, coarseUnknown) >= 0;
}

int ContactCrosspoints::nearIndexOf(decomposition::CoarseNumber coarseUnknown) const {
  return positionIn(near_, coarseUnknown);
}

} // namespace epafi::fetidp
