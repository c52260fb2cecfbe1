#pragma once

/// The corners of subdomains, and points that hold a body.

#include "epafi/decomposition/SharedNodes.hpp"

#include <cstddef>
#include <vector>

namespace epafi::decomposition {

/// Tells for each copy of a subdomain (see SharedNodes) whether it is a corner: - in the plane, if three or
/// more subdomains share it, or two share it on the body's boundary: the end points and
///    meeting points of interfaces. On a grid these are all subdomain corners but the four of the body;
///  - in space, if three or more subdomains share it, and it alone is shared by just these, or it lies on the
///  body's
///    boundary: the end points of edges.
/// Where nobody knows the boundary, findInterfaceEnds stands in for it. All subdomains that share a node find
/// the same.
std::vector<char> findCorners(const Substructures& all, const SharedNodes& shared, std::size_t subdomain);

/// Points, and whether a body that is held there can still move: one holds a scalar field, two different ones
/// a body in the plane, three that are not on a line a body in space.
class HoldingPoints {
public:
  /// \param components  unknowns a node: 1, 2 or 3
  explicit HoldingPoints(int components) : needed_(components) {}

  /// A point that holds no more than those before it is forgotten.
  void add(const Point& point);
  [[nodiscard]] bool hold() const { return points_.size() >= needed_; }
  /// Adds such candidates that all points together hold, far from each other; returns their places, none if
  /// they hold already. Where the candidates cannot hold (in space: all on a line) there are none, or fewer
  /// than it takes.
  std::vector<std::size_t> complete(const std::vector<Point>& candidates);

private:
  [[nodiscard]] double gain(const Point& point) const;

  std::size_t needed_;
  std::vector<Point> points_; ///< independent ones
};

} // namespace epafi::decomposition
