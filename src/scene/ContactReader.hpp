#pragma once

/// The contact pairs out of a scene's list `Contact`.

#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/ObstacleReader.hpp"
#include "epafi/scene/Scene.hpp"

#include <vector>

namespace epafi::scene {

/// Fills the contacts of a scene whose bodies are there: pairs of membranes on rectangles meet along edges, all others on
/// surfaces.
/// \throws InputError if a body or obstacle is unknown (the nearest name is suggested), a body in contact with itself, or an
///         obstacle in no contact; of membranes on rectangles, if an edge is supported or in another pair, or the two edges
///         do not coincide or have different numbers of elements; of all others, if surfaces are not named. Whether the
///         surfaces are in the meshes is not looked at here.
void readContacts(const ListReader& list, const std::vector<NamedObstacle>& obstacles, Scene& scene);

} // namespace epafi::scene
