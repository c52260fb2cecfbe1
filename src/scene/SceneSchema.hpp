#pragma once

/// The valid parameters of a scene: names, types, ranges, defaults and meaning in one place.

#include <Teuchos_ParameterList.hpp>

namespace epafi::scene {

/// Title, Bodies, Contact and Decomposition. A driver adds its own sublists (Solver, Output).
Teuchos::ParameterList sceneSchema();

} // namespace epafi::scene
