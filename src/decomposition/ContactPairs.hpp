#pragma once

/// Contact of membranes along edges that coincide node by node.

#include "epafi/decomposition/BodyLayout.hpp"
#include "epafi/decomposition/ContactLayout.hpp"

#include <vector>

namespace epafi::decomposition {

/// The rows of the scene's pairs of edges, in order along the first body's edge; not numbered yet. \throws InputError if
/// the edges of a pair do not coincide node by node (see scene::coincide), if one of them is supported, or if two pairs
/// share an edge of a body (a common corner is fine). Not collective (every rank finds the same).
std::vector<ContactLayout> layoutPairs(const scene::Scene& scene, const std::vector<BodyLayout>& bodies);

} // namespace epafi::decomposition
