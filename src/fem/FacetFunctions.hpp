#pragma once

/// Tractions on one facet as guaranteed bounds have them: functions ≥ 0, one a node, with the sum 1, among
/// whose sums all polynomials of the facet's order are. On edges and triangles they are Bernstein's. On
/// quadrilaterals they are polynomials on each of the four triangles round the middle; what coefficients of
/// Bernstein's they have there are means of those of the edges and the middle.

#include "epafi/mesh/Cell.hpp"
#include "epafi/mesh/ShapeFunctions.hpp"

#include <Eigen/Core>

#include <array>
#include <utility>
#include <vector>

namespace epafi::fem {

/// Abscissae in [0, 1] and weights of Gauss's rule for degree 7.
inline constexpr std::array<std::array<double, 2>, 4> fourGauss{{{0.069431844202973712, 0.17392742256872693},
                                                                 {0.33000947820757187, 0.32607257743127307},
                                                                 {0.66999052179242813, 0.32607257743127307},
                                                                 {0.93056815579702629, 0.17392742256872693}}};

struct FacetFunctions {
  /// Made once. Precondition: a line, a triangle, or a quadrilateral with inner nodes if of order 2.
  static const FacetFunctions& of(mesh::CellType facet);

  /// An edge or a triangle on which they are polynomials.
  struct Piece {
    std::vector<int> corners; ///< places among the facet's corners; their number: the middle
    Eigen::MatrixXd values;   ///< at the nodes of the piece, a column each
  };
  std::vector<Piece> pieces;
  Eigen::MatrixXd atNodes; ///< values at the facet's nodes, a column each
  Eigen::MatrixXd moments; ///< ∫ N_a β_b over the facet, by its measure
};

} // namespace epafi::fem
