/// Where programs of this kind have failed their users, each by its own name: contact problems. (Quadratic programs taken
/// alone: ProgramCases.cpp.)

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include "epafi/ContactSolver.hpp"

#include <Teuchos_Comm.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

using Run = std::function<CaseResult(const RCP<const Comm>&)>;

StabilityCase make(const std::string& name, const std::string& parameter, const Expectation& expected,
                   Run run) {
  return {"known failures", name, parameter, expected, std::move(run)};
}

Run solving(const scene::Scene& scene) {
  return [scene](const RCP<const Comm>& comm) { return solveContact({scene}, comm); };
}

/// `wrong` makes a solved case a wrong answer.
CaseResult judged(CaseResult result, const std::string& wrong) {
  if (result.outcome == Outcome::solved && !wrong.empty()) {
    result.outcome = Outcome::wrongAnswer;
    result.reason = wrong;
  }
  return result;
}

/// The solution is the start of a second solve, which may divide nothing by the gradient that is left.
CaseResult fromTheSolution(const scene::Scene& scene, const RCP<const Comm>& comm) {
  CaseResult result = solveContact({scene}, comm);
  const auto decomposition = decomposition::decompose(scene, comm);
  ContactSolver solver((Teuchos::ParameterList()));
  solver.setup(decomposition.problem);
  fetidp::ContactSolution solution = solver.solve();
  for (int again = 0; again < 3; ++again) {
    const RCP<Vector> start = solution.multiplier;
    solution = solver.solve(start.get());
    if (solver.report().status != qp::Status::converged)
      return judged(result, "started from the solution it ends with " + solver.report().reason);
  }
  result.products = solver.report().counts.hessianMultiplications;
  std::ostringstream wrong;
  if (!(std::abs(solution.energy - result.energy) <= 1e-6 * std::abs(result.energy)))
    wrong << "the energy changes from " << result.energy << " to " << solution.energy;
  return judged(result, wrong.str());
}

/// The closed nodes of membranes whose deflections are `unit` times as large.
CaseResult closedNodesIn(double unit, const RCP<const Comm>& comm) {
  scene::Scene one = membranes(true, 2, 8), other = one;
  one.contacts[0].gap = 0.05;
  other.contacts[0].gap = 0.05 * unit;
  for (scene::Body& body : other.bodies)
    for (scene::Load& load : body.loads)
      load.value *= unit;
  const CaseResult expected = solveContact({one}, comm), found = solveContact({other}, comm);
  std::ostringstream wrong;
  if (found.active != expected.active)
    wrong << found.active << " closed nodes, not " << expected.active;
  return judged(found, wrong.str());
}

/// On every rank alone, and on all together.
CaseResult onOneAndAll(const scene::Scene& scene, const RCP<const Comm>& comm) {
  const CaseResult all = solveContact({scene}, comm);
  const CaseResult one = solveContact({scene}, comm->split(comm->getRank(), 0));
  std::ostringstream wrong;
  if (!(std::abs(all.energy - one.energy) <= 1e-9 * std::abs(one.energy)) ||
      !(std::abs(all.force - one.force) <= 1e-6 * std::abs(one.force)) || all.active != one.active)
    wrong << "energy, force and closed nodes are " << all.energy << ", " << all.force << ", " << all.active
          << " on " << comm->getSize() << " ranks and " << one.energy << ", " << one.force << ", "
          << one.active << " on one";
  return judged(all, wrong.str());
}

/// A square that slides along its left and its lower side is held. The same where its corner is moved by a little: the
/// kernel follows from the supports that there are, not from a threshold on pivots.
scene::Scene heldByShift(double shift) {
  scene::Scene scene = standingSquare(2, 3);
  scene.bodies[0].solid->mesh.box.upper[0] = 1 + shift;
  scene.bodies[0].solid->mesh.box.lower[1] = shift;
  scene.surfaceContacts[0].obstacle.point[1] = -shift;
  return scene;
}

/// A membrane whose contact line ends at supports of its lower and upper edge.
scene::Scene supportedEnds() {
  scene::Scene scene = membranes(true, 2, 4);
  scene.bodies[0].supports.push_back({"lower", scene::Edge::bottom, 0.0});
  scene.bodies[1].supports.push_back({"upper", scene::Edge::top, 0.0});
  return scene;
}

scene::Scene inCorner() {
  scene::Scene scene;
  scene.bodies = {block("square", {{0, 0, 0}, {1, 1, 0}}, {4, 4, 0}, grid({2, 2, 1}))};
  scene.bodies[0].solid->loads = {weight({-0.5, -1, 0})};
  scene.surfaceContacts = {onPlane("floor", 0, "bottom", {0, 0, 0}, {0, 1, 0}),
                           onPlane("wall", 0, "left", {0, 0, 0}, {1, 0, 0})};
  return scene;
}

} // namespace

StabilityCases knownFailureCases(bool quick) {
  StabilityCases cases;
  const int n = quick ? 4 : 8;
  const auto add = [&](const std::string& name, const std::string& parameter, Run run) {
    cases.push_back(make(name, parameter, solved(), std::move(run)));
  };
  add("touching with zero force (singular solve)", "membranes", solving(strips(true, 2, 2, n)));
  scene::Scene cubes = pressedCubes(2, 2);
  cubes.bodies[1].solid->loads.clear();
  add("touching with zero force (singular solve)", "cubes", solving(cubes));
  for (const bool coercive : {true, false})
    add("division by zero at the exact optimum", coercive ? "held" : "floating",
        [=](const RCP<const Comm>& comm) { return fromTheSolution(membranes(coercive, 2, n), comm); });
  for (const double unit : {1e-12, 1e-6, 1e6, 1e12}) {
    std::ostringstream words;
    words << "deflections times " << unit;
    add("absolute tolerance on the active set", words.str(),
        [=](const RCP<const Comm>& comm) { return closedNodesIn(unit, comm); });
  }
  add("the answer differs between 1 and more processes", "grid",
      [=](const RCP<const Comm>& comm) { return onOneAndAll(membranes(false, 2, n), comm); });
  add("the answer differs between 1 and more processes", "METIS, elastic",
      [=](const RCP<const Comm>& comm) { return onOneAndAll(cut(pressedSquares(1, n), metis(3)), comm); });
  for (const double shift : {1e-15, 1e-12, 1e-9, 1e-6}) {
    std::ostringstream words;
    words << "corner moved by " << shift;
    add("the kernel's dimension jumps with the geometry", words.str(), solving(heldByShift(shift)));
  }
  for (const int parts : {3, 5, 9})
    add("primal unknowns leave a subdomain a rigid motion",
        "plane, " + std::to_string(parts) + " ragged parts",
        solving(cut(standingSquare(1, 8), metis(parts))));
  add("primal unknowns leave a subdomain a rigid motion", "space, slabs",
      solving(cut(pressedCubes(1, 4), grid({4, 1, 1}))));
  add("primal unknowns leave a subdomain a rigid motion", "space, 5 ragged parts",
      solving(cut(pressedCubes(1, 4), metis(5))));
  add("multipliers on nodes that carry supports", "ends of the contact line", solving(supportedEnds()));
  add("two contacts that share a node", "corner of floor and wall", solving(inCorner()));
  return cases;
}

} // namespace epafi::drivers
