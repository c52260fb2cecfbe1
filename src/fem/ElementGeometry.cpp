#include "epafi/fem/ElementGeometry.hpp"

#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <algorithm>
#include <cmath>

namespace epafi::fem {

Point centreOf(std::span<const Point> points) {
  Point centre{0, 0, 0};
  for (const Point& point : points)
    for (std::size_t i = 0; i < 3; ++i)
      centre[i] += point[i];
  for (double& coordinate : centre)
    coordinate /= static_cast<double>(points.size());
  return centre;
}

double diameterOf(std::span<const Point> points) {
  double square = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0;
      for (std::size_t d = 0; d < 3; ++d)
        sum += (points[i][d] - points[j][d]) * (points[i][d] - points[j][d]);
      square = std::max(square, sum);
    }
  return std::sqrt(square);
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

void nodalShares(CellType facet, std::span<const Point> points, std::span<double> shares) {
  withFacetShape(facet, [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape, Shape::dimension + 1>(points);
    Eigen::Map<typename Shape::Values> sums(shares.data());
    sums.setZero();
    for (const auto& sample : gaussSamples<Shape>())
      sums += (Shape::gaussWeight * facetNormal<Shape>(corners, sample).norm()) * sample.values;
  });
}

Eigen::Vector3d areaVector(CellType facet, std::span<const Point> points) {
  return withFacetShape(facet, [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape, Shape::dimension + 1>(points);
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    for (const auto& sample : gaussSamples<Shape>())
      vector.head<Shape::dimension + 1>() += Shape::gaussWeight * facetNormal<Shape>(corners, sample);
    return vector;
  });
}

} // namespace epafi::fem
