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

  /// The scene on a mesh of the ladder, 0 the coarsest, or beyond it, there in larger subdomains: a smaller coarse problem.
  [[nodiscard]] scene::Scene onMesh(int level) const;
};

/// Elements along a side of a scene's first body.
int elementsOfSide(const scene::Scene& scene);

/// Two membranes side by side under loads that do not depend on y, so that the solution is that of two strings:
/// −u₁'' = −1 on (0,1), −u₂'' = −3 on (1,2), u₁(0) = u₂(2) = 0, closed all along x = 1 with the force ½ a length.
AccuracyProblem stringsProblem(int elements, int meshes);

/// The model problem of the paper, 16 elements a side of a subdomain.
AccuracyProblem membranesProblem(bool coercive, int elements, int meshes);

/// Two elastic blocks of the same material one on the other, [0,2] × [0,1] in the plane or [0,2]² × [0,1] in space, the lower
/// one on a sliding floor, both with planes of symmetry at x = 0 (and y = 0). The upper one floats: forces near the axis press
/// it down, others pull its far end up, so that the joint opens there. No corner is singular.
/// \param elements  along the height of a block, even
AccuracyProblem blocksProblem(bool inSpace, int elements, int meshes);

/// All of them; quick: on few and coarse meshes.
std::vector<AccuracyProblem> accuracyProblems(bool quick);

} // namespace epafi::drivers
