#pragma once

/// Which unknown of the whole, assembled problem each unknown of a subdomain is a copy of. Copies that FETI-DP joins, by a
/// gluing row or as a crosspoint, have the same number; no others have.

#include "epafi/decomposition/Decompose.hpp"

#include <vector>

namespace epafi::linear {

/// A list for each of this rank's subdomains: for unknown i the number, ≥ 0, of the value at Subdomain::unknownPosition[i], of
/// n_s in all. Prescribed positions have no unknown and no number. Where unknowns stand for averages and deviations, the numbers
/// are still those of the values of nodes, and where a node has axes of its own (Subdomain::frames), of its values along them.
using GlobalUnknowns = std::vector<std::vector<GlobalOrdinal>>;

/// The numbers of a scene: body after body, node after node, component after component, supported ones left out of the list
/// but not of the numbering. Not collective.
GlobalUnknowns globalUnknowns(const decomposition::Decomposition& decomposition);

/// A map that owns every number once, on one of the ranks that have it. \throws InputError if a number is negative. Collective.
RCP<const Map> ownedUnknowns(const GlobalUnknowns& unknowns, const RCP<const Comm>& comm);

} // namespace epafi::linear
