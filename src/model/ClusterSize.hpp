#pragma once

/// How many subdomains of a body share crosspoints, where the scene leaves that open: all of them, or as many
/// as make FETI-DP's coarse problem harmless (decomposition/Clusters.hpp).

#include "epafi/base/Types.hpp"
#include "epafi/mesh/StructuredMesh.hpp"

#include <array>

namespace epafi::model {

/// With N subdomains on P ranks a run by FETI-DP takes some C(N) + LN/P: every rank solves the coarse problem
/// whole, and C grows like N² in space. Clusters take twice the products, whose coarse problems cost next to
/// nothing, some 3LN/P: they win where PN is large. From where on was measured on one and two ranks
/// (docs/performance.md, "Which method from how many ranks on").
/// \param numSubdomains  N, of all bodies
/// Not collective.
bool clustersPay(int dimension, GlobalOrdinal numSubdomains, int numRanks);

/// \param counts  subdomains of the body in x, y and z, a grid; 1 in z in the plane
/// \returns the number of subdomains in a block that halving the body again and again along its longest side
/// leaves (GroupedPartition numbers its parts that way), whether a rank has so many or several share them; 0
/// for all of them: where P or N is too small, where there is no such block of a useful size, and for bodies
/// that are no grids, whose clusters can take several times the products. Not collective.
int clusterSizeFor(const mesh::StructuredMesh& mesh, std::array<int, 3> counts, GlobalOrdinal numSubdomains,
                   int numRanks);

} // namespace epafi::model
