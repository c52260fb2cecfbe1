#pragma once

/// The contact pairs out of a scene's list `Contact`.

#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/Scene.hpp"

#include <vector>

namespace epafi::scene {

/// \throws InputError if a body is unknown (the nearest name is suggested) or in contact with itself, if an
///         edge is supported or in another pair, or if the two edges do not coincide or have different
///         numbers of elements.
std::vector<ContactPair> readContacts(const ListReader& list, const std::vector<Body>& bodies);

} // namespace epafi::scene
