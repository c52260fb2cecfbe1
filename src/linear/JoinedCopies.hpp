#pragma once

/// Whether the global numbers of unknowns and the way subdomains are joined say the same.

#include "epafi/linear/UnknownExchange.hpp"

namespace epafi::linear {

/// A function u on the whole problem, cut into subdomains by R, satisfies all gluing rows, B_E R u = 0, and its copies at
/// crosspoints agree; and no other functions on the subdomains do, n = n_r + n_c − n_E.
/// \param numOthers  numbers on this rank's part of the map that no unknown has
/// \throws InputError, the same on all ranks, if that is not so. Collective.
void requireJoinedCopies(const decomposition::DecomposedProblem& problem, const GlobalUnknowns& unknowns,
                         std::size_t numOthers, const UnknownExchange& exchange);

} // namespace epafi::linear
