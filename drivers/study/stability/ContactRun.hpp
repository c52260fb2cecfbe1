#pragma once

/// One contact problem, solved and checked against the undecomposed problem.

#include "CaseTable.hpp"
#include "StabilityCase.hpp"

namespace epafi::drivers {

/// Solves the scene of a case within a minute of iterations. Besides scene and Solver its list may give:
///
///   Tolerance           1e-8 if it does not
///   Contrast            of the materials' stiffness; more than 1 or less
///   Reference Solution  "no": no direct solver is asked as well, which would take minutes
///   Closed Nodes        that a right answer has
///   Application, Number what an application does to the problem before it hands it over, and the number that
///   it writes. Such
///                       problems are checked by the solver's own residuals alone: there is no scene that
///                       they belong to
///   Unit of Loads       factor on the loads of elastic bodies
///   Check "start from the solution": again, which may divide nothing by the gradient that is left;
///                       "on one rank too"
///   Reference a case with the same solution and the same way there, the energy in another Unit of Energy
///
/// Outcome: solved, wrongAnswer, or stopped. Collective. \throws InputError, SolvabilityError or Error, the
/// same on all ranks.
CaseResult runContact(const Case& which, const RCP<const Comm>& comm);

} // namespace epafi::drivers
