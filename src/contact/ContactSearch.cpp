#include "epafi/contact/ContactSearch.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

/// Facets whose normals have a smaller cosine with a direction lie beside what is there.
constexpr double beside = 0.2;

/// Direction from a point to the nearest one of an obstacle, and the distance.
struct Approach {
  Vector3d direction; ///< of a deflection ±1 and zeros
  double gap;
};

std::optional<Approach> approachTo(const Obstacle& obstacle, const Vector3d& point, int dimension) {
  Vector3d offset = point - obstacle.point;
  if (dimension == 2)
    offset[2] = 0;
  if (obstacle.kind == Obstacle::Kind::plane)
    return Approach{-obstacle.normal, obstacle.normal.dot(offset)};
  if (obstacle.kind == Obstacle::Kind::cylinder)
    offset -= obstacle.normal.dot(offset) * obstacle.normal;
  const double outwards = obstacle.isHollow ? -1 : 1;
  return Approach{-outwards * offset.normalized(), outwards * (offset.norm() - obstacle.radius)};
}

/// What may stop the deflection at a point of a membrane at z = 0, and how far away it is; nothing: a line
/// along z misses the obstacle.
std::optional<Approach> approachAlongZ(const Obstacle& obstacle, const Vector3d& point) {
  Vector3d offset = point - obstacle.point, z(0, 0, 1);
  if (obstacle.kind == Obstacle::Kind::plane)
    return Approach{Vector3d(-std::copysign(1, obstacle.normal[2]), 0, 0),
                    obstacle.normal.dot(offset) / std::abs(obstacle.normal[2])};
  if (obstacle.kind == Obstacle::Kind::cylinder) {
    offset -= obstacle.normal.dot(offset) * obstacle.normal;
    z -= obstacle.normal[2] * obstacle.normal;
  }
  // |offset + t z| = radius
  const double zz = z.squaredNorm(), middle = -z.dot(offset) / zz;
  const double half = middle * middle - (offset.squaredNorm() - obstacle.radius * obstacle.radius) / zz;
  if (half <= 0)
    return std::nullopt;
  return Approach{Vector3d(middle == 0 ? 0 : std::copysign(1, middle), 0, 0),
                  std::abs(middle) - std::sqrt(half)};
}

void addRow(const Vector3d& direction, double gap, int components, ContactLayout& layout) {
  for (int c = 0; c < components; ++c)
    layout.directions.push_back(direction[c]);
  layout.gaps.push_back(gap);
}

void requireRows(const ContactTerms& contact, const ContactLayout& layout) {
  if (layout.firstNodes.empty() && contact.firstSurface.empty())
    throw refusal(contact, "no node of the membrane lies under or over the obstacle within the distance");
  if (layout.firstNodes.empty())
    throw refusal(contact, "no node of the surface '" + contact.firstSurface +
                               (std::isfinite(contact.distance)
                                    ? "' is near enough to the other side to meet it; enlarge the distance"
                                    : "' faces a node of the other side; check which surfaces are to meet"));
}

/// Whether no force acts on a row that is a spring: middles carry all near the axis of a solid of revolution.
bool isSpringless(const ContactTerms& contact, const RowAreas& areas, const SurfaceNodes& first,
                  std::size_t i) {
  constexpr double roundOff = 1e-9;
  return contact.isOfRevolution && contact.givesWay &&
         areas.of(i) <= roundOff * first.spacings[i] * first.spacings[i];
}

/// Of two surfaces: no row as yet, and the areas of nodes.
std::pair<ContactLayout, RowAreas> begun(const ContactTerms& contact, const SurfaceNodes& first,
                                         const SurfaceNodes& second, const FacingNodes& pairs) {
  if (!contact.coincide)
    requireMatch(contact, first, second, pairs);
  ContactLayout layout;
  layout.name = contact.name;
  return {std::move(layout),
          areasOf(contact, first, [&](std::size_t f, std::size_t) { return pairs.isCommon[f] != 0; })};
}

} // namespace

ContactLayout meetObstacle(const ContactTerms& contact, const SurfaceNodes& first, const Obstacle& obstacle) {
  const bool isDeflection = contact.components == 1;
  const auto approach = [&](std::size_t i) {
    return isDeflection ? approachAlongZ(obstacle, first.points[i])
                        : approachTo(obstacle, first.points[i], contact.dimension);
  };
  ContactLayout layout;
  layout.name = contact.name;
  const RowAreas areas = areasOf(contact, first, [&](std::size_t f, std::size_t i) {
    return isDeflection || first.faces[i].empty() ||
           first.facets[f].normal.dot(approach(i)->direction) > beside;
  });
  bool isAnyNear = false;
  for (std::size_t i = 0; i < first.nodes.size(); ++i) {
    const std::optional<Approach> found = approach(i);
    if (!found || found->gap > contact.distance)
      continue;
    isAnyNear = true;
    const double before = layout.directions.empty() ? found->direction[0] : layout.directions[0];
    if (isDeflection && found->direction[0] * before <= 0)
      throw refusal(contact, "the middle of the obstacle does not lie on one side of the membrane (at " +
                                 text(first.points[i]) + "); move the obstacle");
    if (found->direction.norm() < 0.5) // there is no nearest point
      throw refusal(contact, "the node at " + text(first.points[i]) +
                                 " lies in the centre of the obstacle; move the obstacle");
    if ((!isDeflection && first.normals[i].dot(found->direction) <= 0) ||
        isSpringless(contact, areas, first, i))
      continue;
    layout.firstNodes.push_back(first.nodes[i]);
    addRow(found->direction, contact.gapOf(first.nodes[i], found->gap), contact.components, layout);
    areas.enter(i, layout);
  }
  if (isAnyNear && layout.firstNodes.empty())
    throw refusal(contact, "the surface '" + contact.firstSurface + "' faces away from the obstacle; " +
                               (obstacle.kind == Obstacle::Kind::plane
                                    ? "does the obstacle's normal point to the body?"
                                : obstacle.isHollow ? "is the body inside of the obstacle?"
                                                    : "is the centre of the obstacle inside the body?"));
  requireRows(contact, layout);
  return layout;
}

ContactLayout meetSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                          const FacingNodes& pairs) {
  auto [layout, areas] = begun(contact, first, second, pairs);
  for (std::size_t i = 0; i < pairs.partner.size(); ++i) {
    const std::size_t j = pairs.partner[i];
    if (j == FacingNodes::alone || isSpringless(contact, areas, first, i))
      continue;
    Vector3d normal(contact.sense, 0, 0);
    if (contact.components > 1) {
      const Facing facing = facingOf(first, i, second, j);
      normal = facing.normal;
      layout.numBent += facing.isBent ? 1 : 0;
    }
    layout.firstNodes.push_back(first.nodes[i]);
    layout.secondNodes.push_back(second.shares[j]);
    const double gap = contact.components == 1 ? 0.0 : normal.dot(second.points[j] - first.points[i]);
    addRow(normal, contact.gapOf(first.nodes[i], gap), contact.components, layout);
    areas.enter(i, layout);
  }
  requireRows(contact, layout);
  return layout;
}

ContactLayout tieSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                         const FacingNodes& pairs, const Eigen::Matrix3d& axes) {
  auto [layout, areas] = begun(contact, first, second, pairs);
  for (int c = 0; c < contact.components; ++c)
    for (std::size_t i = 0; i < pairs.partner.size(); ++i) {
      const std::size_t j = pairs.partner[i];
      if (j == FacingNodes::alone)
        continue;
      layout.firstNodes.push_back(first.nodes[i]);
      layout.secondNodes.push_back(second.shares[j]);
      addRow(axes.col(c), 0.0, contact.components, layout);
      areas.enter(i, layout);
    }
  requireRows(contact, layout);
  return layout;
}

} // namespace epafi::contact
