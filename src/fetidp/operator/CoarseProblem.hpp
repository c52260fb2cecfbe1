#pragma once

/// The coarse problem S_cc x_c = z_c on the crosspoint values v_c^g. While it is small every rank holds it:
/// all factorise and solve it alike, for the price of one message. A large one lies on rank 0, and the others
/// send their shares and receive their values, by plans built once. Where bodies are of several clusters
/// (Clusters.hpp), the coarse problem falls apart: ranks whose clusters hang together are a *team* that has
/// the part of these clusters and sums within itself; a rank that shares no cluster needs no message.
///
/// Where a cluster floats, most often a whole body, S_cc is singular with the known kernel R_c (R at the
/// crosspoints). A generalised inverse is then S_cc⁺ = (S_cc + τEEᵀ)⁻¹, where E picks as many crosspoint
/// values of every floating cluster as it has rigid modes, so that EᵀR_c is regular: S S⁺ S = S exactly
/// (Brzobohatý et al., *Int. J. Numer. Meth. Engng* 88 (2011), fixing nodes).

#include "epafi/base/AccurateSum.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/direct/SpdFactor.hpp"
#include "epafi/fetidp/operator/FetiParameters.hpp"
#include "epafi/fetidp/operator/SubdomainGroup.hpp"

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
  /// The team of this rank: all ranks, if bodies are not cut into clusters.
  [[nodiscard]] const RCP<const Comm>& team() const { return team_; }
  /// Whether there is more than one.
  [[nodiscard]] bool isSplit() const { return team_->getSize() < numRanks_; }
  [[nodiscard]] bool isReplicated() const { return !isSplit() && !isOnFirst(); } ///< on all ranks
  /// X = S_cc⁺ Σ_ranks Z, both of this rank's crosspoints, with the columns of X, one after the other in Z.
  /// One sum over the team if each of its ranks has the factor, and the same digits then on any number of
  /// ranks. Collective over the team.
  void solve(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const;
  /// Of this rank.
  [[nodiscard]] std::size_t factorBytes() const;

private:
  [[nodiscard]] bool isOnFirst() const { return !import_.is_null(); }
  [[nodiscard]] int placeOf(decomposition::CoarseNumber unknown) const;
  void findPlaces();
  void solveReplicated(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const;
  void solveOnFirst(std::span<const AccurateSum> z, Eigen::MatrixXd& x) const;

  RCP<const Comm> team_;
  int numRanks_, size_;
  int factorSize_; ///< coarse unknowns of the team
  std::vector<decomposition::CoarseNumber> crosspoints_;
  std::vector<int> places_;                   ///< theirs in the team's factor
  std::unique_ptr<direct::SpdFactor> factor_; ///< null where another rank has it
  mutable std::vector<AccurateSum> sums_;     ///< work of a replicated one
  mutable Eigen::MatrixXd rhs_, solution_;    ///< work
  RCP<const Import>
      import_; ///< from the team's first rank to the others' crosspoints, unless each has the factor
  mutable RCP<MultiVector> first_, mine_; ///< likewise
};

/// Diagonal of K̄ at some crosspoint values, before anything is eliminated: the yardstick for round-off in
/// S_cc, which vanishes where a lone subdomain floats.
/// \param comm     of the ranks that have the values
/// \param placeOf  of a coarse unknown among them, or −1
/// Collective over `comm`.
Eigen::VectorXd crosspointDiagonal(const decomposition::DecomposedProblem& problem, const Comm& comm,
                                   Eigen::Index size, const std::function<int(GlobalOrdinal)>& placeOf);

} // namespace epafi::fetidp
