#pragma once

/// Boxes along the axes.

#include "epafi/base/Types.hpp"

#include <limits>

namespace epafi::mesh {

/// Axis-parallel box; the whole space unless said otherwise. In the plane the third coordinate does not
/// matter.
struct Box {
  Vector3 lower{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                -std::numeric_limits<double>::infinity()};
  Vector3 upper{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                std::numeric_limits<double>::infinity()};
};

/// [x0, x1] × [y0, y1], whatever z.
inline Box rectangle(double x0, double x1, double y0, double y1) {
  Box box;
  box.lower = {x0, y0, box.lower[2]};
  box.upper = {x1, y1, box.upper[2]};
  return box;
}

} // namespace epafi::mesh
