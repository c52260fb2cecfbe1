#include "epafi/scene/ContactReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/scene/EdgeSegment.hpp"
#include "epafi/scene/SolidReader.hpp"

#include <algorithm>

namespace epafi::scene {
namespace {

/// Index of the one that a parameter names among bodies or obstacles.
template <class Named>
int indexOf(const ListReader& pair, const std::string& parameter, const std::vector<Named>& among,
            const std::string& one, const std::string& many) {
  std::vector<std::string> names;
  std::string all;
  for (const Named& candidate : among) {
    if (candidate.name == pair.word(parameter))
      return static_cast<int>(names.size());
    names.push_back(candidate.name);
    all += (all.empty() ? "\"" : ", \"") + candidate.name + '"';
  }
  const std::string near = nearestName(pair.word(parameter), names);
  pair.refuseValue(parameter, "there is no such " + one + "; " +
                                  (!near.empty()   ? "did you mean \"" + near + "\"?"
                                   : names.empty() ? "the scene has no " + many
                                                   : "the " + many + " are " + all));
}

int bodyIndex(const ListReader& pair, const std::string& parameter, const std::vector<Body>& bodies) {
  return indexOf(pair, parameter, bodies, "body", "bodies");
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

ContactPair readEdges(const ListReader& entry, ContactPair pair, const Scene& scene) {
  entry.refuseGiven({"First Surface", "Second Surface"}, "membranes on rectangles meet along edges");
  entry.refuseGiven({"Distance"}, "membranes on rectangles meet along whole edges; remove it");
  for (const char* const needed : {"First Edge", "Second Edge"})
    entry.require(needed);
  pair.firstEdge = entry.edge("First Edge");
  pair.secondEdge = entry.edge("Second Edge");
  const Body& first = scene.bodies[static_cast<std::size_t>(pair.first)];
  const Body& second = scene.bodies[static_cast<std::size_t>(pair.second)];
  checkFree(entry, "First Edge", first, pair.first, pair.firstEdge, scene.contacts);
  checkFree(entry, "Second Edge", second, pair.second, pair.secondEdge, scene.contacts);
  checkMatch(entry, first, pair.firstEdge, second, pair.secondEdge);
  pair.gap = entry.real("Gap");
  return pair;
}

Physics physicsOf(const Body& body) {
  return body.solid ? body.solid->physics : Physics::membrane;
}

/// The obstacle that the pair names.
Obstacle readObstacle(const ListReader& entry, const Body& body,
                      const std::vector<NamedObstacle>& obstacles) {
  const auto& [name, dimension, obstacle] =
      obstacles[static_cast<std::size_t>(indexOf(entry, "Obstacle", obstacles, "obstacle", "obstacles"))];
  const std::string who = "body \"" + body.name + "\" ";
  if (physicsOf(body) == Physics::membrane)
    entry.refuseValue("Obstacle", who + "is a membrane; only elastic bodies meet obstacles");
  if (dimensionOf(physicsOf(body)) != dimension)
    entry.refuseValue("Obstacle", "it is an obstacle " +
                                      std::string(dimension == 3 ? "in space" : "in the plane") + ", but " +
                                      who + "is not");
  return obstacle;
}

SurfaceContact readSurfaces(const ListReader& entry, SurfaceContact pair, const Scene& scene,
                            const std::vector<NamedObstacle>& obstacles) {
  entry.refuseGiven({"First Edge", "Second Edge"},
                    "only membranes on rectangles meet along edges; name surfaces");
  entry.require("First Surface");
  pair.firstSurface = entry.word("First Surface");
  if (pair.second < 0) {
    entry.refuseGiven({"Second Surface"}, "an obstacle is its own surface");
    pair.obstacle = readObstacle(entry, scene.bodies[static_cast<std::size_t>(pair.first)], obstacles);
  } else {
    entry.require("Second Surface");
    pair.secondSurface = entry.word("Second Surface");
  }
  pair.gap = entry.real("Gap");
  if (const double distance = entry.real("Distance"); distance > 0)
    pair.distance = distance;
  return pair;
}

void requireUse(const ListReader& contacts, const std::vector<NamedObstacle>& obstacles) {
  for (const NamedObstacle& obstacle : obstacles) {
    const std::vector<std::string> pairs = contacts.names();
    if (std::none_of(pairs.begin(), pairs.end(), [&](const std::string& pair) {
          return contacts.inside(pair).word("Obstacle") == obstacle.name;
        }))
      contacts.refuseList("has no pair with the obstacle \"" + obstacle.name +
                          "\"; name it in one, or remove it");
  }
}

} // namespace

void readContacts(const ListReader& list, const std::vector<NamedObstacle>& obstacles, Scene& scene) {
  const auto isRectangle = [&](int body) {
    return body < 0 || !scene.bodies[static_cast<std::size_t>(body)].solid;
  };
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    const int first = bodyIndex(entry, "First Body", scene.bodies);
    int second = -1;
    if (entry.hasEntries("Obstacle")) {
      entry.refuseGiven({"Second Body"}, "the obstacle stands in its place; remove one of them");
    } else {
      entry.require("Second Body", " unless there is an obstacle");
      second = bodyIndex(entry, "Second Body", scene.bodies);
      if (first == second)
        entry.refuseValue("Second Body", "a body cannot be in contact with itself");
    }
    if (isRectangle(first) && second >= 0 && isRectangle(second))
      scene.contacts.push_back(readEdges(entry, {name, first, Edge::right, second, Edge::left, 0}, scene));
    else
      scene.surfaceContacts.push_back(readSurfaces(
          entry, {name, first, "", second, "", {}, 0, SurfaceContact().distance}, scene, obstacles));
  }
  requireUse(list, obstacles);
}

} // namespace epafi::scene
