#pragma once

/// Bodies that are free to move, held: scene::Scene::holds.

#include "epafi/model/Decompose.hpp"
#include "epafi/simulation/SolvedScene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace epafi::simulation {

/// What holding a motion has taken.
struct HoldResult {
  std::string motion; ///< in words
  Vector3 force{};    ///< that the hold has on the body
  Point place{};      ///< of its node
};

/// Adds holds against all motions that are free, each at the node that moves most when those before it are
/// held, and decomposes anew with them. Collective. \throws SolvabilityError if bodies' motions are not known
/// \param cut  the scene's
void holdFreeMotions(scene::Scene& scene, std::unique_ptr<model::Decomposition>& cut);

/// Of each. Collective.
std::vector<HoldResult> holdResults(const SolvedScene& solved);

} // namespace epafi::simulation
