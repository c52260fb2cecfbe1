#pragma once

/// Shape functions of order 1 and 2 on reference elements, with Gauss rules. Two families make all cells and facets; their
/// nodes are in the order of Cell.hpp:
///   Simplex<dim, order>  0 ≤ ξᵢ, Σξᵢ ≤ 1; corner 0 at the origin, corner i at 1 on axis i    edge, triangle, tetrahedron
///   Brick<dim, order>    [−1, 1]^dim                                                          quadrilateral, hexahedron
/// All offer the same members, so that what is written for one shape holds for all (withShape, withFacetShape).
///
/// Two rules: that of *gaussPoints* serves stiffnesses and is exact for them on elements with straight edges (bricks:
/// parallelepipeds), and for constant strains on curved ones; that of *finePoints* serves measures, loads and estimates and is exact for squares of shape functions
/// there, and for what curved edges make of measures and pressures. They are the same where one rule does both.

#include "epafi/fem/Cell.hpp"

#include <Eigen/Core>

#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <utility>

namespace epafi::fem {

/// A point of a rule: reference coordinates and weight.
template <int dim>
struct RulePoint {
  Eigen::Matrix<double, dim, 1> xi;
  double weight;
};

/// Sizes and types that the members of a shape share.
template <int dim, int theOrder, int nodes, int corners>
struct ShapeTypes {
  static constexpr int dimension = dim;
  static constexpr int order = theOrder;
  static constexpr int numNodes = nodes;
  static constexpr int numCorners = corners;
  using Coordinates = Eigen::Matrix<double, dim, 1>;   ///< ξ
  using Values = Eigen::Matrix<double, nodes, 1>;      ///< N_a
  using Gradients = Eigen::Matrix<double, dim, nodes>; ///< ∂N_a/∂ξ, a column each
  using Rule = std::span<const RulePoint<dim>>;
};

constexpr int power(int base, int exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/// Edge, triangle or tetrahedron. Order 1: N_0 = L_0 = 1 − Σξᵢ, N_i = L_i = ξᵢ; the rule is the centre, for both purposes.
/// Order 2: L_a(2L_a − 1) at the corners, 4L_aL_b between them; the rules have degrees 2 and 4 (tetrahedron: 3 and 5).
template <int dim, int theOrder = 1>
struct Simplex : ShapeTypes<dim, theOrder, theOrder == 1 ? dim + 1 : (dim + 1) * (dim + 2) / 2, dim + 1> {
  using Types = ShapeTypes<dim, theOrder, theOrder == 1 ? dim + 1 : (dim + 1) * (dim + 2) / 2, dim + 1>;
  using typename Types::Coordinates, typename Types::Values, typename Types::Gradients, typename Types::Rule;
  static constexpr bool isSimplex = true;
  static constexpr double measure = dim == 1   ? 1.0
                                    : dim == 2 ? 1.0 / 2
                                               : 1.0 / 6; ///< of the reference element
  static constexpr int numGaussPoints = theOrder == 1 ? 1 : dim < 3 ? 3 : 8;
  static constexpr int numFinePoints = theOrder == 1 ? 1 : dim == 1 ? 3 : dim == 2 ? 6 : 14;

  static Values values(const Coordinates& xi);
  static Gradients gradients(const Coordinates& xi);
  static Coordinates node(int number); ///< where a node is
  static Coordinates centre();
  static Rule gaussPoints();
  static Rule finePoints();
};

/// Quadrilateral or hexahedron: products of the order's functions of each ξᵢ. The rule has order + 1 points along each axis,
/// exact for degree 2 · order + 1 in each ξᵢ: for areas, volumes, constant loads and pressures on elements of any form.
template <int dim, int theOrder = 1>
struct Brick : ShapeTypes<dim, theOrder, power(theOrder + 1, dim), 1 << dim> {
  using Types = ShapeTypes<dim, theOrder, power(theOrder + 1, dim), 1 << dim>;
  using typename Types::Coordinates, typename Types::Values, typename Types::Gradients, typename Types::Rule;
  static constexpr bool isSimplex = false;
  static constexpr double measure = 1 << dim;
  static constexpr int numGaussPoints = Types::numNodes, numFinePoints = Types::numNodes;

  static Values values(const Coordinates& xi);
  static Gradients gradients(const Coordinates& xi);
  static Coordinates node(int number);
  static Coordinates centre() { return Coordinates::Zero(); }
  /// Each point is the one next to the node of this number.
  static Rule gaussPoints();
  static Rule finePoints() { return gaussPoints(); }
};

extern template struct Simplex<1>;
extern template struct Simplex<2>;
extern template struct Simplex<3>;
extern template struct Brick<2>;
extern template struct Brick<3>;
extern template struct Simplex<1, 2>;
extern template struct Simplex<2, 2>;
extern template struct Simplex<3, 2>;
extern template struct Brick<2, 2>;
extern template struct Brick<3, 2>;

/// The shape functions at a point, and its weight in a rule.
template <class Shape>
struct ShapeSample {
  typename Shape::Values values;
  typename Shape::Gradients gradients;
  double weight = 0;
};

template <class Shape>
ShapeSample<Shape> sampleAt(const typename Shape::Coordinates& xi, double weight = 0) {
  return {Shape::values(xi), Shape::gradients(xi), weight};
}

/// The samples of a rule.
template <class Shape, std::size_t number>
std::array<ShapeSample<Shape>, number> samplesOf(typename Shape::Rule rule) {
  assert(rule.size() == number);
  std::array<ShapeSample<Shape>, number> all;
  for (std::size_t i = 0; i < number; ++i)
    all[i] = sampleAt<Shape>(rule[i].xi, rule[i].weight);
  return all;
}

/// Samples of the rule for stiffnesses, made once.
template <class Shape>
const auto& gaussSamples() {
  static const auto samples =
      samplesOf<Shape, static_cast<std::size_t>(Shape::numGaussPoints)>(Shape::gaussPoints());
  return samples;
}

/// Samples of the finer rule, made once.
template <class Shape>
const auto& fineSamples() {
  if constexpr (Shape::numFinePoints == Shape::numGaussPoints) {
    return gaussSamples<Shape>();
  } else {
    static const auto samples =
        samplesOf<Shape, static_cast<std::size_t>(Shape::numFinePoints)>(Shape::finePoints());
    return samples;
  }
}

/// Samples at the nodes, made once.
template <class Shape>
const auto& nodeSamples() {
  static const auto samples = [] {
    std::array<ShapeSample<Shape>, static_cast<std::size_t>(Shape::numNodes)> all;
    for (int i = 0; i < Shape::numNodes; ++i)
      all[static_cast<std::size_t>(i)] = sampleAt<Shape>(Shape::node(i));
    return all;
  }();
  return samples;
}

/// The sample at the centre, made once; its weight is the whole measure.
template <class Shape>
const ShapeSample<Shape>& centreSample() {
  static const ShapeSample<Shape> sample = sampleAt<Shape>(Shape::centre(), Shape::measure);
  return sample;
}

/// action(shape) for the shape of a plane or solid cell; `decltype(shape)` is the shape. Returns what the action does.
template <class Action>
decltype(auto) withShape(CellType type, Action&& action) {
  assert(dimensionOf(type) > 1);
  switch (type) {
  case CellType::triangle:
    return std::forward<Action>(action)(Simplex<2>{});
  case CellType::quadrilateral:
    return std::forward<Action>(action)(Brick<2>{});
  case CellType::tetrahedron:
    return std::forward<Action>(action)(Simplex<3>{});
  case CellType::triangle6:
    return std::forward<Action>(action)(Simplex<2, 2>{});
  case CellType::quadrilateral9:
    return std::forward<Action>(action)(Brick<2, 2>{});
  case CellType::tetrahedron10:
    return std::forward<Action>(action)(Simplex<3, 2>{});
  case CellType::hexahedron27:
    return std::forward<Action>(action)(Brick<3, 2>{});
  default:
    return std::forward<Action>(action)(Brick<3>{});
  }
}

/// The same for a facet: a line, a triangle or a quadrilateral.
template <class Action>
decltype(auto) withFacetShape(CellType type, Action&& action) {
  assert(dimensionOf(type) < 3);
  switch (type) {
  case CellType::line:
    return std::forward<Action>(action)(Simplex<1>{});
  case CellType::triangle:
    return std::forward<Action>(action)(Simplex<2>{});
  case CellType::line3:
    return std::forward<Action>(action)(Simplex<1, 2>{});
  case CellType::triangle6:
    return std::forward<Action>(action)(Simplex<2, 2>{});
  case CellType::quadrilateral9:
    return std::forward<Action>(action)(Brick<2, 2>{});
  default:
    return std::forward<Action>(action)(Brick<2>{});
  }
}

} // namespace epafi::fem
