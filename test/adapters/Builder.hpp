#pragma once

/// An application's own Stratimikos builder, which only C++17 takes with Trilinos 13.2.

#include "epafi/adapters/Stratimikos.hpp"

#include <Teuchos_ParameterList.hpp>

namespace epafi::adapters {

/// What a builder with Epafi's two strategies, enabled under other names than their own, makes of a list.
RCP<LinearSolveStrategy> strategyOfOwnBuilder(const RCP<Teuchos::ParameterList>& list,
                                              const RCP<const linear::UnassembledOperator>& k);
/// The lists that a builder with Epafi's two strategies takes.
RCP<const Teuchos::ParameterList> validParametersOfBuilder();

} // namespace epafi::adapters
