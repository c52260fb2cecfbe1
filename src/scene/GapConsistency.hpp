#pragma once

/// Do the gaps and supports of a scene leave room for any deflection at all?
///
/// Every contact row says u_first − u_second ≤ gap at one node, a support u = value. An edge is in one pair
/// at most, so that rows share nodes at the corners of the rectangles only: there they are difference
/// constraints, which contradict each other if and only if a cycle of them has a negative sum (Bellman,
/// *Quart. Appl. Math.* 16 (1958) 87–90).

#include "epafi/scene/Scene.hpp"

namespace epafi::scene {

/// Precondition: the pairs of the scene join edges that coincide.
/// \throws SolvabilityError that names the contact pairs and bodies of such a cycle, its place and the
/// overlap. Not collective; the same on all ranks if called with the same scene.
void requireConsistentGaps(const Scene& scene);

} // namespace epafi::scene
