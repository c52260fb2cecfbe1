#pragma once

/// Shape functions of order 1 on reference elements, with Gauss rules. Two families make all cells and facets; their nodes
/// are in the order of Cell.hpp:
///   Simplex<dim>  0 ≤ ξᵢ, Σξᵢ ≤ 1; node 0 at the origin, node i at 1 on axis i     edge, triangle, tetrahedron
///   Brick<dim>    [−1, 1]^dim                                                       quadrilateral, hexahedron
/// Both offer the same members, so that what is written for one shape holds for all (withShape, withFacetShape).

#include "epafi/fem/Cell.hpp"

#include <Eigen/Core>

#include <array>
#include <cassert>
#include <cstddef>
#include <utility>

namespace epafi::fem {

/// Sizes and types that the members of a shape share.
template <int dim, int nodes, int gaussPoints>
struct ShapeTypes {
  static constexpr int dimension = dim;
  static constexpr int numNodes = nodes;
  static constexpr int numGaussPoints = gaussPoints;
  using Coordinates = Eigen::Matrix<double, dim, 1>;   ///< ξ
  using Values = Eigen::Matrix<double, nodes, 1>;      ///< N_a
  using Gradients = Eigen::Matrix<double, dim, nodes>; ///< ∂N_a/∂ξ, a column each
};

/// Edge, triangle or tetrahedron: N_0 = 1 − Σξᵢ, N_i = ξᵢ. The rule is the centre, exact for linear functions: for the
/// stiffness and for constant loads.
template <int dim>
struct Simplex : ShapeTypes<dim, dim + 1, 1> {
  using Types = ShapeTypes<dim, dim + 1, 1>;
  using typename Types::Coordinates, typename Types::Values, typename Types::Gradients;
  static constexpr double gaussWeight = dim == 1 ? 1.0 : dim == 2 ? 1.0 / 2 : 1.0 / 6; ///< of each point

  static Values values(const Coordinates& xi);
  static Gradients gradients(const Coordinates& xi);
  static Coordinates corner(int node);
  static Coordinates centre();
  static Coordinates gaussPoint(int /*point*/) { return centre(); }
};

/// Quadrilateral or hexahedron: N_a = Πᵢ(1 + sᵢξᵢ)/2 with the corner s. The rule has two points along each axis, exact for
/// cubic functions of each ξᵢ: for areas, volumes, constant loads and pressures on elements of any form, for the stiffness
/// of parallelograms and parallelepipeds.
template <int dim>
struct Brick : ShapeTypes<dim, 1 << dim, 1 << dim> {
  using Types = ShapeTypes<dim, 1 << dim, 1 << dim>;
  using typename Types::Coordinates, typename Types::Values, typename Types::Gradients;
  static constexpr double gaussWeight = 1; ///< of each point

  static Values values(const Coordinates& xi);
  static Gradients gradients(const Coordinates& xi);
  static Coordinates corner(int node);
  static Coordinates centre() { return Coordinates::Zero(); }
  /// The one next to the node of this number.
  static Coordinates gaussPoint(int point);
};

extern template struct Simplex<1>;
extern template struct Simplex<2>;
extern template struct Simplex<3>;
extern template struct Brick<2>;
extern template struct Brick<3>;

/// The shape functions at a point.
template <class Shape>
struct ShapeSample {
  typename Shape::Values values;
  typename Shape::Gradients gradients;
};

template <class Shape>
ShapeSample<Shape> sampleAt(const typename Shape::Coordinates& xi) {
  return {Shape::values(xi), Shape::gradients(xi)};
}

/// Samples at the Gauss points, made once.
template <class Shape>
const auto& gaussSamples() {
  static const auto samples = [] {
    std::array<ShapeSample<Shape>, static_cast<std::size_t>(Shape::numGaussPoints)> all;
    for (int i = 0; i < Shape::numGaussPoints; ++i)
      all[static_cast<std::size_t>(i)] = sampleAt<Shape>(Shape::gaussPoint(i));
    return all;
  }();
  return samples;
}

/// Samples at the nodes, made once.
template <class Shape>
const auto& cornerSamples() {
  static const auto samples = [] {
    std::array<ShapeSample<Shape>, static_cast<std::size_t>(Shape::numNodes)> all;
    for (int i = 0; i < Shape::numNodes; ++i)
      all[static_cast<std::size_t>(i)] = sampleAt<Shape>(Shape::corner(i));
    return all;
  }();
  return samples;
}

/// The sample at the centre, made once.
template <class Shape>
const ShapeSample<Shape>& centreSample() {
  static const ShapeSample<Shape> sample = sampleAt<Shape>(Shape::centre());
  return sample;
}

/// action(shape) for the shape of a type of plane or solid cell and an order; `decltype(shape)` is the shape. Returns what the
/// action does.
template <class Action>
decltype(auto) withShape(CellType type, Action&& action, [[maybe_unused]] int order = 1) {
  assert(dimensionOf(type) > 1 && order == 1);
  switch (type) {
  case CellType::triangle:
    return std::forward<Action>(action)(Simplex<2>{});
  case CellType::quadrilateral:
    return std::forward<Action>(action)(Brick<2>{});
  case CellType::tetrahedron:
    return std::forward<Action>(action)(Simplex<3>{});
  default:
    return std::forward<Action>(action)(Brick<3>{});
  }
}

/// The same for a facet: a line, a triangle or a quadrilateral.
template <class Action>
decltype(auto) withFacetShape(CellType type, Action&& action, [[maybe_unused]] int order = 1) {
  assert(dimensionOf(type) < 3 && order == 1);
  switch (type) {
  case CellType::line:
    return std::forward<Action>(action)(Simplex<1>{});
  case CellType::triangle:
    return std::forward<Action>(action)(Simplex<2>{});
  default:
    return std::forward<Action>(action)(Brick<2>{});
  }
}

} // namespace epafi::fem
