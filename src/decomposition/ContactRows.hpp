#pragma once

/// The rows of B_I, handed over as a Tpetra matrix over the unknowns of all bodies.

#include "epafi/decomposition/ConstraintMatrix.hpp"
#include "epafi/decomposition/Crosspoints.hpp"

#include <vector>

namespace epafi::decomposition {

/// \throws InputError, the same on all ranks, if the matrix is not fill-complete, has columns that none of
/// `unknowns` is, a row without an entry other than 0, entries that are not finite, or if the gap lies on
/// other rows. Collective.
/// \param unknowns  the numbers of all unknowns of the subdomains, each on one rank
void requireSound(const ConstraintMatrix& contact, const RCP<const Map>& unknowns);

/// The rows in terms of the subdomains' values at nodes. The rank that owns a row of the matrix owns its
/// multiplier.
struct ContactRows {
  std::vector<std::vector<RowEntry>> rows; ///< B_I^s of this rank's subdomains
  /// B_p of this rank's subdomains, those of their positions (nodes × components) that have no unknown.
  std::vector<std::vector<RowEntry>> heldRows;
  RCP<const Vector> held; ///< what prescribed values contribute to B_I u, on the row map of B_I
};

/// A crosspoint has its entries in the lowest subdomain that shares it, another shared node in all of them:
/// contact acts on the mean of its copies, Σ δ_i u_i / Σ δ_i with δ = diag K^s, which makes the row
/// orthogonal in D⁻¹ to the gluing of the node (see GluingRows.hpp). Every rank holds the list of the nodes
/// that have entries in B_I. Collective. Precondition: the matrix is sound.
ContactRows contactRows(const Substructures& all, const SharedNodes& shared, const Crosspoints& crosspoints,
                        const ConstraintMatrix& contact);

} // namespace epafi::decomposition
