#include "epafi/base/Errors.hpp"
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
        Teuchos::ParameterList& pair =
            contacts.sublist(number++ == 0 ? name : name + ' ' + std::to_string(number));
        pair.set("First Body", bodies_.all()[body].name);
        pair.set("First Surface", surface);
        pair.set("Second Body", bodies_.all()[other].name);
        pair.set("Second Surface", facing);
        fill(pair);
      }
  };
  for (const ContactPair& pair : deck_.contacts) {
    const Interaction& interaction = deck_.interactions.at(pair.interaction);
    if (!pair.adjustSet.empty())
      throw InputError(text(pair.place) +
                       ": *CONTACT PAIR: ADJUST with a set of nodes is not solved here; give the "
                       "gap up to which nodes are to be adjusted");
    add(pair.dependent + " - " + pair.independent, pair.dependent, pair.independent, pair.place,
        [&](Teuchos::ParameterList& list) {
          if (interaction.law == Interaction::Law::tied)
            list.set("Kind", "tied");
          else if (interaction.friction > 0)
            list.set("Friction", interaction.friction);
          if (pair.adjust && interaction.law != Interaction::Law::tied)
            list.set("Adjust", *pair.adjust);
          if (interaction.law == Interaction::Law::linear)
            list.set("Stiffness", interaction.stiffness);
          if (interaction.friction > 0 && interaction.stickSlope.value_or(0) > 0)
            list.set("Stick Slope", *interaction.stickSlope);
        });
  }
  for (const Tie& tie : deck_.ties)
    add(tie.name, tie.dependent, tie.independent, tie.place, [&](Teuchos::ParameterList& list) {
      list.set("Kind", "tied");
      if (tie.tolerance)
        list.set("Distance", *tie.tolerance);
    });
}

} // namespace epafi::deck
