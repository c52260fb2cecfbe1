#pragma once

/// A preconditioner M ≈ H⁻¹ corrected for a few jumps Y that it overrates: with V = M Y,
///   M_V = P M Pᵀ + V(VᵀHV)⁻¹Vᵀ,   P = I − V(VᵀHV)⁻¹VᵀH,
/// (balancing: Mandel, *Comm. Numer. Methods Engrg.* 9 (1993); its spectrum: Nabben, Vuik, *SIAM J. Sci.
/// Comput.* 27 (2006)). M_V H is 1 on V, and what is left has the spectrum of H deflated by V. Where M ≥ H⁻¹,
/// so is M_V, for M_V − H⁻¹ = P(M − H⁻¹)Pᵀ.
///
/// V may have entries in rows with bounds: H, and with it the problem, stays what it is. In a face M_V is
/// used as any other preconditioner, restricted to the free set; that is no longer the correction of the
/// restricted M, but it serves.

#include "epafi/base/Columns.hpp"
#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/qp/operators/ColumnSpace.hpp"

#include <Tpetra_Vector.hpp>

#include <utility>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite if M is.
class CorrectedPreconditioner final : public SymmetricOperator {
public:
  /// \param space  V beside H, factorized
  CorrectedPreconditioner(RCP<const Operator> m, qp::ColumnSpace space)
      : SymmetricOperator(m->getDomainMap()), m_(std::move(m)), space_(std::move(space)),
        residual_(getDomainMap()) {}

  [[nodiscard]] const qp::ColumnSpace& space() const { return space_; } ///< V, with HV and VᵀHV

private:
  /// One application of M, two messages of n_V numbers, 3 n_λ n_V multiplications.
  void multiply(const MultiVector& x, MultiVector& y) const override {
    forEachColumn(x, y, [&](const Vector& in, Vector& out) {
      space_.coefficients(in, coefficients_); // c = (VᵀHV)⁻¹Vᵀx
      residual_.assign(in);
      space_.subtractImage(coefficients_, residual_); // Pᵀx = x − HVc
      m_->apply(residual_, out);
      space_.project(out);                   // P M Pᵀx
      space_.addColumns(coefficients_, out); // + Vc
    });
  }

  RCP<const Operator> m_;
  qp::ColumnSpace space_;
  mutable Vector residual_;                            ///< Pᵀx, work
  mutable qp::ColumnSpace::Coefficients coefficients_; ///< c, work
};

} // namespace epafi::fetidp
