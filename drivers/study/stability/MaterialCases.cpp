/// Elasticity that is nearly incompressible. The elements lock, which is a matter of discretisation and makes the answer a
/// poor one; the solver is to find it all the same.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

scene::Scene withRatio(scene::Scene scene, double ratio) {
  for (scene::Body& body : scene.bodies)
    body.solid->material.poissonsRatio = ratio;
  return scene;
}

void add(StabilityCases& cases, const std::string& name, double ratio, const scene::Scene& scene) {
  for (const bool isPlain : {false, true}) {
    ContactTask task{withRatio(scene, ratio)};
    if (isPlain)
      task.solver = plainMethod();
    std::string words = std::to_string(ratio);
    words.erase(words.find_last_not_of('0') + 1);
    StabilityCase trial{
        "incompressible", name, words, isPlain && ratio > 0.49 ? solvedOrStopped() : solved(), {}};
    trial.run = [task](const RCP<const Comm>& comm) { return solveContact(task, comm); };
    trial.value = 1 / (1 - 2 * ratio); // λ/μ = ν of it
    trial.variant = isPlain ? "plain" : "default";
    cases.push_back(std::move(trial));
  }
}

} // namespace

StabilityCases incompressibleCases(bool quick) {
  StabilityCases cases;
  for (const double ratio : {0.3, 0.45, 0.49, 0.499, 0.4999, 0.49999}) {
    if (quick && (ratio == 0.45 || ratio == 0.49))
      continue;
    add(cases, "squares", ratio, pressedSquares(2, quick ? 3 : 8));
    add(cases, "square on a floor", ratio, standingSquare(2, quick ? 3 : 8));
    add(cases, "cubes", ratio, pressedCubes(2, quick ? 2 : 4));
  }
  return cases;
}

} // namespace epafi::drivers
