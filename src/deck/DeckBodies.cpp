#include "epafi/deck/DeckBodies.hpp"

#include "epafi/base/Errors.hpp"

#include <algorithm>
#include <numeric>

namespace epafi::deck {
namespace {

using Numbers = std::vector<GlobalOrdinal>;

/// The representative of a number's class.
std::size_t rootOf(std::vector<std::size_t>& parents, std::size_t number) {
  while (parents[number] != number)
    number = parents[number] = parents[parents[number]];
  return number;
}

/// Of each element the lowest one that it is joined with by facets.
std::vector<std::size_t> joined(const Elements& elements, const ElementForm& type) {
  std::vector<std::size_t> parents(elements.numbers.size());
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  std::map<Numbers, std::size_t> firstAt; // by the facet's corners, ascending
  for (std::size_t e = 0; e < parents.size(); ++e)
    for (const std::vector<int>& face : type.faces) {
      Numbers corners;
      for (const int corner : face)
        corners.push_back(elements.nodes[e * elements.nodesPerElement + corner]);
      std::sort(corners.begin(), corners.end());
      const auto [place, isNew] = firstAt.try_emplace(std::move(corners), e);
      const std::size_t a = rootOf(parents, place->second), b = rootOf(parents, e);
      parents[std::max(a, b)] = std::min(a, b);
    }
  for (std::size_t e = 0; e < parents.size(); ++e)
    parents[e] = rootOf(parents, e);
  return parents;
}

} // namespace

DeckBodies::DeckBodies(const Deck& deck) {
  findSections(deck);
  for (const Elements& elements : deck.elements)
    addBodies(elements);
  if (bodies_.empty())
    throw InputError(deck.file + " has no elements with a *SOLID SECTION; there is nothing to solve");
  for (int b = 0; b < std::ssize(bodies_); ++b) {
    bodies_[b].name = "body " + std::to_string(b + 1);
    if (bodies_[b].type->physics != bodies_.front().type->physics)
      throw InputError(text(bodies_[b].place) + ": *ELEMENT: elements " + bodies_[b].type->name + " (" +
                       bodies_[b].type->physics + ") cannot go with " + bodies_.front().type->name + " (" +
                       bodies_.front().type->physics + ") in one deck; model all bodies alike");
    for (const GlobalOrdinal node : bodies_[b].nodes)
      bodiesOfNode_[node].push_back(b);
  }
}

/// Of elements in several sections the last one holds.
void DeckBodies::findSections(const Deck& deck) {
  for (int s = 0; s < std::ssize(deck.sections); ++s)
    for (const GlobalOrdinal element : deck.elementSets.at(deck.sections[s].elementSet))
      sectionOf_[element] = s;
}

void DeckBodies::addBodies(const Elements& elements) {
  const ElementForm& type = formOf(elements);
  const std::vector<std::size_t> first = joined(elements, type);
  std::map<std::size_t, std::size_t> bodyAt; // by its lowest element
  for (std::size_t e = 0; e < first.size(); ++e) {
    if (!sectionOf_.contains(elements.numbers[e]))
      throw InputError(text(elements.place) + ": *ELEMENT: element " + std::to_string(elements.numbers[e]) +
                       " is in no *SOLID SECTION, which would say what it is made of");
    const auto [place, isNew] = bodyAt.try_emplace(first[e], bodies_.size());
    if (isNew)
      bodies_.push_back({"", &type, elements.place, {}, {}});
    DeckBody& body = bodies_[place->second];
    body.elements.push_back(elements.numbers[e]);
    bodyOfElement_[elements.numbers[e]] = static_cast<int>(place->second);
    const std::size_t count = elements.nodesPerElement;
    const auto nodes = std::span(elements.nodes).subspan(e * count, count);
    nodesOf_[elements.numbers[e]] = nodes;
    body.nodes.insert(body.nodes.end(), nodes.begin(), nodes.end());
  }
  for (const auto& [lowest, place] : bodyAt) {
    Numbers& nodes = bodies_[place].nodes;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
}

std::vector<GlobalOrdinal> DeckBodies::cornersOf(const std::pair<GlobalOrdinal, int>& face) const {
  const auto nodes = nodesOf(face.first);
  const std::vector<std::vector<int>>& faces = bodies_[ofElement(face.first)].type->faces;
  std::vector<GlobalOrdinal> corners;
  for (const int corner : faces.at(face.second - 1))
    corners.push_back(nodes[corner]);
  return corners;
}

const std::vector<int>& DeckBodies::ofNode(GlobalOrdinal node) const {
  static const std::vector<int> none;
  const auto found = bodiesOfNode_.find(node);
  return found == bodiesOfNode_.end() ? none : found->second;
}

} // namespace epafi::deck
