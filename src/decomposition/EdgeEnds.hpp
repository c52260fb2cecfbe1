#pragma once

/// Where the edges of a cluster end at other clusters: what the faces that meet there do on the mean, the
/// edge's average follows (fetidp/ContactCrosspoints.hpp). On the mean, since a jump of one node alone must
/// not move the whole edge.

#include "epafi/decomposition/Crosspoints.hpp"

#include <span>
#include <vector>

namespace epafi::decomposition {

/// The faces at the ends of a subdomain's edges that have averages. An edge ends in a node which the same
/// subdomains of its cluster share, and other clusters too; the faces there have the nodes that some of
/// these, of both sides, share.
/// \param inside, shared  as for the crosspoints
/// \param clusterOf       of each subdomain of the whole problem
/// Not collective.
std::vector<EdgeEnd> findEdgeEnds(const Substructures& all, const SharedNodes& inside,
                                  const SharedNodes& shared, std::span<const int> clusterOf,
                                  const Crosspoints& crosspoints, SubdomainPlace subdomain);

} // namespace epafi::decomposition
