#include "epafi/fem/Q1Element.hpp"

#include <algorithm>

namespace epafi::fem {

Eigen::Matrix4d membraneStiffness(double hx, double hy) {
  const double a = hy / (6 * hx), b = hx / (6 * hy);
  Eigen::Matrix4d k;
  // Each row: node with itself, its x-neighbour, the opposite node, its y-neighbour.
  const double self = 2 * a + 2 * b, alongX = -2 * a + b, opposite = -a - b, alongY = a - 2 * b;
  k << self, alongX, opposite, alongY, //
      alongX, self, alongY, opposite,  //
      opposite, alongY, self, alongX,  //
      alongY, opposite, alongX, self;
  return k;
}

Eigen::Vector2d segmentLoad(double a, double b, double low, double high) {
  const double from = std::max(a, low), to = std::min(b, high);
  if (to <= from)
    return Eigen::Vector2d::Zero();
  // A linear function over a segment: its value in the middle times the length.
  const double s = (0.5 * (from + to) - a) / (b - a);
  return (to - from) * Eigen::Vector2d(1 - s, s);
}

Eigen::Vector4d membraneLoad(const Eigen::Vector2d& alongX, const Eigen::Vector2d& alongY) {
  return {alongX[0] * alongY[0], alongX[1] * alongY[0], alongX[1] * alongY[1], alongX[0] * alongY[1]};
}

} // namespace epafi::fem
