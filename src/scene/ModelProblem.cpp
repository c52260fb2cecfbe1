#include "epafi/scene/ModelProblem.hpp"

namespace epafi::scene {

Scene modelProblem(bool coercive, int counts, int elements) {
  Scene scene;
  scene.title = coercive ? "Coercive membranes" : "Semicoercive membranes";

  Body left;
  left.name = "left";
  left.mesh.box = mesh::rectangle(0, 1, 0, 1);
  left.mesh.elements = {elements, elements, 0};
  left.decomposition.counts = {counts, counts, 1};
  left.supports = {{"wall", "left", {0.0}}};
  left.loads = {fem::loadInside("upper strip", mesh::rectangle(0, 1, 0.75, 1), coercive ? -1.0 : -5.0)};

  Body right = left;
  right.name = "right";
  right.mesh.box = mesh::rectangle(1, 2, 0, 1);
  right.supports.clear();
  if (coercive)
    right.supports = {{"wall", "right", {0.0}}};
  right.loads = {fem::loadInside("lower strip", mesh::rectangle(1, 2, 0, 0.25), coercive ? -3.0 : -1.0)};

  scene.bodies = {left, right};
  scene.contacts = {{"interface", 0, "right", 1, "left"}};
  return scene;
}

} // namespace epafi::scene
