#include "epafi/contact/ContactSearch.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/contact/FacetTree.hpp"
#include "epafi/fem/ElementGeometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

/// Nodes face each other if what lies between them is normal to the surfaces up to this share of their spacing.
constexpr double matchTolerance = 1e-2;

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
    layout.directions.push_back(direction[c]);
  layout.gaps.push_back(gap);
  layout.areas.push_back(area);
}

/// Boxes of no extent around points.
std::vector<FacetTree::Box> boxesOf(const std::vector<Vector3d>& points) {
  std::vector<FacetTree::Box> boxes;
  for (const Vector3d& x : points)
    boxes.push_back({fem::Point{x[0], x[1], x[2]}, fem::Point{x[0], x[1], x[2]}});
  return boxes;
}

/// The box around two points, with a margin.
FacetTree::Box boxAround(const Vector3d& a, const Vector3d& b, double margin) {
  return fem::boxOf(std::array{fem::Point{a[0], a[1], a[2]}, fem::Point{b[0], b[1], b[2]}}, margin);
}

/// The first node that has no partner and is near to the other surface, or `alone`.
std::size_t lonelyNode(const ContactTerms& contact, const SurfaceNodes& surface, const SurfaceNodes& other,
                       const std::vector<char>& isPaired) {
  const FacetTree tree(boxesOf(other.points));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < isPaired.size(); ++i) {
    if (isPaired[i] != 0)
      continue;
    const double reach = std::min(contact.distance, 2 * surface.spacings[i]);
    tree.meeting(boxAround(surface.points[i], surface.points[i], reach), found);
    if (std::any_of(found.begin(), found.end(),
                    [&](std::size_t j) { return (other.points[j] - surface.points[i]).norm() <= reach; }))
      return i;
  }
  return FacingNodes::alone;
}

/// Nodes of both surfaces, near the other one, that have no partner.
struct LonelyNodes {
  std::size_t first, second;
};

LonelyNodes lonelyNodes(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                        const FacingNodes& pairs) {
  std::vector<char> isPaired(first.nodes.size(), 0), isUsed(second.nodes.size(), 0);
  for (std::size_t i = 0; i < isPaired.size(); ++i)
    if (const std::size_t j = pairs.partner[i]; j != FacingNodes::alone)
      isPaired[i] = isUsed[j] = 1;
  return {lonelyNode(contact, first, second, isPaired), lonelyNode(contact, second, first, isUsed)};
}

bool isUsedTwice(const FacingNodes& pairs) {
  std::vector<std::size_t> used;
  std::copy_if(pairs.partner.begin(), pairs.partner.end(), std::back_inserter(used),
               [](std::size_t j) { return j != FacingNodes::alone; });
  std::sort(used.begin(), used.end());
  return std::adjacent_find(used.begin(), used.end()) != used.end();
}

/// Corners of the facets whose corners all have a place after renumbering, each sorted, all sorted.
std::vector<std::vector<std::size_t>> facetsAs(const SurfaceNodes& surface,
                                               const std::vector<std::size_t>& number) {
  std::vector<std::vector<std::size_t>> facets;
  for (std::vector<std::size_t> corners : surface.facets) {
    for (std::size_t& corner : corners)
      corner = number[corner];
    std::sort(corners.begin(), corners.end());
    if (corners.back() != FacingNodes::alone)
      facets.push_back(std::move(corners));
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

/// Throws if both surfaces have nodes left over that are near the other one.
void requireMatch(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                  const FacingNodes& pairs) {
  const auto [lonelyFirst, lonelySecond] = lonelyNodes(contact, first, second, pairs);
  if (lonelyFirst != FacingNodes::alone && lonelySecond != FacingNodes::alone)
    throw refusal(contact,
                  "the surfaces do not match: neither the node at " + text(first.points[lonelyFirst]) +
                      " of the first nor that at " + text(second.points[lonelySecond]) +
                      " of the second faces a node of the other; mesh them alike, or couple them by mortars");
  if (isUsedTwice(pairs))
    throw refusal(contact,
                  "two nodes of the first surface face the same one of the second; mesh them alike, or "
                  "couple them by mortars");
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

FacingNodes facingNodes(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second) {
  FacingNodes pairs{std::vector<std::size_t>(first.nodes.size())};
  std::iota(pairs.partner.begin(), pairs.partner.end(), std::size_t{0});
  if (contact.coincide)
    return pairs;
  const std::vector<FacetTree::Box> boxes = boxesOf(second.points);
  const FacetTree tree(boxes);
  double size = 0; // of both surfaces: nothing is farther away
  for (const auto* points : {&first.points, &second.points})
    for (const Vector3d& point : *points)
      size = std::max(size, (point - first.points.front()).norm());
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < first.nodes.size(); ++i) {
    const double tolerance = matchTolerance * first.spacings[i], reach = std::min(contact.distance, 2 * size);
    double nearest = std::numeric_limits<double>::infinity();
    pairs.partner[i] = FacingNodes::alone;
    // The normal is that of both surfaces' mean: on curved ones not quite the line that the box is around.
    const double around = tolerance + std::min(reach, first.spacings[i]);
    tree.meeting(boxAround(first.points[i] - reach * first.normals[i],
                           first.points[i] + reach * first.normals[i], around),
                 found);
    for (const std::size_t j : found) {
      const Vector3d between = second.points[j] - first.points[i];
      const Vector3d normal = (first.normals[i] - second.normals[j]).normalized();
      const double along = normal.dot(between);
      if (std::abs(along) <= contact.distance && (between - along * normal).norm() <= tolerance &&
          std::abs(along) < nearest && first.normals[i].dot(second.normals[j]) < 0) {
        nearest = std::abs(along);
        pairs.partner[i] = j;
      }
    }
  }
  return pairs;
}

bool areAlike(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second) {
  if (contact.coincide)
    return true;
  ContactTerms anywhere = contact; // with a distance a single pair might be all that is left
  anywhere.distance = std::numeric_limits<double>::infinity();
  const FacingNodes pairs = facingNodes(anywhere, first, second);
  if (isUsedTwice(pairs))
    return false;
  const LonelyNodes lonely = lonelyNodes(anywhere, first, second, pairs);
  if (lonely.first != FacingNodes::alone && lonely.second != FacingNodes::alone)
    return false;
  std::vector<std::size_t> itself(second.nodes.size(), FacingNodes::alone);
  for (const std::size_t j : pairs.partner)
    if (j != FacingNodes::alone)
      itself[j] = j;
  const std::vector<std::vector<std::size_t>> facets = facetsAs(first, pairs.partner);
  return !facets.empty() && facets == facetsAs(second, itself); // a few nodes may face each other by chance
}

ContactLayout meetSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                          const FacingNodes& pairs) {
  if (!contact.coincide)
    requireMatch(contact, first, second, pairs);
  ContactLayout layout;
  layout.name = contact.name;
  for (std::size_t i = 0; i < pairs.partner.size(); ++i) {
    const std::size_t j = pairs.partner[i];
    if (j == FacingNodes::alone)
      continue;
    const Vector3d normal = contact.components == 1 ? Vector3d(contact.sense, 0, 0)
                                                    : (first.normals[i] - second.normals[j]).normalized();
    layout.firstNodes.push_back(first.nodes[i]);
    layout.secondNodes.push_back(second.shares[j]);
    const double gap = contact.components == 1 ? 0.0 : normal.dot(second.points[j] - first.points[i]);
    addRow(normal, gap + contact.gap, first.areas[i], contact.components, layout);
  }
  requireRows(contact, layout);
  return layout;
}

ContactLayout tieSurface(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second,
                         const FacingNodes& pairs, const Eigen::Matrix3d& axes) {
  if (!contact.coincide)
    requireMatch(contact, first, second, pairs);
  ContactLayout layout;
  layout.name = contact.name;
  for (int c = 0; c < contact.components; ++c)
    for (std::size_t i = 0; i < pairs.partner.size(); ++i) {
      const std::size_t j = pairs.partner[i];
      if (j == FacingNodes::alone)
        continue;
      layout.firstNodes.push_back(first.nodes[i]);
      layout.secondNodes.push_back(second.shares[j]);
      addRow(axes.col(c), 0.0, first.areas[i], contact.components, layout);
    }
  requireRows(contact, layout);
  return layout;
}

} // namespace epafi::contact
