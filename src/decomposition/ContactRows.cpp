#include "epafi/decomposition/ContactRows.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/decomposition/ContactSearch.hpp"
#include "epafi/decomposition/SharedValues.hpp"
#include "epafi/fem/RectangleMesh.hpp"
#include "epafi/scene/EdgeSegment.hpp"

#include <algorithm>
#include <map>
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

/// One row at a node of a piece.
struct Place {
  const Side* side;
  std::size_t row; ///< place among those of the contact
  std::size_t piece, node;
};

/// In the order of the pieces, their sides and the sides' nodes.
std::vector<Place> placesOf(const std::vector<Side>& sides, const std::vector<Piece>& pieces) {
  std::vector<Place> places;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const std::vector<GlobalOrdinal>& nodes = pieces[p].assembled.nodes;
    for (const Side& side : sides) {
      if (side.body != pieces[p].body)
        continue;
      auto entry =
          std::lower_bound(side.nodes.begin(), side.nodes.end(), std::pair(nodes.front(), std::size_t{0}));
      for (auto found = nodes.begin(); entry != side.nodes.end() && entry->first <= nodes.back(); ++entry) {
        found = std::lower_bound(found, nodes.end(), entry->first);
        if (*found == entry->first)
          places.push_back({&side, entry->second, p, static_cast<std::size_t>(found - nodes.begin())});
      }
    }
  }
  return places;
}

/// The share that each copy has in a node's mean, component by component, at places in order; nothing for nodes that are
/// not shared, and crosspoints. Collective.
class Shares {
public:
  Shares(const Layout& layout, const std::vector<Place>& places, const std::vector<Piece>& pieces,
         const RCP<const Comm>& comm) {
    std::vector<SharedNode> nodes;
    for (const Place& place : places) {
      const Piece& piece = pieces[place.piece];
      if (const auto k = piece.sharing.find(place.node);
          k && piece.isCrosspoint[place.node] == 0 && numberOf_.try_emplace(key(place), nodes.size()).second)
        nodes.push_back({place.piece, *k});
    }
    const auto components = static_cast<std::size_t>(layout.models.front()->components());
    Eigen::MatrixXd own(static_cast<Eigen::Index>(nodes.size()), static_cast<Eigen::Index>(components));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Piece& piece = pieces[nodes[i].piece];
      own.row(static_cast<Eigen::Index>(i)) =
          stiffnessOf(piece, piece.sharing.node(nodes[i].place), components);
    }
    const std::vector<Eigen::MatrixXd> copies = valuesOfCopies(layout, pieces, nodes, own, comm);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      shares_.emplace_back(own.row(static_cast<Eigen::Index>(i)).array() / copies[i].colwise().sum().array());
  }
  /// Null if the node has no shares.
  [[nodiscard]] const Eigen::RowVectorXd* at(const Place& place) const {
    const auto found = numberOf_.find(key(place));
    return found == numberOf_.end() ? nullptr : &shares_[found->second];
  }

private:
  static std::pair<std::size_t, std::size_t> key(const Place& place) { return {place.piece, place.node}; }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> numberOf_;
  std::vector<Eigen::RowVectorXd> shares_;
};

/// Enters one row at a node of a piece; returns whether the piece has a free unknown in it.
bool enterRow(const Place& place, GlobalOrdinal row, const Eigen::RowVectorXd* share, Piece& piece) {
  const ContactLayout& contact = *place.side->contact;
  const std::size_t components = contact.directions.size() / contact.firstNodes.size();
  bool isTouched = false;
  for (std::size_t c = 0; c < components; ++c) {
    const double coefficient = place.side->sign * contact.directions[place.row * components + c];
    const int unknown = piece.assembled.unknownOf[place.node * components + c];
    if (coefficient == 0 || unknown < 0)
      continue;
    const double weight = share == nullptr ? 1.0 : (*share)[static_cast<Eigen::Index>(c)];
    piece.rows.push_back({row, unknown, weight * coefficient});
    isTouched = true;
  }
  return isTouched;
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
  for (const scene::SurfaceContact& search : scene.surfaceContacts) {
    const auto& body = scene.bodies[static_cast<std::size_t>(search.first)];
    const int components = body.solid ? componentsOf(body.solid->physics) : 1;
    ContactLayout& contact = contacts.emplace_back(searchContact(search, bodies, components));
    contact.firstRow = firstRow;
    firstRow += contact.numRows();
  }
  return contacts;
}

Rows contactRows(const Layout& layout, const std::vector<ContactLayout>& contacts,
                 const RCP<const Comm>& comm, std::vector<Piece>& pieces) {
  Rows rows;
  if (contacts.empty())
    return rows;
  const std::vector<Side> sides = sidesOf(contacts);
  const std::vector<Place> places = placesOf(sides, pieces);
  const Shares shares(layout, places, pieces, comm);
  for (const Place& place : places) {
    Piece& piece = pieces[place.piece];
    const bool isLowest = piece.sharing.isLowest(piece.part, place.node);
    const Eigen::RowVectorXd* share = shares.at(place);
    const GlobalOrdinal row = place.side->contact->firstRow + static_cast<GlobalOrdinal>(place.row);
    if (isLowest && place.side->sign > 0)
      rows.owned.push_back(row);
    if ((isLowest || share != nullptr) && enterRow(place, row, share, piece))
      rows.touched.push_back(row);
  }
  return rows;
}

double contactGap(const Layout& layout, const std::vector<ContactLayout>& contacts, GlobalOrdinal row) {
  const auto contact = std::find_if(contacts.begin(), contacts.end(),
                                    [row](const ContactLayout& c) { return row < c.firstRow + c.numRows(); });
  const auto place = static_cast<std::size_t>(row - contact->firstRow);
  const std::size_t components = contact->directions.size() / contact->firstNodes.size();
  const auto prescribed = [&](int body, GlobalOrdinal node) {
    double sum = 0;
    for (std::size_t c = 0; c < components; ++c)
      sum +=
          contact->directions[place * components + c] *
          layout.models[static_cast<std::size_t>(body)]->prescribed(node, static_cast<int>(c)).value_or(0.0);
    return sum;
  };
  double gap = contact->gaps[place] - prescribed(contact->firstBody, contact->firstNodes[place]);
  if (contact->secondBody >= 0)
    gap += prescribed(contact->secondBody, contact->secondNodes[place]);
  return gap;
}

} // namespace epafi::decomposition
