#include "epafi/accuracy/Refinement.hpp"

namespace epafi::accuracy {

scene::Scene refined(scene::Scene scene) {
  for (scene::Body& body : scene.bodies) {
    for (int& count : body.mesh.elements)
      count *= 2;
    if (!body.mesh.file.empty())
      ++body.mesh.refinements;
    for (int& count : body.decomposition.counts)
      count *= 2;
    body.decomposition.parts *= dimensionOf(body.physics) == 3 ? 8 : 4;
  }
  return scene;
}

} // namespace epafi::accuracy
