#pragma once

/// Size and form of elements and facets, from their corners in the order of Cell.hpp. In the plane the third coordinate does
/// not matter, and neither does a body's thickness.

#include "epafi/fem/Cell.hpp"
#include "epafi/fem/Mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <span>

namespace epafi::fem {

/// Mean of the corners, which is the image of the reference element's centre.
Point centreOf(std::span<const Point> points);

/// Area or volume; exact, negative if the element is inside out.
double measureOf(CellType type, std::span<const Point> points);

/// ∫N_a over a facet of 2, 3 or 4 points: what of its length or area node a has, all of it together. Exact if the points lie
/// in a plane. What is not a node has 0.
std::array<double, 4> nodalShares(std::span<const Point> points);

/// ∫n over a facet, exact; the normal points outwards if the nodes are in the order of facetsOf() or Surface.
Eigen::Vector3d areaVector(std::span<const Point> points);

} // namespace epafi::fem
