#pragma once

/// Which unknown of the whole, assembled problem each unknown of a subdomain is a copy of. Copies that
/// FETI-DP joins, by a gluing row or as a crosspoint, have the same number; no others have.

#include "epafi/decomposition/DecomposedProblem.hpp"

#include <vector>

namespace epafi::linear {

/// A list for each of this rank's subdomains: for each of its positions (node × components + component, as
/// Subdomain::prescribed has them) the number, ≥ 0, of the value there; what stands at prescribed positions
/// does not matter. Where unknowns stand for averages and deviations, the numbers are still those of the
/// values of nodes, and where a node has axes of its own (Subdomain::frames), of its values along them.
using GlobalUnknowns = std::vector<std::vector<GlobalOrdinal>>;

/// The numbers of the unknowns alone, n_s a subdomain: those at Subdomain::unknownPosition. \throws
/// InputError, the same on all ranks, if there is not one list for each subdomain and one number for each
/// position, or if the number of an unknown is negative. Collective.
GlobalUnknowns atUnknowns(const decomposition::DecomposedProblem& problem, const GlobalUnknowns& atPositions);

/// A map of the numbers that this rank's subdomains have, ascending. Collective.
RCP<const Map> touchedUnknowns(const GlobalUnknowns& unknowns, const RCP<const Comm>& comm);

/// A map that owns every number once, on one of the ranks that have it. Collective.
RCP<const Map> ownedUnknowns(const GlobalUnknowns& unknowns, const RCP<const Comm>& comm);

} // namespace epafi::linear
