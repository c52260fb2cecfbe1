#pragma once

/// Whether nodes that a contact's `Distance` has left out meet the other side all the same.

#include "epafi/simulation/SolvedScene.hpp"

#include <string>

namespace epafi::simulation {

/// Which contacts overlap at nodes that are farther apart than their distance before the load, and so have no
/// row: what was solved lacks inequalities there. In words, with the distance that takes them in; empty if
/// none does. Rows are laid out once more, without a distance, where the sides move far enough to matter.
/// \param doubt  why that could not be done; else as it was
/// Collective.
std::string overlapsBeyondDistance(const SolvedScene& solved, std::string& doubt);

} // namespace epafi::simulation
