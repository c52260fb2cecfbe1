#include "epafi/deck/DeckSections.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <set>

namespace epafi::deck {
namespace {

using Eigen::Vector3d;
using Corners = std::vector<GlobalOrdinal>;

Corners sortedCorners(const DeckBodies& bodies, const std::pair<GlobalOrdinal, int>& face) {
  Corners corners = bodies.cornersOf(face);
  std::sort(corners.begin(), corners.end());
  return corners;
}

Vector3d pointIn(const Deck& deck, GlobalOrdinal node) {
  const auto found = std::lower_bound(deck.nodes.numbers.begin(), deck.nodes.numbers.end(), node);
  return Vector3d::Map(deck.nodes.points[found - deck.nodes.numbers.begin()].data());
}

/// Adds a face, as triangles around its first corner.
void addGeometry(const Deck& deck, const DeckBodies& bodies, const std::pair<GlobalOrdinal, int>& face,
                 DeckSection& section) {
  const Corners corners = bodies.cornersOf(face);
  Vector3d inside(0, 0, 0);
  for (const GlobalOrdinal node : bodies.nodesOf(face.first))
    inside += pointIn(deck, node) / static_cast<double>(bodies.nodesOf(face.first).size());
  const Vector3d first = pointIn(deck, corners[0]);
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    const Vector3d second = pointIn(deck, corners[k]), third = pointIn(deck, corners[k + 1]);
    Vector3d area = 0.5 * (second - first).cross(third - first);
    if (area.dot(first - inside) < 0)
      area = -area;
    section.area += area.norm();
    section.normal += area;
    section.centre += area.norm() * (first + second + third) / 3;
  }
}

} // namespace

std::optional<DeckSection> sectionAt(const Deck& deck, const DeckBodies& bodies, const Surface& surface) {
  if (surface.ofNodes || surface.faces.empty() || bodies.all().front().type->dimension == 2)
    return std::nullopt;
  DeckSection section;
  std::set<GlobalOrdinal> nodes, side, own;
  std::map<Corners, GlobalOrdinal> cut; // the elements that have the section's faces
  for (const auto& face : surface.faces) {
    const Corners all = bodies.nodesOfFace(face);
    nodes.insert(all.begin(), all.end());
    addGeometry(deck, bodies, face, section);
    cut[sortedCorners(bodies, face)] = face.first;
    own.insert(face.first);
  }
  std::map<Corners, std::vector<GlobalOrdinal>> neighbours; // of elements that touch the section
  std::map<GlobalOrdinal, std::vector<Corners>> facesOf;
  for (const DeckBody& body : bodies.all())
    for (const GlobalOrdinal element : body.elements) {
      const auto all = bodies.nodesOf(element);
      if (std::none_of(all.begin(), all.end(), [&](GlobalOrdinal node) { return nodes.contains(node); }))
        continue;
      for (int label = 1; label <= std::ssize(bodies.typeOf(element).faces); ++label) {
        Corners corners = sortedCorners(bodies, {element, label});
        const auto found = cut.find(corners);
        if (found != cut.end()) {
          if (found->second != element && own.contains(element))
            return std::nullopt; // both sides of a face
          continue;
        }
        neighbours[corners].push_back(element);
        facesOf[element].push_back(std::move(corners));
      }
    }
  std::vector<GlobalOrdinal> next(own.begin(), own.end());
  side = own;
  while (!next.empty()) {
    const GlobalOrdinal element = next.back();
    next.pop_back();
    for (const Corners& corners : facesOf[element])
      for (const GlobalOrdinal other : neighbours[corners])
        if (side.insert(other).second)
          next.push_back(other);
  }
  for (const DeckBody& body : bodies.all())
    for (const GlobalOrdinal element : body.elements)
      for (int label = 1; side.contains(element) && label <= std::ssize(bodies.typeOf(element).faces);
           ++label)
        if (const auto found = cut.find(sortedCorners(bodies, {element, label}));
            found != cut.end() && found->second != element)
          return std::nullopt; // they hang together around the section
  for (const GlobalOrdinal element : side)
    for (const GlobalOrdinal node : bodies.nodesOf(element))
      if (nodes.contains(node))
        section.nodesOfElements.emplace_back(element, node);
  section.centre /= section.area;
  if (section.normal.norm() > 1e-9 * section.area)
    section.normal.normalize();
  return section;
}

} // namespace epafi::deck
