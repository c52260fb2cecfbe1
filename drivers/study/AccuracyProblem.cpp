#include "AccuracyProblem.hpp"

#include "CaseTable.hpp"

#include "epafi/accuracy/Refinement.hpp"
#include "epafi/scene/SceneReader.hpp"

#include <algorithm>
#include <utility>

namespace epafi::drivers {
namespace {

constexpr double leftLoad = -1, rightLoad = -3;

/// u and u' of the two strings. λ = (f₁ − f₂)/4, u₁(1) = f₁/2 − λ, u₂(1) = f₂/2 + λ.
fem::FieldValue strings(int body, const Point& point) {
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
  return scene.bodies.front().mesh.elements[0];
}

std::vector<AccuracyProblem> accuracyProblems(bool quick) {
  std::vector<AccuracyProblem> problems;
  for (const Case& one : expandCases(caseText("accuracy"), "problems", quick))
    problems.push_back({one.name, scene::readScene(one.scene(), one.name),
                        static_cast<int>(one.list.get<double>("Meshes")),
                        one.name == "strings" ? strings : accuracy::ExactField()});
  return problems;
}

} // namespace epafi::drivers
