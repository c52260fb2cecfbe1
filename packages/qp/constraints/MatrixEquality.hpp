#pragma once

/// Equality constraints from any matrix or operator B and right-hand side c: full row rank or redundant.

#include "epafi/base/Types.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"
#include "epafi/qp/operators/NormEstimate.hpp"

#include <functional>
#include <span>
#include <string>

namespace epafi::qp {

/// Bx = c in a form that suits SMALBE, together with what was found on the way.
struct PreparedEquality {
  RCP<const EqualityConstraint> constraint; ///< null if no row says anything
  /// The multiplier of the rows of B, on B's range map, from one of the prepared constraint.
  std::function<RCP<Vector>(std::span<const double>)> multiplierOfRows;
  GlobalOrdinal numRows = 0;
  double norm = 0;           ///< ‖B‖, or the Frobenius norm of B: what Bx − c is measured by
  GlobalOrdinal rank = 0;    ///< independent rows; numRows where this was not looked for
  std::string contradiction; ///< why the rows contradict each other; empty if they do not
  RCP<Vector> certificate;   ///< then: y with Bᵀy = 0, yᵀc < 0, of length 1
};

/// Up to `maxDenseRows` rows are made orthonormal: with BBᵀ = VΛVᵀ (rows scaled to length 1 first) the
/// constraint is Λ^{-½}Vᵀ(Bx − c) = 0 without the zero eigenvalues, that is without redundant rows; rows that
/// contradict each other are found. Cost: as many products with Bᵀ and B as there are rows, their squared
/// number in memory on each rank. More rows are only divided by ‖B‖.
///
/// \param b  B, m × n, with a transposed apply; its domain map is that of x
/// \param c  on B's range map; null for 0
/// Rows whose directions differ by less than about 1e-7 count as the same.
/// \throws InputError if B cannot be applied transposed or c is not on its range map. Collective.
PreparedEquality prepareEquality(const RCP<const Operator>& b, const RCP<const Vector>& c, int maxDenseRows,
                                 const NormEstimateParameters& norm);

} // namespace epafi::qp
