#pragma once

/// What preloads have come to, and displacements of single nodes.

#include "epafi/simulation/SolvedScene.hpp"

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

namespace epafi::simulation {

/// Of a section of a bolt.
struct PreloadResult {
  std::string name;      ///< of the tied joint
  double force = 0;      ///< the bolt's tension
  double shortening = 0; ///< what is taken out of its length
};

/// Of each section. Collective.
std::vector<PreloadResult> preloadResults(const SolvedScene& solved);

/// Displacements in space of nodes of a body, on all ranks. \param nodes  the same on all ranks. Collective.
std::vector<Eigen::Vector3d> displacementsAt(const SolvedScene& solved, int body,
                                             std::span<const GlobalOrdinal> nodes);

} // namespace epafi::simulation
