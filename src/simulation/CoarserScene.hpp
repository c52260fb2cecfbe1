#pragma once

/// The same scene with fewer unknowns, to find the contact zone with.

#include "epafi/model/Decompose.hpp"
#include "epafi/scene/Scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace epafi::simulation {

struct CoarserScene {
  scene::Scene scene;
  std::vector<model::BodyLayout> bodies; ///< meshed and cut
  std::string means;                     ///< what makes it coarser, in some words
};

/// Where elements are of order 2 those of order 1 on the same mesh; where all are of order 1 half as many
/// cells along each axis of a grid, and elements twice as large in a geometry. Nothing where no body can be
/// had coarser, as of a mesh file of order 1.
/// \param fine  the bodies of the scene
/// Collective. \throws InputError, the same on all ranks, where a geometry cannot be meshed in this way.
std::optional<CoarserScene> coarserScene(const scene::Scene& scene,
                                         const std::vector<model::BodyLayout>& fine, const Comm& comm);

} // namespace epafi::simulation
