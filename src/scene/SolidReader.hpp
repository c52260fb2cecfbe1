#pragma once

/// What a scene's list says of a body that is no membrane on a rectangle.

#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/Solid.hpp"

namespace epafi::scene {

/// Length of vectors and half the length of boxes in the lists of a body: 3 in space, else 2.
int dimensionOf(Physics physics);

/// \param list  the body's list, validated
/// \throws InputError if what the physics or the kind of an entry needs is missing, or what it has no use for is given.
/// Whether surfaces, groups and points are in the mesh is not looked at here.
Solid readSolid(const ListReader& list, Physics physics);

/// Nodes are counted by int, and their coordinates must be told apart by a double with digits to spare: throws InputError
/// otherwise. \param extent  name of the parameter that `box` comes from
void requireTellableNodes(const ListReader& list, const std::string& extent, const Box& box,
                          const std::array<int, 3>& elements, int dimension);

} // namespace epafi::scene
