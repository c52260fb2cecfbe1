#pragma once

/// Preconditioners of F: M = Eᵀ S̃ E, where E makes of multipliers a displacement that jumps just as they say, B E = I, and
/// S̃ is the stiffness of the subdomains condensed to boundaries and crosspoints. Then λᵀMλ ≥ λᵀF⁻¹λ, which is the least
/// energy of all such displacements: no eigenvalue of MF is below 1 (Klawonn, Widlund, *Comm. Pure Appl. Math.* 59 (2006),
/// for gluing).
///
/// On the boundaries E is B_D, which is B with its entries scaled row by row (ScaledConstraint.hpp). Rows of contact are
/// treated like those of gluing. B B_Dᵀ = I asks for rows that are orthogonal in D⁻¹, which decompose() gives for stiffness
/// scaling.
/// Where contact touches crosspoints these move by u = C λ, C = B_Dᵀ there, and the others of the body follow, X u
/// (ContactCrosspoints.hpp). The boundaries follow too, each subdomain for itself, −Ψ_Δ X u, and so come apart: they jump by
/// J u. What B_D still has to do is λ − J u, and
///   M = (I − J C)ᵀ [Σ B_D S_Δ B_Dᵀ] (I − J C) + Cᵀ Ŝ C,   S_Δ =
///   dirichlet  the stiffness of a subdomain condensed to its boundary, S_ΔΔ (Farhat, Roux, *Int. J. Numer. Meth.
///              Engng* 32 (1991))
///   lumped     the block K_ΔΔ of the boundary alone: cheaper, and weaker
/// Jumps count in every subdomain of the body: smooth motions reach far, and B E = I must hold all over it. MPRGP uses M
/// restricted to its free set ("in face").

#include "epafi/fetidp/ConstrainedCrosspoints.hpp"
#include "epafi/fetidp/ContactCrosspoints.hpp"
#include "epafi/fetidp/FetiParameters.hpp"
#include "epafi/fetidp/GeneralizedInverse.hpp"
#include "epafi/fetidp/MultiplierExchange.hpp"
#include "epafi/fetidp/ScaledConstraint.hpp"

#include <Tpetra_Operator.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace epafi::fetidp {

/// n_λ × n_λ, symmetric positive definite: every row of B touches a free unknown, or it gets a 1 on the diagonal.
class DualPreconditioner final : public Operator {
public:
  /// Shares `inverse`, and keeps a reference to `problem`. Precondition: type is not none.
  /// \param deflated  F with adaptive constraints, which bodies then keep where they follow crosspoints; null without
  /// Collective.
  DualPreconditioner(const decomposition::DecomposedProblem& problem,
                     std::shared_ptr<GeneralizedInverse> inverse, const PreconditionerParameters& parameters,
                     const RCP<const DeflatedDualOperator>& deflated = Teuchos::null);

  [[nodiscard]] RCP<const Map> getDomainMap() const override { return map_; }
  [[nodiscard]] RCP<const Map> getRangeMap() const override { return map_; }
  /// y = alpha M x + beta y, all columns in one pass: two neighbour exchanges, one dense product a subdomain and column,
  /// and, where contact touches crosspoints, two exchanges and two products with Ψ_Δ more, and two messages of n_C and n_N
  /// numbers a column. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS,
             double alpha = 1.0, double beta = 0.0) const override;
  [[nodiscard]] bool hasTransposeApply() const override { return true; }

  /// λ = Eᵀ(f − K u): as B E = I, the multipliers of a solution u, and for a guess of it, ones as good in the energy norm.
  /// \param given  u, of which the boundaries and crosspoints count; the interiors follow. n_s × 1 of each of this rank's
  ///               subdomains
  /// Precondition: type dirichlet. A sparse solve and a dense product a subdomain. Collective.
  [[nodiscard]] RCP<Vector> multipliersOf(const decomposition::DecomposedProblem& problem,
                                          const SubdomainVectors& given) const;
  /// Bytes of this rank's blocks; what an application reads.
  [[nodiscard]] std::size_t bytes() const;

private:
  /// What a group of identical subdomains needs: m members, n_Δ boundary unknowns.
  struct Block {
    std::size_t group = 0;                                   ///< index in the inverse's groups
    std::shared_ptr<const direct::SymmetricBlock> stiffness; ///< S_Δ
    std::vector<double> weights;   ///< B_D's entries in the order of SubdomainGroup::boundaryEntries
    Eigen::MatrixXd input, output; ///< work, n_Δ × mk
    Eigen::MatrixXi near;          ///< n_c × m: of each member's crosspoint values; empty where none moves
    Eigen::MatrixXd motion;        ///< work, n_c × mk: of these crosspoint values, or the forces there
  };
  void makeBlocks(const decomposition::DecomposedProblem& problem, PreconditionerParameters::Type type,
                  bool isSingle);
  void prepareCrosspoints(const ScaledConstraint& scaled);
  void constrainCrosspoints(const decomposition::DecomposedProblem& problem,
                            const DeflatedDualOperator& deflated);
  void prepareColumns(Eigen::Index numColumns) const;
  void moveCrosspoints(const MultiVector& lambda) const;
  void subtractJumps() const;
  void multiplyBlocks(std::span<const double> lambda, std::span<double> result) const;
  void shareResult() const;
  void passForcesOn() const;
  void addForcesOf(const decomposition::DecomposedProblem& problem, const SubdomainVectors& given,
                   const SubdomainVectors& free, std::span<double> result) const;
  void addCrosspointForces() const;

  RCP<const Map> map_;
  std::shared_ptr<GeneralizedInverse> inverse_;
  ContactCrosspoints crosspoints_;
  std::optional<ConstrainedCrosspoints> constrained_; ///< where there are adaptive constraints
  mutable std::vector<Block> blocks_;
  std::vector<ScaledConstraint::CrosspointEntry>
      crosspointWeights_;             ///< C, of the rows of this rank, row by row
  std::vector<double> inverseShares_; ///< of the rows of this rank: 1/Σ b_i B_D,i over the boundary
  mutable std::vector<AccurateSum> touchedSums_, nearSums_;                       ///< work, n_C k and n_N k
  mutable Eigen::MatrixXd displacement_, forces_, nearDisplacement_, nearForces_; ///< work, likewise
  std::vector<int> untouched_; ///< rows without a free unknown, local indices
  mutable MultiplierExchange input_, output_;
  mutable RCP<MultiVector> smooth_, result_; ///< work: λ − J u, M λ
};

} // namespace epafi::fetidp
