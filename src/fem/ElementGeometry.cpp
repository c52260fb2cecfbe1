#include "epafi/fem/ElementGeometry.hpp"

#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace epafi::fem {
namespace {

/// Smallest value of measure(map) at the corners and Gauss points.
template <class Shape, class Measure>
double smallestValue(std::span<const Point> points, const Measure& measure) {
  const auto corners = relativeCorners<Shape>(points);
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& sample : cornerSamples<Shape>())
    smallest = std::min(smallest, measure(ElementMap<Shape>(corners, sample)));
  for (const auto& sample : gaussSamples<Shape>())
    smallest = std::min(smallest, measure(ElementMap<Shape>(corners, sample)));
  return smallest;
}

/// A quotient whose denominator may be 0 where the element has an edge of no length.
double quotient(double determinant, double lengths) {
  return lengths > 0 ? determinant / lengths : 0;
}

template <class Shape>
double scaledJacobianOf(std::span<const Point> points, const Shape& /*shape*/) {
  return smallestValue<Shape>(points, [](const ElementMap<Shape>& map) {
    return quotient(map.determinant(), map.jacobian().colwise().norm().prod());
  });
}

/// The determinant is the same everywhere; the edges that meet at a corner take the columns' place.
template <int dim>
double scaledJacobianOf(std::span<const Point> points, const Simplex<dim>& /*shape*/) {
  const auto corners = relativeCorners<Simplex<dim>>(points);
  const double determinant = ElementMap<Simplex<dim>>(corners, centreSample<Simplex<dim>>()).determinant();
  double smallest = std::numeric_limits<double>::infinity();
  for (int a = 0; a <= dim; ++a) {
    double lengths = 1;
    for (int b = 0; b <= dim; ++b)
      if (b != a)
        lengths *= (corners.col(b) - corners.col(a)).norm();
    smallest = std::min(smallest, quotient(determinant, lengths));
  }
  return smallest * (dim == 2 ? 2 / std::sqrt(3.0) : std::sqrt(2.0)); // 1 for equal edges
}

} // namespace

Point centreOf(std::span<const Point> points) {
  Point centre{0, 0, 0};
  for (const Point& point : points)
    for (std::size_t i = 0; i < 3; ++i)
      centre[i] += point[i];
  for (double& coordinate : centre)
    coordinate /= static_cast<double>(points.size());
  return centre;
}

double measureOf(CellType type, std::span<const Point> points) {
  return withShape(type, [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape>(points);
    double measure = 0;
    for (const auto& sample : gaussSamples<Shape>())
      measure += Shape::gaussWeight * ElementMap<Shape>(corners, sample).determinant();
    return measure;
  });
}

double smallestJacobian(CellType type, std::span<const Point> points) {
  return withShape(type, [&](auto shape) {
    using Shape = decltype(shape);
    return smallestValue<Shape>(points, [](const ElementMap<Shape>& map) { return map.determinant(); });
  });
}

double scaledJacobian(CellType type, std::span<const Point> points) {
  return withShape(type, [&](auto shape) { return scaledJacobianOf(points, shape); });
}

double facetMeasure(std::span<const Point> points) {
  return withFacetShape(points.size(), [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape, Shape::dimension + 1>(points);
    double measure = 0;
    for (const auto& sample : gaussSamples<Shape>())
      measure += Shape::gaussWeight * facetNormal<Shape>(corners, sample).norm();
    return measure;
  });
}

Eigen::Vector3d areaVector(std::span<const Point> points) {
  return withFacetShape(points.size(), [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape, Shape::dimension + 1>(points);
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    for (const auto& sample : gaussSamples<Shape>())
      vector.head<Shape::dimension + 1>() += Shape::gaussWeight * facetNormal<Shape>(corners, sample);
    return vector;
  });
}

} // namespace epafi::fem
