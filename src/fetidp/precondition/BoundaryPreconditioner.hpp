#pragma once

/// Σ B_D S_Δ B_Dᵀ over the subdomains, what a preconditioner of F does at their boundaries: S_Δ is the
/// stiffness of a subdomain condensed to its boundary, S_ΔΔ (dirichlet), or the block K_ΔΔ of the boundary
/// alone (lumped).

#include "epafi/direct/SymmetricBlock.hpp"
#include "epafi/fetidp/operator/FetiParameters.hpp"
#include "epafi/fetidp/operator/GeneralizedInverse.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"
#include "epafi/fetidp/precondition/ScaledConstraint.hpp"

#include <memory>
#include <vector>

namespace epafi::fetidp {

/// Symmetric, positive semidefinite; identical subdomains share a block.
class BoundaryPreconditioner {
public:
  /// Shares `inverse`. Precondition: type is not none. Collective.
  BoundaryPreconditioner(const decomposition::DecomposedProblem& problem,
                         std::shared_ptr<const GeneralizedInverse> inverse, const ScaledConstraint& scaled,
                         const PreconditionerParameters& parameters);

  /// y = Σ B_D S_Δ B_Dᵀ x, all columns in one pass: two neighbour exchanges, one dense product a subdomain
  /// and column, or two triangular ones with its factor. Collective.
  void apply(const MultiVector& x, MultiVector& y) const;
  /// y = Σ B_D S_Δ u_Δ, u of n_s × 1. Collective.
  void applyTo(const SubdomainVectors& u, Vector& y) const;
  /// Bytes of this rank's blocks; what is left to factors takes none.
  [[nodiscard]] std::size_t bytes() const;

private:
  /// Of a group of identical subdomains: m members, n_Δ boundary unknowns.
  struct Block {
    std::shared_ptr<const direct::SymmetricBlock> stiffness; ///< S_Δ; null: as the factor has it
    std::vector<InterfaceEntry> scaled;                      ///< B_D's entries
  };
  struct Work {
    Eigen::MatrixXd displacement, forces; ///< n_Δ × mk
  };
  [[nodiscard]] Work& prepared(std::size_t group, Eigen::Index numColumns) const;
  void multiply(std::size_t group, Work& work) const;

  std::shared_ptr<const GeneralizedInverse> inverse_;
  std::vector<Block> blocks_; ///< of the inverse's groups
  mutable std::vector<Work> work_;
  mutable MultiplierExchange input_, output_;
};

} // namespace epafi::fetidp
