#pragma once

/// The map x(ξ) = Σ N_a(ξ) x_a from a reference element to one in the plane or in space.

#include "epafi/fem/Mesh.hpp"
#include "epafi/fem/ShapeFunctions.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cassert>
#include <span>

namespace epafi::fem {

/// Corners less the first one, a column each: far from the origin, differences of coordinates are still exact.
template <class Shape, int space = Shape::dimension>
Eigen::Matrix<double, space, Shape::numNodes> relativeCorners(std::span<const Point> points) {
  assert(points.size() == static_cast<std::size_t>(Shape::numNodes));
  Eigen::Matrix<double, space, Shape::numNodes> corners;
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t i = 0; i < static_cast<std::size_t>(space); ++i)
      corners(static_cast<int>(i), static_cast<int>(a)) = points[a][i] - points[0][i];
  return corners;
}

/// ∂x/∂ξ and what follows from it, at one point of an element that fills its space.
template <class Shape>
class ElementMap {
public:
  using Jacobian = Eigen::Matrix<double, Shape::dimension, Shape::dimension>;
  using Corners = Eigen::Matrix<double, Shape::dimension, Shape::numNodes>;

  ElementMap(const Corners& corners, const ShapeSample<Shape>& sample)
      : jacobian_(corners * sample.gradients.transpose()) {}

  [[nodiscard]] const Jacobian& jacobian() const { return jacobian_; }
  [[nodiscard]] double determinant() const { return jacobian_.determinant(); }
  /// ∂N_a/∂x, a column each. Precondition: the determinant is not 0.
  [[nodiscard]] typename Shape::Gradients gradients(const ShapeSample<Shape>& sample) const {
    return jacobian_.inverse().transpose() * sample.gradients;
  }

private:
  Jacobian jacobian_;
};

/// Normal of a facet at a point, as long as the facet's length or area there is greater than the reference element's. It
/// points to the right of an edge, and to where a face is seen counter-clockwise: outwards.
template <class Shape>
Eigen::Matrix<double, Shape::dimension + 1, 1>
facetNormal(const Eigen::Matrix<double, Shape::dimension + 1, Shape::numNodes>& corners,
            const ShapeSample<Shape>& sample) {
  const Eigen::Matrix<double, Shape::dimension + 1, Shape::dimension> tangents =
      corners * sample.gradients.transpose();
  if constexpr (Shape::dimension == 1)
    return {tangents(1, 0), -tangents(0, 0)};
  else
    return tangents.col(0).cross(tangents.col(1));
}

} // namespace epafi::fem
