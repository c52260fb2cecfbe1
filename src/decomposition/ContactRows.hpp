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

/// Enters the rows in the pieces. This rank owns those whose first node lies, at its lowest subdomain, on this rank. Nodes
/// that supports hold in the row's direction have no entry. A crosspoint has its entry in the lowest-numbered subdomain that
/// shares it, another shared node in all of them: contact acts on the mean of its copies, Σ δ_i u_i / Σ δ_i with δ = diag
/// K^s, which makes the row orthogonal in D⁻¹ to the gluing of the node (see GluingRows.hpp). `touched` may have rows twice.
/// Precondition: the pieces' bases are not changed yet. Collective.
Rows contactRows(const Layout& layout, const std::vector<ContactLayout>& contacts,
                 const RCP<const Comm>& comm, std::vector<Piece>& pieces);

/// The right-hand side c of a contact row: its gap, less what supported nodes contribute.
double contactGap(const Layout& layout, const std::vector<ContactLayout>& contacts, GlobalOrdinal row);

} // namespace epafi::decomposition
