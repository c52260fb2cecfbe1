#pragma once

/// Is there an x in Ω with Bx = c? The least-squares problem min ½‖Bx − c‖² over Ω says so without a product
/// with A.

#include "epafi/qp/constraints/ConvexSet.hpp"
#include "epafi/qp/constraints/EqualityConstraint.hpp"

#include <vector>

namespace epafi::qp {

struct Feasibility {
  bool isFeasible = true; ///< false only with a certificate
  double distance = 0;    ///< smallest ‖Bx − c‖ found
  std::vector<double>
      certificate; ///< if infeasible: y = Bx − c there, so that yᵀ(Bx − c) > 0 for every x in Ω
};

/// Moves x to a point of Ω that is nearest to Bx = c in that sense, if it was not there already. Infeasible
/// is said if ‖Bx − c‖ stays above 1e-8 (‖c‖ + ‖B‖‖x‖) while the gradient Bᵀ(Bx − c) has vanished beside it.
/// Collective.
Feasibility findFeasiblePoint(const RCP<const EqualityConstraint>& equality, const RCP<const ConvexSet>& set,
                              Vector& x);

} // namespace epafi::qp
