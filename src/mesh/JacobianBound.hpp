#pragma once

/// A bound of the element map's Jacobian on the whole of an element, not at points alone.

#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/Mesh.hpp"

#include <span>

namespace epafi::mesh {

/// A lower bound of det ∂x/∂ξ on an element. The determinant is a polynomial of known degree: its
/// coefficients in Bernstein's basis bound it, and on smaller and smaller parts of the element they come as
/// near as need be (Johnen, Remacle, Geuzaine, *J. Comput. Phys.* 233 (2013)). Positive if the determinant is
/// positive everywhere, unless it falls below some thousandth of what it is elsewhere; where it is not
/// positive at a point that was looked at, its value there.
/// \param points  numNodesOf(type) nodes, order 2; of plane elements the first two coordinates count
double leastDeterminant(CellType type, std::span<const Point> points);

} // namespace epafi::mesh
