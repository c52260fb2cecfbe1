#pragma once

/// One quadratic program as dense data, solved by qp::QpSolver and checked from these data alone.

#include "StabilityCase.hpp"

#include "epafi/benchmarks/DenseProgram.hpp"

#include <Teuchos_ParameterList.hpp>

namespace epafi::drivers {

/// From the list Program: Size springs in a row (Springs, 1 or 0), the first one held, under a Load on each,
/// Lower ≤ x ≤ Upper; Rows that ask for Σx = Value, all but the first with one coefficient larger by Change;
/// the objective times Factor. The lists Hessian Entries {"i j"}, Load Entries, Lower Entries … replace
/// single entries.
benchmarks::DenseProgram programOf(const Teuchos::ParameterList& list);

/// Solves the list Program of a case with the parameters of its list Solver; the start is Program/Start: a
/// number for all entries, "ascending", or the "solution" without bounds. Check "solve twice": all data must
/// be as they were, and a second solve must do as the first one did. A list Reference is a case with the same
/// x, and multipliers that are, in the Unit of Energy, the same or add up to the same.
///
/// Outcome: solved if the conditions of Karush, Kuhn and Tucker hold, recomputed in extended precision;
/// noSolution if the certificate of it does; stopped; or wrongAnswer. Collective. \throws InputError, the
/// same on all ranks.
CaseResult runProgram(const Teuchos::ParameterList& list, const RCP<const Comm>& comm);

} // namespace epafi::drivers
