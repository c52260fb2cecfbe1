#pragma once

/// Where the interfaces of subdomains end, found from matrices alone: where there is no mesh, nobody knows
/// the boundary of a body, and with it the corners that lie there (Corners.hpp).

#include "epafi/decomposition/SharedNodes.hpp"

#include <cstddef>
#include <vector>

namespace epafi::decomposition {

/// Places of the two ends of each chain of nodes that just the same parts share, two or more in the plane and
/// three or more in space, as far as they do not lie beside a corner, a node that still more parts share.
/// Chains hang together in the graph of K^s; their ends are a pair of nodes with the longest way between
/// them, found by two searches in breadth. None where `subdomain` is not the lowest one: that one decides for
/// all. Not collective.
std::vector<std::size_t> findInterfaceEnds(const Substructures& all, const SharedNodes& shared,
                                           std::size_t subdomain);

} // namespace epafi::decomposition
