#pragma once

/// Which nodes of two surfaces, or of a surface and an obstacle, may meet, in which direction, and how far they are apart.
///
/// An obstacle's gap is the distance of a node from it, along its own normal, negative inside; nodes whose surface
/// faces away from it get none. Two surfaces must match: every
/// node of one faces a node of the other along the normal, the mean of both surfaces' normals there; nodes that have no
/// counterpart are left out as long as the other surface is used up, such as beside a punch. Nodes farther from the other
/// side than the contact's `distance` get no row, and cost nothing.

#include "epafi/decomposition/BodyLayout.hpp"
#include "epafi/decomposition/ContactLayout.hpp"

namespace epafi::decomposition {

/// The rows of one contact; `firstRow` is left to the caller. \throws InputError if a surface is not there, no node is near
/// enough, or the surfaces do not match. Not collective.
ContactLayout searchContact(const scene::SurfaceContact& contact, const std::vector<BodyLayout>& bodies,
                            int components);

} // namespace epafi::decomposition
