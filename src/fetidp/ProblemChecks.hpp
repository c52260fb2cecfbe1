#pragma once

/// What is refused before anything is computed with it: numbers that are none.

#include "epafi/decomposition/ProblemData.hpp"

namespace epafi::fetidp {

/// \throws InputError on all ranks that names body and subdomain if an entry of a stiffness matrix is NaN or
/// infinite, or one of a row of B. An infinite entry on the diagonal would pass for a support. Collective.
void requireFiniteMatrices(const decomposition::DecomposedProblem& problem);

/// The same for loads and gaps. Collective.
void requireFiniteData(const decomposition::DecomposedProblem& problem,
                       const decomposition::ProblemData& data);

} // namespace epafi::fetidp
