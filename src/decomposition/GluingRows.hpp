#pragma once

/// The rows of B_E: at every node that several subdomains share and that is no crosspoint, the copies are
/// chained, u_lower − u_higher = 0: one row less than copies, so that no row is redundant.

#include "epafi/decomposition/Pieces.hpp"

#include <vector>

namespace epafi::decomposition {

/// Rows are numbered from `firstRow` by lower subdomain, then node, then component, whatever the number of
/// ranks; the lower side's rank owns a row and tells its number to the other side. Enters the rows in the
/// pieces.
/// \param[out] numRows  of the whole problem.
/// Collective.
Rows gluingRows(const Layout& layout, std::vector<Piece>& pieces, GlobalOrdinal firstRow,
                const RCP<const Comm>& comm, GlobalOrdinal& numRows);

} // namespace epafi::decomposition
