#pragma once

/// One way to solve a problem of the accuracy study, measured.

#include "AccuracyReference.hpp"
#include "AccuracyTable.hpp"
#include "CaseTable.hpp"

namespace epafi::drivers {

/// Solves a problem on a mesh of its ladder by all variants in turns, several times over, so that a busy
/// machine does them all the same harm. Times are medians. Rows of iterations that stop early say so.
/// Collective.
/// \param variants  of cases/accuracy.cases: name; tolerance, "balanced" or the default's if empty; Solver,
/// Nested
/// \param budget    seconds after which there is no further round
std::vector<Row> measureVariants(const AccuracyProblem& problem, int level,
                                 const AccuracyReference& reference, const std::vector<Case>& variants,
                                 double budget, const RCP<const Comm>& comm);

} // namespace epafi::drivers
