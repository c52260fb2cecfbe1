#pragma once

/// Problems that the accuracy study measures errors of, each on a ladder of meshes.

#include "epafi/accuracy/ErrorNorms.hpp"
#include "epafi/scene/Scene.hpp"

#include <string>
#include <vector>

namespace epafi::drivers {

struct AccuracyProblem {
  std::string name;
  scene::Scene coarsest;
  int meshes = 1;             ///< of the ladder; each has half the mesh size of the one before
  accuracy::ExactField exact; ///< empty where no closed form is known

  /// Of the elements.
  [[nodiscard]] int order() const { return coarsest.bodies.front().mesh.order; }
  /// The scene on a mesh of the ladder, 0 the coarsest, or beyond it, there in larger subdomains: a smaller
  /// coarse problem.
  [[nodiscard]] scene::Scene onMesh(int level) const;
};

/// Elements along a side of a scene's first body.
int elementsOfSide(const scene::Scene& scene);

/// Those of cases/accuracy.cases; quick: on few and coarse meshes.
std::vector<AccuracyProblem> accuracyProblems(bool quick);

} // namespace epafi::drivers
