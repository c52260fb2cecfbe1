#include "Scenes.hpp"

#include "epafi/scene/ModelProblem.hpp"

namespace epafi::drivers {

scene::Decomposition grid(std::array<int, 3> counts) {
  scene::Decomposition how;
  how.counts = counts;
  return how;
}

scene::Decomposition metis(int parts) {
  scene::Decomposition how;
  how.method = scene::Decomposition::Method::metis;
  how.parts = parts;
  return how;
}

scene::Scene cut(scene::Scene scene, const scene::Decomposition& how) {
  for (scene::Body& body : scene.bodies)
    body.decomposition = how;
  return scene;
}

scene::Scene membranes(bool coercive, int subdomains, int elements) {
  return scene::modelProblem(coercive, subdomains, subdomains * elements);
}

scene::Scene strips(bool coercive, double first, double second, int elements) {
  scene::Scene scene = scene::modelProblem(coercive, 2, elements);
  scene.bodies[0].loads = {{"load", {0, 1, 0, 1}, first}};
  scene.bodies[1].loads = {{"load", {1, 2, 0, 1}, second}};
  return scene;
}

scene::Body block(const std::string& name, const scene::Box& box, std::array<int, 3> elements,
                  const scene::Decomposition& how) {
  scene::Body body;
  body.name = name;
  scene::Solid solid;
  solid.physics = elements[2] > 0 ? scene::Physics::elasticity3d : scene::Physics::planeStrain;
  solid.material.youngsModulus = 200;
  solid.mesh.box = box;
  solid.mesh.elements = elements;
  body.solid = solid;
  body.decomposition = how;
  return body;
}

scene::SolidSupport clamp(const std::string& surface) {
  return {"clamp on " + surface, surface, {0.0, 0.0, 0.0}};
}

scene::SolidSupport slide(const std::string& surface, double normal) {
  return {"slide on " + surface, surface, {}, normal};
}

scene::SolidLoad weight(const scene::Vector3& force) {
  return {"weight", scene::SolidLoad::Kind::body, {}, "", {0, 0, 0}, force};
}

scene::SolidLoad pointForce(const scene::Vector3& point, const scene::Vector3& force) {
  return {"force", scene::SolidLoad::Kind::point, {}, "", point, force};
}

scene::SurfaceContact onPlane(const std::string& name, int body, const std::string& surface,
                              const scene::Vector3& point, const scene::Vector3& normal, double gap) {
  scene::SurfaceContact contact;
  contact.name = name;
  contact.first = body;
  contact.firstSurface = surface;
  contact.obstacle.point = point;
  contact.obstacle.normal = normal;
  contact.gap = gap;
  return contact;
}

scene::SurfaceContact between(const std::string& name, int first, const std::string& firstSurface, int second,
                              const std::string& secondSurface, double gap) {
  scene::SurfaceContact contact;
  contact.name = name;
  contact.first = first;
  contact.firstSurface = firstSurface;
  contact.second = second;
  contact.secondSurface = secondSurface;
  contact.gap = gap;
  return contact;
}

scene::Scene pressedSquares(int subdomains, int elements) {
  const int n = subdomains * elements;
  scene::Scene scene;
  scene.title = "Pressed squares";
  scene.bodies.push_back(
      block("lower", {{0, 0, 0}, {1, 1, 0}}, {n, n, 0}, grid({subdomains, subdomains, 1})));
  scene.bodies.push_back(
      block("upper", {{0, 1, 0}, {1, 2, 0}}, {n, n, 0}, grid({subdomains, subdomains, 1})));
  scene.bodies[0].solid->supports = {clamp("bottom")};
  scene.bodies[1].solid->supports = {clamp("top")};
  scene.bodies[1].solid->loads = {weight({0.5, -2, 0})};
  scene.surfaceContacts = {between("joint", 1, "bottom", 0, "top")};
  return scene;
}

scene::Scene pressedCubes(int subdomains, int elements) {
  const int n = subdomains * elements;
  scene::Scene scene;
  scene.title = "Pressed cubes";
  const auto how = grid({subdomains, subdomains, subdomains});
  scene.bodies.push_back(block("lower", {{0, 0, 0}, {1, 1, 1}}, {n, n, n}, how));
  scene.bodies.push_back(block("upper", {{0, 0, 1}, {1, 1, 2}}, {n, n, n}, how));
  scene.bodies[0].solid->supports = {clamp("bottom")};
  scene.bodies[1].solid->supports = {clamp("top")};
  scene.bodies[1].solid->loads = {weight({0.5, 0, -2})};
  scene.surfaceContacts = {between("joint", 1, "bottom", 0, "top")};
  return scene;
}

scene::Scene standingSquare(int subdomains, int elements) {
  const int n = subdomains * elements;
  scene::Scene scene;
  scene.title = "Standing square";
  scene.bodies.push_back(
      block("square", {{0, 0, 0}, {1, 1, 0}}, {n, n, 0}, grid({subdomains, subdomains, 1})));
  scene.bodies[0].solid->supports = {slide("left")};
  scene.bodies[0].solid->loads = {weight({0, -1, 0})};
  scene.surfaceContacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0})};
  return scene;
}

} // namespace epafi::drivers
