#include "epafi/contact/CoveringFacets.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/mesh/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace epafi::contact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Facets face each other if their normals are this far from orthogonal.
constexpr double facing = -0.2;
/// Pieces of a facet below this share of it are slivers, which round-off makes.
constexpr double sliver = 1e-12;

/// Whether two sets of pieces overlap by more than round-off.
bool overlap(const Common& a, const Common& b, int dimension) {
  Polygon polygon, work;
  for (const Polygon& p : a.pieces)
    for (const Polygon& q : b.pieces) {
      double area = 0;
      if (dimension == 2) {
        area = std::min(p[1][0], q[1][0]) - std::max(p[0][0], q[0][0]);
      } else {
        polygon = p;
        clip(polygon, q, work);
        area = areaOf(polygon);
      }
      if (area > 1e-6 * std::min(a.area, b.area))
        return true;
    }
  return false;
}

} // namespace

CoveringFacets::CoveringFacets(const ContactTerms& terms, const PlacedSurface& first,
                               const PlacedSurface& second)
    : terms_(terms), first_(viewsOf(first)), second_(viewsOf(second)), tree_(boxesOf(second_)) {
  size_ = mesh::diameterOf(boxOfAll());
  reach_ = std::min(terms.distance, size_);
}

ViewPlane CoveringFacets::viewPlane(std::size_t f) const {
  return ViewPlane::across(first_[f].centre(), first_[f].normal(), terms_.dimension);
}

std::vector<FacetView> CoveringFacets::viewsOf(const PlacedSurface& placed) {
  std::vector<FacetView> views;
  std::vector<Point> points;
  for (std::size_t f = 0; f < placed.surface.numFacets(); ++f) {
    points.clear();
    for (const GlobalOrdinal node : placed.surface.facet(f))
      points.push_back(placed.pointAt(node));
    views.emplace_back(placed.surface.typeOf(f), points);
  }
  return views;
}

/// The box of a facet moved along its normal, from behind it to ahead of it.
mesh::BoxTree::Box CoveringFacets::boxOf(const FacetView& view, double behind, double ahead) {
  std::vector<Point> points;
  for (Eigen::Index a = 0; a < view.points().cols(); ++a)
    for (const double along : {-behind, ahead}) {
      const Vector3d x = view.points().col(a) + along * view.normal();
      points.push_back({x[0], x[1], x[2]});
    }
  return mesh::boxOf(points, 0.1 * view.diameter()); // curved facets bulge
}

std::vector<mesh::BoxTree::Box> CoveringFacets::boxesOf(const std::vector<FacetView>& views) {
  std::vector<mesh::BoxTree::Box> boxes;
  for (const FacetView& view : views)
    boxes.push_back(boxOf(view, 0, 0));
  return boxes;
}

std::vector<Point> CoveringFacets::boxOfAll() const {
  std::vector<Point> corners;
  for (const auto* views : {&first_, &second_})
    for (const FacetView& view : *views) {
      const mesh::BoxTree::Box box = boxOf(view, 0, 0);
      corners.insert(corners.end(), box.begin(), box.end());
    }
  const mesh::BoxTree::Box all = mesh::boxOf(corners);
  return {all.begin(), all.end()};
}

void CoveringFacets::refuse() {
  reach_ = size_;
  misses_ = {};
  for (std::size_t f = 0; f < first_.size(); ++f) // once more, to say why
    covering(f, viewPlane(f), size_);
  const char* why = misses_.deep > 0 ? "overlap deeper than a body is thick: one lies behind the other; name "
                                       "the surfaces that are to meet, or move one of the bodies"
                    : misses_.far > 0 ? "are farther apart than the contact's distance; enlarge it"
                    : misses_.away > 0
                        ? "face away from each other; name the surfaces that are to meet"
                        : "do not overlap at all, seen along their normals; check which surfaces are to meet";
  throw InputError("contact '" + terms_.name + "': the two surfaces " + why);
}

void CoveringFacets::refuseFold(const FacetView& view) const {
  throw InputError("contact '" + terms_.name + "': a facet at " + text(view.centre()) +
                   " is folded, as its counterpart sees it; mesh the surface finer there");
}

/// The part of the plane that both cover, piece by piece.
Common CoveringFacets::commonOf(const FacetView& own, const FacetView& other, const ViewPlane& plane) {
  Common common;
  common.nearest = std::numeric_limits<double>::infinity();
  common.deepest = -common.nearest;
  const auto note = [&](const Vector2d& point) {
    const auto here = own.at(point, plane), there = other.at(point, plane);
    if (!here || !there)
      refuseFold(here ? other : own);
    const double along = plane.axes.col(2).dot(there->place - here->place);
    common.nearest = std::min(common.nearest, along);
    common.deepest = std::max(common.deepest, along);
  };
  const auto seen = [&](const std::vector<Vector3d>& piece, bool isOpposite) {
    Polygon polygon;
    for (const Vector3d& corner : piece)
      polygon.push_back(plane.seen(corner));
    if (isOpposite)
      std::reverse(polygon.begin(), polygon.end());
    return polygon;
  };
  for (const auto& mine : own.pieces())
    for (const auto& theirs : other.pieces()) {
      clipped_ = seen(theirs, true);
      const Polygon window = seen(mine, false);
      double area = 0;
      if (terms_.dimension == 2) {
        const double from = std::max(clipped_[0][0], window[0][0]),
                     to = std::min(clipped_[1][0], window[1][0]);
        clipped_ = {{from, 0}, {to, 0}};
        area = to - from;
      } else {
        clip(clipped_, window, work_);
        area = areaOf(clipped_);
      }
      if (area <= sliver * own.area())
        continue;
      common.pieces.push_back(clipped_);
      common.area += area;
      for (const Vector2d& corner : clipped_)
        note(corner);
    }
  return common;
}

/// How deep facets may overlap.
double CoveringFacets::deepestOf(const FacetView& own, const FacetView& other, double allowed) const {
  const double large = std::max(own.diameter(), other.diameter());
  if (allowed <= large || !terms_.thickness)
    return std::max(allowed, large);
  return std::max(large, std::min(allowed, terms_.thickness(own.normal())));
}

/// The facets of the other surface that lie across a facet; of several layers the nearest.
std::vector<CoveringFacets::Covered> CoveringFacets::covering(std::size_t f, const ViewPlane& plane,
                                                              double allowed) {
  const FacetView& own = first_[f];
  tree_.meeting(boxOf(own, std::min(size_, std::max(own.diameter(), allowed)), reach_), found_);
  std::vector<Covered> pairs;
  double covered = 0, whole = 0;
  for (const std::size_t g : found_) {
    const FacetView& other = second_[g];
    if (own.normal().dot(other.normal()) > facing) {
      ++misses_.away;
      continue;
    }
    Common common = commonOf(own, other, plane);
    if (common.pieces.empty())
      continue;
    if (common.nearest > terms_.distance) {
      ++misses_.far;
      continue;
    }
    if (common.deepest < -deepestOf(own, other, allowed)) {
      ++misses_.deep;
      continue;
    }
    covered += common.area;
    pairs.emplace_back(g, std::move(common));
  }
  for (const auto& piece : own.pieces()) {
    Polygon polygon;
    for (const Vector3d& corner : piece)
      polygon.push_back(plane.seen(corner));
    whole += terms_.dimension == 2 ? polygon[1][0] - polygon[0][0] : areaOf(polygon);
  }
  if (covered <= (1 + 1e-6) * whole)
    return pairs;
  std::stable_sort(pairs.begin(), pairs.end(), [](const Covered& a, const Covered& b) {
    return std::abs(a.second.nearest + a.second.deepest) < std::abs(b.second.nearest + b.second.deepest);
  });
  std::vector<Covered> kept;
  for (Covered& pair : pairs)
    if (std::none_of(kept.begin(), kept.end(), [&](const Covered& other) {
          return overlap(pair.second, other.second, terms_.dimension);
        }))
      kept.push_back(std::move(pair));
  std::sort(kept.begin(), kept.end(), [](const Covered& a, const Covered& b) { return a.first < b.first; });
  return kept;
}

} // namespace epafi::contact
