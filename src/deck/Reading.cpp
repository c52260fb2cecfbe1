#include "epafi/deck/Reading.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <array>

namespace epafi::deck {
namespace {

constexpr std::array elementTypes{
    ElementType{"C3D4", 4, 4},    ElementType{"C3D6", 6, 5},   ElementType{"C3D8", 8, 6},
    ElementType{"C3D10", 10, 4},  ElementType{"C3D15", 15, 5}, ElementType{"C3D20", 20, 6},
    ElementType{"C3D20R", 20, 6}, ElementType{"CPE3", 3, 3},   ElementType{"CPE4", 4, 4},
    ElementType{"CPE6", 6, 3},    ElementType{"CPE8", 8, 4},   ElementType{"CPE8R", 8, 4},
    ElementType{"CPS3", 3, 3},    ElementType{"CPS4", 4, 4},   ElementType{"CPS6", 6, 3},
    ElementType{"CPS8", 8, 4},    ElementType{"CPS8R", 8, 4},  ElementType{"CAX3", 3, 3},
    ElementType{"CAX4", 4, 4},    ElementType{"CAX6", 6, 3},   ElementType{"CAX8", 8, 4},
    ElementType{"CAX8R", 8, 4}};

constexpr std::size_t mostNumbersInSets = std::size_t{1} << 27; // a GiB

template <class Things>
std::vector<std::string> keysOf(const Things& things) {
  std::vector<std::string> names;
  for (const auto& [name, thing] : things)
    names.push_back(name);
  return names;
}

/// "there is no set of nodes "FX"; did you mean "FIX"?"
std::string notThere(const std::string& kind, const std::string& name,
                     const std::vector<std::string>& names) {
  const std::string near = nearestName(name, names);
  return "there is no " + kind + ' ' + inQuotes(shortened(name)) +
         (near.empty() ? "; define it, or name one that the deck defines"
                       : "; did you mean " + inQuotes(near) + '?');
}

template <class Things>
void requireThing(const Reading::Reference& reference, const std::string& kind, const Things& things) {
  if (!things.contains(reference.name))
    reference.card->refuseAt(reference.place, notThere(kind, reference.name, keysOf(things)));
}

} // namespace

const ElementType* findElementType(const std::string& name) {
  const auto* const found = std::find_if(elementTypes.begin(), elementTypes.end(),
                                         [&](const ElementType& type) { return name == type.name; });
  return found == elementTypes.end() ? nullptr : found;
}

std::vector<std::string> elementTypeNames() {
  std::vector<std::string> names;
  for (const ElementType& type : elementTypes)
    names.emplace_back(type.name);
  return names;
}

void Reading::refer(const Card& card, const Place& place, Reference::To to, const std::string& name) {
  if (!name.empty())
    references.push_back({&card, place, to, name});
}

void Reading::checkReferences() const {
  for (const Reference& reference : references)
    switch (reference.to) {
    case Reference::To::material:
      requireThing(reference, "material", deck.materials);
      break;
    case Reference::To::orientation:
      requireThing(reference, "orientation", deck.orientations);
      break;
    case Reference::To::surface:
      requireThing(reference, "surface", deck.surfaces);
      break;
    case Reference::To::interaction:
      requireThing(reference, "surface interaction", deck.interactions);
      break;
    case Reference::To::amplitude:
      requireThing(reference, "amplitude", deck.amplitudes);
      break;
    }
}

bool Reading::hasNode(GlobalOrdinal number) const {
  return std::binary_search(deck.nodes.numbers.begin(), deck.nodes.numbers.end(), number);
}

const Elements* Reading::typeOf(GlobalOrdinal element) const {
  const auto found = std::lower_bound(elements.begin(), elements.end(), std::pair(element, 0));
  return found == elements.end() || found->first != element ? nullptr : &deck.elements[found->second];
}

GlobalOrdinal Reading::node(const Fields& fields, int field) const {
  const GlobalOrdinal number = fields.number(field, "a node");
  if (!hasNode(number))
    fields.refuse("there is no node " + std::to_string(number));
  return number;
}

std::vector<GlobalOrdinal> Reading::nodes(const Fields& fields, int field) {
  if (parsedWhole(fields[field]))
    return {node(fields, field)};
  const std::string name = fields.name(field, "a node or a set of nodes");
  const auto found = deck.nodeSets.find(name);
  if (found == deck.nodeSets.end())
    fields.refuse(notThere("set of nodes", name, keysOf(deck.nodeSets)));
  count(fields.card(), found->second.size());
  return found->second;
}

std::vector<GlobalOrdinal> Reading::elementsIn(const Fields& fields, int field) {
  if (parsedWhole(fields[field])) {
    const GlobalOrdinal number = fields.number(field, "an element");
    if (typeOf(number) == nullptr)
      fields.refuse("there is no element " + std::to_string(number));
    return {number};
  }
  const std::string name = fields.name(field, "an element or a set of elements");
  const auto found = deck.elementSets.find(name);
  if (found == deck.elementSets.end())
    fields.refuse(notThere("set of elements", name, keysOf(deck.elementSets)));
  count(fields.card(), found->second.size());
  return found->second;
}

std::string Reading::nodeSet(const Card& card, std::string_view parameter) const {
  std::string name = card.required(parameter);
  if (!deck.nodeSets.contains(name))
    card.refuse(notThere("set of nodes", name, keysOf(deck.nodeSets)));
  return name;
}

std::string Reading::elementSet(const Card& card, std::string_view parameter) const {
  std::string name = card.required(parameter);
  if (!deck.elementSets.contains(name))
    card.refuse(notThere("set of elements", name, keysOf(deck.elementSets)));
  return name;
}

void Reading::count(const Card& card, std::size_t numbers) {
  counted_ += numbers;
  if (counted_ > mostNumbersInSets)
    card.refuse("sets, and what is prescribed on them, hold more than " + std::to_string(mostNumbersInSets) +
                " numbers by here; name large sets less often");
}

void Reading::ignore(const std::string& keyword, const Place& place) {
  if (std::none_of(deck.ignored.begin(), deck.ignored.end(),
                   [&](const Ignored& ignored) { return ignored.keyword == keyword; }))
    deck.ignored.push_back({keyword, place});
}

void refuseTwice(const Card& card, const std::string& name, const Place& place) {
  card.refuse("\"" + shortened(name) + "\" is defined in " + text(place) +
              ", too; give them different names");
}

} // namespace epafi::deck
