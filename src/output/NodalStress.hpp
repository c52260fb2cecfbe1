#pragma once

/// Stress of elastic bodies at their nodes.

#include "epafi/output/SolvedScene.hpp"

#include <vector>

namespace epafi::output {

/// Von Mises stress at the nodes of body `body`, of this rank's slab (evenShare of the nodes). Linear elements have their
/// stress at their centres; a node has the mean of the elements around it, weighted by their areas or volumes, of every
/// component of the tensor, and von Mises' norm of that: exact where the stress is constant, O(h²) inside uniform meshes, and
/// the same for every cut and number of ranks but for round-off. Between two materials it is the mean of both sides.
/// Each rank looks at the elements of its own subdomains. Precondition: the body is elastic. Collective.
std::vector<double> vonMisesAtNodes(const SolvedScene& solved, int body);

} // namespace epafi::output
