#pragma once

/// Preconditioner of the augmented Hessian PFP + ρQ of floating bodies: PMP + ρ⁻¹Q with M ≈ F⁻¹.

#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite if M is.
class ProjectedPreconditioner final : public Operator {
public:
  /// \param penalty  ρ > 0
  ProjectedPreconditioner(RCP<const Operator> m, RCP<const NaturalCoarseSpace> coarseSpace, double penalty);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return m_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return m_->getRangeMap(); }
  /// y = alpha (PMP + ρ⁻¹Q) x + beta y: one application of M and two messages of k numbers. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

private:
  RCP<const Operator> m_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  double penalty_;
  mutable Vector projected_, image_;
};

} // namespace epafi::fetidp
