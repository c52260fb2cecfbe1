#include "epafi/fetidp/FeasibleForces.hpp"

#include "epafi/qp/Box.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include <limits>

namespace epafi::fetidp {

RCP<const qp::ConvexSet> feasibleForces(const decomposition::DecomposedProblem& problem) {
  const RCP<Vector> lower = rcp(new Vector(problem.multiplierMap));
  const auto values = lower->getDataNonConst();
  for (LocalOrdinal row = 0; row < values.size(); ++row)
    if (problem.kindOf(decomposition::OwnedMultiplier(row)) != decomposition::RowKind::contact)
      values[row] = -std::numeric_limits<double>::infinity();
  return rcp(new qp::Box(lower));
}

} // namespace epafi::fetidp
