#pragma once

/// B_D, the matrix B with its entries scaled row by row,
///   b_i → (b_i/δ_i) / Σ_k b_k²/δ_k,
/// k over all entries of the row, or, where rows share unknowns, over those that are its own
/// (SharedRows.hpp): then B B_Dᵀ = I there too; δ = 1 for multiplicity scaling, δ = the diagonal of K^s (at
/// crosspoints, of K̄) for stiffness (ρ) scaling: what takes multipliers to displacements in preconditioners
/// of F (Klawonn, Widlund, *Comm. Pure Appl. Math.* 54 (2001)).

#include "epafi/fetidp/operator/FetiParameters.hpp"
#include "epafi/fetidp/operator/MultiplierExchange.hpp"
#include "epafi/fetidp/precondition/ContactCrosspoints.hpp"

#include <vector>

namespace epafi::fetidp {

struct ScaledConstraint {
  /// What moves a crosspoint, an entry there or a share of one on a face at its edge's end: multiplier (ghost
  /// map), index in ContactCrosspoints, value.
  struct CrosspointEntry {
    int multiplier, touched;
    double weight;
  };
  std::vector<std::vector<double>>
      boundary; ///< of this rank's subdomains, in the order of their entries at remainders
  std::vector<CrosspointEntry> atCrosspoints; ///< of this rank's subdomains
  std::vector<double>
      boundaryShares;         ///< Σ b_i B_D,i of each row (ghost map) over this rank's entries at remainders
  std::vector<int> untouched; ///< rows of this rank (multiplierMap) without any entry
};

/// Collective.
ScaledConstraint scaleConstraint(const decomposition::DecomposedProblem& problem,
                                 const ContactCrosspoints& crosspoints,
                                 PreconditionerParameters::Scaling scaling, const RCP<const Import>& plan);

} // namespace epafi::fetidp
