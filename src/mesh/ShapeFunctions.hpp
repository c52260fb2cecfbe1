#pragma once

/// Shape functions of order 1 and 2 on reference elements, with Gauss rules. Two families make most cells and
/// all facets, two more what lies between them; their nodes are in the order of Cell.hpp:
///   simplices 0 ≤ ξᵢ, Σξᵢ ≤ 1; corner 0 at the origin, corner i at 1 on axis i edge, triangle, tetrahedron
///   bricks [−1, 1]^dim quadrilateral, hexahedron
///   prisms a triangle × [−1, 1]
///   pyramids |ξ|, |η| ≤ 1 − ζ ≤ 1
/// What is written for a dimension holds for all shapes of it: their numbers of nodes are known when the
/// program runs, so that it is compiled once for each dimension, not for each shape (withShape,
/// withFacetShape).
///
/// Two rules: that of *gaussSamples* serves stiffnesses and is exact for them on elements with straight edges
/// (bricks: parallelepipeds), and for constant strains on curved ones; that of *fineSamples* serves measures,
/// loads and estimates and is exact for squares of shape functions there, and for what curved edges make of
/// measures and pressures. They are the same where one rule does both. A third one, *reducedSamples*, is less
/// than a stiffness asks for, and others have it: of bricks and edges of order 2 as many Gauss points along
/// each axis as the order, of prisms of order 1 two, of order 2 nine. It leaves motions of single elements
/// without energy (BracedElements.hpp) but of prisms of order 2.

#include "epafi/mesh/Cell.hpp"

#include <Eigen/Core>

#include <cassert>
#include <span>
#include <utility>
#include <vector>

namespace epafi::mesh {

template <int dim>
using Coordinates = Eigen::Matrix<double, dim, 1>; ///< ξ
/// A value at each node. No memory is allocated for it.
using NodalValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, mostNodes, 1>;
/// A column for each node, likewise.
template <int rows>
using NodalColumns = Eigen::Matrix<double, rows, Eigen::Dynamic,
                                   rows == 1 ? Eigen::RowMajor : Eigen::ColMajor, rows, mostNodes>;

/// The shape functions at a point, and its weight in a rule.
template <int dim>
struct ShapeSample {
  Coordinates<dim> xi;
  NodalValues values;          ///< N_a
  NodalColumns<dim> gradients; ///< ∂N_a/∂ξ, a column each
  double weight = 0;
};

constexpr int power(int base, int exponent) {
  return exponent == 0 ? 1 : base * power(base, exponent - 1);
}

/// One shape; see referenceShape.
///
/// Simplices of order 1: N_0 = L_0 = 1 − Σξᵢ, N_i = L_i = ξᵢ; the rule is the centre, for both purposes.
/// Order 2: L_a(2L_a − 1) at the corners, 4L_aL_b between them; the rules have degrees 2 and 4 (tetrahedron:
/// 3 and 5). Bricks: products of the order's functions of each ξᵢ. The rule has order + 1 points along each
/// axis, exact for degree 2 · order + 1 in each ξᵢ: for areas, volumes, constant loads and pressures on
/// elements of any form. Each of its points is the one next to the node of its number. Bricks without inner
/// nodes: functions and rule of those with them, whose inner nodes follow the others (Serendipity): N_a gets
/// what a has in each inner node.
///
/// Prisms and pyramids have on each facet the functions of that facet, on edges alone of order 2. Prisms:
/// products of those of a triangle and an edge; of order 2 without those that belong to middles of sides.
/// Their rules are a triangle's times order + 1 points along the edge. Pyramids: rational functions
/// (Bedrosian, *Int. J. Numer. Meth. Engng* 35 (1992)), polynomials in 1 − ζ, ξ/(1 − ζ) and η/(1 − ζ), and a
/// Gauss rule of order + 1 points along each of these, exact for constant strains.
template <int dim>
class Shape {
public:
  using Samples = std::vector<ShapeSample<dim>>;

  explicit Shape(CellType shapeType);

  const CellType type;
  const bool isSimplex, isBrick;
  const int order, numNodes;
  const double measure; ///< of the reference element

  [[nodiscard]] NodalValues values(const Coordinates<dim>& xi) const;
  [[nodiscard]] NodalColumns<dim> gradients(const Coordinates<dim>& xi) const;
  [[nodiscard]] ShapeSample<dim> sampleAt(const Coordinates<dim>& xi, double weight = 0) const {
    return {xi, values(xi), gradients(xi), weight};
  }
  [[nodiscard]] auto node(int number) const { return nodes_.col(number); } ///< where a node is
  [[nodiscard]] const Coordinates<dim>& centre() const { return centreSample_.xi; }

  [[nodiscard]] const Samples& gaussSamples() const { return gaussSamples_; }
  [[nodiscard]] const Samples& fineSamples() const {
    return fineSamples_.empty() ? gaussSamples_ : fineSamples_;
  }
  /// The same, of simplices of order 1 as of those of order 2: for integrands that a radius multiplies.
  [[nodiscard]] const Samples& revolvedSamples() const {
    return revolvedSamples_.empty() ? fineSamples() : revolvedSamples_;
  }
  /// Of prisms, and of bricks and edges of order 2; of others those of stiffnesses.
  [[nodiscard]] const Samples& reducedSamples() const {
    return reducedSamples_.empty() ? gaussSamples_ : reducedSamples_;
  }
  [[nodiscard]] const Samples& nodeSamples() const { return nodeSamples_; } ///< at the nodes; weights 0
  /// Of prisms and pyramids of order 2: what values at gaussSamples make at the nodes, carried on by the
  /// nearest function of order 1; a row a node.
  [[nodiscard]] const Eigen::MatrixXd& fromGaussToNodes() const { return fromGaussToNodes_; }
  [[nodiscard]] const ShapeSample<dim>& centreSample() const {
    return centreSample_;
  } ///< its weight is the measure

private:
  void placeNodes();
  void findFollowers();
  void setSamples();
  [[nodiscard]] NodalValues valuesOfAll(const Coordinates<dim>& xi) const;
  [[nodiscard]] NodalColumns<dim> gradientsOfAll(const Coordinates<dim>& xi) const;

  NodalColumns<dim> nodes_; ///< inner ones that the shape has not stand behind the others
  /// What each node has in each of these, a column each; empty: there are none.
  Eigen::MatrixXd followers_, fromGaussToNodes_;
  ShapeSample<dim> centreSample_;
  Samples gaussSamples_, fineSamples_, revolvedSamples_, reducedSamples_, nodeSamples_;
};

extern template class Shape<1>;
extern template class Shape<2>;
extern template class Shape<3>;

/// Made once. Precondition: cells of this type have the dimension.
template <int dim>
const Shape<dim>& referenceShape(CellType type);
extern template const Shape<1>& referenceShape(CellType type);
extern template const Shape<2>& referenceShape(CellType type);
extern template const Shape<3>& referenceShape(CellType type);

/// What the corners' functions of order 1 are at the nodes of a plane or solid cell of any order: a row a
/// node, a column a corner. Made once.
const Eigen::MatrixXd& cornerShares(CellType type);

/// action(shape) for the shape of a plane or solid cell, a Shape<2> or Shape<3>. Returns what the action
/// does.
template <class Action>
decltype(auto) withShape(CellType type, Action&& action) {
  assert(dimensionOf(type) > 1);
  return dimensionOf(type) == 2 ? std::forward<Action>(action)(referenceShape<2>(type))
                                : std::forward<Action>(action)(referenceShape<3>(type));
}

/// The same for a facet: a line, a triangle or a quadrilateral; a Shape<1> or Shape<2>.
template <class Action>
decltype(auto) withFacetShape(CellType type, Action&& action) {
  assert(dimensionOf(type) < 3);
  return dimensionOf(type) == 1 ? std::forward<Action>(action)(referenceShape<1>(type))
                                : std::forward<Action>(action)(referenceShape<2>(type));
}

} // namespace epafi::mesh
