/// The same problem in other units, loads of any size, and loads of very different sizes together.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

struct Units {
  double length = 1, force = 1; ///< of a membrane: of a deflection; of a load
};

/// Membranes in the plane do not change; their deflections and loads do.
scene::Scene membranesIn(const Units& units, bool coercive) {
  scene::Scene scene = membranes(coercive, 2, 4);
  for (scene::Body& body : scene.bodies) {
    body.conductivity = units.force / units.length;
    for (scene::Load& load : body.loads)
      load.value *= units.force;
  }
  scene.contacts[0].gap = 0.01 * units.length;
  return scene;
}

scene::Scene squaresIn(const Units& units, bool) {
  scene::Scene scene = pressedSquares(2, 3);
  for (scene::Body& body : scene.bodies) {
    scene::Solid& solid = *body.solid;
    for (auto* corner : {&solid.mesh.box.lower, &solid.mesh.box.upper})
      for (double& coordinate : *corner)
        coordinate *= units.length;
    solid.material.youngsModulus *= units.force / (units.length * units.length);
    solid.material.thickness *= units.length;
    for (scene::SolidLoad& load : solid.loads)
      for (double& component : load.value)
        component *= units.force / std::pow(units.length, 3);
  }
  scene.surfaceContacts[0].gap = 1e-3 * units.length;
  return scene;
}

/// Solves in units of 1 and in the given ones; the answers must be the same, and so must the way there.
CaseResult compare(scene::Scene (*build)(const Units&, bool), const Units& units, bool coercive,
                   const RCP<const Comm>& comm) {
  const CaseResult one = solveContact({build({}, coercive)}, comm);
  CaseResult other = solveContact({build(units, coercive)}, comm);
  const double energy = other.energy / (units.force * units.length) / one.energy;
  std::ostringstream text;
  if (!(std::abs(energy - 1) < 1e-6))
    text << "the energy is " << energy << " of that in units of 1; ";
  if (other.active != one.active)
    text << other.active << " closed nodes, not " << one.active << "; ";
  if (std::abs(other.products - one.products) > one.products / 5)
    text << other.products << " products, not " << one.products << "; ";
  if (other.outcome == Outcome::solved && !text.str().empty()) {
    other.outcome = Outcome::wrongAnswer;
    other.reason = text.str();
  }
  return other;
}

std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0e", value);
  return text;
}

void addUnits(StabilityCases& cases, const std::string& name, scene::Scene (*build)(const Units&, bool),
              bool coercive) {
  for (const double length : {1e-9, 1.0, 1e9})
    for (const double force : {1e-9, 1.0, 1e9}) {
      if (length == 1 && force == 1)
        continue;
      const Units units{length, force};
      StabilityCase trial{"units", name, "length " + words(length) + ", force " + words(force), solved(), {}};
      trial.run = [=](const RCP<const Comm>& comm) { return compare(build, units, coercive, comm); };
      cases.push_back(std::move(trial));
    }
}

} // namespace

StabilityCases unitCases(bool quick) {
  StabilityCases cases;
  addUnits(cases, "units of membranes", membranesIn, true);
  addUnits(cases, "units of floating membranes", membranesIn, false);
  addUnits(cases, "units of elastic squares", squaresIn, true);
  for (int k = -8; k <= 8; k += quick ? 8 : 2) {
    const double size = std::pow(10.0, k);
    const auto add = [&](const std::string& name, const scene::Scene& scene) {
      StabilityCase trial{"units", name, words(size), solved(), {}};
      trial.run = [scene](const RCP<const Comm>& comm) { return solveContact({scene}, comm); };
      trial.value = size;
      cases.push_back(std::move(trial));
    };
    for (const bool coercive : {true, false}) {
      scene::Scene scene = membranes(coercive, 2, quick ? 4 : 8);
      for (scene::Body& body : scene.bodies)
        body.loads[0].value *= size;
      add(coercive ? "loads times" : "loads times, floating", scene);
      scene = membranes(coercive, 2, quick ? 4 : 8);
      scene.bodies[1].loads[0].value *= size; // beside the other body's of 1
      add(coercive ? "one body's load times" : "one body's load times, floating", scene);
    }
    scene::Scene scene = strips(true, 1, 0, 8);
    scene.bodies[0].loads = {{"small", {0, 1, 0, 0.5}, 1e-8}, {"large", {0, 1, 0.5, 1}, 1e8}};
    scene.bodies[1].loads = {{"middle", {1, 2, 0, 1}, size}};
    add("loads of 1e-8 and 1e8 on a body, beside", scene);
  }
  return cases;
}

} // namespace epafi::drivers
