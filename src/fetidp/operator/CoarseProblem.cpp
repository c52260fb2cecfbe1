#include "epafi/fetidp/operator/CoarseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"
#include "epafi/base/SortUnique.hpp"
#include "epafi/decomposition/Clusters.hpp"
#include "epafi/direct/DenseOrthogonal.hpp"

#include <Tpetra_Map.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::SparseMatrix;
/// Entries (i, j, value), also in messages.
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Place of a coarse unknown in the matrix.
using PlaceOf = std::function<int(decomposition::CoarseNumber)>;

/// The ranks that clusters join to this one. Whole bodies stay together: the factor of all is the same to the
/// last digit on any number of ranks. Collective.
RCP<const Comm> teamOf(const DecomposedProblem& problem) {
  const RCP<const Comm>& all = problem.comm;
  const int rank = all->getRank(), ranks = all->getSize();
  if (ranks == 1 || problem.clusters.size() <= problem.bodies.size())
    return all;
  std::set<int> clusters;
  for (const auto& subdomain : problem.subdomains)
    clusters.insert(problem.clusterOf[subdomain.number]);
  std::vector<decomposition::Link>
      mine; // pieces of ranks, and of clusters, whose numbers come after those of the ranks
  for (const int cluster : clusters)
    mine.push_back({rank, ranks + cluster});
  const std::vector<int> teams =
      decomposition::piecesOf(ranks + problem.clusters.size(), gatherOnAll(*all, mine));
  const bool isOne = std::all_of(teams.begin(), teams.begin() + ranks, [](int team) { return team == 0; });
  return isOne ? all : RCP<const Comm>(all->split(teams[rank], rank));
}

/// S_cc = Σ L_cᵀ S L_c. The blocks are added up in the order of the subdomains, whatever rank they come from;
/// on rank 0 alone, or on all ranks of `comm`.
SparseMatrix assemble(const DecomposedProblem& problem, const Comm& comm, int size, const PlaceOf& placeOf,
                      std::span<const SubdomainGroup> groups, bool isOnFirst) {
  std::vector<const Eigen::MatrixXd*> blocks(problem.subdomains.size());
  for (const SubdomainGroup& group : groups)
    for (const std::size_t member : group.members())
      blocks[member] = &group.condensed().schurComplement();
  Triplets mine;
  std::vector<int> places;
  for (std::size_t s = 0; s < blocks.size(); ++s) {
    const auto& indices = problem.subdomains[s].crosspointIndices;
    places.resize(indices.size());
    std::transform(indices.begin(), indices.end(), places.begin(), placeOf);
    for (std::size_t j = 0; j < places.size(); ++j)
      for (std::size_t i = 0; i < places.size(); ++i)
        mine.emplace_back(places[i], places[j], (*blocks[s])(i, j));
  }
  const Triplets all = isOnFirst ? gatherOnFirst(comm, mine) : gatherOnAll(comm, mine);
  SparseMatrix result(size, size);
  result.setFromTriplets(all.begin(), all.end());
  return result;
}

/// R at the crosspoints: a row has the modes of its cluster, from the first column on, and coarse unknowns of
/// other clusters have nothing to do with it; and the cluster of each coarse unknown that floats (−1
/// elsewhere).
struct CoarseKernel {
  Eigen::MatrixXd modes;
  std::vector<int> cluster;
};

/// Collective over `comm`.
CoarseKernel gatherKernel(const DecomposedProblem& problem, const Comm& comm, int size,
                          const PlaceOf& placeOf) {
  Triplets mine;
  for (const auto& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      for (int mode = 0; mode < subdomain.kernel.cols(); ++mode)
        mine.emplace_back(placeOf(subdomain.crosspointIndices[i]), problem.kernelOffsetOf(subdomain) + mode,
                          subdomain.kernel(subdomain.crosspointUnknowns[i], mode));
  int most = 0;
  std::vector<int> clusterOf; // of each mode
  for (int c = 0; c < std::ssize(problem.clusters); ++c) {
    most = std::max(most, problem.clusters[c].kernelDimension);
    clusterOf.insert(clusterOf.end(), problem.clusters[c].kernelDimension, c);
  }
  CoarseKernel kernel{Eigen::MatrixXd::Zero(size, most), std::vector<int>(size, -1)};
  for (const auto& entry : gatherOnAll(comm, mine)) {
    const int cluster = clusterOf[entry.col()];
    kernel.cluster[entry.row()] = cluster;
    kernel.modes(entry.row(),
                 entry.col() - problem.clusters[cluster].kernelOffset) =
        entry.value(); // copies of a crosspoint agree
  }
  return kernel;
}

/// As many crosspoint values of each cluster as it has modes, such that R there is well conditioned: QR with
/// pivoting.
std::vector<int> fixingUnknowns(const DecomposedProblem& problem, const CoarseKernel& kernel) {
  std::vector<std::vector<int>> candidates(problem.clusters.size());
  for (int i = 0; i < std::ssize(kernel.cluster); ++i)
    if (kernel.cluster[i] >= 0)
      candidates[kernel.cluster[i]].push_back(i);
  std::vector<int> fixed;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const decomposition::Cluster& cluster = problem.clusters[c];
    if (cluster.kernelDimension == 0 || candidates[c].empty()) // it may be another rank's
      continue;
    const Eigen::MatrixXd transposed =
        kernel.modes(candidates[c], Eigen::seqN(0, cluster.kernelDimension)).transpose();
    const direct::PivotedColumns pivoted = direct::pivotedColumns(transposed);
    if (pivoted.rank < cluster.kernelDimension)
      throw Error("the crosspoints of the floating body '" + problem.bodies[cluster.body].name +
                  "' do not hold the " + std::to_string(cluster.kernelDimension) +
                  " rigid modes of its cluster of subdomains number " + std::to_string(c) +
                  "; choose more crosspoints");
    for (int k = 0; k < cluster.kernelDimension; ++k)
      fixed.push_back(candidates[c][pivoted.order[k]]);
  }
  return fixed;
}

/// Largest stiffness of each cluster with subdomains on the ranks of `comm`. Collective over it.
std::map<int, double> largestStiffness(const DecomposedProblem& problem, const Comm& comm) {
  struct OfCluster {
    int cluster;
    double stiffness;
  };
  std::vector<OfCluster> mine;
  for (const auto& subdomain : problem.subdomains)
    if (subdomain.stiffness->rows() > 0)
      mine.push_back(
          {problem.clusterOf[subdomain.number], Eigen::VectorXd(subdomain.stiffness->diagonal()).maxCoeff()});
  std::map<int, double> largest;
  for (const auto& [cluster, value] : gatherOnAll(comm, mine))
    largest[cluster] = std::max(largest[cluster], value);
  return largest;
}

/// Throws unless S_cc R_c = 0 to round-off, measured by the largest stiffness of the same cluster: round-off
/// of its stiff parts reaches its soft ones, wherever the crosspoints are. Not collective; the same on all
/// ranks.
void requireKernel(const SparseMatrix& matrix, const CoarseKernel& kernel,
                   const std::map<int, double>& stiffness) {
  if (kernel.modes.size() == 0)
    return;
  const Eigen::MatrixXd forces = matrix * kernel.modes; // S_cc joins no two clusters
  const double largestMode = kernel.modes.cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < kernel.cluster.size(); ++i) {
    const double force = forces.row(i).lpNorm<Eigen::Infinity>();
    const auto found = stiffness.find(kernel.cluster[i]);
    if (found != stiffness.end() && !(force <= 1e-8 * found->second * largestMode)) // also NaN
      throw Error("the rigid modes of the floating bodies are no kernel of the coarse problem; check "
                  "stiffness and kernel");
  }
}

} // namespace

Eigen::VectorXd crosspointDiagonal(const DecomposedProblem& problem, const Comm& comm, Eigen::Index size,
                                   const std::function<int(GlobalOrdinal)>& placeOf) {
  std::vector<AccurateSum> sums(size);
  for (const auto& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      if (const int place = placeOf(subdomain.crosspointIndices[i]); place >= 0) {
        const int unknown = subdomain.crosspointUnknowns[i];
        sums[place].add(subdomain.stiffness->coeff(unknown, unknown));
      }
  Eigen::VectorXd diagonal(size);
  sumOverRanks(comm, sums, diagonal.data());
  return diagonal;
}

CoarseProblem::CoarseProblem(const DecomposedProblem& problem, std::span<const SubdomainGroup> groups,
                             std::span<const decomposition::CoarseNumber> crosspoints,
                             const DirectSolvers& solvers)
    : team_(teamOf(problem)), numRanks_(problem.comm->getSize()),
      size_(static_cast<int>(problem.crosspointMap->getGlobalNumElements())), factorSize_(size_),
      crosspoints_(crosspoints.begin(), crosspoints.end()) {
  findPlaces();
  const bool isOnFirst = factorSize_ > solvers.maxReplicated && team_->getSize() > 1;
  const bool isMine = !isOnFirst || team_->getRank() == 0;
  const auto place = [this](decomposition::CoarseNumber unknown) { return placeOf(unknown); };
  SparseMatrix matrix = assemble(problem, *team_, factorSize_, place, groups, isOnFirst);
  std::optional<CoarseKernel> kernel;
  Eigen::VectorXd stiffness;
  std::map<int, double> largest;
  if (problem.kernelDimension > 0) {
    largest = largestStiffness(problem, *team_);
    kernel = gatherKernel(problem, *team_, factorSize_, place);
    stiffness = crosspointDiagonal(problem, *team_, factorSize_, place);
  }
  collectively(*problem.comm, [&] {
    if (!isMine)
      return;
    if (kernel) {
      requireKernel(matrix, *kernel, largest);
      for (const int unknown : fixingUnknowns(problem, *kernel))
        matrix.coeffRef(unknown, unknown) += stiffness[unknown]; // τ
    }
    matrix.makeCompressed();
    factor_ = direct::factorize(matrix, solvers.coarse, "the coarse problem");
  });
  if (!isOnFirst) {
    sums_.resize(factorSize_);
    return;
  }
  const RCP<const Map> firstMap = rcp(new Map(factorSize_, isMine ? factorSize_ : 0, 0, team_));
  const RCP<const Map> myMap = mapInOrder({places_.begin(), places_.end()}, team_);
  import_ = rcp(new Import(firstMap, myMap));
  first_ = rcp(new MultiVector(firstMap, 1));
  mine_ = rcp(new MultiVector(myMap, 1));
}

/// In the factor the team's coarse unknowns are in ascending order. Collective over the team.
void CoarseProblem::findPlaces() {
  if (!isSplit()) {
    places_.assign(crosspoints_.begin(), crosspoints_.end());
    return;
  }
  std::vector<decomposition::CoarseNumber> all = gatherOnAll(*team_, crosspoints_);
  sortUnique(all);
  factorSize_ = static_cast<int>(all.size());
  for (const decomposition::CoarseNumber unknown : crosspoints_)
    places_.push_back(static_cast<int>(std::lower_bound(all.begin(), all.end(), unknown) - all.begin()));
}

/// In the factor, of a crosspoint of this rank.
int CoarseProblem::placeOf(decomposition::CoarseNumber unknown) const {
  return places_[std::lower_bound(crosspoints_.begin(), crosspoints_.end(), unknown) - crosspoints_.begin()];
}

void CoarseProblem::solve(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const {
  if (factorSize_ == 0)
    return;
  if (factor_) {
    rhs_.resize(factorSize_, x.cols());
    solution_.resize(factorSize_, x.cols());
  }
  if (isOnFirst())
    solveOnFirst(z, x);
  else
    solveReplicated(z, x);
}

void CoarseProblem::solveReplicated(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const {
  sums_.assign(rhs_.size(), AccurateSum());
  for (Eigen::Index j = 0, k = 0; j < x.cols(); ++j)
    for (const int place : places_)
      sums_[j * factorSize_ + place] = z[k++];
  sumOverRanks(*team_, sums_, rhs_.data());
  factor_->solve(rhs_, solution_);
  for (Eigen::Index j = 0; j < x.cols(); ++j)
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x(i, j) = solution_(places_[i], j);
}

void CoarseProblem::solveOnFirst(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const {
  const std::size_t numColumns = x.cols();
  if (mine_->getNumVectors() != numColumns) {
    first_ = rcp(new MultiVector(first_->getMap(), numColumns));
    mine_ = rcp(new MultiVector(mine_->getMap(), numColumns));
  }
  for (std::size_t j = 0, k = 0; j < numColumns; ++j) {
    const auto values = mine_->getDataNonConst(j);
    for (double& value : values)
      value = z[k++].value();
  }
  first_->putScalar(0.0);
  first_->doExport(*mine_, *import_, Tpetra::ADD);
  if (factor_) {
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(first_->getData(j).begin(), factorSize_, rhs_.col(j).data());
    factor_->solve(rhs_, solution_);
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(solution_.col(j).data(), factorSize_, first_->getDataNonConst(j).begin());
  }
  mine_->doImport(*first_, *import_, Tpetra::INSERT);
  for (std::size_t j = 0; j < numColumns; ++j)
    std::copy_n(mine_->getData(j).begin(), x.rows(), x.col(j).data());
}

std::size_t CoarseProblem::factorBytes() const {
  return factor_ ? factor_->bytes() : 0;
}

} // namespace epafi::fetidp
