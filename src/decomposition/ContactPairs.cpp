#include "epafi/decomposition/ContactPairs.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/fem/RectangleMesh.hpp"
#include "epafi/scene/EdgeSegment.hpp"

#include <map>
#include <string>
#include <utility>

namespace epafi::decomposition {
namespace {

/// Mesh of a membrane, which scene::ContactPair is about.
const fem::RectangleMesh& rectangleOf(const BodyLayout& body) {
  return dynamic_cast<const fem::RectangleMesh&>(*body.mesh);
}

void requireMatchingNodes(const scene::ContactPair& pair, const BodyLayout& first, const BodyLayout& second) {
  const std::string edges = "the " + toString(pair.firstEdge) + " edge of '" + first.name + "' and the " +
                            toString(pair.secondEdge) + " edge of '" + second.name + "'";
  const GlobalOrdinal n = rectangleOf(first).numEdgeNodes(pair.firstEdge),
                      m = rectangleOf(second).numEdgeNodes(pair.secondEdge);
  if (n != m) {
    throw InputError("contact pair '" + pair.name + "': " + edges + " have non-matching nodes, " +
                     std::to_string(n) + " and " + std::to_string(m) +
                     "; give both edges the same number of elements");
  }
  const scene::EdgeSegment a = segmentOf(rectangleOf(first).rectangle(), pair.firstEdge),
                           b = segmentOf(rectangleOf(second).rectangle(), pair.secondEdge);
  if (!coincide(a, b))
    throw InputError("contact pair '" + pair.name + "': " + edges + " do not coincide: one is " +
                     toString(a) + ", the other " + toString(b));
}

void requireUnsupported(const scene::ContactPair& pair, const scene::Body& body, scene::Edge edge) {
  for (const scene::Support& support : body.supports)
    if (support.edge == edge)
      throw InputError("contact pair '" + pair.name + "' and support '" + support.name +
                       "' overlap: both lie on the " + toString(edge) + " edge of body '" + body.name +
                       "'; remove one of them");
}

void requireBodies(const scene::ContactPair& pair, std::size_t numBodies) {
  for (const int body : {pair.first, pair.second})
    if (body < 0 || static_cast<std::size_t>(body) >= numBodies)
      throw InputError("contact pair '" + pair.name + "' names body number " + std::to_string(body) +
                       ", but the scene has " + std::to_string(numBodies) + " bodies, numbered from 0");
}

/// Remembers which pair has taken an edge of a body; one edge cannot serve two pairs.
class TakenEdges {
public:
  void take(const scene::ContactPair& pair, int body, scene::Edge edge, const std::string& bodyName) {
    const auto [entry, isNew] = taken_.try_emplace({body, edge}, pair.name);
    if (!isNew)
      throw InputError("the " + toString(edge) + " edge of body '" + bodyName +
                       "' is used twice for contact, by '" + entry->second + "' and '" + pair.name +
                       "'; give each contact pair edges of its own");
  }

private:
  std::map<std::pair<int, scene::Edge>, std::string> taken_;
};

/// The rows at a pair of edges.
ContactLayout layoutEdges(const scene::ContactPair& pair, const std::vector<BodyLayout>& bodies) {
  const fem::RectangleMesh &first = rectangleOf(bodies[static_cast<std::size_t>(pair.first)]),
                           &second = rectangleOf(bodies[static_cast<std::size_t>(pair.second)]);
  ContactLayout contact;
  contact.name = pair.name;
  contact.firstBody = pair.first;
  contact.secondBody = pair.second;
  const GlobalOrdinal numRows = first.numEdgeNodes(pair.firstEdge);
  const scene::EdgeSegment edge = segmentOf(first.rectangle(), pair.firstEdge);
  const double spacing = (edge.to - edge.from) / static_cast<double>(numRows - 1);
  for (GlobalOrdinal k = 0; k < numRows; ++k) {
    contact.firstNodes.push_back(first.edgeNode(pair.firstEdge, k));
    contact.secondNodes.push_back(second.edgeNode(pair.secondEdge, k));
    contact.areas.push_back(k == 0 || k + 1 == numRows ? 0.5 * spacing : spacing);
  }
  contact.directions.assign(contact.firstNodes.size(), 1.0);
  contact.gaps.assign(contact.firstNodes.size(), pair.gap);
  return contact;
}

} // namespace

std::vector<ContactLayout> layoutPairs(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  std::vector<ContactLayout> contacts;
  TakenEdges takenEdges;
  for (const scene::ContactPair& pair : scene.contacts) {
    requireBodies(pair, bodies.size());
    const auto first = static_cast<std::size_t>(pair.first), second = static_cast<std::size_t>(pair.second);
    requireUnsupported(pair, scene.bodies[first], pair.firstEdge);
    requireUnsupported(pair, scene.bodies[second], pair.secondEdge);
    requireMatchingNodes(pair, bodies[first], bodies[second]);
    takenEdges.take(pair, pair.first, pair.firstEdge, bodies[first].name);
    takenEdges.take(pair, pair.second, pair.secondEdge, bodies[second].name);
    contacts.push_back(layoutEdges(pair, bodies));
  }
  return contacts;
}

} // namespace epafi::decomposition
