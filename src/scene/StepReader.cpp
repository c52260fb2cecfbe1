#include "epafi/scene/StepReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <algorithm>
#include <string_view>

namespace epafi::scene {
namespace {

/// The entries "name = number" of a parameter, parted by commas.
std::vector<std::pair<std::string, double>> entriesOf(const ListReader& step, const std::string& parameter) {
  std::vector<std::pair<std::string, double>> entries;
  const std::string& text = step.word(parameter);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (entry.empty())
      continue;
    const std::size_t equals = entry.rfind('=');
    double value = 0;
    try {
      value = parsedReal(equals == std::string::npos ? "" : entry.substr(equals + 1));
    } catch (const InputError&) {
      step.refuseValue(parameter, "\"" + entry + "\" is not of the form name = number");
    }
    const std::string name = trimmed(entry.substr(0, equals));
    if (std::any_of(entries.begin(), entries.end(), [&](const auto& other) { return other.first == name; }))
      step.refuseValue(parameter, "\"" + name + "\" is named twice");
    entries.emplace_back(name, value);
  }
  return entries;
}

[[noreturn]] void refuseName(const ListReader& step, const std::string& parameter, const std::string& name,
                             const std::vector<std::string>& known) {
  const std::string near = nearestName(name, known);
  std::string all;
  for (const std::string& each : known)
    all += (all.empty() ? "\"" : ", \"") + each + '"';
  step.refuseValue(parameter, "there is no \"" + name + "\"; " +
                                  (!near.empty()   ? "did you mean \"" + near + "\"?"
                                   : known.empty() ? "the scene has none"
                                                   : "there are " + all));
}

/// Factors of what bodies have, named "body/what". \param of  the loads or supports of a body
template <class Of>
std::map<Step::Place, double> factorsOf(const ListReader& step, const std::string& parameter,
                                        const Scene& scene, const Of& of) {
  std::map<std::string, Step::Place> places;
  std::vector<std::string> names;
  for (int body = 0; body < std::ssize(scene.bodies); ++body)
    for (int k = 0; k < std::ssize(of(scene.bodies[body])); ++k) {
      names.push_back(scene.bodies[body].name + '/' + of(scene.bodies[body])[k].name);
      places[names.back()] = {body, k};
    }
  std::map<Step::Place, double> factors;
  for (const auto& [name, factor] : entriesOf(step, parameter)) {
    const auto place = places.find(name);
    if (place == places.end())
      refuseName(step, parameter, name, names);
    factors[place->second] = factor;
  }
  return factors;
}

/// Numbers of contacts, by their places in the scene.
std::map<int, double> ofContacts(const ListReader& step, const std::string& parameter, const Scene& scene) {
  std::vector<std::string> names;
  for (const SurfaceContact& contact : scene.contacts)
    names.push_back(contact.name);
  std::map<int, double> numbers;
  for (const auto& [name, number] : entriesOf(step, parameter)) {
    const auto place = std::find(names.begin(), names.end(), name);
    if (place == names.end())
      refuseName(step, parameter, name, names);
    numbers[static_cast<int>(place - names.begin())] = number;
  }
  return numbers;
}

std::map<int, double> gapsOf(const ListReader& step, const Scene& scene) {
  std::map<int, double> gaps = ofContacts(step, "Gaps", scene);
  for (const auto& [place, gap] : gaps)
    if (scene.contacts[place].kind == SurfaceContact::Kind::tied)
      step.refuseValue("Gaps", "\"" + scene.contacts[place].name +
                                   "\" is a tied joint, which keeps the gap that there is");
  return gaps;
}

/// Rows of friction are made once: contacts have it in all steps or in none.
std::map<int, double> frictionOf(const ListReader& step, const Scene& scene) {
  std::map<int, double> friction = ofContacts(step, "Friction", scene);
  for (const auto& [place, coefficient] : friction)
    if (scene.contacts[place].friction == 0 || !(coefficient > 0))
      step.refuseValue("Friction",
                       "\"" + scene.contacts[place].name +
                           "\" must have a coefficient greater than 0 both here and in its own list");
  return friction;
}

} // namespace

std::vector<Step> readSteps(const Teuchos::ParameterList& list, const std::string& where,
                            const Scene& scene) {
  std::vector<Step> steps;
  if (!list.isSublist("Steps"))
    return steps;
  Teuchos::ParameterList own("Epafi");
  own.sublist("Steps") = list.sublist("Steps");
  const Teuchos::ParameterList complete = validated(own, sceneSchema(), where);
  const ListReader all(complete.sublist("Steps"), where, "Steps");
  for (const std::string& name : all.names()) {
    const ListReader entry = all.inside(name);
    steps.push_back({name,
                     factorsOf(
                         entry, "Loads", scene, [](const Body& body) -> auto& { return body.loads; }),
                     factorsOf(
                         entry, "Supports", scene, [](const Body& body) -> auto& { return body.supports; }),
                     gapsOf(entry, scene), frictionOf(entry, scene)});
  }
  return steps;
}

Scene atStep(Scene scene, const std::vector<Step>& steps, std::size_t last) {
  std::map<Step::Place, double> loads, supports; // as they stand
  for (std::size_t k = 0; k <= last; ++k) {
    for (const auto& [place, factor] : steps[k].loads)
      loads[place] = factor;
    for (const auto& [place, factor] : steps[k].supports)
      supports[place] = factor;
    for (const auto& [contact, gap] : steps[k].gaps)
      scene.contacts[contact].gap = gap;
    for (const auto& [contact, coefficient] : steps[k].friction)
      scene.contacts[contact].friction = coefficient;
  }
  for (const auto& [place, factor] : loads)
    for (double& component : scene.bodies[place.first].loads[place.second].value)
      component *= factor;
  for (const auto& [place, factor] : supports) {
    fem::SolidSupport& support = scene.bodies[place.first].supports[place.second];
    for (std::optional<double>& component : support.value)
      if (component)
        *component *= factor;
    if (support.normal)
      *support.normal *= factor;
  }
  return scene;
}

} // namespace epafi::scene
