#pragma once

/// The rows of B_E: at every node that several subdomains share and that is no crosspoint, each copy but the
/// first equals the mean of those before it,
///   Σ_{i<k} δ_i u_i / Σ_{i<k} δ_i − u_k = 0,   δ = diag K^s,
/// which is u_0 − u_1 = 0 where there are two: one row less than copies, so that no row is redundant.
/// Weighted like this the rows are orthogonal in D⁻¹, D = diag δ; where they are not, as in a chain u_{k−1} −
/// u_k, preconditioners have to invert B D⁻¹ Bᵀ at each node, or lose the lower bound of their spectrum
/// (Klawonn, Widlund, *Comm. Pure Appl. Math.* 54 (2001), section 4; orthonormal rows with equal weights:
/// Dostál, Kozubek, Sadowská, Vondrák, *Scalable Algorithms for Contact Problems*).
///
/// Between clusters (Clusters.hpp) a row b is multiplied by its size, (b D⁻¹bᵀ)^−½ over the geometric mean of
/// all these rows, so that all have the same length in D⁻¹. P, orthogonal in their multipliers, is then the
/// projector with the scaling Q = (b D⁻¹bᵀ)⁻¹ of those of rows that are not multiplied, which knows of jumps
/// of the stiffness (Farhat, Chen, Mandel, Roux, *Comput. Methods Appl. Mech. Engrg.* 167 (1998); Klawonn,
/// Widlund, as above).

#include "epafi/decomposition/Crosspoints.hpp"

#include <memory>
#include <span>
#include <vector>

namespace epafi::decomposition {

/// Row k − 1 of a node is that of copies k − 1 and k. Rows are numbered by the lower one's subdomain, then
/// node, then component, whatever the number of ranks; the lower side's rank owns a row and tells its number
/// to the others.
struct GluingRows {
  std::vector<std::vector<RowEntry>> rows; ///< B_E^s of this rank's subdomains
  std::vector<GlobalOrdinal> owned;        ///< rows that this rank owns, ascending
  std::vector<GlobalOrdinal> elsewhere; ///< others in which its subdomains have entries, some perhaps twice
  GlobalOrdinal numRows = 0;            ///< of the whole problem
};

/// \param clusterOf  of each subdomain of the whole problem
/// \param stiffness  K^s of each subdomain in the basis in which the rows act
/// \param firstRow   number of the first one
/// Collective.
GluingRows gluingRows(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints,
                      std::span<const int> clusterOf,
                      std::span<const std::shared_ptr<const SparseMatrix>> stiffness, GlobalOrdinal firstRow);

} // namespace epafi::decomposition
