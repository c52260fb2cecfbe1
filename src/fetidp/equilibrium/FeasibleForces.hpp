#pragma once

/// What multipliers may be. Whoever asks for the sign of a force asks this set: the iteration, certificates,
/// recovery, starts, contradictions.

#include "epafi/decomposition/ProblemData.hpp"
#include "epafi/qp/constraints/ConvexSet.hpp"

namespace epafi::fetidp {

/// λ_n ≥ 0 in the rows of contact, |λ_t| ≤ g + μ times the normal force at nodes with friction (in the plane
/// an interval, in space a disc), any number in the rows of ties and gluing; on multiplierMap. Collective.
/// \param normal  where normal forces are taken from, with friction; null: friction holds any force
RCP<const qp::ConvexSet> feasibleForces(const decomposition::DecomposedProblem& problem,
                                        const decomposition::ProblemData& data, const Vector* normal);

/// The same where friction holds nothing: what proves that constraints contradict each other, which friction
/// is none of. Not collective.
RCP<const qp::ConvexSet> feasibleForcesWithoutFriction(const decomposition::DecomposedProblem& problem);

} // namespace epafi::fetidp
