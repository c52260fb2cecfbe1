#include "epafi/decomposition/ContactRows.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/scene/EdgeSegment.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace epafi::decomposition {
namespace {

void requireMatchingNodes(const scene::ContactPair& pair, const BodyLayout& first, const BodyLayout& second) {
  const std::string edges = "the " + toString(pair.firstEdge) + " edge of '" + first.name + "' and the " +
                            toString(pair.secondEdge) + " edge of '" + second.name + "'";
  const GlobalOrdinal n = first.mesh->numEdgeNodes(pair.firstEdge),
                      m = second.mesh->numEdgeNodes(pair.secondEdge);
  if (n != m) {
    throw InputError("contact pair '" + pair.name + "': " + edges + " have non-matching nodes, " +
                     std::to_string(n) + " and " + std::to_string(m) +
                     "; give both edges the same number of elements");
  }
  const scene::EdgeSegment a = segmentOf(first.mesh->rectangle(), pair.firstEdge),
                           b = segmentOf(second.mesh->rectangle(), pair.secondEdge);
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

struct Side {
  double coefficient;
  int body;
  scene::Edge edge;
};

} // namespace

std::vector<ContactLayout> layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  std::vector<ContactLayout> contacts;
  GlobalOrdinal firstRow = 0;
  TakenEdges takenEdges;
  for (const scene::ContactPair& pair : scene.contacts) {
    requireBodies(pair, bodies.size());
    const auto first = static_cast<std::size_t>(pair.first), second = static_cast<std::size_t>(pair.second);
    requireUnsupported(pair, scene.bodies[first], pair.firstEdge);
    requireUnsupported(pair, scene.bodies[second], pair.secondEdge);
    requireMatchingNodes(pair, bodies[first], bodies[second]);
    takenEdges.take(pair, pair.first, pair.firstEdge, bodies[first].name);
    takenEdges.take(pair, pair.second, pair.secondEdge, bodies[second].name);
    const GlobalOrdinal numRows = bodies[first].mesh->numEdgeNodes(pair.firstEdge);
    contacts.push_back(
        {pair.name, firstRow, numRows, pair.first, pair.second, pair.firstEdge, pair.secondEdge, pair.gap});
    firstRow += numRows;
  }
  return contacts;
}

Rows contactRows(const Layout& layout, const std::vector<ContactLayout>& contacts,
                 std::vector<Piece>& pieces) {
  Rows rows;
  std::vector<std::size_t> places;
  for (Piece& piece : pieces) {
    const fem::RectangleMesh& mesh = *layout.bodies[static_cast<std::size_t>(piece.body)].mesh;
    const std::vector<GlobalOrdinal>& nodes = piece.assembled.nodes;
    for (const ContactLayout& contact : contacts)
      for (const Side& side : {Side{1.0, contact.firstBody, contact.firstEdge},
                               Side{-1.0, contact.secondBody, contact.secondEdge}}) {
        if (side.body != piece.body)
          continue;
        mesh.placesOnEdge(side.edge, nodes, places);
        for (const std::size_t place : places) {
          if (!piece.sharing.isLowest(piece.part, place))
            continue;
          const GlobalOrdinal row = contact.firstRow + mesh.positionOnEdge(side.edge, nodes[place]);
          if (side.coefficient > 0)
            rows.owned.push_back(row);
          if (piece.assembled.unknownOf[place] >= 0) {
            rows.touched.push_back(row);
            piece.rows.push_back({row, piece.assembled.unknownOf[place], side.coefficient});
          }
        }
      }
  }
  return rows;
}

double contactGap(const Layout& layout, const std::vector<ContactLayout>& contacts, GlobalOrdinal row) {
  const auto contact = std::find_if(contacts.begin(), contacts.end(),
                                    [row](const ContactLayout& c) { return row < c.firstRow + c.numRows; });
  const auto value = [&](int body, scene::Edge edge) {
    const auto b = static_cast<std::size_t>(body);
    const GlobalOrdinal node = layout.bodies[b].mesh->edgeNode(edge, row - contact->firstRow);
    return layout.models[b]->prescribed(node, 0).value_or(0.0);
  };
  return contact->gap - value(contact->firstBody, contact->firstEdge) +
         value(contact->secondBody, contact->secondEdge);
}

} // namespace epafi::decomposition
