#include "epafi/scene/ContactReader.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/ParameterValue.hpp"
#include "epafi/scene/EdgeContact.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace epafi::scene {
namespace {

struct NamedObstacle {
  std::string name;
  int dimension = 3; ///< of the bodies that it can meet
  Obstacle obstacle;
};

/// The vector, divided by its length.
Vector3 direction(const ListReader& list, const std::string& name, int dimension) {
  Vector3 vector = list.vector(name, dimension);
  const double length = std::hypot(vector[0], vector[1], vector[2]);
  if (length == 0)
    list.refuseValue(name, "must have a direction");
  for (double& component : vector)
    component /= length;
  return vector;
}

/// One of the list `Obstacles`.
NamedObstacle readObstacle(const std::string& name, const ListReader& list) {
  NamedObstacle result;
  result.name = name;
  const std::string& kind = list.word("Kind");
  const std::string useless = "an obstacle of the kind \"" + kind + "\" has no use for it";
  result.dimension = kind == "plane" ? std::clamp(list.length("Point"), 2, 3) : kind == "circle" ? 2 : 3;
  if (kind == "cylinder" && list.length("Point") == 2)
    list.refuseValue("Kind", "a bore or a roller in the plane is a \"circle\"");
  if (kind == "sphere" && list.length("Point") == 2)
    list.refuseValue("Kind", "a centre of two coordinates is that of a \"circle\"");
  result.obstacle.point = list.vector("Point", result.dimension);
  if (kind == "plane") {
    list.refuseGiven({"Radius", "Axis", "Side"}, useless);
    list.require("Normal", " of a plane");
    result.obstacle.normal = direction(list, "Normal", result.dimension);
    return result;
  }
  list.refuseGiven({"Normal"}, useless);
  list.require("Radius", " of a " + kind);
  result.obstacle.kind = kind == "cylinder" ? Obstacle::Kind::cylinder : Obstacle::Kind::sphere;
  result.obstacle.radius = list.positive("Radius");
  result.obstacle.isHollow = list.word("Side") == "inside";
  if (kind == "cylinder") {
    list.require("Axis", " of a cylinder");
    result.obstacle.normal = direction(list, "Axis", result.dimension);
  } else {
    list.refuseGiven({"Axis"}, useless);
  }
  return result;
}

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

/// Whether a line along z meets it everywhere or nowhere.
bool isUpright(const Obstacle& obstacle) {
  const double z = std::abs(obstacle.normal[2]);
  return obstacle.kind == Obstacle::Kind::plane ? z < 1e-6 : z > 1 - 1e-12;
}

/// The obstacle that the pair names.
Obstacle obstacleOf(const ListReader& entry, const Body& body, const std::vector<NamedObstacle>& obstacles) {
  const auto& [name, dimension, obstacle] =
      obstacles[indexOf(entry, "Obstacle", obstacles, "obstacle", "obstacles")];
  const std::string who = "body \"" + body.name + "\" ";
  if (body.physics == fem::Physics::membrane) {
    if (dimension == 2 || obstacle.isHollow)
      entry.refuseValue("Obstacle",
                        who + "is a membrane at z = 0, which meets planes, and spheres and cylinders "
                              "from outside, in space: give three coordinates");
    if (obstacle.kind != Obstacle::Kind::sphere && isUpright(obstacle))
      entry.refuseValue("Obstacle",
                        who + "is a membrane at z = 0, which can neither meet a plane nor a cylinder "
                              "that stands upright");
    return obstacle;
  }
  if (dimensionOf(body.physics) != dimension)
    entry.refuseValue("Obstacle", "it is an obstacle " +
                                      std::string(dimension == 3 ? "in space" : "in the plane") + ", but " +
                                      who + "is not");
  if (body.physics == fem::Physics::axisymmetric &&
      (obstacle.kind == Obstacle::Kind::plane ? obstacle.normal[0] != 0 : obstacle.point[0] != 0))
    entry.refuseValue("Obstacle", who + "is axisymmetric, and meets planes across its axis, with a normal "
                                        "{0, 1} or {0, -1}, and spheres, circles with their centre at x = 0");
  return obstacle;
}

/// Where two membranes on rectangles meet.
void readEdges(const ListReader& entry, SurfaceContact& pair) {
  entry.refuseGiven({"First Surface", "Second Surface"}, "membranes on rectangles meet along edges");
  entry.refuseGiven({"Distance"}, "membranes on rectangles meet along whole edges; remove it");
  for (const char* const needed : {"First Edge", "Second Edge"})
    entry.require(needed);
  pair.firstSurface = entry.edge("First Edge");
  pair.secondSurface = entry.edge("Second Edge");
}

/// Where all others do.
void readSurfaces(const ListReader& entry, const std::vector<Body>& bodies,
                  const std::vector<NamedObstacle>& obstacles, SurfaceContact& pair) {
  const bool coversBody = pair.second < 0 && bodies[pair.first].physics == fem::Physics::membrane;
  if (coversBody)
    entry.refuseGiven({"First Edge", "First Surface"}, "an obstacle may stop a membrane anywhere; remove it");
  entry.refuseGiven({"First Edge", "Second Edge"},
                    "only membranes on rectangles meet along edges; name surfaces");
  if (!coversBody)
    entry.require("First Surface");
  pair.firstSurface = entry.word("First Surface");
  if (pair.second < 0) {
    entry.refuseGiven({"Second Surface"}, "an obstacle is its own surface");
    pair.obstacle = obstacleOf(entry, bodies[pair.first], obstacles);
  } else {
    entry.require("Second Surface");
    pair.secondSurface = entry.word("Second Surface");
  }
  if (const double distance = entry.real("Distance"); distance > 0)
    pair.distance = distance;
  if (entry.has("Adjust"))
    pair.adjust = entry.real("Adjust");
}

/// How the sides are joined.
void readCoupling(const ListReader& entry, SurfaceContact& pair) {
  using Coupling = SurfaceContact::Coupling;
  using Side = SurfaceContact::Side;
  pair.kind = entry.word("Kind") == "tied" ? SurfaceContact::Kind::tied : SurfaceContact::Kind::contact;
  if (pair.second < 0) {
    if (pair.kind == SurfaceContact::Kind::tied)
      entry.refuseValue("Kind", "nothing is tied to an obstacle; hold the surface by a support");
    entry.refuseGiven({"Coupling", "Multipliers"}, "an obstacle has no mesh");
  }
  if (pair.kind == SurfaceContact::Kind::tied)
    entry.refuseGiven({"Gap"}, "a tied joint keeps the gap that there is");
  pair.adjustNodes = entry.word("Adjust Nodes");
  const std::string &coupling = entry.word("Coupling"), &side = entry.word("Multipliers");
  pair.coupling = coupling == "nodes"    ? Coupling::nodes
                  : coupling == "mortar" ? Coupling::mortar
                                         : Coupling::automatic;
  if (pair.coupling == Coupling::nodes)
    entry.refuseGiven({"Multipliers"}, "pairs of nodes have one each");
  pair.multipliers = side == "first" || !pair.adjustNodes.empty() ? Side::first
                     : side == "second"                           ? Side::second
                                                                  : Side::automatic;
}

/// What hinders the surfaces from slipping, and by what they give way.
void readFriction(const ListReader& entry, const Body& body, SurfaceContact& pair) {
  pair.friction = entry.real("Friction");
  pair.frictionBound = entry.real("Friction Bound");
  pair.stiffness = entry.real("Stiffness");
  pair.stickSlope = entry.real("Stick Slope");
  const bool isTied = pair.kind == SurfaceContact::Kind::tied;
  for (const char* const name : {"Adjust", "Adjust Nodes"})
    if (entry.has(name) && (body.physics == fem::Physics::membrane || isTied))
      entry.refuseValue(name, "membranes and tied joints have no gap that their shapes leave");
  for (const char* const name : {"Stiffness", "Stick Slope"}) {
    if (entry.real(name) > 0 && body.physics == fem::Physics::membrane)
      entry.refuseValue(name, "membranes do not give way where they touch");
    if (entry.real(name) > 0 && isTied && pair.coupling == SurfaceContact::Coupling::nodes)
      entry.refuseValue("Coupling", "a tied joint that gives way is coupled by mortars");
  }
  if (isTied && pair.stickSlope == 0)
    pair.stickSlope = pair.stiffness;
  if (pair.stickSlope > 0 && (isTied ? pair.stiffness == 0 : !pair.hasFriction()))
    entry.refuseValue("Stick Slope", isTied ? "a tied joint that gives way needs a Stiffness, too"
                                            : "there is no friction that would make the surfaces stick");
  if (!pair.hasFriction())
    return;
  const char* const given = pair.friction > 0 ? "Friction" : "Friction Bound";
  if (pair.friction > 0 && pair.frictionBound > 0)
    entry.refuseValue("Friction Bound", "Coulomb's Friction is given as well; leave out one of them");
  if (isTied)
    entry.refuseValue(given, "a tied joint does not slip; remove it, or make the pair a contact");
  if (body.physics == fem::Physics::membrane)
    entry.refuseValue(given, "membranes move along z alone and cannot slip; friction is for elastic bodies");
}

/// What a joint is tightened by, if it is a section of a bolt.
void readPreload(const ListReader& entry, const Body& body, SurfaceContact& pair) {
  if (!entry.hasEntries("Preload")) {
    entry.refuseGiven({"Preload Direction"}, "there is no Preload");
    return;
  }
  if (pair.kind != SurfaceContact::Kind::tied || body.physics == fem::Physics::membrane)
    entry.refuseValue("Preload", "it is for tied joints of elastic bodies, the parts of a bolt");
  if (pair.stiffness > 0)
    entry.refuseValue("Preload", "a section of a bolt does not give way; remove its Stiffness");
  pair.preload = preloadOf(entry.word("Preload"));
  if (!pair.preload || pair.preload->kind == Preload::Kind::locked)
    entry.refuseValue("Preload", "it must be \"force\" or \"shortening\" and a number");
  if (entry.hasEntries("Preload Direction"))
    pair.preloadDirection = direction(entry, "Preload Direction", dimensionOf(body.physics));
}

void requireSoundEdges(const ListReader& entry, const Scene& scene) {
  const std::optional<EdgeFault> fault = faultOf(scene, scene.contacts.size() - 1);
  if (!fault)
    return;
  if (fault->side < 0)
    entry.refuseList(fault->objection);
  entry.refuseValue(fault->side == 0 ? "First Edge" : "Second Edge", fault->objection);
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

std::optional<Preload> preloadOf(const std::string& text) {
  using Kind = Preload::Kind;
  if (text == "locked")
    return Preload{Kind::locked};
  for (const auto& [word, kind] : {std::pair("force ", Kind::force), {"shortening ", Kind::shortening}})
    if (text.starts_with(word))
      try {
        return Preload{kind, parsedReal(text.substr(std::string_view(word).size()))};
      } catch (const InputError&) {
        return std::nullopt;
      }
  return std::nullopt;
}

void readContacts(const ListReader& list, const ListReader& rigid, Scene& scene) {
  std::vector<NamedObstacle> obstacles;
  for (const std::string& name : rigid.names())
    obstacles.push_back(readObstacle(name, rigid.inside(name)));
  for (const std::string& name : list.names()) {
    const ListReader entry = list.inside(name);
    SurfaceContact pair;
    pair.name = name;
    pair.first = bodyIndex(entry, "First Body", scene.bodies);
    if (entry.hasEntries("Obstacle")) {
      entry.refuseGiven({"Second Body"}, "the obstacle stands in its place; remove one of them");
    } else {
      entry.require("Second Body", " unless there is an obstacle");
      pair.second = bodyIndex(entry, "Second Body", scene.bodies);
      if (pair.first == pair.second)
        entry.refuseValue("Second Body", "a body cannot be in contact with itself");
    }
    const bool alongEdges = isAlongEdges(scene, pair);
    if (alongEdges)
      readEdges(entry, pair);
    else
      readSurfaces(entry, scene.bodies, obstacles, pair);
    readCoupling(entry, pair);
    readFriction(entry, scene.bodies[pair.first], pair);
    readPreload(entry, scene.bodies[pair.first], pair);
    pair.gap = entry.real("Gap");
    scene.contacts.push_back(pair);
    if (alongEdges)
      requireSoundEdges(entry, scene);
  }
  requireUse(list, obstacles);
}

} // namespace epafi::scene
