#include "epafi/scene/ModelProblem.hpp"

namespace epafi::scene {

Scene modelProblem(bool coercive, int counts, int elements) {
  Scene scene;
  scene.title = coercive ? "Coercive membranes" : "Semicoercive membranes";

  Body left;
  left.name = "left";
  left.rectangle = {0, 1, 0, 1};
  left.elements = {elements, elements};
  left.decomposition.counts = {counts, counts, 1};
  left.supports = {{"wall", Edge::left, 0.0}};
  left.loads = {{"upper strip", {0, 1, 0.75, 1}, coercive ? -1.0 : -5.0}};

  Body right = left;
  right.name = "right";
  right.rectangle = {1, 2, 0, 1};
  right.supports.clear();
  if (coercive)
    right.supports = {{"wall", Edge::right, 0.0}};
  right.loads = {{"lower strip", {1, 2, 0, 0.25}, coercive ? -3.0 : -1.0}};

  scene.bodies = {left, right};
  scene.contacts = {{"interface", 0, Edge::right, 1, Edge::left, 0.0}};
  return scene;
}

} // namespace epafi::scene
