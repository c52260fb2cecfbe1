#include "epafi/fem/ElementShape.hpp"

#include "epafi/fem/ElementGeometry.hpp"
#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <limits>

namespace epafi::fem {
namespace {

void noteJacobian(ElementShape& shape, double value, int corner) {
  if (value < shape.leastJacobian) {
    shape.leastJacobian = value;
    shape.corner = corner;
  }
}

/// Of a simplex the determinant is the same everywhere; of a quadrilateral it is linear, so that its least value lies at a
/// corner.
template <class Shape>
void measure(std::span<const Point> points, ElementShape& shape) {
  constexpr double reference = Shape::numGaussPoints * Shape::gaussWeight; // measure of the reference element
  const auto corners = relativeCorners<Shape>(points);
  if constexpr (Shape::numGaussPoints > 1) {
    int corner = 0;
    for (const auto& sample : cornerSamples<Shape>())
      noteJacobian(shape, reference * ElementMap<Shape>(corners, sample).determinant(), corner++);
  }
  for (const auto& sample : gaussSamples<Shape>()) {
    const double inside = ElementMap<Shape>(corners, sample).determinant();
    shape.measure += Shape::gaussWeight * inside; // exact, see Brick
    noteJacobian(shape, reference * inside, -1);
  }
}

} // namespace

ElementShape shapeOf(CellType type, std::span<const Point> corners) {
  ElementShape shape;
  shape.diameter = diameterOf(corners);
  shape.leastJacobian = std::numeric_limits<double>::infinity();
  withShape(type, [&](auto reference) { measure<decltype(reference)>(corners, shape); });
  return shape;
}

} // namespace epafi::fem
