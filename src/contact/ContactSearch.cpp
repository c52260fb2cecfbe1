#include "epafi/contact/ContactSearch.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

/// Nodes face each other if what lies between them is normal to the surfaces up to this share of their spacing.
constexpr double matchTolerance = 1e-2;

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

InputError refusal(const ContactTerms& contact, const std::string& what) {
  return InputError("contact '" + contact.name + "': " + what);
}

/// Direction from a point to the nearest one of an obstacle, and the distance.
struct Approach {
  Vector3d direction;
  double gap;
};

Approach approachTo(const Obstacle& obstacle, const Vector3d& point, int dimension) {
  Vector3d offset = point - obstacle.point;
  if (dimension == 2)
    offset[2] = 0;
  if (obstacle.kind == Obstacle::Kind::plane)
    return {-obstacle.normal, obstacle.normal.dot(offset)};
  return {-offset.normalized(), offset.norm() - obstacle.radius};
}

void addRow(const Vector3d& direction, double gap, double area, int components, ContactLayout& layout) {
  for (int c = 0; c < components; ++c)
    layout.directions.push_back(components == 1 ? 1.0 : direction[c]);
  layout.gaps.push_back(gap);
  layout.areas.push_back(area);
}

/// For each node of a surface the node of the other that it faces, or none. Nodes are sorted along one axis: those
/// farther away along it than the distance are not looked at; without a distance all are.
std::vector<std::size_t> findPartners(const SurfaceNodes& first, const SurfaceNodes& second,
                                      double distance) {
  std::vector<std::size_t> order(second.nodes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Vector3d lower = first.points.front(), upper = lower;
  for (const Vector3d& point : first.points) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  int axis = 0;
  (upper - lower).maxCoeff(&axis);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return second.points[a][axis] < second.points[b][axis]; });

  std::vector<std::size_t> partner(first.nodes.size(), none);
  for (std::size_t i = 0; i < first.nodes.size(); ++i) {
    const double tolerance = matchTolerance * first.spacings[i];
    double nearest = std::numeric_limits<double>::infinity();
    const double reach = distance + tolerance, from = first.points[i][axis] - reach;
    auto next = std::lower_bound(order.begin(), order.end(), from,
                                 [&](std::size_t j, double x) { return second.points[j][axis] < x; });
    for (; next != order.end() && second.points[*next][axis] <= first.points[i][axis] + reach; ++next) {
      const std::size_t j = *next;
      const Vector3d between = second.points[j] - first.points[i];
      const Vector3d normal = (first.normals[i] - second.normals[j]).normalized();
      const double along = normal.dot(between);
      if (std::abs(along) <= distance && (between - along * normal).norm() <= tolerance &&
          std::abs(along) < nearest && first.normals[i].dot(second.normals[j]) < 0) {
        nearest = std::abs(along);
        partner[i] = j;
      }
    }
  }
  return partner;
}

/// Throws if both surfaces have nodes left over that are near the other one.
void requireMatch(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                  const std::vector<std::size_t>& partner) {
  std::vector<char> isUsed(second.nodes.size(), 0);
  for (const std::size_t j : partner)
    if (j != none)
      isUsed[j] = 1;
  const auto isNear = [&](const SurfaceNodes& surface, std::size_t place, const SurfaceNodes& other) {
    const double reach = std::min(contact.distance, 2 * surface.spacings[place]);
    return std::any_of(other.points.begin(), other.points.end(), [&](const Vector3d& point) {
      return (point - surface.points[place]).norm() <= reach;
    });
  };
  std::size_t lonelyFirst = none, lonelySecond = none;
  for (std::size_t i = 0; i < partner.size() && lonelyFirst == none; ++i)
    if (partner[i] == none && isNear(first, i, second))
      lonelyFirst = i;
  for (std::size_t j = 0; j < isUsed.size() && lonelySecond == none; ++j)
    if (isUsed[j] == 0 && isNear(second, j, first))
      lonelySecond = j;
  if (lonelyFirst != none && lonelySecond != none)
    throw refusal(contact, "the surfaces do not match: neither the node at " +
                               text(first.points[lonelyFirst]) + " of the first nor that at " +
                               text(second.points[lonelySecond]) +
                               " of the second faces a node of the other; mesh them alike");
}

void requireRows(const ContactTerms& contact, const ContactLayout& layout) {
  if (layout.firstNodes.empty())
    throw refusal(contact, "no node of the surface '" + contact.firstSurface +
                               (std::isfinite(contact.distance)
                                    ? "' is near enough to the other side to meet it; enlarge the distance"
                                    : "' faces a node of the other side; check which surfaces are to meet"));
}

} // namespace

ContactLayout meetObstacle(const ContactTerms& contact, const SurfaceNodes& first, const Obstacle& obstacle) {
  ContactLayout layout;
  layout.name = contact.name;
  bool isAnyNear = false;
  for (std::size_t i = 0; i < first.nodes.size(); ++i) {
    const auto [direction, gap] = approachTo(obstacle, first.points[i], contact.dimension);
    if (gap > contact.distance)
      continue;
    isAnyNear = true;
    if (direction.norm() < 0.5) // a node in the centre of a sphere has no nearest point
      throw refusal(contact, "the node at " + text(first.points[i]) +
                                 " lies in the centre of the obstacle; move the obstacle");
    if (first.normals[i].dot(direction) <= 0)
      continue;
    layout.firstNodes.push_back(first.nodes[i]);
    addRow(direction, gap + contact.gap, first.areas[i], contact.dimension, layout);
  }
  if (isAnyNear && layout.firstNodes.empty())
    throw refusal(contact, "the surface '" + contact.firstSurface + "' faces away from the obstacle; " +
                               (obstacle.kind == Obstacle::Kind::plane
                                    ? "does the obstacle's normal point to the body?"
                                    : "is the centre of the obstacle inside the body?"));
  requireRows(contact, layout);
  return layout;
}

ContactLayout meetSurface(const ContactTerms& contact, const SurfaceNodes& first,
                          const SurfaceNodes& second) {
  ContactLayout layout;
  layout.name = contact.name;
  std::vector<std::size_t> partner(first.nodes.size());
  std::iota(partner.begin(), partner.end(), std::size_t{0});
  if (!contact.coincide) {
    partner = findPartners(first, second, contact.distance);
    requireMatch(contact, first, second, partner);
  }
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i] == none)
      continue;
    const std::size_t j = partner[i];
    const Vector3d normal = (first.normals[i] - second.normals[j]).normalized();
    layout.firstNodes.push_back(first.nodes[i]);
    layout.secondNodes.push_back(second.shares[j]);
    const double gap = contact.components == 1 ? 0.0 : normal.dot(second.points[j] - first.points[i]);
    addRow(normal, gap + contact.gap, first.areas[i], contact.components, layout);
  }
  std::erase(partner, none);
  std::sort(partner.begin(), partner.end());
  if (std::adjacent_find(partner.begin(), partner.end()) != partner.end())
    throw refusal(contact, "two nodes of the first surface face the same one of the second; mesh them alike");
  requireRows(contact, layout);
  return layout;
}

} // namespace epafi::contact
