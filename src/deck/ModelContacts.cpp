#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/deck/ModelMaker.hpp"

#include <algorithm>
#include <set>

namespace epafi::deck {
namespace {

using FaceList = std::vector<std::pair<GlobalOrdinal, int>>;

/// FaceList of one element alone all of whose corners are among some nodes.
FaceList facesAt(const Deck& deck, const std::vector<GlobalOrdinal>& nodes) {
  std::map<std::vector<GlobalOrdinal>, FaceList> facesOf; // by corners, ascending
  for (const Elements& elements : deck.elements) {
    const ElementForm& type = formOf(elements);
    for (std::size_t e = 0; e < elements.numbers.size(); ++e)
      for (int f = 0; f < std::ssize(type.faces); ++f) {
        std::vector<GlobalOrdinal> corners;
        for (const int corner : type.faces[f])
          corners.push_back(elements.nodes[e * elements.nodesPerElement + corner]);
        std::sort(corners.begin(), corners.end());
        if (std::includes(nodes.begin(), nodes.end(), corners.begin(), corners.end()))
          facesOf[corners].emplace_back(elements.numbers[e], f + 1);
      }
  }
  FaceList faces;
  for (const auto& [corners, at] : facesOf)
    if (at.size() == 1)
      faces.push_back(at.front());
  std::sort(faces.begin(), faces.end());
  return faces;
}

} // namespace

/// Bodies that have faces of a surface, and what the surface is called in their meshes.
std::map<int, std::string> ModelMaker::surfacesOf(const std::string& surface, const Place& place) {
  const Surface& given = deck_.surfaces.at(surface);
  const FaceList faces = given.ofNodes ? facesAt(deck_, given.nodes) : given.faces;
  if (faces.empty())
    throw InputError(text(place) + ": the nodes of the surface " + surface +
                     " make no face of an element; define it by the elements' faces");
  std::map<int, std::string> names;
  for (const auto& [element, label] : faces)
    names.try_emplace(bodies_.ofElement(element), surface);
  model_.groups.surfaces[surface] = faces;
  return names;
}

/// Whether a set has all nodes of a surface's faces.
bool ModelMaker::hasNodesOf(const std::string& set, const std::string& surface) const {
  const Numbers& nodes = deck_.nodeSets.at(set);
  const auto has = [&](GlobalOrdinal node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  const Surface& given = deck_.surfaces.at(surface);
  for (const Elements& elements : deck_.elements)
    for (const auto& [element, label] : given.faces) {
      const auto at = std::lower_bound(elements.numbers.begin(), elements.numbers.end(), element);
      if (at == elements.numbers.end() || *at != element)
        continue;
      for (const int corner : formOf(elements).faces.at(label - 1))
        if (!has(elements.nodes[(at - elements.numbers.begin()) * elements.nodesPerElement + corner]))
          return false;
    }
  return std::all_of(given.nodes.begin(), given.nodes.end(), has);
}

void ModelMaker::addContacts() {
  Teuchos::ParameterList& contacts = model_.scene.sublist("Contact");
  const auto add = [&](const std::string& name, const std::string& dependent, const std::string& independent,
                       const Place& place, const auto& fill) {
    const auto first = surfacesOf(dependent, place), second = surfacesOf(independent, place);
    int number = 0;
    for (const auto& [body, surface] : first)
      for (const auto& [other, facing] : second) {
        if (body == other)
          throw InputError(text(place) + ": " + name +
                           ": both surfaces are of one body, which cannot touch "
                           "itself here");
        const std::string own = number++ == 0 ? name : name + ' ' + std::to_string(number);
        Teuchos::ParameterList& pair = contacts.sublist(own);
        pair.set("First Body", bodies_.all()[body].name);
        pair.set("First Surface", surface);
        pair.set("Second Body", bodies_.all()[other].name);
        pair.set("Second Surface", facing);
        fill(pair, own);
      }
  };
  for (const ContactPair& pair : deck_.contacts) {
    const Interaction& interaction = deck_.interactions.at(pair.interaction);
    const bool isWhole = !pair.adjustSet.empty() && hasNodesOf(pair.adjustSet, pair.dependent);
    if (!pair.adjustSet.empty() && !isWhole)
      throw InputError(text(pair.place) +
                       ": *CONTACT PAIR: ADJUST with a part of the nodes is not solved here; give the "
                       "gap up to which nodes are to be adjusted");
    add(pair.dependent + " - " + pair.independent, pair.dependent, pair.independent, pair.place,
        [&](Teuchos::ParameterList& list, const std::string& name) {
          contactsOf_[pair.interaction].push_back(name);
          if (interaction.law == Interaction::Law::tied)
            list.set("Kind", "tied");
          else if (interaction.friction > 0)
            list.set("Friction", interaction.friction);
          constexpr double whatever = 1e30;
          if ((pair.adjust || isWhole) && interaction.law != Interaction::Law::tied)
            list.set("Adjust", pair.adjust.value_or(whatever));
          if (interaction.law == Interaction::Law::linear)
            list.set("Stiffness", interaction.stiffness);
          if (interaction.friction > 0 && interaction.stickSlope.value_or(0) > 0)
            list.set("Stick Slope", *interaction.stickSlope);
        });
  }
  changeFriction();
  for (const Tie& tie : deck_.ties)
    add(tie.name, tie.dependent, tie.independent, tie.place,
        [&](Teuchos::ParameterList& list, const std::string& /*name*/) {
          list.set("Kind", "tied");
          if (tie.tolerance)
            list.set("Distance", *tie.tolerance);
        });
}

void ModelMaker::changeFriction() {
  for (std::size_t k = 0; k < deck_.steps.size(); ++k) {
    std::string coefficients;
    for (const FrictionChange& change : deck_.steps[k].frictions) {
      const Interaction& interaction = deck_.interactions.at(change.interaction);
      if (change.stickSlope.value_or(0) != interaction.stickSlope.value_or(0) || interaction.friction == 0 ||
          change.friction == 0)
        throw InputError(text(change.place) +
                         ": *CHANGE FRICTION: a coefficient greater than 0 may change to another, "
                         "but the stick slope stays as it is");
      for (const std::string& contact : contactsOf_[change.interaction]) {
        coefficients += contact + " = " + valueText(change.friction) + ", ";
        if (deck_.steps.size() == 1)
          model_.scene.sublist("Contact").sublist(contact).set("Friction", change.friction);
      }
    }
    if (!coefficients.empty() && deck_.steps.size() > 1)
      model_.scene.sublist("Steps").sublist("step " + std::to_string(k + 1)).set("Friction", coefficients);
  }
}

} // namespace epafi::deck
