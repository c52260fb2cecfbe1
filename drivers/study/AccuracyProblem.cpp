#include "AccuracyProblem.hpp"

#include "epafi/accuracy/Refinement.hpp"
#include "epafi/scene/ModelProblem.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace epafi::drivers {
namespace {

constexpr double leftLoad = -1, rightLoad = -3;

/// u and u' of the two strings. λ = (f₁ − f₂)/4, u₁(1) = f₁/2 − λ, u₂(1) = f₂/2 + λ.
fem::FieldValue strings(int body, const fem::Point& point) {
  constexpr double force = (leftLoad - rightLoad) / 4;
  const bool isLeft = body == 0;
  const double load = isLeft ? leftLoad : rightLoad, atJoint = load / 2 + (isLeft ? -force : force);
  const double fromWall = isLeft ? point[0] : 2 - point[0];
  const double slope = atJoint + load / 2; // at the wall, away from it
  fem::FieldValue value;
  value.displacement = {slope * fromWall - load * fromWall * fromWall / 2};
  value.flux = {(isLeft ? 1 : -1) * (slope - load * fromWall)};
  return value;
}

scene::Body block(bool inSpace, bool isUpper, int elements) {
  const double bottom = isUpper ? 1 : 0;
  scene::Solid solid;
  solid.physics = inSpace ? scene::Physics::elasticity3d : scene::Physics::planeStrain;
  solid.material.youngsModulus = 1;
  solid.material.poissonsRatio = 0.3;
  if (inSpace) {
    solid.mesh.box = {{0, 0, bottom}, {2, 2, bottom + 1}};
    solid.mesh.elements = {2 * elements, 2 * elements, elements};
  } else {
    solid.mesh.box = {{0, bottom, 0}, {2, bottom + 1, 0}};
    solid.mesh.elements = {2 * elements, elements, 0};
  }
  scene::SolidSupport symmetry{"symmetry x", "left", {}};
  symmetry.value[0] = 0.0;
  solid.supports.push_back(symmetry);
  if (inSpace) {
    symmetry = {"symmetry y", "front", {}};
    symmetry.value[1] = 0.0;
    solid.supports.push_back(symmetry);
  }
  scene::Body body;
  body.name = isUpper ? "upper" : "lower";
  body.solid = solid;
  return body;
}

/// Force per volume in a part of the upper block, from its mid-plane up.
scene::SolidLoad force(const char* name, bool inSpace, double from, double to, double value) {
  scene::SolidLoad load;
  load.name = name;
  const std::size_t vertical = inSpace ? 2 : 1;
  for (std::size_t d = 0; d < vertical; ++d) {
    load.box.lower[d] = from;
    load.box.upper[d] = to;
  }
  load.box.lower[vertical] = 1.5;
  load.box.upper[vertical] = 2;
  load.value[vertical] = value;
  return load;
}

} // namespace

scene::Scene AccuracyProblem::onMesh(int level) const {
  scene::Scene scene = coarsest;
  for (int k = 0; k < level; ++k)
    scene = accuracy::refined(std::move(scene));
  if (level >= meshes)
    for (scene::Body& body : scene.bodies)
      for (int& count : body.decomposition.counts)
        count = std::max(1, count / 2);
  return scene;
}

int elementsOfSide(const scene::Scene& scene) {
  const scene::Body& first = scene.bodies.front();
  return first.solid ? first.solid->mesh.elements[0] : first.elements[0];
}

AccuracyProblem stringsProblem(int elements, int meshes) {
  AccuracyProblem problem = membranesProblem(true, elements, meshes);
  problem.name = "strings";
  problem.coarsest.title = "Two membranes under loads along x alone";
  problem.coarsest.bodies[0].loads = {{"load", {0, 1, 0, 1}, leftLoad}};
  problem.coarsest.bodies[1].loads = {{"load", {1, 2, 0, 1}, rightLoad}};
  problem.exact = strings;
  return problem;
}

AccuracyProblem membranesProblem(bool coercive, int elements, int meshes) {
  AccuracyProblem problem;
  problem.name = coercive ? "coercive" : "semicoercive";
  problem.coarsest = scene::modelProblem(coercive, std::max(1, elements / 16), elements);
  problem.meshes = meshes;
  return problem;
}

AccuracyProblem blocksProblem(bool inSpace, int elements, int meshes) {
  AccuracyProblem problem;
  problem.name = inSpace ? "blocks_space" : "blocks_plane";
  problem.meshes = meshes;
  problem.coarsest.title = "Two elastic blocks";
  problem.coarsest.bodies = {block(inSpace, false, elements), block(inSpace, true, elements)};
  const int parts = std::max(1, elements / 16); // of the height
  for (scene::Body& body : problem.coarsest.bodies)
    body.decomposition.counts = inSpace ? std::array{1, 1, 1} : std::array{2 * parts, parts, 1};
  scene::SolidSupport floor{"floor", "bottom", {}};
  floor.value[inSpace ? 2 : 1] = 0.0;
  problem.coarsest.bodies[0].solid->supports.push_back(floor);
  problem.coarsest.bodies[1].solid->loads = {force("press", inSpace, 0, 1, -0.1),
                                             force("pull", inSpace, 1.5, 2, 0.06)};
  scene::SurfaceContact joint;
  joint.name = "joint";
  joint.firstSurface = "top";
  joint.second = 1;
  joint.secondSurface = "bottom";
  problem.coarsest.surfaceContacts = {joint};
  return problem;
}

std::vector<AccuracyProblem> accuracyProblems(bool quick) {
  if (quick)
    return {stringsProblem(16, 3), membranesProblem(true, 16, 3), membranesProblem(false, 16, 3),
            blocksProblem(false, 8, 2), blocksProblem(true, 2, 2)};
  return {stringsProblem(32, 4), membranesProblem(true, 32, 4), membranesProblem(false, 32, 4),
          blocksProblem(false, 16, 4), blocksProblem(true, 2, 3)};
}

} // namespace epafi::drivers
