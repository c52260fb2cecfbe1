#pragma once

/// PAP + σQ with an orthogonal projector P = I − Q, most often that on Ker G. With F and σ = 0 it is the
/// Hessian of the dual problem of floating bodies; with M ≈ F⁻¹ and σ = ρ⁻¹ the preconditioner of PFP + ρQ.

#include "epafi/base/Columns.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/equilibrium/NaturalCoarseSpace.hpp"

#include <Tpetra_Vector.hpp>

#include <functional>
#include <utility>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric. Where A is positive definite, so is this with σ > 0; with σ = 0 it has the kernel
/// Im Q. A product takes one with A and P twice: from both sides, as of round-off beside Im P conjugate
/// gradients would make negative curvature.
class ProjectedOperator final : public SymmetricOperator {
public:
  /// \param a           A, on the map of the multipliers
  /// \param project     x ← Px, collective
  /// \param complement  σ ≥ 0
  ProjectedOperator(RCP<const Operator> a, std::function<void(Vector&)> project, double complement = 0)
      : SymmetricOperator(a->getDomainMap()), a_(std::move(a)), project_(std::move(project)),
        complement_(complement), projected_(getDomainMap()) {}
  /// On Ker G, with two messages of k numbers. \param coarseSpace  G and P
  ProjectedOperator(RCP<const Operator> a, const RCP<const NaturalCoarseSpace>& coarseSpace,
                    double complement = 0)
      : ProjectedOperator(
            std::move(a), [coarseSpace](Vector& x) { coarseSpace->project(x); }, complement) {}

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      projected_.assign(in);
      project_(projected_);       // Px
      a_->apply(projected_, out); // APx
      project_(out);              // PAPx
      if (complement_ != 0)
        out.update(complement_, in, -complement_, projected_, 1.0); // + σ(x − Px)
    });
  }

  RCP<const Operator> a_;
  std::function<void(Vector&)> project_;
  double complement_;
  mutable Vector projected_; ///< work: Px
};

} // namespace epafi::fetidp
