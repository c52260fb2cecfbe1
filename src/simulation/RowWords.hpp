#pragma once

/// Rows of contact and ties in the words of the scene that they come from.

#include "epafi/fetidp/equilibrium/Contradictions.hpp"
#include "epafi/model/Decompose.hpp"

namespace epafi::simulation {

/// The same error with the names of contacts, joints and bodies, and a place, instead of numbers of rows. Not
/// collective.
fetidp::ContradictionError inWordsOf(const model::Decomposition& decomposition,
                                     const fetidp::ContradictionError& error);

} // namespace epafi::simulation
