#pragma once

/// The map x(ξ) = Σ N_a(ξ) x_a from a reference element to one in the plane or in space.

#include "epafi/mesh/Mesh.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cassert>
#include <span>

namespace epafi::mesh {

/// Nodes less the first one, a column each: far from the origin, differences of coordinates are still exact.
template <int space>
NodalColumns<space> relativeCorners(std::span<const Point> points) {
  assert(points.size() <= mostNodes);
  NodalColumns<space> corners(space, points.size());
  for (int a = 0; a < std::ssize(points); ++a)
    for (int i = 0; i < space; ++i)
      corners(i, a) = points[a][i] - points[0][i];
  return corners;
}

/// ∂/∂ξ of what has these values at the nodes, a column each.
template <class Nodal, int dim>
Eigen::Matrix<double, Nodal::RowsAtCompileTime, dim> derivatives(const Nodal& nodal,
                                                                 const ShapeSample<dim>& sample) {
  return nodal.lazyProduct(sample.gradients.transpose());
}

/// ∂x/∂ξ and what follows from it, at one point of an element that fills its space.
template <int dim>
class ElementMap {
public:
  using Jacobian = Eigen::Matrix<double, dim, dim>;

  ElementMap(const NodalColumns<dim>& corners, const ShapeSample<dim>& sample)
      : jacobian_(derivatives(corners, sample)) {}

  [[nodiscard]] const Jacobian& jacobian() const { return jacobian_; }
  [[nodiscard]] double determinant() const { return jacobian_.determinant(); }
  /// ∂N_a/∂x, a column each. Precondition: the determinant is not 0.
  [[nodiscard]] NodalColumns<dim> gradients(const ShapeSample<dim>& sample) const {
    const Jacobian inverse = jacobian_.inverse().transpose();
    return inverse.lazyProduct(sample.gradients);
  }

private:
  Jacobian jacobian_;
};

/// Normal of a facet at a point, as long as the facet's length or area there is greater than the reference
/// element's. It points to the right of an edge, and to where a face is seen counter-clockwise: outwards.
template <int dim>
Eigen::Matrix<double, dim + 1, 1> facetNormal(const NodalColumns<dim + 1>& corners,
                                              const ShapeSample<dim>& sample) {
  const Eigen::Matrix<double, dim + 1, dim> tangents = derivatives(corners, sample);
  if constexpr (dim == 1)
    return {tangents(1, 0), -tangents(0, 0)};
  else
    return tangents.col(0).cross(tangents.col(1));
}

} // namespace epafi::mesh
