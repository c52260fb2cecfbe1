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

Eigen::Vector4d membraneLoad(const scene::Rectangle& element, const scene::Rectangle& box) {
  const double x0 = std::max(element.x0, box.x0), x1 = std::min(element.x1, box.x1);
  const double y0 = std::max(element.y0, box.y0), y1 = std::min(element.y1, box.y1);
  if (x1 <= x0 || y1 <= y0)
    return Eigen::Vector4d::Zero();
  // A bilinear function over a rectangle: its value at the centre times the area.
  const double s = (0.5 * (x0 + x1) - element.x0) / (element.x1 - element.x0);
  const double t = (0.5 * (y0 + y1) - element.y0) / (element.y1 - element.y0);
  const double area = (x1 - x0) * (y1 - y0);
  return area * Eigen::Vector4d((1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t);
}

} // namespace epafi::fem
