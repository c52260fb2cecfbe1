#pragma once

/// From a scene to a DecomposedProblem.

#include "epafi/decomposition/ContactLayout.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/Partition.hpp"
#include "epafi/fem/Mesh.hpp"
#include "epafi/scene/Scene.hpp"

#include <memory>
#include <vector>

namespace epafi::decomposition {

/// A body of the scene with its mesh and the way it is cut.
struct BodyLayout {
  std::string name;
  std::unique_ptr<const fem::Mesh> mesh;
  std::shared_ptr<const Partition> partition; ///< bodies that are meshed and cut alike share one
  int firstSubdomain = 0;                     ///< number of its part 0 in the whole problem
};

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
