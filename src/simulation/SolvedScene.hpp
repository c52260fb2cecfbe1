#pragma once

/// A scene with its solution: what everything in this room looks at.

#include "epafi/fetidp/solve/ContactSolution.hpp"
#include "epafi/model/Decompose.hpp"
#include "epafi/scene/EdgeContact.hpp"
#include "epafi/scene/Scene.hpp"

namespace epafi::simulation {

/// References, no copies. Precondition: `decomposition` was made from `scene`, `solution` belongs to
/// `decomposition`.
struct SolvedScene {
  const scene::Scene& scene;
  const model::Decomposition& decomposition;
  const fetidp::ContactSolution& solution;

  /// The communicator of the problem.
  [[nodiscard]] const Comm& comm() const { return *decomposition.problem.comm; }
  /// What the scene says of a body if it is elastic, else null.
  [[nodiscard]] const scene::Body* elasticBody(int body) const {
    const scene::Body& candidate = scene.bodies[body];
    return candidate.physics != fem::Physics::membrane ? &candidate : nullptr;
  }
  /// Whether its bodies are, about the y-axis: forces across it are in balance all around.
  [[nodiscard]] bool isOfRevolution() const {
    return scene.bodies.front().physics == fem::Physics::axisymmetric;
  }
  /// Whether a contact is that of membranes' edges.
  [[nodiscard]] bool isAlongEdges(int contact) const {
    const int number = decomposition.contacts[contact].number;
    return scene::isAlongEdges(scene, scene.contacts[number]);
  }
};

} // namespace epafi::simulation
