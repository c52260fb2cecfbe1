#pragma once

/// PFP, the Hessian of the dual problem of floating bodies on Ker G.

#include "epafi/base/Columns.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive semidefinite with the kernel Im Gᵀ. A product takes one with F and two
/// messages of k numbers.
class ProjectedOperator final : public SymmetricOperator {
public:
  /// \param dualOperator  F, on the map of the multipliers
  /// \param coarseSpace   G and P
  ProjectedOperator(RCP<const Operator> dualOperator, RCP<const NaturalCoarseSpace> coarseSpace)
      : SymmetricOperator(dualOperator->getDomainMap()), dualOperator_(std::move(dualOperator)),
        coarseSpace_(std::move(coarseSpace)), projected_(getDomainMap()) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      projected_.assign(in);
      coarseSpace_->project(projected_);     // Px
      dualOperator_->apply(projected_, out); // FPx
      coarseSpace_->project(out);            // PFPx
    });
  }

  RCP<const Operator> dualOperator_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  mutable Vector projected_; ///< work: Px
};

} // namespace epafi::fetidp
