/// Degenerate and ill-posed input: nothing to do, too little to hold a body, and numbers that are none.

#include "ContactRun.hpp"
#include "Scenes.hpp"

#include "epafi/scene/SceneReader.hpp"

#include <Teuchos_Array.hpp>
#include <Teuchos_ArrayRCP.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <limits>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

namespace epafi::drivers {
namespace {

using decomposition::DecomposedProblem;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

void add(StabilityCases& cases, const std::string& name, const std::string& parameter,
         const Expectation& expected, const ContactTask& task) {
  StabilityCase trial{"input", name, parameter, expected, {}};
  trial.run = [task](const RCP<const Comm>& comm) { return solveContact(task, comm); };
  cases.push_back(std::move(trial));
}

std::string words(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

scene::Scene withoutLoads(scene::Scene scene) {
  for (scene::Body& body : scene.bodies) {
    body.loads.clear();
    if (body.solid)
      body.solid->loads.clear();
  }
  return scene;
}

scene::Scene withoutContact(scene::Scene scene) {
  scene.contacts.clear();
  scene.surfaceContacts.clear();
  return scene;
}

void addLittleToDo(StabilityCases& cases) {
  add(cases, "zero load", "held", solved(), {withoutLoads(membranes(true, 2, 4))});
  add(cases, "zero load", "floating", notUnique("does not press"), {withoutLoads(membranes(false, 2, 4))});
  add(cases, "zero load", "elastic", solved(), {withoutLoads(pressedSquares(2, 3))});
  add(cases, "no contact pair", "held", solved(), {withoutContact(membranes(true, 2, 4))});
  add(cases, "no contact pair", "one subdomain each", solved(), {withoutContact(membranes(true, 1, 4))});
  add(cases, "no contact pair", "elastic", solved(), {withoutContact(pressedSquares(2, 3))});
  add(cases, "subdomains of one element", "membranes", solved(), {membranes(true, 4, 1)});
  add(cases, "subdomains of one element", "floating", solved(), {membranes(false, 4, 1)});
  add(cases, "subdomains of one element", "squares", solved(), {pressedSquares(3, 1)});
  add(cases, "subdomains of one element", "cubes", solved(), {pressedCubes(2, 1)});
  scene::Scene apart = membranes(true, 1, 4); // a third body that nothing touches: no multiplier
  apart.bodies.push_back(apart.bodies[0]);
  apart.bodies[2].name = "apart";
  apart.bodies[2].rectangle = {5, 6, 0, 1};
  apart.bodies[2].loads[0].box = {5, 6, 0, 1};
  add(cases, "a subdomain without multipliers", "a body apart", solved(), {apart});
  add(cases, "more subdomains than elements", "5 x 5 of 4 x 4", wrongInput("elements"), {[] {
        scene::Scene scene = membranes(true, 1, 4);
        return cut(scene, grid({5, 5, 1}));
      }()});
}

void addNotHeld(StabilityCases& cases) {
  scene::Scene scene = membranes(false, 2, 4);
  add(cases, "floating body without contact", "a load moves it", noSolution("'right'"),
      {withoutContact(scene)});
  add(cases, "floating body without contact", "without load", notUnique("'right'"),
      {withoutLoads(withoutContact(scene))});
  scene.bodies[1].loads[0].value = 1;
  add(cases, "floating body without balance", "pulled off", noSolution("pulls the floating body 'right'"),
      {scene});
  add(cases, "floating body held by contact only", "membrane", solved(), {membranes(false, 2, 4)});
  scene::Scene square = standingSquare(2, 3);
  add(cases, "floating body held by contact only", "square between wall and floor", solved(), {square});
  square.bodies[0].solid->supports.clear();
  add(cases, "floating body held by contact only", "square that may slide", notUnique("slide"), {square});
  square.bodies[0].solid->loads = {weight({0.1, -1, 0})};
  add(cases, "floating body without balance", "square that slides off", noSolution("slide"), {square});
}

/// Changes one number of what an application hands over, on the rank that has it.
void addNotFinite(StabilityCases& cases) {
  for (const double value : {nan, infinity}) {
    ContactTask task{membranes(true, 2, 4)};
    task.change = [value](DecomposedProblem& problem) {
      for (auto& subdomain : problem.subdomains)
        if (subdomain.number == 1)
          subdomain.load[0] = value;
    };
    add(cases, "NaN or infinity in a load", words(value), wrongInput("load of body"), task);
    task.change = [value](DecomposedProblem& problem) {
      if (problem.multiplierMap->isNodeGlobalElement(1))
        problem.gap->replaceGlobalValue(1, value);
    };
    add(cases, "NaN or infinity in a gap", words(value), wrongInput("gap of contact row 1"), task);
    task.change = [value](DecomposedProblem& problem) {
      for (auto& subdomain : problem.subdomains)
        if (subdomain.number == 1) {
          auto matrix = std::make_shared<decomposition::SparseMatrix>(*subdomain.stiffness);
          matrix->coeffRef(3, 3) = value;
          subdomain.stiffness = matrix;
        }
    };
    add(cases, "NaN or infinity in a stiffness", words(value), wrongInput("stiffness of body"), task);
    task.change = [value](DecomposedProblem& problem) {
      for (auto& subdomain : problem.subdomains)
        if (!subdomain.constraint.empty())
          subdomain.constraint[0].coefficient = value;
    };
    add(cases, "NaN or infinity in a constraint row", words(value),
        wrongInput("has a coefficient in subdomain"), task);
  }
}

/// Arrays as parameters hold them.
Teuchos::Array<double> numbers(const std::vector<double>& values) {
  return Teuchos::Array<double>(values);
}
Teuchos::Array<int> counts(const std::vector<int>& values) {
  return Teuchos::Array<int>(values);
}

/// The smallest scene as a parameter list.
Teuchos::ParameterList sceneList() {
  Teuchos::ParameterList list("Epafi");
  double x = 0;
  for (const char* const name : {"left", "right"}) {
    auto& body = list.sublist("Bodies").sublist(name);
    body.set("Rectangle", numbers({x, x + 1, 0.0, 1.0}));
    body.set("Elements", counts({4, 4}));
    body.sublist("Supports").sublist("wall").set("Edge", name);
    x += 1;
  }
  auto& pair = list.sublist("Contact").sublist("interface");
  pair.set("First Body", "left").set("First Edge", "right");
  pair.set("Second Body", "right").set("Second Edge", "left");
  return list;
}

void addRead(StabilityCases& cases, const std::string& name, const std::string& parameter,
             const Expectation& expected, const std::function<void(Teuchos::ParameterList&)>& change) {
  StabilityCase trial{"input", name, parameter, expected, {}};
  trial.run = [change](const RCP<const Comm>& comm) {
    Teuchos::ParameterList list = sceneList();
    change(list);
    return solveContact({scene::readScene(list, "scene.xml")}, comm);
  };
  cases.push_back(std::move(trial));
}

void addScenes(StabilityCases& cases) {
  using List = Teuchos::ParameterList;
  const auto left = [](List& list) -> List& { return list.sublist("Bodies").sublist("left"); };
  addRead(cases, "NaN or infinity in a scene", "conductivity", wrongInput("Conductivity"),
          [=](List& list) { left(list).set("Conductivity", nan); });
  addRead(cases, "NaN or infinity in a scene", "gap", wrongInput("Gap"),
          [=](List& list) { list.sublist("Contact").sublist("interface").set("Gap", infinity); });
  addRead(cases, "NaN or infinity in a scene", "corner", wrongInput("Rectangle"), [=](List& list) {
    left(list).set("Rectangle", numbers({0.0, nan, 0.0, 1.0}));
  });
  for (const double conductivity : {0.0, -1.0})
    addRead(cases, "material that resists nothing", "conductivity " + words(conductivity),
            wrongInput("Conductivity"), [=](List& list) { left(list).set("Conductivity", conductivity); });
  addRead(cases, "no elements", "0 x 4", wrongInput("Elements"), [=](List& list) {
    left(list).set("Elements", counts({0, 4}));
  });
  for (const double ratio : {0.5, -1.0, 0.7})
    addRead(cases, "Poisson's ratio out of range", words(ratio), wrongInput("Poisson's Ratio"),
            [=](List& list) {
              list = List("Epafi");
              auto& body = list.sublist("Bodies").sublist("block");
              body.set("Physics", "plane strain").set("Poisson's Ratio", ratio);
              body.set("Box", numbers({0.0, 1.0, 0.0, 1.0}));
              body.set("Elements", counts({2, 2}));
            });
}

} // namespace

StabilityCases inputCases(bool) {
  StabilityCases cases;
  addLittleToDo(cases);
  addNotHeld(cases);
  addNotFinite(cases);
  addScenes(cases);
  return cases;
}

} // namespace epafi::drivers
