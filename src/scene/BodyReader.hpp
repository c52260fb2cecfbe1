#pragma once

/// One body out of a scene's list `Bodies`.

#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/Scene.hpp"

#include <string>

namespace epafi::scene {

/// Membranes on rectangles have words of their own: edges for surfaces, and boxes that cut elements for
/// loads.
///
/// \param list  the body's list, validated, its Decomposition complete
/// \throws InputError if what the physics or the kind of an entry needs is missing, what it has no use for is
/// given, or something does not make sense: sizes, counts, boxes outside of the body, an edge of a membrane
/// supported twice or with another value at a corner, more nodes than an int counts. Whether surfaces, groups
/// and points are in the mesh is not looked at here.
Body readBody(const std::string& name, const ListReader& list);

} // namespace epafi::scene
