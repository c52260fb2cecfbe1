#include "epafi/decomposition/ContactRows.hpp"

#include "epafi/decomposition/ContactPairs.hpp"
#include "epafi/decomposition/ContactSearch.hpp"
#include "epafi/decomposition/KnownRows.hpp"
#include "epafi/decomposition/NodeShares.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace epafi::decomposition {
namespace {

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

/// One row at a node of a piece.
struct Place {
  const Side* side;
  std::size_t row; ///< place among those of the contact
  PieceNode at;
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
          places.push_back({&side, entry->second, {p, static_cast<std::size_t>(found - nodes.begin())}});
      }
    }
  }
  return places;
}

/// Enters one row at a node of a piece; returns whether the piece has a free unknown in it.
bool enterRow(const fem::BodyModel& model, const Place& place, GlobalOrdinal row,
              const Eigen::RowVectorXd* share, Piece& piece) {
  const auto components = static_cast<std::size_t>(model.components());
  const Eigen::Vector3d direction =
      directionAt(model, piece.assembled.nodes[place.at.node], *place.side->contact, place.row);
  const std::span<const int> unknowns =
      std::span(piece.assembled.unknownOf).subspan(place.at.node * components, components);
  double free = 0;
  for (std::size_t c = 0; c < components; ++c)
    if (unknowns[c] >= 0)
      free = std::hypot(free, direction[static_cast<Eigen::Index>(c)]);
  if (free <= heldDirection)
    return false;
  for (std::size_t c = 0; c < components; ++c) {
    const auto component = static_cast<Eigen::Index>(c);
    const double coefficient = place.side->sign * direction[component];
    if (unknowns[c] < 0 || std::abs(coefficient) <= roundOff)
      continue;
    const double weight = share == nullptr ? 1.0 : (*share)[component];
    piece.rows.push_back({row, unknowns[c], weight * coefficient});
  }
  return true;
}

} // namespace

std::vector<ContactLayout> layoutContacts(const scene::Scene& scene, const std::vector<BodyLayout>& bodies) {
  std::vector<ContactLayout> contacts = layoutPairs(scene, bodies);
  KnownRows known;
  for (const scene::SurfaceContact& search : scene.surfaceContacts) {
    const auto& body = scene.bodies[static_cast<std::size_t>(search.first)];
    const int components = body.solid ? componentsOf(body.solid->physics) : 1;
    known.dropFrom(contacts.emplace_back(searchContact(search, bodies, components)));
  }
  GlobalOrdinal firstRow = 0;
  for (ContactLayout& contact : contacts) {
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
  std::vector<PieceNode> nodes;
  for (const Place& place : places)
    nodes.push_back(place.at);
  const NodeShares shares(outlineOf(layout), nodes, pieces, comm);
  for (const Place& place : places) {
    Piece& piece = pieces[place.at.piece];
    const bool isLowest = piece.sharing.isLowest(piece.part, place.at.node);
    const Eigen::RowVectorXd* share = shares.at(place.at);
    const GlobalOrdinal row = place.side->contact->firstRow + static_cast<GlobalOrdinal>(place.row);
    if (isLowest && place.side->sign > 0)
      rows.owned.push_back(row);
    if ((isLowest || share != nullptr) &&
        enterRow(*layout.models[static_cast<std::size_t>(piece.body)], place, row, share, piece))
      rows.touched.push_back(row);
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
