#pragma once

/// Convex polygons in a plane: the part that two have in common, and Gauss rules on intervals and triangles.

#include <Eigen/Core>

#include <vector>

namespace epafi::contact {

/// Corners, counter-clockwise.
using Polygon = std::vector<Eigen::Vector2d>;

/// Area; negative if the corners run clockwise.
double areaOf(const Polygon& polygon);

/// What a convex polygon has in common with another one, after Sutherland and Hodgman, *Comm. ACM* 17 (1974):
/// cut along the window's edges one by one. Fewer than three corners: nothing.
/// \param work  overwritten
void clip(Polygon& polygon, const Polygon& window, Polygon& work);

/// Whether a point lies in a convex polygon or no farther than `margin` from the lines of its edges.
bool contains(const Polygon& polygon, const Eigen::Vector2d& point, double margin);

/// A point of a rule on a simplex: barycentric coordinates without that of corner 0, and its share of the
/// simplex.
struct SimplexPoint {
  Eigen::Vector2d xi;
  double weight;
};

/// Exact for polynomials of a degree, on the interval (dimension 1) or the triangle (dimension 2: products of
/// Gauss points, with one side collapsed to a corner). Made once for each degree; the weights' sum is 1.
const std::vector<SimplexPoint>& simplexRule(int dimension, int degree);

} // namespace epafi::contact
