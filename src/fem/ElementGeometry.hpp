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

/// Area or volume; exact, negative if the element is inside out.
double measureOf(CellType type, std::span<const Point> points);

/// Smallest determinant of ∂x/∂ξ at the corners and Gauss points; an element is usable only where it is positive. Of
/// triangles, quadrilaterals and tetrahedra it is the smallest anywhere.
double smallestJacobian(CellType type, std::span<const Point> points);

/// The same without units, −1 to 1: the determinant over the product of the lengths of ∂x/∂ξ's columns, smallest at the
/// corners and Gauss points (P. M. Knupp's scaled Jacobian). 1 for rectangles and boxes, equilateral triangles and regular
/// tetrahedra; 0 for flat or degenerate elements, negative for inverted ones.
double scaledJacobian(CellType type, std::span<const Point> points);

/// Length of an edge (2 points) or area of a face (3 or 4, exact if they lie in a plane).
double facetMeasure(std::span<const Point> points);

/// ∫n over a facet, exact; the normal points outwards if the nodes are in the order of facetsOf() or Surface.
Eigen::Vector3d areaVector(std::span<const Point> points);

} // namespace epafi::fem
