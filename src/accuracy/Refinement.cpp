#include "epafi/accuracy/Refinement.hpp"

namespace epafi::accuracy {

scene::Scene refined(scene::Scene scene) {
  for (scene::Body& body : scene.bodies) {
    const bool isInSpace = body.solid && body.solid->physics == scene::Physics::elasticity3d;
    for (int& count : body.elements)
      count *= 2;
    if (body.solid) {
      for (int& count : body.solid->mesh.elements)
        count *= 2;
      if (!body.solid->mesh.file.empty())
        ++body.solid->mesh.refinements;
    }
    for (int& count : body.decomposition.counts)
      count *= 2;
    body.decomposition.parts *= isInSpace ? 8 : 4;
  }
  return scene;
}

} // namespace epafi::accuracy
