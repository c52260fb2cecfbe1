#pragma once

/// A with a few columns U taken out of the iteration (ColumnSpace.hpp): x = Pμ + U(UᵀAU)⁻¹Uᵀb, where μ is met
/// by
///   A_U = PᵀAP = PᵀA = A − AU(UᵀAU)⁻¹UᵀA
/// and by Pᵀb; the gradients A_U μ − Pᵀb and Ax − b are the same vector. Where U has no entries in rows with
/// bounds, P leaves these alone, and bounds of x are bounds of μ: Domorádová, Dostál, *Numer. Linear Algebra
/// Appl.* 14 (2007) 791–806.

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/qp/operators/ColumnSpace.hpp"

#include <Tpetra_MultiVector.hpp>

#include <utility>

namespace epafi::qp {

/// A_U, n × n, symmetric positive semidefinite, with the kernel Im U beside what A has. A product costs one
/// with A and one message of k numbers a column.
class DeflatedOperator final : public SymmetricOperator {
public:
  /// \param a      A, symmetric positive semidefinite; kept
  /// \param space  U beside A, factorized
  DeflatedOperator(RCP<const Operator> a, ColumnSpace space)
      : SymmetricOperator(space.map()), a_(std::move(a)), space_(std::move(space)) {}

  /// x from μ, in place: x = μ + U(UᵀAU)⁻¹Uᵀ(b − Aμ). One product with A. Collective.
  void complete(const MultiVector& b, MultiVector& x) const {
    MultiVector residual(b, Teuchos::Copy);
    a_->apply(x, residual, Teuchos::NO_TRANS, -1.0, 1.0);
    space_.correct(residual, x);
  }
  [[nodiscard]] const ColumnSpace& space() const { return space_; } ///< U, with AU and UᵀAU

private:
  void multiply(const MultiVector& x, MultiVector& y) const override {
    a_->apply(x, y);
    space_.projectTransposed(y); // PᵀAx: what round-off leaves of UᵀAx is gone as well
  }

  RCP<const Operator> a_;
  ColumnSpace space_;
};

} // namespace epafi::qp
