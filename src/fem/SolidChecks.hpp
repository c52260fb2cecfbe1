#pragma once

/// What a solid must be before anything is assembled.

#include "epafi/fem/SolidBody.hpp"

namespace epafi::fem {

/// \throws InputError if a plane physics meets a mesh in space, or the other way round.
void requireDimension(const SolidBody& body);

/// Elements joined in facets move as one rigid body; those joined in less may turn about each other, which membranes
/// cannot. \throws InputError if an elastic body is not joined in facets, or a membrane not even in nodes. Linear in the number
/// of elements.
void requireJoined(const SolidBody& body);

} // namespace epafi::fem
