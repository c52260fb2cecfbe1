#pragma once

/// PFP, the Hessian of the dual problem of floating bodies on Ker G.

#include "epafi/fetidp/NaturalCoarseSpace.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive semidefinite with the kernel Im Gᵀ.
class ProjectedOperator final : public Operator {
public:
  /// \param dualOperator  F, on the map of the multipliers
  /// \param coarseSpace   G and P
  ProjectedOperator(RCP<const Operator> dualOperator, RCP<const NaturalCoarseSpace> coarseSpace);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return dualOperator_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return dualOperator_->getRangeMap(); }
  /// y = alpha PFP x + beta y: one product with F and two messages of k numbers. Symmetric. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

private:
  RCP<const Operator> dualOperator_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  mutable Vector projected_, image_;
};

} // namespace epafi::fetidp
