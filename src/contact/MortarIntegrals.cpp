#include "epafi/contact/MortarIntegrals.hpp"

#include "epafi/base/Errors.hpp"
#include "epafi/base/Text.hpp"
#include "epafi/contact/FacetTree.hpp"
#include "epafi/contact/FacetView.hpp"
#include "epafi/fem/ElementGeometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace epafi::contact {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Facets face each other if their normals are this far from orthogonal.
constexpr double facing = -0.2;
/// Nodes this near to what the other side covers, beside their own facet's size, are reached: rims of curved surfaces that
/// meet deviate as seen along facets' normals.
constexpr double onRim = 0.01;
/// Pieces of a facet below this share of it are slivers, which round-off makes.
constexpr double sliver = 1e-12;
/// Rules are exact to this degree beyond that of straight facets where the integrands are no polynomials.
constexpr int beyond = 6;

/// What is left of a facet and another one, seen on the first one's plane.
struct Common {
  std::vector<Polygon> pieces; ///< in the plane: intervals of two points
  double area = 0;
  double nearest = 0,
         deepest = 0; ///< least and largest distance at the pieces' corners, along the first one's normal
};

/// Why facets that might have met do not.
struct Misses {
  int away = 0, far = 0, deep = 0;
};

class Integrator {
public:
  Integrator(const MortarTerms& terms, const PlacedSurface& first, const PlacedSurface& second)
      : terms_(terms), first_(viewsOf(first)), second_(viewsOf(second)), tree_(boxesOf(second_)) {
    size_ = fem::diameterOf(boxOfAll());
    reach_ = std::min(terms.distance, size_);
  }

  std::vector<MortarFacet> integrate() {
    std::vector<MortarFacet> facets;
    for (std::size_t f = 0; f < first_.size(); ++f)
      if (MortarFacet facet = integrateOver(f); !facet.across.empty())
        facets.push_back(std::move(facet));
    if (facets.empty())
      refuse();
    return facets;
  }

private:
  using Pair = std::pair<std::size_t, Common>; ///< facet of the second surface, and what it covers

  static std::vector<FacetView> viewsOf(const PlacedSurface& placed);
  static std::vector<FacetTree::Box> boxesOf(const std::vector<FacetView>& views);
  static FacetTree::Box boxOf(const FacetView& view, double behind, double ahead);
  [[nodiscard]] std::vector<fem::Point> boxOfAll() const;
  [[noreturn]] void refuse();

  MortarFacet integrateOver(std::size_t f);
  std::vector<Pair> covering(const FacetView& own, const ViewPlane& plane);
  [[nodiscard]] Common commonOf(const FacetView& own, const FacetView& other, const ViewPlane& plane);
  void add(const FacetView& own, const FacetView& other, const ViewPlane& plane, const Common& common,
           MortarFacet& facet, Eigen::MatrixXd& coupling) const;
  [[nodiscard]] bool reaches(const Common& common, const Vector2d& point, double margin) const;
  [[noreturn]] void refuseFold(const FacetView& view) const;

  const MortarTerms& terms_;
  std::vector<FacetView> first_, second_;
  FacetTree tree_;
  double size_ = 0;       ///< of both surfaces
  double reach_ = 0;      ///< how far the search goes along normals
  bool goesBack_ = false; ///< whether it goes as far backwards
  Misses misses_;
  std::vector<std::size_t> found_;
  Polygon clipped_, work_;
};

std::vector<FacetView> Integrator::viewsOf(const PlacedSurface& placed) {
  std::vector<FacetView> views;
  std::vector<fem::Point> points;
  for (std::size_t f = 0; f < placed.surface.numFacets(); ++f) {
    points.clear();
    for (const GlobalOrdinal node : placed.surface.facet(f))
      points.push_back(placed.pointAt(node));
    views.emplace_back(placed.surface.facetType, points);
  }
  return views;
}

/// The box of a facet moved along its normal, from behind it to ahead of it.
FacetTree::Box Integrator::boxOf(const FacetView& view, double behind, double ahead) {
  std::vector<fem::Point> points;
  for (Eigen::Index a = 0; a < view.points().cols(); ++a)
    for (const double along : {-behind, ahead}) {
      const Vector3d x = view.points().col(a) + along * view.normal();
      points.push_back({x[0], x[1], x[2]});
    }
  return fem::boxOf(points, 0.1 * view.diameter()); // curved facets bulge
}

std::vector<FacetTree::Box> Integrator::boxesOf(const std::vector<FacetView>& views) {
  std::vector<FacetTree::Box> boxes;
  for (const FacetView& view : views)
    boxes.push_back(boxOf(view, 0, 0));
  return boxes;
}

std::vector<fem::Point> Integrator::boxOfAll() const {
  std::vector<fem::Point> corners;
  for (const auto* views : {&first_, &second_})
    for (const FacetView& view : *views) {
      const FacetTree::Box box = boxOf(view, 0, 0);
      corners.insert(corners.end(), box.begin(), box.end());
    }
  const FacetTree::Box all = fem::boxOf(corners);
  return {all.begin(), all.end()};
}

void Integrator::refuse() {
  reach_ = size_;
  goesBack_ = true;
  for (const FacetView& own : first_) // once more, to say why
    covering(own, ViewPlane::across(own.centre(), own.normal(), terms_.dimension));
  const char* why = misses_.deep > 0   ? "overlap deeper than an element; move one of the bodies"
                    : misses_.away > 0 ? "face away from each other; name the surfaces that are to meet"
                    : misses_.far > 0
                        ? "are farther apart than the contact's distance; enlarge it"
                        : "do not overlap at all, seen along their normals; check which surfaces are to meet";
  throw InputError("contact '" + terms_.name + "': the two surfaces " + why);
}

void Integrator::refuseFold(const FacetView& view) const {
  throw InputError("contact '" + terms_.name + "': a facet at " + text(view.centre()) +
                   " is folded, as its counterpart sees it; mesh the surface finer there");
}

/// The part of the plane that both cover, piece by piece.
Common Integrator::commonOf(const FacetView& own, const FacetView& other, const ViewPlane& plane) {
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

/// The facets of the other surface that lie across a facet; of several layers the nearest.
std::vector<Integrator::Pair> Integrator::covering(const FacetView& own, const ViewPlane& plane) {
  tree_.meeting(boxOf(own, goesBack_ ? reach_ : std::min(reach_, own.diameter()), reach_), found_);
  std::vector<Pair> pairs;
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
    if (common.deepest < -std::max(own.diameter(), other.diameter())) {
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
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::abs(a.second.nearest + a.second.deepest) < std::abs(b.second.nearest + b.second.deepest);
  });
  std::vector<Pair> kept;
  for (Pair& pair : pairs)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const Pair& other) { return overlap(pair.second, other.second, terms_.dimension); }))
      kept.push_back(std::move(pair));
  std::sort(kept.begin(), kept.end(), [](const Pair& a, const Pair& b) { return a.first < b.first; });
  return kept;
}

bool Integrator::reaches(const Common& common, const Vector2d& point, double margin) const {
  return std::any_of(common.pieces.begin(), common.pieces.end(), [&](const Polygon& piece) {
    return terms_.dimension == 2 ? piece[0][0] - margin <= point[0] && point[0] <= piece[1][0] + margin
                                 : contains(piece, point, margin);
  });
}

/// The integrals over what one facet of the other surface covers.
void Integrator::add(const FacetView& own, const FacetView& other, const ViewPlane& plane,
                     const Common& common, MortarFacet& facet, Eigen::MatrixXd& coupling) const {
  const bool isPolynomial = own.isAffine() && other.isAffine();
  const int degree = own.degree() + std::max(own.degree(), other.degree()) + (isPolynomial ? 0 : beyond);
  const std::vector<SimplexPoint>& rule = simplexRule(terms_.dimension - 1, degree);
  for (const Polygon& piece : common.pieces)
    for (std::size_t corner = 1; corner + 1 < std::max<std::size_t>(piece.size(), 3); ++corner) {
      const Vector2d along = piece[corner] - piece[0],
                     across = terms_.dimension == 2 ? Vector2d(0, 0) : Vector2d(piece[corner + 1] - piece[0]);
      const double size =
          terms_.dimension == 2 ? along[0] : 0.5 * (along[0] * across[1] - along[1] * across[0]);
      for (const SimplexPoint& point : rule) {
        const Vector2d seen = piece[0] + point.xi[0] * along + point.xi[1] * across;
        const auto here = own.at(seen, plane), there = other.at(seen, plane);
        if (!here || !there)
          refuseFold(here ? other : own);
        const double weight = point.weight * size * here->slope;
        facet.area += weight;
        facet.shares += weight * here->values;
        facet.mass.noalias() += (weight * here->values) * here->values.transpose();
        coupling.noalias() += (weight * here->values) * there->values.transpose();
      }
    }
}

MortarFacet Integrator::integrateOver(std::size_t f) {
  const FacetView& own = first_[f];
  const Eigen::Index n = own.points().cols();
  const ViewPlane plane = ViewPlane::across(own.centre(), own.normal(), terms_.dimension);
  MortarFacet facet{f,
                    own.area(),
                    0,
                    Eigen::VectorXd::Zero(n),
                    Eigen::MatrixXd::Zero(n, n),
                    {},
                    std::vector<char>(static_cast<std::size_t>(n), 0)};
  for (const auto& [g, common] : covering(own, plane)) {
    const FacetView& other = second_[g];
    auto& across =
        facet.across.emplace_back(MortarFacet::Across{g, Eigen::MatrixXd::Zero(n, other.points().cols())});
    add(own, other, plane, common, facet, across.coupling);
    for (Eigen::Index a = 0; a < n; ++a)
      if (reaches(common, plane.seen(own.points().col(a)), onRim * own.diameter()))
        facet.isReached[static_cast<std::size_t>(a)] = 1;
  }
  return facet;
}

} // namespace

std::vector<MortarFacet> mortarIntegrals(const MortarTerms& terms, const PlacedSurface& first,
                                         const PlacedSurface& second) {
  return Integrator(terms, first, second).integrate();
}

} // namespace epafi::contact
