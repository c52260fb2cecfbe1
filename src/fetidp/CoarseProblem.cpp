#include "epafi/fetidp/CoarseProblem.hpp"

#include "epafi/base/Collective.hpp"
#include "epafi/base/Errors.hpp"
#include "epafi/base/Maps.hpp"

#include <Eigen/QR>
#include <Tpetra_Map.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

namespace epafi::fetidp {
namespace {

using decomposition::DecomposedProblem;
using decomposition::SparseMatrix;
/// Entries (i, j, value), also in messages.
using Triplets = std::vector<Eigen::Triplet<double>>;

/// S_cc = Σ L_cᵀ S L_c. The blocks are added up in the order of the subdomains, whatever rank they come from;
/// on rank 0 alone unless replicated.
SparseMatrix assemble(const DecomposedProblem& problem, int size, std::span<const SubdomainGroup> groups,
                      bool isReplicated) {
  std::vector<const Eigen::MatrixXd*> blocks(problem.subdomains.size());
  for (const SubdomainGroup& group : groups)
    for (const std::size_t member : group.members())
      blocks[member] = &group.condensed().schurComplement();
  Triplets mine;
  for (std::size_t s = 0; s < blocks.size(); ++s) {
    const auto& indices = problem.subdomains[s].crosspointIndices;
    for (std::size_t j = 0; j < indices.size(); ++j)
      for (std::size_t i = 0; i < indices.size(); ++i)
        mine.emplace_back(static_cast<int>(indices[i]), static_cast<int>(indices[j]),
                          (*blocks[s])(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }
  const Triplets all = isReplicated ? gatherOnAll(*problem.comm, mine) : gatherOnFirst(*problem.comm, mine);
  SparseMatrix result(size, size);
  result.setFromTriplets(all.begin(), all.end());
  return result;
}

/// R at the crosspoints, size × kernelDimension, and the body of each coarse unknown that floats (−1
/// elsewhere).
struct CoarseKernel {
  Eigen::MatrixXd modes;
  std::vector<int> body;
};

CoarseKernel gatherKernel(const DecomposedProblem& problem, int size) {
  Triplets mine;
  for (const auto& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      for (Eigen::Index mode = 0; mode < subdomain.kernel.cols(); ++mode) {
        const auto column = problem.bodies[static_cast<std::size_t>(subdomain.body)].kernelOffset + mode;
        mine.emplace_back(static_cast<int>(subdomain.crosspointIndices[i]), static_cast<int>(column),
                          subdomain.kernel(subdomain.crosspointUnknowns[i], mode));
      }
  CoarseKernel kernel{Eigen::MatrixXd::Zero(size, problem.kernelDimension),
                      std::vector<int>(static_cast<std::size_t>(size), -1)};
  for (const auto& entry : gatherOnAll(*problem.comm, mine)) {
    kernel.modes(entry.row(), entry.col()) = entry.value(); // copies of a crosspoint agree
    for (std::size_t body = 0; body < problem.bodies.size(); ++body)
      if (entry.col() >= problem.bodies[body].kernelOffset &&
          entry.col() < problem.bodies[body].kernelOffset + problem.bodies[body].kernelDimension)
        kernel.body[static_cast<std::size_t>(entry.row())] = static_cast<int>(body);
  }
  return kernel;
}

/// As many crosspoint values of the body as it has modes, such that R there is well conditioned: QR with
/// pivoting.
std::vector<int> fixingUnknowns(const decomposition::Body& body, int index, const CoarseKernel& kernel) {
  std::vector<int> candidates;
  for (std::size_t i = 0; i < kernel.body.size(); ++i)
    if (kernel.body[i] == index)
      candidates.push_back(static_cast<int>(i));
  const Eigen::MatrixXd transposed =
      kernel.modes(candidates, Eigen::seqN(body.kernelOffset, body.kernelDimension)).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(transposed);
  if (qr.rank() < body.kernelDimension)
    throw Error("the crosspoints of the floating body '" + body.name + "' do not hold its " +
                std::to_string(body.kernelDimension) + " rigid modes; choose more crosspoints");
  std::vector<int> fixed;
  for (int k = 0; k < body.kernelDimension; ++k)
    fixed.push_back(candidates[static_cast<std::size_t>(qr.colsPermutation().indices()[k])]);
  return fixed;
}

/// Throws unless S_cc R_c = 0 to round-off, measured by the largest stiffness at the crosspoints of the same body:
/// round-off of its stiff parts reaches its soft ones. Not collective; the same on all ranks.
void requireKernel(const SparseMatrix& matrix, const CoarseKernel& kernel, const Eigen::VectorXd& stiffness) {
  const Eigen::MatrixXd forces = matrix * kernel.modes;
  const double largestMode = kernel.modes.cwiseAbs().maxCoeff();
  std::map<int, double> stiffnessOf;
  for (std::size_t i = 0; i < kernel.body.size(); ++i) {
    double& largest = stiffnessOf[kernel.body[i]];
    largest = std::max(largest, stiffness[static_cast<Eigen::Index>(i)]);
  }
  for (std::size_t i = 0; i < kernel.body.size(); ++i) {
    const double force = forces.row(static_cast<Eigen::Index>(i)).lpNorm<Eigen::Infinity>();
    if (!(force <= 1e-8 * stiffnessOf[kernel.body[i]] * largestMode)) // also NaN
      throw Error("the rigid modes of the floating bodies are no kernel of the coarse problem; check "
                  "stiffness and kernel");
  }
}

} // namespace

Eigen::VectorXd crosspointDiagonal(const DecomposedProblem& problem, Eigen::Index size,
                                   const std::function<int(GlobalOrdinal)>& placeOf) {
  std::vector<AccurateSum> sums(static_cast<std::size_t>(size));
  for (const auto& subdomain : problem.subdomains)
    for (std::size_t i = 0; i < subdomain.crosspointUnknowns.size(); ++i)
      if (const int place = placeOf(subdomain.crosspointIndices[i]); place >= 0) {
        const int unknown = subdomain.crosspointUnknowns[i];
        sums[static_cast<std::size_t>(place)].add(subdomain.stiffness->coeff(unknown, unknown));
      }
  Eigen::VectorXd diagonal(size);
  sumOverRanks(*problem.comm, sums, diagonal.data());
  return diagonal;
}

CoarseProblem::CoarseProblem(const DecomposedProblem& problem, std::span<const SubdomainGroup> groups,
                             std::span<const decomposition::CoarseNumber> crosspoints,
                             const DirectSolvers& solvers)
    : comm_(problem.comm), size_(static_cast<int>(problem.crosspointMap->getGlobalNumElements())),
      crosspoints_(crosspoints.begin(), crosspoints.end()) {
  const bool isReplicated = size_ <= solvers.maxReplicated || comm_->getSize() == 1;
  const bool isMine = isReplicated || comm_->getRank() == 0;
  SparseMatrix matrix = assemble(problem, size_, groups, isReplicated);
  std::optional<CoarseKernel> kernel;
  Eigen::VectorXd stiffness;
  if (problem.kernelDimension > 0) {
    kernel = gatherKernel(problem, size_);
    stiffness =
        crosspointDiagonal(problem, size_, [](GlobalOrdinal unknown) { return static_cast<int>(unknown); });
  }
  collectively(*comm_, [&] {
    if (!isMine)
      return;
    if (kernel) {
      requireKernel(matrix, *kernel, stiffness);
      for (std::size_t body = 0; body < problem.bodies.size(); ++body)
        if (problem.bodies[body].kernelDimension > 0)
          for (const int unknown : fixingUnknowns(problem.bodies[body], static_cast<int>(body), *kernel))
            matrix.coeffRef(unknown, unknown) += stiffness[unknown]; // τ
    }
    matrix.makeCompressed();
    factor_ = direct::factorize(matrix, solvers.coarse, "the coarse problem");
  });
  if (isReplicated) {
    sums_.resize(static_cast<std::size_t>(size_));
    return;
  }
  const auto whole = static_cast<Tpetra::global_size_t>(size_);
  const RCP<const Map> firstMap = rcp(new Map(whole, static_cast<std::size_t>(isMine ? size_ : 0), 0, comm_));
  const RCP<const Map> myMap = mapInOrder({crosspoints_.begin(), crosspoints_.end()}, comm_);
  import_ = rcp(new Import(firstMap, myMap));
  first_ = rcp(new MultiVector(firstMap, 1));
  mine_ = rcp(new MultiVector(myMap, 1));
}

void CoarseProblem::solve(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const {
  if (size_ == 0)
    return;
  if (factor_) {
    rhs_.resize(size_, x.cols());
    solution_.resize(size_, x.cols());
  }
  if (isReplicated())
    solveReplicated(z, x);
  else
    solveOnFirst(z, x);
}

void CoarseProblem::solveReplicated(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const {
  sums_.assign(static_cast<std::size_t>(rhs_.size()), AccurateSum());
  for (Eigen::Index j = 0, k = 0; j < x.cols(); ++j)
    for (const decomposition::CoarseNumber crosspoint : crosspoints_)
      sums_[static_cast<std::size_t>(j * size_ + crosspoint)] = z[static_cast<std::size_t>(k++)];
  sumOverRanks(*comm_, sums_, rhs_.data());
  factor_->solve(rhs_, solution_);
  for (Eigen::Index j = 0; j < x.cols(); ++j)
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x(i, j) = solution_(static_cast<Eigen::Index>(crosspoints_[static_cast<std::size_t>(i)]), j);
}

void CoarseProblem::solveOnFirst(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const {
  const auto numColumns = static_cast<std::size_t>(x.cols());
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
      std::copy_n(first_->getData(j).begin(), size_, rhs_.col(static_cast<Eigen::Index>(j)).data());
    factor_->solve(rhs_, solution_);
    for (std::size_t j = 0; j < numColumns; ++j)
      std::copy_n(solution_.col(static_cast<Eigen::Index>(j)).data(), size_,
                  first_->getDataNonConst(j).begin());
  }
  mine_->doImport(*first_, *import_, Tpetra::INSERT);
  for (std::size_t j = 0; j < numColumns; ++j)
    std::copy_n(mine_->getData(j).begin(), x.rows(), x.col(static_cast<Eigen::Index>(j)).data());
}

std::size_t CoarseProblem::factorBytes() const {
  return factor_ ? factor_->bytes() : 0;
}

} // namespace epafi::fetidp
