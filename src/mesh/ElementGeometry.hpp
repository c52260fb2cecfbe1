#pragma once

/// Size and form of elements and facets, from their nodes in the order of Cell.hpp. In the plane the third
/// coordinate does not matter, and neither does a body's thickness.

#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace epafi::mesh {

/// Mean of points; of an element's corners of order 1 the image of the reference element's centre.
Point centreOf(std::span<const Point> points);

/// Lowest and highest coordinates of points, at least one; the box that they make is widened by a margin on
/// all sides.
std::array<Point, 2> boxOf(std::span<const Point> points, double margin = 0);

/// Longest distance between two points.
double diameterOf(std::span<const Point> points);

/// Area or volume; exact, negative if the element is inside out.
double measureOf(CellType type, std::span<const Point> points);

/// ∫N_a over a facet: what of its length or area node a has, all of it together. Exact if the points lie in a
/// plane.
/// \param shares  as many as points, overwritten
void nodalShares(CellType facet, std::span<const Point> points, std::span<double> shares);

/// 2πx at a point of an element or facet that turns about the y-axis. \param values  of the shape functions
template <class Values>
double circumferenceAt(std::span<const Point> points, const Values& values) {
  double radius = 0;
  for (std::size_t a = 0; a < points.size(); ++a)
    radius += values[static_cast<Eigen::Index>(a)] * points[a][0];
  return 2 * std::numbers::pi * radius;
}

/// nodalShares of the area that an edge makes as it turns about the y-axis: ∫2πx N_a.
void revolvedShares(CellType edge, std::span<const Point> points, std::span<double> shares);

/// ∫n over a facet, exact; the normal points outwards if the nodes are in the order of facetsOf() or Surface.
Eigen::Vector3d areaVector(CellType facet, std::span<const Point> points);

/// Normals of a facet at its nodes, outwards likewise; of order 1 the same ∫n at each, of order 2 as long as
/// the facet's area.
/// \param normals  as many as points, overwritten
void nodalNormals(CellType facet, std::span<const Point> points, std::vector<Eigen::Vector3d>& normals);

/// Size and shape of an element, to tell a sound one from inverted, flat and folded ones.
struct ElementShape {
  double diameter = 0; ///< longest distance between two nodes
  double measure = 0;  ///< area or volume; negative if the nodes are numbered the other way round
  /// Smallest determinant of the element map's Jacobian, scaled to the element's measure if it is a
  /// parallelogram or parallelepiped (a simplex: its measure). At the corners, and of a hexahedron at the
  /// 2×2×2 Gauss points too; of order 2 a bound on the whole element (JacobianBound.hpp).
  double leastJacobian = 0;
  int corner = -1; ///< where that is, as a place among the element's nodes; −1: elsewhere
};

/// \param corners  numNodesOf(type) points; of plane elements the first two coordinates count.
ElementShape shapeOf(CellType type, std::span<const Point> corners);

} // namespace epafi::mesh
