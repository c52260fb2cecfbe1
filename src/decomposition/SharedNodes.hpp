#pragma once

/// Which subdomains share a node, found by the ranks telling each other.

#include "epafi/decomposition/Pieces.hpp"

#include <vector>

namespace epafi::decomposition {

/// Fills the `sharing` of the pieces, whose nodes are numbered through all of them, part = number. Each rank holds lists of
/// its own nodes only. \throws InputError, the same on all ranks, if a node has more than maxCopies copies, or different
/// unknowns in two of them. Collective.
/// Preconditions: number, part, nodes and unknownOf of the pieces are set.
void shareNodes(const Outline& outline, const RCP<const Comm>& comm, std::vector<Piece>& pieces);

} // namespace epafi::decomposition
