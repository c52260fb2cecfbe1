#pragma once

/// Which facets of one surface lie across those of another, and where: seen along the normals of the first
/// one's.

#include "epafi/contact/ContactTerms.hpp"
#include "epafi/contact/ConvexPolygon.hpp"
#include "epafi/contact/FacetView.hpp"
#include "epafi/contact/MortarIntegrals.hpp"
#include "epafi/mesh/BoxTree.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace epafi::contact {

/// What is left of a facet and another one, seen on the first one's plane.
struct Common {
  std::vector<Polygon> pieces; ///< in the plane: intervals of two points
  double area = 0;
  double nearest = 0,
         deepest = 0; ///< least and largest distance at the pieces' corners, along the first one's normal
};

class CoveringFacets {
public:
  /// Keeps references to the terms.
  CoveringFacets(const ContactTerms& terms, const PlacedSurface& first, const PlacedSurface& second);

  using Covered = std::pair<std::size_t, Common>; ///< facet of the second surface, and what it covers

  [[nodiscard]] const std::vector<FacetView>& first() const { return first_; }
  [[nodiscard]] const std::vector<FacetView>& second() const { return second_; }
  [[nodiscard]] double size() const { return size_; } ///< of both surfaces together
  /// Of a facet of the first surface, along its normal.
  [[nodiscard]] ViewPlane viewPlane(std::size_t f) const;
  /// The facets that lie across facet f of the first surface, ascending; of several layers the nearest.
  /// \param allowed how deep it may lie behind them, where that is more than facets are large
  std::vector<Covered> covering(std::size_t f, const ViewPlane& plane, double allowed);
  /// Throws an InputError that says why no facet meets any other.
  [[noreturn]] void refuse();
  [[noreturn]] void refuseFold(const FacetView& view) const;

private:
  static std::vector<FacetView> viewsOf(const PlacedSurface& placed);
  static std::vector<mesh::BoxTree::Box> boxesOf(const std::vector<FacetView>& views);
  static mesh::BoxTree::Box boxOf(const FacetView& view, double behind, double ahead);
  [[nodiscard]] std::vector<Point> boxOfAll() const;
  [[nodiscard]] double deepestOf(const FacetView& own, const FacetView& other, double allowed) const;
  [[nodiscard]] Common commonOf(const FacetView& own, const FacetView& other, const ViewPlane& plane);

  /// Why facets that might have met do not.
  struct Misses {
    int away = 0, far = 0, deep = 0;
  };

  const ContactTerms& terms_;
  std::vector<FacetView> first_, second_;
  mesh::BoxTree tree_;
  double size_ = 0;
  double reach_ = 0; ///< how far the search goes along normals
  Misses misses_;
  std::vector<std::size_t> found_;
  Polygon clipped_, work_;
};

} // namespace epafi::contact
