#pragma once

/// Preconditioner of the augmented Hessian PFP + ρQ of floating bodies: PMP + ρ⁻¹Q with M ≈ F⁻¹.

#include "epafi/base/Columns.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite if M is.
class ProjectedPreconditioner final : public SymmetricOperator {
public:
  /// \param penalty  ρ > 0
  ProjectedPreconditioner(RCP<const Operator> m, RCP<const NaturalCoarseSpace> coarseSpace, double penalty)
      : SymmetricOperator(m->getDomainMap()), m_(std::move(m)), coarseSpace_(std::move(coarseSpace)),
        penalty_(penalty), projected_(getDomainMap()) {}

private:
  /// One application of M and two messages of k numbers.
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      projected_.assign(in);
      coarseSpace_->project(projected_); // Px
      m_->apply(projected_, out);        // MPx
      coarseSpace_->project(out);        // PMPx
      const double share = 1.0 / penalty_;
      out.update(share, in, -share, projected_, 1.0); // + ρ⁻¹(x − Px)
    });
  }

  RCP<const Operator> m_;
  RCP<const NaturalCoarseSpace> coarseSpace_;
  double penalty_;
  mutable Vector projected_; ///< Px, work
};

} // namespace epafi::fetidp
