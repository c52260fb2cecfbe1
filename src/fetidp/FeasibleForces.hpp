#pragma once

/// What multipliers may be. Whoever asks for the sign of a force asks this set: the iteration, certificates,
/// recovery, starts, contradictions.

#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/qp/ConvexSet.hpp"

namespace epafi::fetidp {

/// λ ≥ 0 in the rows of contact, any number in those of ties and gluing; on multiplierMap. Not collective.
RCP<const qp::ConvexSet> feasibleForces(const decomposition::DecomposedProblem& problem);

} // namespace epafi::fetidp
