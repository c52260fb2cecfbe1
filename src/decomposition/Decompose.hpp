#pragma once

/// From a scene to a DecomposedProblem.

#include "epafi/decomposition/BodyLayout.hpp"
#include "epafi/decomposition/ContactLayout.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// The scene cut into subdomains: where everything lies (for output), and the problem itself (for FETI-DP).
struct Decomposition {
  std::vector<BodyLayout> bodies;
  std::vector<ContactLayout> contacts;
  DecomposedProblem problem;
};

/// Cuts the scene into subdomains, gives each rank a contiguous run of them and assembles them.
/// Collective. \throws InputError (the same on all ranks) if contact edges do not match, or if a contact edge
/// is supported.
Decomposition decompose(const scene::Scene& scene, const RCP<const Comm>& comm);

} // namespace epafi::decomposition
