#pragma once

/// From a parameter list to a Scene.

#include "epafi/scene/Scene.hpp"

#include <Teuchos_ParameterList.hpp>

#include <string>

namespace epafi::scene {

/// \param list   a list validated against sceneSchema() (further sublists, Solver and Output, are passed over)
/// \param given  the list as the user gave it: tells which entries of a body's Decomposition override the scene's
/// \param where  the file, for messages
/// \throws InputError, one sentence: sizes that are not positive, boxes that miss their body, unknown bodies, edges that are
///         both supported and in contact, contact pairs that share an edge, cuts finer than the mesh. Not collective.
Scene readScene(const Teuchos::ParameterList& list, const Teuchos::ParameterList& given, const std::string& where);

} // namespace epafi::scene
