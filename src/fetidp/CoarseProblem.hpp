#pragma once

/// The coarse problem S_cc x_c = z_c on the crosspoint values v_c^g. While it is small it is the one thing of global
/// size that every rank holds: all factorise and solve it alike, for the price of one message. A large one lies on
/// rank 0, and the others send their shares and receive their values, by plans built once. Where bodies are of several
/// clusters (Clusters.hpp) and no coarse unknown belongs to two ranks, each rank has the part of its own, and there are no messages.
///
/// Where a cluster floats, most often a whole body, S_cc is singular with the known kernel R_c (R at the crosspoints). A generalised
/// inverse is then S_cc⁺ = (S_cc + τEEᵀ)⁻¹, where E picks as many crosspoint values of every floating cluster as
/// it has rigid modes, so that EᵀR_c is regular: S S⁺ S = S exactly (Brzobohatý et al., *Int. J. Numer. Meth.
/// Engng* 88 (2011), fixing nodes).

#include "epafi/base/AccurateSum.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/direct/SpdFactor.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/SubdomainGroup.hpp"

#include <Eigen/Core>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace epafi::fetidp {

class CoarseProblem {
public:
  /// Sums the subdomains' Schur complements over all ranks and factorises.
  /// \param crosspoints  this rank's coarse unknowns, ascending
  /// Collective. \throws Error if the kernel handed over is none of S_cc, or if the factorisation fails.
  CoarseProblem(const decomposition::DecomposedProblem& problem, std::span<const SubdomainGroup> groups,
                std::span<const decomposition::CoarseNumber> crosspoints, const DirectSolvers& solvers);

  /// Coarse unknowns of the whole problem.
  [[nodiscard]] int size() const { return size_; }
  /// Whether every rank has a part of its own, or all of it.
  [[nodiscard]] bool isSplit() const { return comm_->getSize() < numRanks_; }
  [[nodiscard]] bool isReplicated() const { return !isSplit() && !isOnFirst(); } ///< the latter
  /// X = S_cc⁺ Σ_ranks Z, both of this rank's crosspoints, with the columns of X, one after the other in Z. One sum over
  /// the ranks if replicated, and the same digits then on any number of ranks; none if split. Collective.
  void solve(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const;
  /// Of this rank.
  [[nodiscard]] std::size_t factorBytes() const;

private:
  [[nodiscard]] bool isOnFirst() const { return !import_.is_null(); }
  [[nodiscard]] int placeOf(decomposition::CoarseNumber unknown) const;
  void solveReplicated(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const;
  void solveOnFirst(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const;

  RCP<const Comm> comm_; ///< of the ranks that work on one factor: all, or if split this one alone
  int numRanks_, size_;
  int factorSize_ = 0; ///< coarse unknowns of the factor: all, or this rank's
  std::vector<decomposition::CoarseNumber> crosspoints_;
  std::unique_ptr<direct::SpdFactor> factor_; ///< null where another rank has it
  mutable std::vector<AccurateSum> sums_;     ///< work of a replicated one
  mutable Eigen::MatrixXd rhs_, solution_;    ///< work
  RCP<const Import> import_;                  ///< from rank 0 to the ranks' crosspoints, unless replicated
  mutable RCP<MultiVector> first_, mine_;     ///< likewise
};

/// Diagonal of K̄ at some crosspoint values, before anything is eliminated: the yardstick for round-off in S_cc, which vanishes
/// where a lone subdomain floats.
/// \param comm     of the ranks that have the values
/// \param placeOf  of a coarse unknown among them, or −1
/// Collective over `comm`.
Eigen::VectorXd crosspointDiagonal(const decomposition::DecomposedProblem& problem, const Comm& comm,
                                   Eigen::Index size, const std::function<int(GlobalOrdinal)>& placeOf);

} // namespace epafi::fetidp
