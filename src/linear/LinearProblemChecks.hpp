#pragma once

/// What linear solvers have to refuse.

#include "epafi/linear/UnassembledOperator.hpp"

#include <string>

namespace epafi::linear {

/// \throws InputError if the problem has rows of contact, SolvabilityError (not unique) if a body floats,
/// InputError if an entry of K or B is no finite number; the same on all ranks. \param what the solver's name
/// for people Collective. Returns the problem.
const decomposition::DecomposedProblem& requireLinearProblem(const UnassembledOperator& k,
                                                             const std::string& what);

/// Whether the global numbers of unknowns and the way subdomains are joined say the same: a function u on the
/// whole problem, cut into subdomains by R, satisfies all gluing rows, B_E R u = 0, and its copies at
/// crosspoints agree; and no other functions on the subdomains do, n = n_r + n_c − n_E.
/// \param numOthers  numbers on this rank's part of the map that no unknown has
/// \throws InputError, the same on all ranks, if that is not so. Collective.
void requireJoinedCopies(const decomposition::DecomposedProblem& problem, const GlobalUnknowns& unknowns,
                         std::size_t numOthers, const UnknownExchange& exchange);

} // namespace epafi::linear
