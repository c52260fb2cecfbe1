#pragma once

#include "epafi/base/Types.hpp"
#include "epafi/decomposition/ContactPlace.hpp"

#include <vector>

namespace epafi::decomposition {

/// Rows over the unknowns of nodes, B u ≤ c of contact or B u = c of tied joints, with the prescribed values
/// still among u. The unknown of a node's component is node × components + component, nodes numbered through
/// all bodies.
struct ConstraintMatrix {
  RCP<const CrsMatrix> rows; ///< B, fill-complete; its rows are numbered from 0
  RCP<const Vector> gap;     ///< c, on the row map of B
  /// Of this rank's rows, as far as anyone knows: what tells bodies that only the facets of their surfaces
  /// hold.
  std::vector<ContactPlace> places = {};
};

} // namespace epafi::decomposition
