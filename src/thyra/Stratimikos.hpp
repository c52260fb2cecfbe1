#pragma once

/// Epafi among the linear solvers and preconditioners that Stratimikos picks by name from a parameter list.

#include "epafi/linear/UnassembledOperator.hpp"

#include <string>

namespace Stratimikos {
class DefaultLinearSolverBuilder;
} // namespace Stratimikos

namespace epafi::thyra {

/// From now on "Linear Solver Type" = `name` is FetiDpFactory, with its parameters in the list "Linear Solver Types/`name`".
/// Precondition: the builder has no parameters yet. Not collective.
void enableFetiDp(Stratimikos::DefaultLinearSolverBuilder& builder,
                  const std::string& name = "Epafi FETI-DP");

/// "Preconditioner Type" = `name` is BddcFactory(k), with its parameters in "Preconditioner Types/`name`"; likewise.
/// \param k  the decomposition of forward operators that are assembled; null if they are UnassembledOperators themselves
void enableBddc(Stratimikos::DefaultLinearSolverBuilder& builder,
                const RCP<const linear::UnassembledOperator>& k = Teuchos::null,
                const std::string& name = "Epafi BDDC");

} // namespace epafi::thyra
