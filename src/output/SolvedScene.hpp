#pragma once

/// A scene with its solution: what everything in this room looks at.

#include "epafi/decomposition/Decompose.hpp"
#include "epafi/fetidp/ContactSolution.hpp"
#include "epafi/scene/Scene.hpp"

namespace epafi::output {

/// References, no copies. Precondition: `decomposition` was made from `scene`, `solution` belongs to `decomposition`.
struct SolvedScene {
  const scene::Scene& scene;
  const decomposition::Decomposition& decomposition;
  const fetidp::ContactSolution& solution;

  /// The communicator of the problem.
  [[nodiscard]] const Comm& comm() const { return *decomposition.problem.comm; }
  /// What the scene says of a body if it is elastic, else null.
  [[nodiscard]] const scene::Solid* elasticBody(int body) const {
    const auto& solid = scene.bodies[static_cast<std::size_t>(body)].solid;
    return solid && solid->physics != scene::Physics::membrane ? &*solid : nullptr;
  }
  /// The scene's contact of surfaces that became decomposition.contacts[contact]; null if that is a pair of membranes'
  /// edges.
  [[nodiscard]] const scene::SurfaceContact* surfaceContact(int contact) const {
    const auto place = static_cast<std::size_t>(contact), pairs = scene.contacts.size();
    return place < pairs ? nullptr : &scene.surfaceContacts[place - pairs];
  }
};

} // namespace epafi::output
