#include "epafi/scene/ContactReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/scene/EdgeSegment.hpp"

namespace epafi::scene {
namespace {

int bodyIndex(const ListReader& pair, const std::string& parameter, const std::vector<Body>& bodies) {
  std::vector<std::string> names;
  std::string all;
  for (const Body& body : bodies) {
    if (body.name == pair.word(parameter))
      return static_cast<int>(names.size());
    names.push_back(body.name);
    all += (all.empty() ? "\"" : ", \"") + body.name + '"';
  }
  const std::string near = nearestName(pair.word(parameter), names);
  pair.refuseValue(parameter, "there is no such body; " + (near.empty() ? "the bodies are " + all
                                                                        : "did you mean \"" + near + "\"?"));
}

/// Refuses an edge that is supported, or in one of the pairs before.
void checkFree(const ListReader& list, const std::string& parameter, const Body& body, int index, Edge edge,
               const std::vector<ContactPair>& before) {
  for (const Support& support : body.supports)
    if (support.edge == edge)
      list.refuseValue(parameter, "that edge of body \"" + body.name + "\" has the support \"" +
                                      support.name + "\"; an edge is either supported or in contact");
  for (const ContactPair& other : before)
    if ((other.first == index && other.firstEdge == edge) ||
        (other.second == index && other.secondEdge == edge))
      list.refuseValue(parameter, "that edge of body \"" + body.name + "\" is in the contact pair \"" +
                                      other.name + "\" already");
}

void checkMatch(const ListReader& list, const Body& first, Edge firstEdge, const Body& second,
                Edge secondEdge) {
  const EdgeSegment a = segmentOf(first.rectangle, firstEdge), b = segmentOf(second.rectangle, secondEdge);
  if (!coincide(a, b))
    list.refuseList("joins edges that do not coincide: \"" + toString(firstEdge) + "\" of body \"" +
                    first.name + "\" is " + toString(a) + ", but \"" + toString(secondEdge) +
                    "\" of body \"" + second.name + "\" is " + toString(b));
  const int m = first.elements[a.isVertical ? 1 : 0], n = second.elements[b.isVertical ? 1 : 0];
  if (m != n)
    list.refuseList("joins edges with different numbers of elements: " + std::to_string(m) + " on body \"" +
                    first.name + "\", but " + std::to_string(n) + " on body \"" + second.name + '"');
}

} // namespace

std::vector<ContactPair> readContacts(const ListReader& list, const std::vector<Body>& bodies) {
  std::vector<ContactPair> pairs;
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    ContactPair pair;
    pair.name = name;
    pair.first = bodyIndex(entry, "First Body", bodies);
    pair.second = bodyIndex(entry, "Second Body", bodies);
    if (pair.first == pair.second)
      entry.refuseValue("Second Body", "a body cannot be in contact with itself");
    pair.firstEdge = entry.edge("First Edge");
    pair.secondEdge = entry.edge("Second Edge");
    const Body& first = bodies[static_cast<std::size_t>(pair.first)];
    const Body& second = bodies[static_cast<std::size_t>(pair.second)];
    checkFree(entry, "First Edge", first, pair.first, pair.firstEdge, pairs);
    checkFree(entry, "Second Edge", second, pair.second, pair.secondEdge, pairs);
    checkMatch(entry, first, pair.firstEdge, second, pair.secondEdge);
    pair.gap = entry.real("Gap");
    pairs.push_back(pair);
  }
  return pairs;
}

} // namespace epafi::scene
