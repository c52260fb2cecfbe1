#pragma once

/// What shape functions and rules of prisms and pyramids are; see Shape.

#include "epafi/mesh/ShapeFunctions.hpp"

#include <vector>

namespace epafi::mesh {

/// A point of a rule.
template <int dim>
struct RulePoint {
  Coordinates<dim> xi; ///< where it is
  double weight;       ///< with which it counts
};
/// All of them.
template <int dim>
using Rule = std::vector<RulePoint<dim>>;

/// A column for each function at a point: its value, and below it its gradient.
/// \param nodes  those of the reference element
NodalColumns<4> jetsOf(CellType type, const NodalColumns<3>& nodes, const Coordinates<3>& xi);

/// A triangle's rule times order + 1 points along the edge.
Rule<3> prismRule(int order, const Rule<2>& triangle);

/// order + 1 points along each of ζ, ξ/(1 − ζ) and η/(1 − ζ).
Rule<3> pyramidRule(int order);

} // namespace epafi::mesh
