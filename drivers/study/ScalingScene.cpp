#include "ScalingScene.hpp"

#include "epafi/scene/ModelProblem.hpp"

namespace epafi::drivers {
namespace {

scene::Body block(const std::string& name, double bottom, const std::string& held, int counts, int elements) {
  scene::Body body;
  body.name = name;
  body.physics = fem::Physics::elasticity3d;
  body.material.youngsModulus = 200;
  body.mesh.box = {{0, 0, bottom}, {1, 1, bottom + 1}};
  body.mesh.elements = {counts * elements, counts * elements, counts * elements};
  body.decomposition.counts = {counts, counts, counts};
  body.supports = {{"held", held, {0.0, 0.0, 0.0}}};
  return body;
}

} // namespace

scene::Scene scalingScene(const std::string& problem, int counts, int elements) {
  if (problem != "blocks")
    return scene::modelProblem(problem == "coercive", counts, counts * elements);
  scene::Scene scene;
  scene.bodies = {block("lower", 0, "bottom", counts, elements), block("upper", 1, "top", counts, elements)};
  fem::SolidLoad press;
  press.name = "press";
  press.box = {{0, 0, 1}, {0.5, 1, 1.5}};
  press.value = {0, 0, -1};
  scene.bodies[1].loads = {press};
  scene::SurfaceContact joint;
  joint.name = "joint";
  joint.first = 0;
  joint.firstSurface = "top";
  joint.second = 1;
  joint.secondSurface = "bottom";
  scene.contacts = {joint};
  return scene;
}

} // namespace epafi::drivers
