#pragma once

/// Points sorted into a k-d tree, to find those in a box, or the nearest one, without looking at the others.
/// Made in O(n log n), whatever the points' distribution; holds 29 bytes a point.

#include "epafi/base/Types.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace epafi::mesh {

class PointTree {
public:
  explicit PointTree(std::span<const Point> points);

  /// Indices of the points in a closed box, in no order; `found` is overwritten.
  void inBox(const Point& lower, const Point& upper, std::vector<LocalOrdinal>& found) const;

  /// Index of the point nearest to x; of equally near ones the lowest. Precondition: there is one.
  [[nodiscard]] LocalOrdinal nearest(const Point& x) const;

private:
  void sort(std::size_t begin, std::size_t end);

  // The middle of a range splits it at a plane across the axis noted there; short ranges are not split.
  std::vector<LocalOrdinal> index_;
  std::vector<Point> points_; ///< in the order of index_
  std::vector<std::uint8_t> axis_;
};

} // namespace epafi::mesh
