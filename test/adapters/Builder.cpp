#include "Builder.hpp"

#include "epafi/adapters/Stratimikos.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>

namespace epafi::adapters {

RCP<LinearSolveStrategy> strategyOfOwnBuilder(const RCP<Teuchos::ParameterList>& list,
                                              const RCP<const linear::UnassembledOperator>& k) {
  Stratimikos::DefaultLinearSolverBuilder builder;
  enableFetiDp(builder, "Tearing");
  enableBddc(builder, k, "Balancing");
  builder.setParameterList(list);
  return Thyra::createLinearSolveStrategy(builder);
}

RCP<const Teuchos::ParameterList> validParametersOfBuilder() {
  Stratimikos::DefaultLinearSolverBuilder builder;
  enableFetiDp(builder);
  enableBddc(builder);
  return builder.getValidParameters();
}

} // namespace epafi::adapters
