#pragma once

/// The rigid obstacles out of a scene's list `Obstacles`.

#include "epafi/scene/Body.hpp"
#include "epafi/scene/ListReader.hpp"

#include <string>
#include <vector>

namespace epafi::scene {

struct NamedObstacle {
  std::string name;
  int dimension = 3; ///< of the bodies that it can meet
  Obstacle obstacle;
};

/// \throws InputError if what an obstacle's kind needs is missing or what it has no use for is given, if vectors are not
///         of one length, or a normal is 0.
std::vector<NamedObstacle> readObstacles(const ListReader& list);

} // namespace epafi::scene
