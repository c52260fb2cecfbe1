#pragma once

/// What is refused before anything is computed with it, or when the iteration has proved it: numbers that are none, and rows of
/// contact that contradict each other, or the supports.

#include "epafi/decomposition/DecomposedProblem.hpp"

namespace epafi::fetidp {

/// \throws InputError on all ranks that names body and subdomain if an entry of a stiffness matrix is NaN or infinite, or
/// one of a row of B. An infinite entry on the diagonal would pass for a support. Collective.
void requireFiniteMatrices(const decomposition::DecomposedProblem& problem);

/// The same for loads and gaps. Collective.
void requireFiniteData(const decomposition::DecomposedProblem& problem);

/// Throws SolvabilityError if a contact row that no free unknown can influence is violated: supports and gap
/// contradict each other. Collective.
void requireFeasibleGaps(const decomposition::DecomposedProblem& problem);

/// Throws SolvabilityError if d proves that no u satisfies B_I u ≤ c_I, B_E u = 0: d_I ≥ 0, Bᵀd = 0 and cᵀd < 0 (Farkas), each
/// to round-off of its terms, whatever the stiffness of the bodies. \param d  on multiplierMap
/// Collective.
void refuseContradiction(const decomposition::DecomposedProblem& problem, const Vector& d);

} // namespace epafi::fetidp
