#pragma once

/// What a linear solver has to refuse.

#include "epafi/linear/UnassembledOperator.hpp"

#include <string>

namespace epafi::linear {

/// \throws InputError if the problem has rows of contact, SolvabilityError (not unique) if a body floats, InputError if an entry
/// of K or B is no finite number; the same on all ranks. \param what  the solver's name for people
/// Collective. Returns the problem.
const decomposition::DecomposedProblem& requireLinearProblem(const UnassembledOperator& k,
                                                             const std::string& what);

} // namespace epafi::linear
