#include "epafi/decomposition/ContactRows.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ContactSearch.hpp"
#include "epafi/decomposition/KnownRows.hpp"
#include "epafi/fem/RectangleMesh.hpp"
#include "epafi/scene/EdgeSegment.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
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

/// One body's side of a contact: its nodes, ascending, with their places among the rows.
struct Side {
  const ContactLayout* contact;
  double sign;
  int body;
  std::vector<std::pair<GlobalOrdinal, std::size_t>> nodes;
};

std::vector<Side> sidesOf(const std::vector<ContactLayout>& contacts) {
  std::vector<Side> sides;
  const auto add = [&](const ContactLayout& contact, double sign, int body,
                       const std::vector<GlobalOrdinal>& nodes) {
    Side& side = sides.emplace_back(Side{&contact, sign, body, {}});
    for (std::size_t place = 0; place < nodes.size(); ++place)
      side.nodes.emplace_back(nodes[place], place);
    std::sort(side.nodes.begin(), side.nodes.end());
  };
  for (const ContactLayout& contact : contacts) {
    add(contact, 1.0, contact.firstBody, contact.firstNodes);
    if (contact.secondBody >= 0)
      add(contact, -1.0, contact.secondBody, contact.secondNodes);
  }
  return sides;
}

/// A node that can move in a row's direction by no more than this share of what it is moved by does not count in it: the
/// rest is round-off of normals.
constexpr double heldDirection = 1e-6;
/// Coefficients that would be 0 without round-off of normals and frames.
constexpr double roundOff = 1e-14;

/// d in the unknowns of a node: its components, or Qᵀd where the node has a frame Q. All rows of a contact have the same
/// number of components.
Eigen::Vector3d directionAt(const fem::BodyModel& model, GlobalOrdinal node, const ContactLayout& contact,
                            std::size_t place) {
  const std::size_t components = contact.directions.size() / contact.firstNodes.size();
  Eigen::Vector3d direction(0, 0, 0);
  for (std::size_t c = 0; c < components; ++c)
    direction[static_cast<Eigen::Index>(c)] = contact.directions[place * components + c];
  if (const Eigen::Matrix3d* frame = model.frame(node))
    direction = frame->transpose() * direction;
  return direction;
}

/// Enters one row at a node of a piece; returns whether the piece has a free unknown in it.
bool enterRow(const fem::BodyModel& model, const Side& side, std::size_t place, std::size_t node,
              GlobalOrdinal row, Piece& piece) {
  const auto components = static_cast<std::size_t>(model.components());
  const Eigen::Vector3d direction = directionAt(model, piece.assembled.nodes[node], *side.contact, place);
  const std::span<const int> unknowns =
      std::span(piece.assembled.unknownOf).subspan(node * components, components);
  double free = 0;
  for (std::size_t c = 0; c < components; ++c)
    if (unknowns[c] >= 0)
      free = std::hypot(free, direction[static_cast<Eigen::Index>(c)]);
  if (free <= heldDirection)
    return false;
  for (std::size_t c = 0; c < components; ++c) {
    const double coefficient = side.sign * direction[static_cast<Eigen::Index>(c)];
    if (unknowns[c] >= 0 && std::abs(coefficient) > roundOff)
      piece.rows.push_back({row, unknowns[c], coefficient});
  }
  return true;
}

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
    ContactLayout& contact = contacts.emplace_back(layoutEdges(pair, bodies));
    contact.firstRow = firstRow;
    firstRow += contact.numRows();
  }
  KnownRows known;
  for (const scene::SurfaceContact& search : scene.surfaceContacts) {
    const auto& body = scene.bodies[static_cast<std::size_t>(search.first)];
    const int components = body.solid ? componentsOf(body.solid->physics) : 1;
    ContactLayout& contact = contacts.emplace_back(searchContact(search, bodies, components));
    known.dropFrom(contact);
    contact.firstRow = firstRow;
    firstRow += contact.numRows();
  }
  return contacts;
}

Rows contactRows(const Layout& layout, const std::vector<ContactLayout>& contacts,
                 std::vector<Piece>& pieces) {
  Rows rows;
  const std::vector<Side> sides = sidesOf(contacts);
  for (Piece& piece : pieces) {
    const std::vector<GlobalOrdinal>& nodes = piece.assembled.nodes;
    for (const Side& side : sides) {
      if (side.body != piece.body)
        continue;
      auto entry =
          std::lower_bound(side.nodes.begin(), side.nodes.end(), std::pair(nodes.front(), std::size_t{0}));
      for (auto found = nodes.begin(); entry != side.nodes.end() && entry->first <= nodes.back(); ++entry) {
        found = std::lower_bound(found, nodes.end(), entry->first);
        if (*found != entry->first)
          continue;
        const auto node = static_cast<std::size_t>(found - nodes.begin());
        if (!piece.sharing.isLowest(piece.part, node))
          continue;
        const GlobalOrdinal row = side.contact->firstRow + static_cast<GlobalOrdinal>(entry->second);
        if (side.sign > 0)
          rows.owned.push_back(row);
        if (enterRow(*layout.models[static_cast<std::size_t>(piece.body)], side, entry->second, node, row,
                     piece))
          rows.touched.push_back(row);
      }
    }
  }
  return rows;
}

double contactGap(const Layout& layout, const std::vector<ContactLayout>& contacts, GlobalOrdinal row) {
  const auto contact = std::find_if(contacts.begin(), contacts.end(),
                                    [row](const ContactLayout& c) { return row < c.firstRow + c.numRows(); });
  const auto place = static_cast<std::size_t>(row - contact->firstRow);
  const auto prescribed = [&](int body, GlobalOrdinal node) {
    const fem::BodyModel& model = *layout.models[static_cast<std::size_t>(body)];
    const Eigen::Vector3d direction = directionAt(model, node, *contact, place);
    double sum = 0;
    for (int c = 0; c < model.components(); ++c)
      sum += direction[c] * model.prescribed(node, c).value_or(0.0);
    return sum;
  };
  double gap = contact->gaps[place] - prescribed(contact->firstBody, contact->firstNodes[place]);
  if (contact->secondBody >= 0)
    gap += prescribed(contact->secondBody, contact->secondNodes[place]);
  return gap;
}

} // namespace epafi::decomposition
