#pragma once

/// What is refused before anything is computed with it: numbers that are none.

#include "epafi/decomposition/ProblemData.hpp"

namespace epafi::fetidp {

/// \throws InputError on all ranks that names body and subdomain if an entry of a stiffness matrix is NaN or
/// infinite, or one of a row of B. An infinite entry on the diagonal would pass for a support. Collective.
void requireFiniteMatrices(const decomposition::DecomposedProblem& problem);

/// Throws InputError, the same on all ranks, if the data are not of this problem, as it is now: none, or with
/// other subdomains, unknowns or rows. Collective.
void requireOwnData(const decomposition::DecomposedProblem& problem, const decomposition::ProblemData& data);

/// The same for loads and gaps that are not finite. Collective.
void requireFiniteData(const decomposition::DecomposedProblem& problem,
                       const decomposition::ProblemData& data);

} // namespace epafi::fetidp
