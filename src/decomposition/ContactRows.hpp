#pragma once

/// The rows of B_I: dᵀ(u_first − u_second) ≤ gap at the nodes of a contact.

#include "epafi/decomposition/Pieces.hpp"

#include <vector>

namespace epafi::decomposition {

/// Numbers the rows pair after pair, along the first body's edge. A node may take part in several contacts, each with a row
/// of its own; a row that says what one of an earlier contact says (see KnownRows.hpp) is left out. \throws InputError if
/// the edges of a pair do not coincide node by node (see scene::coincide), if one of them is supported, if two
/// pairs share an edge of a body (a common corner is fine), or if a contact adds no row to those before; SolvabilityError
/// if two contacts leave a node no room. Not collective (every rank finds the same).
std::vector<ContactLayout> layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies);

/// Enters the rows in the pieces. This rank owns those whose first node lies, at its lowest subdomain, on
/// this rank. A node that several subdomains share has its entry in the lowest-numbered one; nodes that supports hold in
/// the row's direction have none. `touched` has a row twice if both its nodes are here. Not collective.
Rows contactRows(const Layout& layout, const std::vector<ContactLayout>& contacts,
                 std::vector<Piece>& pieces);

/// The right-hand side c of a contact row: its gap, less what supported nodes contribute.
double contactGap(const Layout& layout, const std::vector<ContactLayout>& contacts, GlobalOrdinal row);

} // namespace epafi::decomposition
