#pragma once

/// One body out of a scene's list `Bodies`.

#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/Scene.hpp"

#include <string>

namespace epafi::scene {

/// \param list  the body's list, validated, its Decomposition complete
/// \throws InputError if anything in it does not make sense: sizes, counts, boxes outside of the body, an
///         edge supported twice, supports that disagree at a corner, more nodes than an int counts.
Body readBody(const std::string& name, const ListReader& list);

} // namespace epafi::scene
