#pragma once

/// What a scene may say: names, types, defaults, ranges and meaning of its parameters, in one place.

#include <Teuchos_ParameterList.hpp>

namespace epafi::scene {

/// The schema (see base/Parameters.hpp) of a scene: `Title`, `Bodies`, `Contact` and `Decomposition`. A whole
/// file may hold the list `Solver` beside them, which another room describes.
Teuchos::ParameterList sceneSchema();

/// The part of it that says how a body is cut into subdomains.
Teuchos::ParameterList decompositionSchema();

} // namespace epafi::scene
