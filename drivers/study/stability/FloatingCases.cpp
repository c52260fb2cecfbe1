/// Bodies that hardly anything holds: supports through soft layers, loads that hardly press, contacts that hardly hinder.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0e", value);
  return value == 0 ? "0" : text;
}

void add(StabilityCases& cases, const std::string& name, double value, const Expectation& expected,
         const ContactTask& task, const std::string& remains = "") {
  StabilityCase trial{"floating", name, words(value), expected, {}};
  trial.run = [task](const RCP<const Comm>& comm) { return solveContact(task, comm); };
  trial.value = value;
  trial.remains = remains;
  cases.push_back(std::move(trial));
}

/// The right membrane is held at its right edge through a column of elements of conductivity `spring`. With its length of
/// one element that is a spring of spring/h a length.
scene::Scene onSoftLayer(double spring, double load, int elements) {
  scene::Scene scene = membranes(false, 2, elements);
  scene::Body& right = scene.bodies[1];
  const double h = 1.0 / right.elements[0];
  right.regions = {{"spring", {2 - h, 2, 0, 1}, spring}};
  right.supports = {{"wall", scene::Edge::right, 0.0}};
  right.loads[0].value = load;
  return scene;
}

/// A square on a floor that a soft column of elements at its left holds sideways.
scene::Scene leaningOnSoftLayer(double spring, int elements) {
  scene::Scene scene = standingSquare(2, elements);
  scene::Solid& solid = *scene.bodies[0].solid;
  solid.supports = {clamp("left")};
  solid.loads = {weight({0, -1, 0})};
  scene::SolidRegion layer;
  layer.name = "spring";
  layer.box.upper[0] = 1.0 / solid.mesh.elements[0];
  layer.material.youngsModulus = 200 * spring;
  solid.regions = {layer};
  return scene;
}

/// The right body floats under loads on its halves that nearly balance: ∓1 − r.
scene::Scene hardlyPressed(double resultant, int elements) {
  scene::Scene scene = strips(false, 1.0, 0.0, elements);
  scene.bodies[1].loads = {{"lower", {1, 2, 0, 0.5}, 1.0 - resultant},
                           {"upper", {1, 2, 0.5, 1}, -1.0 - resultant}};
  return scene;
}

/// A square on a floor and against a wall at its left, with a load of 1 down at x = 1 − distance from its right end and
/// ½ against the wall.
scene::Scene leaning(double distance) {
  const double x = 1 - distance;
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, grid({2, 2, 1}))};
  scene.bodies[0].solid->loads = {pointForce({1, 1, 0}, {0, -x, 0}), pointForce({0, 1, 0}, {0, x - 1, 0}),
                                  pointForce({1, 0, 0}, {-0.5, 0, 0})};
  scene.surfaceContacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}),
                           onPlane("wall", 0, "left", {0, 0, 0}, {1, 0, 0})};
  return scene;
}

/// A square on a floor; its lower corners stand before planes that rise outwards from there so slowly, at an angle ε to the
/// floor, that they hardly keep it from sliding.
scene::Scene betweenSlopes(double angle) {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, grid({2, 2, 1}))};
  scene.bodies[0].solid->loads = {weight({0, -1, 0})};
  const double s = std::sin(angle), c = std::cos(angle);
  scene.surfaceContacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}),
                           onPlane("left slope", 0, "left", {0, 0, 0}, {s, c, 0}),
                           onPlane("right slope", 0, "right", {1, 0, 0}, {-s, c, 0})};
  return scene;
}

} // namespace

StabilityCases floatingCases(bool quick) {
  StabilityCases cases;
  const int elements = quick ? 4 : 8;
  for (int k = 2; k <= 12; k += quick ? 5 : 2) {
    const double spring = std::pow(10.0, -k);
    // Pulled off, the body is as large a spring away as its load asks: a condition of 1e12 and more leaves of sixteen
    // digits about the four that are asked for in the energy norm.
    const std::string lost = "F's entries are " + words(1 / spring) +
                             " beside displacements of 1: round-off leaves few digits of these";
    add(cases, "soft support, pressed", spring, solved(), {onSoftLayer(spring, -1, elements)},
        k < 12 ? "" : lost);
    add(cases, "soft support, pulled off", spring, k <= 8 ? solved() : solvedOrStopped(),
        {onSoftLayer(spring, 1, elements)});
    add(cases, "elastic, soft support", spring, solved(), {leaningOnSoftLayer(spring, quick ? 3 : 6)},
        k < 10 ? "" : lost);
  }
  for (const double resultant : {1e-2, 1e-4, 1e-6, 1e-8})
    add(cases, "resultant of the load", resultant, solved(), {hardlyPressed(resultant, elements)});
  for (const double resultant : {1e-10, 0.0})
    add(cases, "resultant of the load", resultant, notUnique("does not press the floating body 'right'"),
        {hardlyPressed(resultant, elements)});
  for (const double resultant : {-1e-6, -1e-2})
    add(cases, "resultant of the load", resultant, noSolution("pulls the floating body 'right'"),
        {hardlyPressed(resultant, elements)});
  for (const double distance : {1e-1, 1e-4, 1e-6})
    add(cases, "load near the edge of the base", distance, solved(), {leaning(distance)});
  for (const double distance : {1e-12, 0.0})
    add(cases, "load near the edge of the base", distance, notUnique("turn about"), {leaning(distance)});
  for (const double distance : {-1e-4, -1e-1})
    add(cases, "load near the edge of the base", distance, noSolution("turn about"), {leaning(distance)});
  for (const double angle : {1e-1, 1e-2, 1e-3})
    add(cases, "contacts that hardly hinder a slide", angle, solved(), {betweenSlopes(angle)});
  // Below 1e-6 of a motion what hinders it counts as round-off of the normals.
  for (const double angle : {1e-7, 1e-9})
    add(cases, "contacts that hardly hinder a slide", angle, notUnique("slide"), {betweenSlopes(angle)});
  return cases;
}

} // namespace epafi::drivers
