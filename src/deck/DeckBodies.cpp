#include "epafi/deck/DeckBodies.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/SortUnique.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace epafi::deck {
namespace {

using Numbers = std::vector<GlobalOrdinal>;

/// The representative of a number's class.
std::size_t rootOf(std::vector<std::size_t>& parents, std::size_t number) {
  while (parents[number] != number)
    number = parents[number] = parents[parents[number]];
  return number;
}

/// An element and where it stands.
struct Member {
  GlobalOrdinal number;
  const Elements* among;
  const ElementForm* type;
  std::span<const GlobalOrdinal> nodes;
};

/// By their numbers.
std::vector<Member> membersOf(const std::vector<const Elements*>& alike) {
  std::vector<Member> members;
  for (const Elements* elements : alike) {
    const std::size_t count = elements->nodesPerElement;
    for (std::size_t e = 0; e < elements->numbers.size(); ++e)
      members.push_back({elements->numbers[e], elements, &formOf(*elements),
                         std::span(elements->nodes).subspan(e * count, count)});
  }
  std::sort(members.begin(), members.end(),
            [](const Member& a, const Member& b) { return a.number < b.number; });
  return members;
}

/// action(place of an element, its face from 1 on, the face's corners, ascending) for all faces.
template <class Action>
void forEachFace(const std::vector<Member>& members, const Action& action) {
  for (std::size_t e = 0; e < members.size(); ++e)
    for (int label = 1; label <= std::ssize(members[e].type->faces); ++label) {
      Numbers corners;
      for (const int corner : members[e].type->faces[label - 1])
        corners.push_back(members[e].nodes[corner]);
      std::sort(corners.begin(), corners.end());
      action(e, label, std::move(corners));
    }
}

/// Corners of the faces at which bolts are cut.
std::set<Numbers> cutsOf(const Deck& deck, const std::vector<Member>& members) {
  std::set<std::pair<GlobalOrdinal, int>> sections;
  for (const Pretension& pretension : deck.pretensions)
    if (!pretension.element) {
      const auto& faces = deck.surfaces.at(pretension.surface).faces;
      sections.insert(faces.begin(), faces.end());
    }
  std::set<Numbers> cuts;
  if (!sections.empty())
    forEachFace(members, [&](std::size_t e, int label, Numbers corners) {
      if (sections.contains({members[e].number, label}))
        cuts.insert(std::move(corners));
    });
  return cuts;
}

/// Of each element the lowest one that it is joined with by facets. \param cuts  those that join none
std::vector<std::size_t> joined(const std::vector<Member>& members, const std::set<Numbers>& cuts) {
  std::vector<std::size_t> parents(members.size());
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  std::map<Numbers, std::size_t> firstAt; // by the facet's corners
  forEachFace(members, [&](std::size_t e, int, Numbers corners) {
    if (cuts.contains(corners))
      return;
    const auto [place, isNew] = firstAt.try_emplace(std::move(corners), e);
    const std::size_t a = rootOf(parents, place->second), b = rootOf(parents, e);
    parents[std::max(a, b)] = std::min(a, b);
  });
  for (std::size_t e = 0; e < parents.size(); ++e)
    parents[e] = rootOf(parents, e);
  return parents;
}

/// Whether elements of two types may be in one body, all of which is reduced or nothing.
bool areAlike(const ElementForm& a, const ElementForm& b) {
  const int edgesOfOrder2 = 8; // Gmsh's kinds from there on
  return a.physics == b.physics && (a.kind < edgesOfOrder2) == (b.kind < edgesOfOrder2) &&
         (!a.mayBeReduced() || !b.mayBeReduced() || a.isReduced == b.isReduced);
}

/// The elements of a deck, those that may be in one body together; of types that exclude each other each
/// stands alone.
std::vector<std::vector<const Elements*>> classesOf(const Deck& deck) {
  std::vector<std::vector<const Elements*>> classes;
  for (const Elements& elements : deck.elements) {
    const auto isIn = [&](const std::vector<const Elements*>& known) {
      return std::all_of(known.begin(), known.end(),
                         [&](const Elements* other) { return areAlike(formOf(elements), formOf(*other)); });
    };
    const auto found = std::find_if(classes.begin(), classes.end(), isIn);
    if (found == classes.end())
      classes.push_back({&elements});
    else
      found->push_back(&elements);
  }
  return classes;
}

} // namespace

DeckBodies::DeckBodies(const Deck& deck) {
  findSections(deck);
  for (const std::vector<const Elements*>& alike : classesOf(deck))
    addBodies(deck, alike);
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

void DeckBodies::addBodies(const Deck& deck, const std::vector<const Elements*>& alike) {
  const std::vector<Member> members = membersOf(alike);
  const std::vector<std::size_t> first = joined(members, cutsOf(deck, members));
  std::map<std::size_t, std::size_t> bodyAt; // by its lowest element
  for (std::size_t e = 0; e < first.size(); ++e) {
    const auto& [number, among, type, nodes] = members[e];
    if (!sectionOf_.contains(number))
      throw InputError(text(among->place) + ": *ELEMENT: element " + std::to_string(number) +
                       " is in no *SOLID SECTION, which would say what it is made of");
    const auto [place, isNew] = bodyAt.try_emplace(first[e], bodies_.size());
    if (isNew)
      bodies_.push_back({"", type, among->place, {}, {}});
    DeckBody& body = bodies_[place->second];
    if (type->isReduced && !body.type->isReduced)
      std::tie(body.type, body.place) = std::pair(type, among->place);
    body.elements.push_back(number);
    bodyOfElement_[number] = static_cast<int>(place->second);
    typeOf_[number] = type;
    nodesOf_[number] = nodes;
    body.nodes.insert(body.nodes.end(), nodes.begin(), nodes.end());
  }
  for (const auto& [lowest, place] : bodyAt) {
    Numbers& nodes = bodies_[place].nodes;
    sortUnique(nodes);
  }
}

std::vector<GlobalOrdinal> DeckBodies::cornersOf(const std::pair<GlobalOrdinal, int>& face) const {
  const auto nodes = nodesOf(face.first);
  const std::vector<std::vector<int>>& faces = typeOf(face.first).faces;
  std::vector<GlobalOrdinal> corners;
  for (const int corner : faces.at(face.second - 1))
    corners.push_back(nodes[corner]);
  return corners;
}

std::vector<GlobalOrdinal> DeckBodies::nodesOfFace(const std::pair<GlobalOrdinal, int>& face) const {
  const auto nodes = nodesOf(face.first);
  const std::vector<int>& corners = typeOf(face.first).faces.at(face.second - 1);
  const auto isCorner = [&](int place) {
    return std::find(corners.begin(), corners.end(), place) != corners.end();
  };
  std::vector<GlobalOrdinal> result = cornersOf(face);
  const auto edges = edgesOf(typeOf(face.first));
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (isCorner(edges[e][0]) && isCorner(edges[e][1]))
      result.push_back(nodes[nodes.size() - edges.size() + e]);
  return result;
}

const std::vector<int>& DeckBodies::ofNode(GlobalOrdinal node) const {
  static const std::vector<int> none;
  const auto found = bodiesOfNode_.find(node);
  return found == bodiesOfNode_.end() ? none : found->second;
}

} // namespace epafi::deck
