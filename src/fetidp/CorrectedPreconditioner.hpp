#pragma once

/// A preconditioner M ≈ H⁻¹ corrected for a few jumps Y that it overrates: with V = M Y,
///   M_V = P M Pᵀ + V(VᵀHV)⁻¹Vᵀ,   P = I − V(VᵀHV)⁻¹VᵀH,
/// (balancing: Mandel, *Comm. Numer. Methods Engrg.* 9 (1993); its spectrum: Nabben, Vuik, *SIAM J. Sci. Comput.* 27
/// (2006)). M_V H is 1 on V, and what is left has the spectrum of H deflated by V. Where M ≥ H⁻¹, so is M_V, for
/// M_V − H⁻¹ = P(M − H⁻¹)Pᵀ.
///
/// V may have entries in rows with bounds: H, and with it the problem, stays what it is. In a face M_V is used as any other
/// preconditioner, restricted to the free set; that is no longer the correction of the restricted M, but it serves
/// (docs/theory.md, "Jumps of the stiffness", has figures).

#include "epafi/fetidp/DualColumnSpace.hpp"

#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite if M is.
class CorrectedPreconditioner final : public Operator {
public:
  /// Costs n_V products with H and with M. \param h  needed here only. \param columns  Y. \throws Error if VᵀHV is not positive definite. Collective.
  CorrectedPreconditioner(const Operator& h, RCP<const Operator> m, const OverratedColumns& columns,
                          const Import& plan);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return m_->getDomainMap(); }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return m_->getRangeMap(); }
  /// y = alpha M_V x + beta y: one application of M, two messages of n_V numbers, 3 n_λ n_V multiplications. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }
  /// n_V.
  [[nodiscard]] int numColumns() const { return space_.size(); }
  /// Bytes of this rank's part of HV and of V.
  [[nodiscard]] std::size_t bytes() const { return space_.bytes(); }

private:
  RCP<const Operator> m_;
  DualColumnSpace space_;
  mutable Vector residual_, image_;      ///< work
  mutable Eigen::VectorXd coefficients_; ///< likewise
};

} // namespace epafi::fetidp
