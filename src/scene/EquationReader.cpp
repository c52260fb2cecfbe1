#include "epafi/scene/EquationReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <sstream>

namespace epafi::scene {
namespace {

/// "2.5 beam/tip/X". Names of bodies may have blanks, and those of sets slashes.
Equation::Term termOf(const ListReader& entry, const std::string& text, const Scene& scene) {
  const auto refuse = [&](const std::string& why) { entry.refuseValue("Terms", '"' + text + "\" " + why); };
  Equation::Term term;
  const std::size_t first = text.find(' '), end = text.rfind('/');
  try {
    term.factor = parsedReal(text.substr(0, first));
  } catch (const InputError&) {
    term.factor = 0;
  }
  if (term.factor == 0 || first == std::string::npos || end == std::string::npos || end < first)
    refuse("is not of the form factor body/nodes/component");
  const std::string component = text.substr(end + 1), place = text.substr(first + 1, end - first - 1);
  term.component = component.size() == 1 ? static_cast<int>(std::string("XYZ").find(component)) : -1;
  const auto body = std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const Body& candidate) {
    return place.starts_with(candidate.name + '/');
  });
  if (body == scene.bodies.end())
    refuse("names no body of the scene; it should begin with one");
  const int components = componentsOf(body->physics);
  if (term.component < 0 || term.component >= components)
    refuse("must end in one of the components that bodies have, X" +
           std::string(components > 1 ? ", Y" : "") + (components > 2 ? " or Z" : ""));
  term.body = static_cast<int>(body - scene.bodies.begin());
  term.nodes = place.substr(body->name.size() + 1);
  return term;
}

} // namespace

void readEquations(const ListReader& list, Scene& scene) {
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    Equation equation{name, {}, entry.real("Value"), entry.real("Stiffness")};
    std::istringstream terms(entry.word("Terms"));
    for (std::string text; std::getline(terms, text, ',');)
      if (!trimmed(text).empty())
        equation.terms.push_back(termOf(entry, trimmed(text), scene));
    if (equation.terms.empty())
      entry.refuseList("has no terms; give at least one");
    scene.equations.push_back(std::move(equation));
  }
}

} // namespace epafi::scene
