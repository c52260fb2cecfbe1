#pragma once

/// Stratimikos with Epafi's strategies and those of its peers. Needs no more than C++17.

#include "epafi/adapters/Stratimikos.hpp"

#include <Teuchos_ParameterList.hpp>

namespace epafi::drivers {

/// The solver that a list asks for; "Preconditioner Type" may also be "MueLu" or "FROSch". \param k the
/// decomposition of operators that are assembled. Not collective. \throws what Stratimikos throws if a
/// parameter is wrong
RCP<adapters::LinearSolveStrategy> strategyAmongPeers(const RCP<Teuchos::ParameterList>& list,
                                                      const RCP<const linear::UnassembledOperator>& k);

} // namespace epafi::drivers
