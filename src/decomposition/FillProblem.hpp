#pragma once

/// From pieces to the problem: what scenes and applications have in common once subdomains are assembled and crosspoints
/// chosen. In this order: contact rows, changeBasis, gluing rows, fillSubdomains, attachRows.

#include "epafi/decomposition/Crosspoints.hpp"
#include "epafi/decomposition/DecomposedProblem.hpp"
#include "epafi/decomposition/Pieces.hpp"

#include <vector>

namespace epafi::decomposition {

/// Averages along edges become unknowns of the pieces, whose rows are so far those of contact; returns them piece by
/// piece. Not collective.
std::vector<std::vector<Average>> changeBasis(const Outline& outline, std::vector<Piece>& pieces);

/// The subdomains, their splitting in remainders and crosspoints, and the maps of both; moves what is assembled out of the
/// pieces, what it takes to attach B stays. Precondition: `problem.comm` is set. Collective.
void fillSubdomains(const Outline& outline, const CrosspointNumbering& crosspoints,
                    const std::vector<std::vector<Average>>& averages, std::vector<Piece>& pieces,
                    DecomposedProblem& problem);

/// B and the maps of the multipliers: entries named by global rows become local; gaps become 0. Collective.
void attachRows(const Rows& contact, const Rows& gluing, const std::vector<Piece>& pieces,
                DecomposedProblem& problem);

} // namespace epafi::decomposition
