#pragma once

/// Rows of contact that act on the same displacements, and a preconditioner that is positive definite for them.
///
/// Where rows b_i, b_k at a node depend on each other, F is singular along what balances, Σ λ_i b_i = 0, and so is
/// M = B_D S B_Dᵀ, which takes forces to displacements and back: of a residual along it nothing is left, and the iteration
/// could not move there to the bound that decides which of the rows carry force.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"

#include <vector>

namespace epafi::fetidp {

/// Rows of contact (local indices of multiplierMap, ascending) with an unknown that another one acts on too. Collective.
std::vector<LocalOrdinal> sharedContactRows(const decomposition::DecomposedProblem& problem);

/// M + σI on some rows, M elsewhere; symmetric positive definite if M is semidefinite, with a kernel on those rows alone.
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
