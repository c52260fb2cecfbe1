#pragma once

/// Preconditioners of F: M = Eᵀ S̃ E, where E makes of multipliers a displacement that jumps just as they
/// say, B E = I, and S̃ is the stiffness of the subdomains condensed to boundaries and crosspoints. Then λᵀMλ
/// ≥ λᵀF⁻¹λ, which is the least energy of all such displacements: no eigenvalue of MF is below 1 (Klawonn,
/// Widlund, *Comm. Pure Appl. Math.* 59 (2006), for gluing).
///
/// On the boundaries E is B_D, which is B with its entries scaled row by row (ScaledConstraint.hpp). Rows of
/// contact are treated like those of gluing. B B_Dᵀ = I asks for rows that are orthogonal in D⁻¹, which
/// decompose() gives for stiffness scaling. Where contact touches crosspoints these move by u = C λ, C = B_Dᵀ
/// there, and the others of the body follow, X u (ContactCrosspoints.hpp). The boundaries follow too, each
/// subdomain for itself, −Ψ_Δ X u, and so come apart: they jump by J u. What B_D still has to do is λ − J u,
/// and
///   M = (I − J C)ᵀ [Σ B_D S_Δ B_Dᵀ] (I − J C) + Cᵀ Ŝ C,   S_Δ =
///   dirichlet the stiffness of a subdomain condensed to its boundary, S_ΔΔ (Farhat, Roux, *Int. J. Numer.
///   Meth.
///              Engng* 32 (1991))
///   lumped     the block K_ΔΔ of the boundary alone: cheaper, and weaker
/// Jumps count in every subdomain of the body: smooth motions reach far, and B E = I must hold all over it.
/// MPRGP uses M restricted to its free set ("in face").

#include "epafi/base/SymmetricOperator.hpp"
#include "epafi/fetidp/precondition/BoundaryPreconditioner.hpp"
#include "epafi/fetidp/precondition/CrosspointMotion.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite: every row of B touches a free unknown, or it gets a 1 on the
/// diagonal. A product takes all columns in one pass: two neighbour exchanges, one dense product a subdomain
/// and column, and, where contact touches crosspoints, two exchanges and two products with Ψ_Δ more, and two
/// messages of n_C and n_N numbers a column.
class DualPreconditioner final : public SymmetricOperator {
public:
  /// Shares `inverse`, and keeps a reference to `problem`. Precondition: type is not none.
  /// \param deflated  F with adaptive constraints, which bodies then keep where they follow crosspoints; null
  /// without
  /// Collective.
  DualPreconditioner(const decomposition::DecomposedProblem& problem,
                     std::shared_ptr<const GeneralizedInverse> inverse,
                     const PreconditionerParameters& parameters,
                     const RCP<const qp::DeflatedOperator>& deflated = Teuchos::null);

  /// λ = Eᵀ(f − K u): as B E = I, the multipliers of a solution u, and for a guess of it, ones as good in the
  /// energy norm.
  /// \param given  u, of which the boundaries and crosspoints count; the interiors follow. n_s × 1 of each of
  /// this rank's subdomains
  /// Precondition: type dirichlet. A sparse solve and a dense product a subdomain. Collective.
  [[nodiscard]] RCP<Vector> multipliersOf(const decomposition::DecomposedProblem& problem,
                                          const decomposition::ProblemData& data,
                                          const SubdomainVectors& given) const;
  /// Bytes of this rank's blocks; what is left to factors takes none.
  [[nodiscard]] std::size_t bytes() const { return boundary_->bytes(); }

private:
  void multiply(const MultiVector& x, MultiVector& y) const override;

  std::shared_ptr<const GeneralizedInverse> inverse_;
  std::optional<CrosspointMotion> motion_;         ///< where contact touches crosspoints
  std::optional<BoundaryPreconditioner> boundary_; ///< always
  std::vector<LocalOrdinal> untouched_;            ///< rows without a free unknown
  mutable Eigen::MatrixXd displacement_;           ///< work: C λ
  mutable RCP<MultiVector> rest_;                  ///< work: λ − J C λ
};

} // namespace epafi::fetidp
