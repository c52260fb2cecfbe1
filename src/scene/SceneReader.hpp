#pragma once

/// From a parameter list to a scene.

#include "epafi/scene/Scene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::scene {

/// Reads a scene, bodies and pairs in the list's order. The list is checked against sceneSchema() here,
/// whether or not it was before; the list `Solver` in it is left to others. A body inherits
/// from the top level's Decomposition what its own does not give.
///
/// \param where  with what messages begin (a file, usually)
/// \throws InputError with one sentence naming file, list, parameter, value and what is allowed,
///         SolvabilityError if gaps and supports contradict each other (see GapConsistency.hpp).
/// Not collective; the same on all ranks if called with the same list.
Scene readScene(const Teuchos::ParameterList& list, const std::string& where);

} // namespace epafi::scene
