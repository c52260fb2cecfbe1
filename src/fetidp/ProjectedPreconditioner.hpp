#pragma once

/// Preconditioner of the augmented Hessian PFP + ρQ of floating bodies: PMP + ρ⁻¹Q with M ≈ F⁻¹.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite if M is.
class ProjectedPreconditioner final : public SymmetricOperator {
public:
  /// \param penalty  ρ > 0
  ProjectedPreconditioner(RCP<const Operator> m, RCP<const NaturalCoarseSpace> coarseSpace, double penalty);

private:
  /// One application of M and two messages of k numbers.
  void multiply(const MultiVector& x, MultiVector& y) const override;

  RCP<const Operator> m_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  double penalty_;
  mutable Vector projected_; ///< Px, work
};

} // namespace epafi::fetidp
