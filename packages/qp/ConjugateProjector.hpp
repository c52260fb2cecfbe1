#pragma once

/// Preconditioning by a conjugate projector for partially bounded problems: Domorádová, Dostál, *Numer. Linear Algebra
/// Appl.* 14 (2007) 791–806. The coarse space Im U lives in the entries without bounds, so that
///   P = I − U(UᵀAU)⁻¹UᵀA
/// leaves bounded entries alone; what U can do for the solution is done at once, and MPRGP works on AP = PᵀAP, whose
/// spectrum no longer holds what U took care of.

#include "epafi/base/Types.hpp"

#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include <vector>

namespace epafi::qp {

class ConjugateProjector {
public:
  /// \param a  A, symmetric positive semidefinite
  /// \param u  U, n × k, k small; kept
  /// Costs k products with A. \throws InputError if UᵀAU is not positive definite. Collective.
  ConjugateProjector(RCP<const Operator> a, RCP<const MultiVector> u);

  /// The operator AP, symmetric positive semidefinite. One product with A and one message of k numbers an apply. Refers
  /// to this projector, which must outlive it.
  [[nodiscard]] RCP<const Operator> projectedOperator() const;
  /// Pᵀb = b − AU(UᵀAU)⁻¹Uᵀb. Collective.
  void projectLinearTerm(const Vector& b, Vector& projected) const;
  /// x = Px' + U(UᵀAU)⁻¹Uᵀb from the solution x' of the projected problem, in place. Collective.
  void complete(const Vector& b, Vector& x) const;

  /// x ← Px. Collective.
  void project(Vector& x) const;
  /// y = APx. Collective.
  void apply(const Vector& x, Vector& y) const;
  [[nodiscard]] const RCP<const Operator>& hessian() const { return a_; }

private:
  std::vector<double> coefficients(const MultiVector& columns, const Vector& x) const;
  static void subtract(const MultiVector& columns, const std::vector<double>& coefficients, double factor,
                       Vector& x);

  RCP<const Operator> a_;
  RCP<const MultiVector> u_;
  MultiVector au_;               ///< AU
  std::vector<double> cholesky_; ///< of UᵀAU, k × k on every rank
};

} // namespace epafi::qp
