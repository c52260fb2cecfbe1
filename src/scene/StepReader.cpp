#include "epafi/scene/StepReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/base/Parameters.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/scene/ContactReader.hpp"
#include "epafi/scene/ListReader.hpp"
#include "epafi/scene/SceneSchema.hpp"

#include <algorithm>
#include <ranges>
#include <string_view>

namespace epafi::scene {
namespace {

/// "name = value", of a parameter.
struct Entry {
  std::string name, value, text;
};

/// The entries of a parameter, parted by commas.
std::vector<Entry> entriesOf(const ListReader& step, const std::string& parameter) {
  std::vector<Entry> entries;
  const std::string& text = step.word(parameter);
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string entry = trimmed(text.substr(begin, end - begin));
    begin = end + 1;
    if (entry.empty())
      continue;
    const std::size_t equals = entry.rfind('=');
    const std::string name = trimmed(entry.substr(0, equals));
    if (name.empty())
      step.refuseValue(parameter, "\"" + entry + "\" is not of the form name = value");
    if (std::any_of(entries.begin(), entries.end(), [&](const Entry& other) { return other.name == name; }))
      step.refuseValue(parameter, "\"" + name + "\" is named twice");
    entries.push_back({name, equals == std::string::npos ? "" : trimmed(entry.substr(equals + 1)), entry});
  }
  return entries;
}

[[noreturn]] void refuseForm(const ListReader& step, const std::string& parameter, const Entry& entry,
                             const std::string& values) {
  step.refuseValue(parameter, "\"" + entry.text + "\" is not of the form name = " + values);
}

double numberIn(const ListReader& step, const std::string& parameter, const Entry& entry) {
  try {
    return parsedReal(entry.value);
  } catch (const InputError&) {
    refuseForm(step, parameter, entry, "number");
  }
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

/// action(entry, place) for the entries about what bodies have, named "body/what".
/// \param of  the loads or supports of a body
template <class Of, class Action>
void forEachPlace(const ListReader& step, const std::string& parameter, const Scene& scene, const Of& of,
                  const Action& action) {
  std::map<std::string, Step::Place> places;
  std::vector<std::string> names;
  for (int body = 0; body < std::ssize(scene.bodies); ++body)
    for (int k = 0; k < std::ssize(of(scene.bodies[body])); ++k) {
      names.push_back(scene.bodies[body].name + '/' + of(scene.bodies[body])[k].name);
      places[names.back()] = {body, k};
    }
  for (const Entry& entry : entriesOf(step, parameter)) {
    const auto place = places.find(entry.name);
    if (place == places.end())
      refuseName(step, parameter, entry.name, names);
    action(entry, place->second);
  }
}

/// action(entry, place in the scene) for the entries about contacts.
template <class Action>
void forEachContact(const ListReader& step, const std::string& parameter, const Scene& scene,
                    const Action& action) {
  std::vector<std::string> names;
  for (const SurfaceContact& contact : scene.contacts)
    names.push_back(contact.name);
  for (const Entry& entry : entriesOf(step, parameter)) {
    const auto place = std::find(names.begin(), names.end(), entry.name);
    if (place == names.end())
      refuseName(step, parameter, entry.name, names);
    action(entry, static_cast<int>(place - names.begin()));
  }
}

void readLoads(const ListReader& list, const Scene& scene, Step& step) {
  forEachPlace(
      list, "Loads", scene, [](const Body& body) -> auto& { return body.loads; },
      [&](const Entry& entry, const Step::Place& place) {
        step.loads[place] = numberIn(list, "Loads", entry);
      });
}

/// \param isFirst  whether no step is before this one
void readSupports(const ListReader& list, const Scene& scene, bool isFirst, Step& step) {
  forEachPlace(
      list, "Supports", scene, [](const Body& body) -> auto& { return body.supports; },
      [&](const Entry& entry, const Step::Place& place) {
        step.states[place] = entry.value == "off"     ? SupportState::off
                             : entry.value == "fixed" ? SupportState::fixed
                                                      : SupportState::on;
        if (entry.value == "fixed" && isFirst)
          list.refuseValue("Supports", "\"" + entry.name + "\" cannot be fixed where no step has moved it");
        if (step.states[place] == SupportState::on)
          step.supports[place] = numberIn(list, "Supports", entry);
      });
}

/// \param before  the scene at the step before
void readContactStates(const ListReader& list, const Scene& before, bool isFirst, Step& step) {
  forEachContact(list, "Contacts", before, [&](const Entry& entry, int place) {
    if (entry.value != "on" && entry.value != "off")
      refuseForm(list, "Contacts", entry, "on or name = off");
    const SurfaceContact& contact = before.contacts[place];
    step.isOn[place] = entry.value == "on";
    if (step.isOn[place] && !contact.isOn && !isFirst &&
        (contact.hasFriction() || contact.kind == SurfaceContact::Kind::tied))
      list.refuseValue("Contacts", "\"" + entry.name +
                                       "\" would draw back what has moved while it was off; contacts with "
                                       "friction and tied joints may go, but not come back");
  });
}

void readGaps(const ListReader& list, const Scene& scene, Step& step) {
  forEachContact(list, "Gaps", scene, [&](const Entry& entry, int place) {
    if (scene.contacts[place].kind == SurfaceContact::Kind::tied)
      list.refuseValue("Gaps", "\"" + entry.name + "\" is a tied joint, which keeps the gap that there is");
    step.gaps[place] = numberIn(list, "Gaps", entry);
  });
}

/// Rows of friction are made once: contacts have it in all steps or in none.
void readCoefficients(const ListReader& list, const Scene& scene, Step& step) {
  forEachContact(list, "Friction", scene, [&](const Entry& entry, int place) {
    step.friction[place] = numberIn(list, "Friction", entry);
    if (scene.contacts[place].friction == 0 || !(step.friction[place] > 0))
      list.refuseValue("Friction",
                       "\"" + entry.name +
                           "\" must have a coefficient greater than 0 both here and in its own list");
  });
}

void readPreloads(const ListReader& list, const Scene& scene, bool isFirst, Step& step) {
  forEachContact(list, "Preload", scene, [&](const Entry& entry, int place) {
    if (!scene.contacts[place].preload)
      list.refuseValue("Preload", "\"" + entry.name + "\" has no Preload in its own list");
    const std::optional<Preload> preload = preloadOf(entry.value);
    if (!preload)
      refuseForm(list, "Preload", entry, preloadForms);
    if (preload->kind == Preload::Kind::locked && isFirst)
      list.refuseValue("Preload", "\"" + entry.name + "\" cannot be locked where no step has tightened it");
    step.preloads[place] = *preload;
  });
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
  Scene before = scene;
  for (const std::string& name : all.names()) {
    const ListReader entry = all.inside(name);
    const bool isFirst = steps.empty();
    Step step;
    step.name = name;
    readLoads(entry, scene, step);
    readSupports(entry, scene, isFirst, step);
    readContactStates(entry, before, isFirst, step);
    readGaps(entry, scene, step);
    readCoefficients(entry, scene, step);
    readPreloads(entry, scene, isFirst, step);
    steps.push_back(std::move(step));
    before = atStep(scene, steps, steps.size() - 1);
  }
  return steps;
}

Scene atStep(Scene scene, const std::vector<Step>& steps, std::size_t last) {
  std::map<Step::Place, double> loads, supports; // as they stand
  std::map<Step::Place, SupportState> states;    // likewise
  for (std::size_t k = 0; k <= last; ++k) {
    for (const auto& [place, factor] : steps[k].loads)
      loads[place] = factor;
    for (const auto& [place, factor] : steps[k].supports)
      supports[place] = factor;
    for (const auto& [contact, gap] : steps[k].gaps)
      scene.contacts[contact].gap = gap;
    for (const auto& [contact, coefficient] : steps[k].friction)
      scene.contacts[contact].friction = coefficient;
    for (const auto& [contact, isOn] : steps[k].isOn)
      scene.contacts[contact].isOn = isOn;
    for (const auto& [contact, preload] : steps[k].preloads)
      scene.contacts[contact].preload = preload;
    for (const auto& [place, state] : steps[k].states)
      states[place] = state;
  }
  for (const auto& [place, factor] : loads) {
    fem::SolidLoad& load = scene.bodies[place.first].loads[place.second];
    for (Vector3* const vector : {&load.value, &load.moment})
      for (double& component : *vector)
        component *= factor;
  }
  for (const auto& [place, factor] : supports) {
    fem::SolidSupport& support = scene.bodies[place.first].supports[place.second];
    for (std::optional<double>& component : support.value)
      if (component)
        *component *= factor;
    if (support.normal)
      *support.normal *= factor;
  }
  for (const auto& [place, state] : states)
    if (state == SupportState::fixed)
      scene.bodies[place.first].supports[place.second].displacements.emplace();
  for (const auto& [place, state] : std::views::reverse(states)) // the last of a body first
    if (state == SupportState::off) {
      std::vector<fem::SolidSupport>& all = scene.bodies[place.first].supports;
      all.erase(all.begin() + place.second);
    }
  return scene;
}

} // namespace epafi::scene
