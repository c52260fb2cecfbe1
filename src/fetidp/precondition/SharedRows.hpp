#pragma once

/// Rows of contact and ties that act on the same displacements, and a preconditioner that is positive
/// definite for them.
///
/// *Own entries.* Mortars of one side take of the other side's nodes, each row of several, each node in
/// several rows. With all entries B B_Dᵀ would be far from I; with those at unknowns that no other row acts
/// on, which are the nodes of the side that has the multipliers, it is I, and no eigenvalue of MF is below 1
/// (as with all weight on one side: Dokeva, Dryja, Proskurowski, *SIAM J. Numer. Anal.* 44 (2006); Kim, Lee,
/// *ibid.* 43 (2005)).
///
/// Where rows b_i, b_k at a node depend on each other, F is singular along what balances, Σ λ_i b_i = 0, and
/// so is M = B_D S B_Dᵀ, which takes forces to displacements and back: of a residual along it nothing is
/// left, and the iteration could not move there to the bound that decides which of the rows carry force.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"

#include <vector>

namespace epafi::fetidp {

/// Which entries of rows a preconditioner looks at.
struct OwnEntries {
  /// Of each of this rank's subdomains and of each entry of B there, 0 or 1: all entries of gluing, of
  /// another row those at unknowns that no other of contact or ties acts on, or all if these weigh too
  /// little. A node's row of contact and its rows of friction do not count as others: they are perpendicular.
  std::vector<std::vector<char>> counts;
  /// Rows of this rank (local indices of multiplierMap, ascending) with too little of their own.
  std::vector<LocalOrdinal> dependent;
};

/// \param plan  multiplierMap to multiplierGhostMap
/// Collective.
OwnEntries ownEntries(const decomposition::DecomposedProblem& problem, const Import& plan);

/// By how much rows count jumps, n_λ: the largest |b| of a row of gluing, which is 1 but between clusters
/// (GluingRows.hpp); 1 for other rows. \param plan likewise Collective.
RCP<Vector> sizesOfRows(const decomposition::DecomposedProblem& problem, const Import& plan);

/// M + σI on some rows, M elsewhere; symmetric positive definite if M is semidefinite, with a kernel on those
/// rows alone.
class ShiftedPreconditioner final : public SymmetricOperator {
public:
  /// \param rows   local indices, this rank's
  /// \param shift  σ > 0; 1/‖F‖ adds at most 1 to an eigenvalue of MF
  ShiftedPreconditioner(RCP<const Operator> m, std::vector<LocalOrdinal> rows, double shift);

private:
  /// One application of M, no message of its own.
  void multiply(const MultiVector& x, MultiVector& y) const override;

  RCP<const Operator> m_;
  std::vector<LocalOrdinal> rows_;
  double shift_;
};

} // namespace epafi::fetidp
