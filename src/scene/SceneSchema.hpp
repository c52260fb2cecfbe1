#pragma once

/// What a scene may say: names, types, defaults, ranges and meaning of its parameters, in one place.

#include <Teuchos_ParameterList.hpp>

namespace epafi::scene {

/// The schema (see base/Parameters.hpp) of a scene: `Title`, `Bodies`, `Contact` and `Decomposition`. A whole
/// file may hold the lists `Solver` and `Output` beside them, which other rooms describe. An empty word or
/// array as default means that the parameter must be given, or what its documentation says.
Teuchos::ParameterList sceneSchema();

/// The part of it that says how a body is cut into subdomains.
Teuchos::ParameterList decompositionSchema();

} // namespace epafi::scene
