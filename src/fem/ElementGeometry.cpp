#include "epafi/fem/ElementGeometry.hpp"

#include "epafi/fem/ElementMap.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

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

std::array<double, 4> nodalShares(std::span<const Point> points) {
  return withFacetShape(points.size(), [&](auto shape) {
    using Shape = decltype(shape);
    const auto corners = relativeCorners<Shape, Shape::dimension + 1>(points);
    std::array<double, 4> shares{};
    for (const auto& sample : gaussSamples<Shape>()) {
      const double measure = Shape::gaussWeight * facetNormal<Shape>(corners, sample).norm();
      for (std::size_t a = 0; a < points.size(); ++a)
        shares[a] += measure * sample.values[static_cast<Eigen::Index>(a)];
    }
    return shares;
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
