#pragma once

/// Contact rows of an application: B_I as a Tpetra matrix over the global unknowns.

#include "epafi/decomposition/Pieces.hpp"

#include <utility>
#include <vector>

namespace epafi::decomposition {

/// B_I u ≤ c as an application has it, with the prescribed values still among u.
struct ContactMatrix {
  RCP<const CrsMatrix> rows; ///< B_I, n_I × unknowns, fill-complete; its rows are numbered 0 … n_I − 1
  RCP<const Vector> gap;     ///< c, on the row map of B_I
};

/// \throws InputError, the same on all ranks, if the matrix is not fill-complete, has columns that none of `unknowns` is, a
/// row without an entry other than 0, entries that are not finite, or if the gap lies on other rows. Collective.
/// \param unknowns  the numbers of all unknowns of the pieces, each on one rank
void requireSound(const ContactMatrix& contact, const RCP<const Map>& unknowns);

/// Enters the rows in the pieces as contactRows does for scenes: at a crosspoint in the lowest subdomain that shares it, at
/// another shared node in all of them, with the mean of its copies. The rank that owns a row of the matrix owns its
/// multiplier. \param[out] held  what prescribed values contribute to B_I u, by row; one entry a column, on one rank
/// Preconditions: the matrix is sound; the pieces' bases are not changed. Collective.
Rows enterContactMatrix(const Outline& outline, const ContactMatrix& contact, const RCP<const Comm>& comm,
                        std::vector<Piece>& pieces, std::vector<std::pair<GlobalOrdinal, double>>& held);

} // namespace epafi::decomposition
