#pragma once

/// The lists `Obstacles` and `Contact` of the schema of scene files.

#include <Teuchos_ParameterList.hpp>

namespace epafi::scene {

/// Adds what one of them may hold to `Obstacles`, or to `Contact`.
void describeObstacle(Teuchos::ParameterList& obstacles);
void describePair(Teuchos::ParameterList& contact);

} // namespace epafi::scene
