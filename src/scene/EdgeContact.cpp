#include "epafi/scene/EdgeContact.hpp"

#include "epafi/base/ParameterValue.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::scene {
namespace {

/// What speaks against an edge of a body in this contact.
std::string objectionTo(const Scene& scene, std::size_t contact, int body, const std::string& edge) {
  const Body& owner = scene.bodies[body];
  if (std::find(edges.begin(), edges.end(), edge) == edges.end())
    return "body \"" + owner.name + "\" has no edge \"" + edge + '"';
  const std::string that = "that edge of body \"" + owner.name + "\" ";
  for (const fem::SolidSupport& support : owner.supports)
    if (support.surface == edge)
      return that + "has the support \"" + support.name + "\"; an edge is either supported or in contact";
  for (std::size_t c = 0; c < contact; ++c) {
    const SurfaceContact& other = scene.contacts[c];
    if ((other.first == body && other.firstSurface == edge) ||
        (other.second == body && other.secondSurface == edge))
      return that + "is in the contact pair \"" + other.name + "\" already";
  }
  return "";
}

} // namespace

EdgeSegment segmentOf(const mesh::Box& rectangle, const std::string& edge) {
  const Vector3 &lower = rectangle.lower, &upper = rectangle.upper;
  if (edge == "left" || edge == "right")
    return {true, edge == "left" ? lower[0] : upper[0], lower[1], upper[1]};
  return {false, edge == "bottom" ? lower[1] : upper[1], lower[0], upper[0]};
}

std::string toString(const EdgeSegment& segment) {
  const std::string along = valueText(segment.from) + " to " + valueText(segment.to);
  return (segment.isVertical ? "x = " : "y = ") + valueText(segment.at) + ", " +
         (segment.isVertical ? "y" : "x") + " from " + along;
}

bool coincide(const EdgeSegment& a, const EdgeSegment& b) {
  const double tolerance = 1e-10 * std::min(a.to - a.from, b.to - b.from);
  const auto isNear = [tolerance](double x, double y) { return std::abs(x - y) <= tolerance; };
  return a.isVertical == b.isVertical && isNear(a.at, b.at) && isNear(a.from, b.from) && isNear(a.to, b.to);
}

bool isAlongEdges(const Scene& scene, const SurfaceContact& contact) {
  return contact.second >= 0 && isMembraneOnRectangle(scene.bodies[contact.first]) &&
         isMembraneOnRectangle(scene.bodies[contact.second]);
}

std::optional<EdgeFault> faultOf(const Scene& scene, std::size_t contact) {
  const SurfaceContact& pair = scene.contacts[contact];
  if (const std::string objection = objectionTo(scene, contact, pair.first, pair.firstSurface);
      !objection.empty())
    return EdgeFault{0, objection};
  if (const std::string objection = objectionTo(scene, contact, pair.second, pair.secondSurface);
      !objection.empty())
    return EdgeFault{1, objection};
  if (pair.first == pair.second)
    return EdgeFault{1, "a body cannot be in contact with itself"};
  const Body& first = scene.bodies[pair.first];
  const Body& second = scene.bodies[pair.second];
  const EdgeSegment a = segmentOf(first.mesh.box, pair.firstSurface),
                    b = segmentOf(second.mesh.box, pair.secondSurface);
  if (!coincide(a, b))
    return EdgeFault{-1, "joins edges that do not coincide: \"" + pair.firstSurface + "\" of body \"" +
                             first.name + "\" is " + toString(a) + ", but \"" + pair.secondSurface +
                             "\" of body \"" + second.name + "\" is " + toString(b)};
  const int m = first.mesh.elements[a.isVertical ? 1 : 0], n = second.mesh.elements[b.isVertical ? 1 : 0];
  if (m != n && pair.coupling == SurfaceContact::Coupling::nodes)
    return EdgeFault{-1, "joins edges with different numbers of elements: " + std::to_string(m) +
                             " on body \"" + first.name + "\", but " + std::to_string(n) + " on body \"" +
                             second.name + "\"; leave the coupling to mortars"};
  return std::nullopt;
}

} // namespace epafi::scene
