/// Contact at its limits: touching without force, all closed, none, grazing, overlapping at the start, said twice, and
/// impossible.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

constexpr long long anyNumber = -1;

/// \param active  closed nodes that a right answer has
void add(StabilityCases& cases, const std::string& name, const std::string& parameter, double value,
         const Expectation& expected, const ContactTask& task, long long active = anyNumber) {
  StabilityCase trial{"contact", name, parameter, expected, {}};
  trial.run = [task, active](const RCP<const Comm>& comm) {
    CaseResult result = solveContact(task, comm);
    if (result.outcome == Outcome::solved && active != anyNumber && result.active != active) {
      result.outcome = Outcome::wrongAnswer;
      result.reason = "closed nodes: " + std::to_string(result.active) + ", not " + std::to_string(active);
    }
    return result;
  };
  trial.value = value;
  cases.push_back(std::move(trial));
}

std::string words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%+.0e", value);
  return value == 0 ? "0" : text;
}

scene::Scene withGap(scene::Scene scene, double gap) {
  for (scene::ContactPair& pair : scene.contacts)
    pair.gap = gap;
  for (scene::SurfaceContact& contact : scene.surfaceContacts)
    contact.gap = gap;
  return scene;
}

/// A column of two layers between sliding walls, pushed down by 1/8 onto a plane that lies `gap` below it.
scene::Scene column(double gap) {
  scene::Scene scene;
  scene.bodies = {block("column", {{0, 0, 0}, {1, 2, 0}}, {4, 8, 0}, grid({2, 2, 1}))};
  scene::Solid& solid = *scene.bodies[0].solid;
  solid.supports = {slide("left"), slide("right"), slide("top", -0.125)};
  scene::SolidRegion layer;
  layer.name = "upper";
  layer.box.lower[1] = 1;
  layer.material = solid.material;
  layer.material.youngsModulus *= 100;
  solid.regions = {layer};
  scene.surfaceContacts = {onPlane("floor", 0, "bottom", {0, -gap, 0}, {0, 1, 0})};
  return scene;
}

/// The pressed squares stand on a second plane that meets them at a lower point, or at the same one turned by an angle.
scene::Scene inCorner() {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, grid({2, 2, 1}))};
  scene.bodies[0].solid->loads = {weight({-0.5, -1, 0})};
  scene.surfaceContacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}),
                           onPlane("wall", 0, "left", {0, 0, 0}, {1, 0, 0})};
  return scene;
}

/// Two membranes, each of which is to lie above the other one by 1.
scene::Scene eachAbove() {
  scene::Scene scene = pressedSquares(2, 2);
  for (scene::Body& body : scene.bodies) {
    body.solid->physics = scene::Physics::membrane;
    body.solid->supports[0].value = {0.0, std::nullopt, std::nullopt};
    body.solid->loads.clear();
  }
  scene.surfaceContacts[0].gap = -1;
  scene.surfaceContacts.push_back(between("back", 0, "top", 1, "bottom", -1));
  return scene;
}

/// Two rows of B for the same nodes that ask for opposite things, by an application.
void contradict(decomposition::DecomposedProblem& problem) {
  for (auto& subdomain : problem.subdomains) {
    auto& rows = subdomain.constraint;
    const int first = problem.multiplierGhostMap->getLocalElement(0),
              second = problem.multiplierGhostMap->getLocalElement(1);
    if (first < 0 || second < 0)
      continue;
    std::erase_if(rows,
                  [&](const decomposition::ConstraintEntry& entry) { return entry.multiplier == second; });
    const auto copy = rows;
    for (const decomposition::ConstraintEntry& entry : copy)
      if (entry.multiplier == first)
        rows.push_back({second, entry.unknown, -entry.coefficient});
  }
  if (problem.multiplierMap->isNodeGlobalElement(1))
    problem.gap->replaceGlobalValue(1, -1.0);
}

void addTouching(StabilityCases& cases, bool quick) {
  const int n = quick ? 4 : 16;
  add(cases, "zero force, zero gap on a line", "held", 0, solved(), {strips(true, 2, 2, n)});
  add(cases, "zero force, zero gap on a line", "floating", 0, notUnique("does not press"),
      {strips(false, 2, 0, n)});
  scene::Scene cubes = pressedCubes(2, 2);
  cubes.bodies[1].solid->loads.clear();
  add(cases, "zero force, zero gap on a face", "cubes without load", 0, solved(), {cubes});
  add(cases, "all nodes closed", "membranes", unknown, solved(), {strips(true, 100, -100, n)}, n + 1);
  scene::Scene floating = strips(false, 5, -2, n);
  add(cases, "all nodes closed", "floating", unknown, solved(), {floating}, n + 1);
  add(cases, "no node closed", "membranes", unknown, solved(), {strips(true, -1, 1, n)}, 0);
  add(cases, "no node closed", "squares, wide gap", unknown, solved(), {withGap(pressedSquares(2, 3), 1)}, 0);
  // Free, the bodies come as near as 1 at x = 1: all nodes touch at once.
  for (const double by : {-1e-6, -1e-9, -1e-12, 0.0, 1e-12, 1e-9, 1e-6})
    add(cases, "grazing: gap wider than the way by", words(by), by, solved(),
        {withGap(strips(true, 1, -1, n), 1 + by)});
  // 1/8 ± 1e-9 as a number of sixteen digits is known to 1e-8 of the difference: the tolerance asks for as much.
  for (const double by : {-1e-6, -1e-9, 0.0, 1e-9})
    add(cases, "grazing column: gap wider than the way by", words(by), by,
        by == -1e-9 ? solvedOrStopped() : solved(), {column(0.125 + by)});
}

void addPenetration(StabilityCases& cases) {
  for (const double depth : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    add(cases, "initial penetration", words(depth), depth, solved(),
        {withGap(membranes(true, 2, 4), -depth)});
    add(cases, "initial penetration, floating", words(depth), depth, solved(),
        {withGap(membranes(false, 2, 4), -depth)});
  }
  for (const double depth : {1e-6, 1e-3, 1e-1})
    add(cases, "initial penetration, elastic", words(depth), depth, solved(),
        {withGap(pressedSquares(2, 3), -depth)});
}

void addRows(StabilityCases& cases) {
  scene::Scene scene = inCorner();
  scene.surfaceContacts.push_back(scene.surfaceContacts[0]);
  scene.surfaceContacts.back().name = "again";
  add(cases, "the same contact twice", "all rows", unknown, wrongInput("'again'"), {scene});
  // Rows that say the same but for round-off, or with another gap, stay: F is semidefinite.
  for (const double lower : {1e-3, 1e-9}) {
    scene.surfaceContacts.back().obstacle.point = {0, -lower, 0};
    add(cases, "redundant rows: a second floor lower by", words(lower), lower, solved(), {scene});
  }
  for (const double angle : {1e-2, 1e-5, 1e-8, 1e-12}) {
    scene.surfaceContacts.back().obstacle.point = {0, 0, 0};
    scene.surfaceContacts.back().obstacle.normal = {std::sin(angle), std::cos(angle), 0};
    // A plane turned by round-off may count as the same contact, which is refused by its name.
    add(cases, "redundant rows: a second floor turned by", words(angle), angle,
        angle > 1e-10 ? solved() : Expectation{{Outcome::solved, Outcome::wrongInput}}, {scene});
  }
  scene = inCorner();
  scene.surfaceContacts.push_back(onPlane("edge", 0, "left", {0, 0, 0}, {std::sqrt(0.5), std::sqrt(0.5), 0}));
  add(cases, "redundant rows: three at a corner", "floor, wall, edge", unknown, solved(), {scene});
  scene = inCorner();
  scene.surfaceContacts.push_back(onPlane("ceiling", 0, "bottom", {0, -0.125, 0}, {0, -1, 0}));
  add(cases, "contradictory contacts", "a ceiling that the floor's nodes face from behind", unknown,
      wrongInput("faces away"), {scene});
  add(cases, "contradictory contacts", "each membrane above the other by 1", unknown, noSolution("'"),
      {eachAbove()});
  ContactTask byHand{membranes(true, 2, 4)};
  byHand.change = contradict;
  add(cases, "contradictory rows", "by an application", unknown, noSolution("contradict"), byHand);
  byHand.scene = membranes(false, 2, 4);
  add(cases, "contradictory rows", "by an application, floating", unknown, noSolution("contradict"), byHand);
  cases.back().remains = "SMALBE ends at its limit of products: its directions never are those of zero "
                         "curvature that would prove it";
  scene = inCorner();
  scene.surfaceContacts.push_back(onPlane("press", 0, "top", {0, 0.875, 0}, {0, -1, 0}));
  add(cases, "less room than the body is thick", "squeezed by 1/8", unknown, solved(), {scene});
  scene::Scene held = column(0.0625);
  held.bodies[0].solid->supports = {slide("left"), slide("right"), slide("bottom", 0.125)};
  add(cases, "supports push through the floor", "by 1/16", unknown, noSolution("overlap by 0.0625"), {held});
}

} // namespace

StabilityCases contactCases(bool quick) {
  StabilityCases cases;
  addTouching(cases, quick);
  addPenetration(cases);
  addRows(cases);
  return cases;
}

} // namespace epafi::drivers
