#include "epafi/contact/MortarIntegrals.hpp"

#include "epafi/contact/CoveringFacets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace epafi::contact {
namespace {

using Eigen::Vector2d;

/// Nodes this near to what the other side covers, beside their own facet's size, are reached: rims of curved
/// surfaces that meet deviate as seen along facets' normals.
constexpr double onRim = 0.01;
/// Rules are exact to this degree beyond that of straight facets where the integrands are no polynomials.
constexpr int beyond = 6;

class Integrator {
public:
  Integrator(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second)
      : dimension_(terms.dimension), isOfRevolution_(terms.isOfRevolution), surface_(first.surface),
        cover_(terms, first, second), allowed_(first.surface.numFacets(), 0.0) {}

  std::vector<MortarFacet> integrate();

private:
  MortarFacet integrateOver(std::size_t f);
  void integrateAll();
  void followOverlaps();
  void add(const FacetView& own, const FacetView& other, const ViewPlane& plane, const Common& common,
           MortarFacet& facet, Eigen::MatrixXd& coupling) const;
  [[nodiscard]] bool reaches(const Common& common, const Vector2d& point, double margin) const;

  /// 2πr of a solid of revolution, else 1. \param values  of the shape functions
  [[nodiscard]] double around(const FacetView& facet, const FacetValues& values) const {
    return isOfRevolution_ ? 2 * std::numbers::pi * facet.points().row(0).dot(values) : 1;
  }

  int dimension_;
  bool isOfRevolution_;
  const mesh::Surface& surface_; ///< the first one
  CoveringFacets cover_;
  /// Of each facet of the first surface how deep it may lie in the other body, if that is more than facets
  /// are large.
  std::vector<double> allowed_;
  std::vector<MortarFacet> facets_; ///< integrals over each of them
};

bool Integrator::reaches(const Common& common, const Vector2d& point, double margin) const {
  return std::any_of(common.pieces.begin(), common.pieces.end(), [&](const Polygon& piece) {
    return dimension_ == 2 ? piece[0][0] - margin <= point[0] && point[0] <= piece[1][0] + margin
                           : contains(piece, point, margin);
  });
}

/// The integrals over what one facet of the other surface covers.
void Integrator::add(const FacetView& own, const FacetView& other, const ViewPlane& plane,
                     const Common& common, MortarFacet& facet, Eigen::MatrixXd& coupling) const {
  const bool isPolynomial = own.isAffine() && other.isAffine();
  const int degree = own.degree() + std::max(own.degree(), other.degree()) + (isPolynomial ? 0 : beyond) +
                     (isOfRevolution_ ? own.degree() : 0);
  const std::vector<SimplexPoint>& rule = simplexRule(dimension_ - 1, degree);
  for (const Polygon& piece : common.pieces)
    for (std::size_t corner = 1; corner + 1 < std::max<std::size_t>(piece.size(), 3); ++corner) {
      const Vector2d along = piece[corner] - piece[0],
                     across = dimension_ == 2 ? Vector2d(0, 0) : Vector2d(piece[corner + 1] - piece[0]);
      const double size = dimension_ == 2 ? along[0] : 0.5 * (along[0] * across[1] - along[1] * across[0]);
      for (const SimplexPoint& point : rule) {
        const Vector2d seen = piece[0] + point.xi[0] * along + point.xi[1] * across;
        const auto here = own.at(seen, plane), there = other.at(seen, plane);
        if (!here || !there)
          cover_.refuseFold(here ? other : own);
        const double weight = point.weight * size * here->slope * around(own, here->values);
        facet.area += weight;
        facet.shares += weight * here->values;
        facet.mass.noalias() += (weight * here->values) * here->values.transpose();
        coupling.noalias() += (weight * here->values) * there->values.transpose();
      }
    }
}

MortarFacet Integrator::integrateOver(std::size_t f) {
  const FacetView& own = cover_.first()[f];
  const Eigen::Index n = own.points().cols();
  const ViewPlane plane = cover_.viewPlane(f);
  MortarFacet facet{f,
                    own.area() * (isOfRevolution_ ? 2 * std::numbers::pi * own.centre()[0] : 1),
                    0,
                    1,
                    0,
                    Eigen::VectorXd::Zero(n),
                    Eigen::MatrixXd::Zero(n, n),
                    {},
                    std::vector<char>(n, 0)};
  for (const auto& [g, common] : cover_.covering(f, plane, allowed_[f])) {
    const FacetView& other = cover_.second()[g];
    auto& across =
        facet.across.emplace_back(MortarFacet::Across{g, Eigen::MatrixXd::Zero(n, other.points().cols())});
    add(own, other, plane, common, facet, across.coupling);
    facet.cosine = std::min(facet.cosine, own.normal().dot(other.normal()));
    facet.deepest = std::max(facet.deepest, -common.nearest);
    for (Eigen::Index a = 0; a < n; ++a)
      if (reaches(common, plane.seen(own.points().col(a)), onRim * own.diameter()))
        facet.isReached[a] = 1;
  }
  return facet;
}

void Integrator::integrateAll() {
  facets_.clear();
  for (std::size_t f = 0; f < surface_.numFacets(); ++f)
    facets_.push_back(integrateOver(f));
}

/// Goes on from facets that overlap to those around, which may overlap more by their own size.
void Integrator::followOverlaps() {
  std::unordered_map<GlobalOrdinal, std::vector<std::size_t>> facetsAt;
  for (std::size_t f = 0; f < surface_.numFacets(); ++f)
    for (const GlobalOrdinal node : surface_.facet(f))
      facetsAt[node].push_back(f);
  std::vector<std::size_t> next;
  for (std::size_t f = 0; f < surface_.numFacets(); ++f)
    if (facets_[f].deepest > 0.1 * cover_.first()[f].diameter())
      next.push_back(f);
  for (std::vector<std::size_t> front; !next.empty();) {
    front.swap(next);
    next.clear();
    for (const std::size_t f : front)
      for (const GlobalOrdinal node : surface_.facet(f))
        for (const std::size_t g : facetsAt[node]) {
          const double bound = facets_[f].deepest +
                               std::max(cover_.first()[f].diameter(), cover_.first()[g].diameter()),
                       before = facets_[g].area;
          if (bound <= allowed_[g] || before >= (1 - 1e-6) * facets_[g].whole)
            continue;
          allowed_[g] = bound;
          facets_[g] = integrateOver(g);
          if (facets_[g].area > before)
            next.push_back(g);
        }
  }
}

std::vector<MortarFacet> Integrator::integrate() {
  const auto isCovered = [](const MortarFacet& facet) { return !facet.across.empty(); };
  allowed_.assign(surface_.numFacets(), 0.0);
  integrateAll();
  if (std::none_of(facets_.begin(), facets_.end(), isCovered)) {
    allowed_.assign(surface_.numFacets(), cover_.size());
    integrateAll();
    double least = cover_.size();
    for (const MortarFacet& facet : facets_)
      if (isCovered(facet))
        least = std::min(least, facet.deepest);
    for (std::size_t f = 0; f < surface_.numFacets(); ++f)
      allowed_[f] = least + cover_.first()[f].diameter();
    integrateAll();
  }
  followOverlaps();
  std::erase_if(facets_, [&](const MortarFacet& facet) { return !isCovered(facet); });
  if (facets_.empty())
    cover_.refuse();
  return std::move(facets_);
}

} // namespace

std::vector<MortarFacet> mortarIntegrals(const ContactTerms& terms, const PlacedSurface& first,
                                         const PlacedSurface& second) {
  return Integrator(terms, first, second).integrate();
}

} // namespace epafi::contact
