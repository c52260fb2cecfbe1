#pragma once

/// F with jumps taken out of the iteration: with columns U in gluing rows only and
///   P = I − U(UᵀFU)⁻¹UᵀF
/// the multipliers are λ = Pμ + U(UᵀFU)⁻¹Uᵀd̃, and μ is met by F_U = PᵀFP = F − FU(UᵀFU)⁻¹UᵀF, the dual operator of the
/// displacements with UᵀBu = 0, and by Pᵀd̃. The gradients F_U μ − Pᵀd̃ and Fλ − d̃ are the same vector. U has no
/// entries in rows of contact, so that bounds are not touched, and rigid motions keep bodies glued, so that GU = 0 and GP = G:
/// λ is in equilibrium if μ is. Projector preconditioning: Domorádová, Dostál, *Numer. Linear Algebra Appl.* 14 (2007)
/// 791–806; for adaptive constraints: Klawonn, Rheinbach, *ZAMM* 92 (2012).

#include "epafi/fetidp/DualColumnSpace.hpp"
#include "epafi/fetidp/DualOperator.hpp"

#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive semidefinite, with the kernel Im U beside what F has.
class DeflatedDualOperator final : public Operator {
public:
  /// Costs n_U products with F. \param columns  U, in gluing rows. \throws Error if UᵀFU is not positive definite. Collective.
  DeflatedDualOperator(RCP<const DualOperator> f, const OverratedColumns& columns);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return f_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return f_->getRangeMap(); }
  /// y = alpha F_U x + beta y, all columns in one pass of F: beside it one message of n_U numbers and n_λ n_U
  /// multiplications a column. Symmetric. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

  /// d ← Pᵀd = d − FU(UᵀFU)⁻¹Uᵀd. One message of n_U numbers. Collective.
  void project(Vector& d) const { space_.subtractImage(space_.coefficients(d), d); }
  /// λ from μ, in place: λ = μ + U(UᵀFU)⁻¹Uᵀ(d̃ − Fμ). One product with F. Collective.
  void complete(const Vector& rhs, Vector& lambda) const;
  /// U, with FU and UᵀFU.
  [[nodiscard]] const DualColumnSpace& space() const { return space_; }
  /// n_U.
  [[nodiscard]] int numConstraints() const { return space_.size(); }
  /// Bytes of this rank's part of FU and of U.
  [[nodiscard]] std::size_t bytes() const { return space_.bytes(); }

private:
  RCP<const DualOperator> f_;
  DualColumnSpace space_;
  mutable RCP<MultiVector> image_; ///< work
};

} // namespace epafi::fetidp
