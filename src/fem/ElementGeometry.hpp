#pragma once

/// Size and form of elements and facets, from their corners in the order of Cell.hpp. In the plane the third coordinate does
/// not matter, and neither does a body's thickness.

#include "epafi/fem/Cell.hpp"
#include "epafi/fem/Mesh.hpp"

#include <Eigen/Core>

#include <span>

namespace epafi::fem {

/// Mean of the corners, which is the image of the reference element's centre.
Point centreOf(std::span<const Point> points);

/// Longest distance between two points.
double diameterOf(std::span<const Point> points);

/// Area or volume; exact, negative if the element is inside out.
double measureOf(CellType type, std::span<const Point> points);

/// ∫N_a over a facet: what of its length or area node a has, all of it together. Exact if the points lie in a plane.
/// \param shares  as many as points, overwritten
void nodalShares(CellType facet, std::span<const Point> points, std::span<double> shares);

/// ∫n over a facet, exact; the normal points outwards if the nodes are in the order of facetsOf() or Surface.
Eigen::Vector3d areaVector(CellType facet, std::span<const Point> points);

} // namespace epafi::fem
