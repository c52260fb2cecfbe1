#pragma once

/// Size and shape of single elements, to tell sound ones from inverted, flat and folded ones.

#include "epafi/fem/Cell.hpp"
#include "epafi/fem/Mesh.hpp"

#include <span>

namespace epafi::fem {

struct ElementShape {
  double diameter = 0; ///< longest distance between two nodes
  double measure = 0;  ///< area or volume; negative if the nodes are numbered the other way round
  /// Smallest determinant of the element map's Jacobian, scaled to the element's measure if it is a parallelogram or
  /// parallelepiped (a simplex: its measure). At the corners, and of a hexahedron at the 2×2×2 Gauss points too.
  double leastJacobian = 0;
  int corner = -1; ///< where that is, as a place among the element's nodes; −1: inside
};

/// \param corners  numNodesOf(type) points; of plane elements the first two coordinates count.
ElementShape shapeOf(CellType type, std::span<const Point> corners);

} // namespace epafi::fem
