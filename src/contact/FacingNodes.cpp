#include "epafi/contact/FacingNodes.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/BoxTree.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

namespace epafi::contact {
namespace {

using Eigen::Vector3d;

/// Nodes face each other if what lies between them is normal to the surfaces up to this share of their
/// spacing.
constexpr double matchTolerance = 1e-2;

/// Boxes of no extent around points.
std::vector<mesh::BoxTree::Box> boxesOf(const std::vector<Vector3d>& points) {
  std::vector<mesh::BoxTree::Box> boxes;
  for (const Vector3d& x : points)
    boxes.push_back({Point{x[0], x[1], x[2]}, Point{x[0], x[1], x[2]}});
  return boxes;
}

/// The box around two points, with a margin.
mesh::BoxTree::Box boxAround(const Vector3d& a, const Vector3d& b, double margin) {
  return mesh::boxOf(std::array{Point{a[0], a[1], a[2]}, Point{b[0], b[1], b[2]}}, margin);
}

/// The first node that has no partner and is near to the other surface, or `alone`.
std::size_t lonelyNode(const ContactTerms& contact, const SurfaceNodes& surface, const SurfaceNodes& other,
                       const std::vector<char>& isPaired) {
  const mesh::BoxTree tree(boxesOf(other.points));
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

using Corners = std::vector<std::size_t>;

/// A facet's corners after renumbering, sorted; `alone`, if there is one, comes last.
Corners cornersAs(const SurfaceNodes::Facet& facet, const Corners& number) {
  Corners corners(facet.nodes.begin(), facet.nodes.begin() + facet.numCorners);
  for (std::size_t& corner : corners)
    corner = number[corner];
  std::sort(corners.begin(), corners.end());
  return corners;
}

/// Corners of the facets whose corners all have a place after renumbering, each sorted, all sorted.
std::vector<Corners> facetsAs(const SurfaceNodes& surface, const Corners& number) {
  std::vector<Corners> facets;
  for (const SurfaceNodes::Facet& facet : surface.facets) {
    Corners corners = cornersAs(facet, number);
    if (corners.back() != FacingNodes::alone)
      facets.push_back(std::move(corners));
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

/// Those of nodes that a pair has: each itself, all others alone.
Corners usedNodes(const SurfaceNodes& second, const Corners& partner) {
  Corners itself(second.nodes.size(), FacingNodes::alone);
  for (const std::size_t j : partner)
    if (j != FacingNodes::alone)
      itself[j] = j;
  return itself;
}

/// See FacingNodes::isCommon. Where facets of different forms lie between the same nodes, all whose nodes
/// have a partner are.
std::vector<char> commonFacets(const SurfaceNodes& first, const SurfaceNodes& second,
                               const Corners& partner) {
  const std::vector<Corners> theirs = facetsAs(second, usedNodes(second, partner));
  std::vector<char> isCommon;
  for (const bool needsCounterpart : {true, false}) {
    isCommon.clear();
    for (const SurfaceNodes::Facet& facet : first.facets) {
      const Corners corners = cornersAs(facet, partner);
      isCommon.push_back(
          corners.back() != FacingNodes::alone &&
                  (!needsCounterpart || std::binary_search(theirs.begin(), theirs.end(), corners))
              ? 1
              : 0);
    }
    if (std::find(isCommon.begin(), isCommon.end(), 1) != isCommon.end())
      break;
  }
  return isCommon;
}

/// Unit normals of the faces at a node.
std::vector<Vector3d> faceNormals(const SurfaceNodes& surface, std::size_t i) {
  if (surface.faces[i].empty())
    return {surface.normals[i]};
  std::vector<Vector3d> normals;
  for (const Vector3d& face : surface.faces[i])
    normals.push_back(face.normalized());
  return normals;
}

/// The mean of the faces of a node that face some normals better than `cosine`, and how many they are.
std::pair<Vector3d, int> meanFacing(const SurfaceNodes& surface, std::size_t i,
                                    const std::vector<Vector3d>& others, double cosine) {
  if (surface.faces[i].empty())
    return {surface.normals[i], 1};
  std::pair<Vector3d, int> mean{Vector3d::Zero(), 0};
  for (const Vector3d& face : surface.faces[i])
    if (std::any_of(others.begin(), others.end(),
                    [&](const Vector3d& other) { return other.dot(face.normalized()) <= cosine; })) {
      mean.first += face;
      ++mean.second;
    }
  mean.first.normalize();
  return mean;
}

} // namespace

RowAreas areasOf(const ContactTerms& contact, const SurfaceNodes& surface,
                 const std::function<bool(std::size_t facet, std::size_t node)>& counts) {
  std::vector<char> hasFacet(surface.nodes.size(), 0);
  RowAreas areas(contact, hasFacet.size());
  const auto addFacets = [&](const auto& counted) {
    for (std::size_t f = 0; f < surface.facets.size(); ++f)
      for (std::size_t a = 0; a < surface.facets[f].nodes.size(); ++a)
        if (const std::size_t i = surface.facets[f].nodes[a]; counted(f, i))
          areas.add(f, i, surface.facets[f].shares[a]);
  };
  addFacets([&](std::size_t f, std::size_t i) {
    const bool is = counts(f, i);
    hasFacet[i] = hasFacet[i] != 0 || is ? 1 : 0;
    return is;
  });
  const std::vector<char> had = hasFacet;
  addFacets([&](std::size_t, std::size_t i) { return had[i] == 0; });
  return areas;
}

Facing facingOf(const SurfaceNodes& first, std::size_t i, const SurfaceNodes& second, std::size_t j) {
  if (first.faces[i].empty() && second.faces[j].empty())
    return {(first.normals[i] - second.normals[j]).normalized(), first.normals[i].dot(second.normals[j]),
            false};
  const std::vector<Vector3d> own = faceNormals(first, i), other = faceNormals(second, j);
  double best = 1;
  for (const Vector3d& a : own)
    for (const Vector3d& b : other)
      best = std::min(best, a.dot(b));
  const auto [mine, numMine] = meanFacing(first, i, other, best + asGood);
  const auto [theirs, numTheirs] = meanFacing(second, j, own, best + asGood);
  return {(mine - theirs).normalized(), mine.dot(theirs), numMine + numTheirs > 2};
}

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

FacingNodes facingNodes(const ContactTerms& contact, const SurfaceNodes& first, const SurfaceNodes& second) {
  FacingNodes pairs{std::vector<std::size_t>(first.nodes.size()), std::vector<char>(first.facets.size(), 1)};
  std::iota(pairs.partner.begin(), pairs.partner.end(), std::size_t{0});
  if (contact.coincide)
    return pairs;
  const std::vector<mesh::BoxTree::Box> boxes = boxesOf(second.points);
  const mesh::BoxTree tree(boxes);
  double size = 0; // of both surfaces: nothing is farther away
  for (const auto* points : {&first.points, &second.points})
    for (const Vector3d& point : *points)
      size = std::max(size, (point - first.points.front()).norm());
  std::vector<std::size_t> found;
  std::vector<double> distances(first.nodes.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < first.nodes.size(); ++i) {
    const double tolerance = matchTolerance * first.spacings[i], reach = 2 * size;
    pairs.partner[i] = FacingNodes::alone;
    // The normal is that of both surfaces' mean: on curved ones not quite the line that the box is around.
    const double around = tolerance + std::min(reach, first.spacings[i]);
    for (const Vector3d& outwards : faceNormals(first, i)) {
      tree.meeting(boxAround(first.points[i] - reach * outwards, first.points[i] + reach * outwards, around),
                   found);
      for (const std::size_t j : found) {
        const Vector3d between = second.points[j] - first.points[i];
        const Facing facing = facingOf(first, i, second, j);
        const double along = facing.normal.dot(between);
        if (along < 0 && contact.thickness && -along > contact.thickness(facing.normal))
          continue; // a far side
        if ((between - along * facing.normal).norm() <= tolerance && std::abs(along) < distances[i] &&
            facing.cosine < 0) {
          distances[i] = std::abs(along);
          pairs.partner[i] = j;
        }
      }
    }
  }
  pairs.isCommon = commonFacets(first, second, pairs.partner);
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (distances[i] > contact.distance)
      pairs.partner[i] = FacingNodes::alone;
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
  const std::vector<Corners> facets = facetsAs(first, pairs.partner);
  return !facets.empty() && // a few nodes may face each other by chance
         facets == facetsAs(second, usedNodes(second, pairs.partner));
}

} // namespace epafi::contact
