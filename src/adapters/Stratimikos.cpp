#include "epafi/adapters/Stratimikos.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>

namespace epafi::adapters {

void enableFetiDp(Stratimikos::DefaultLinearSolverBuilder& builder, const std::string& name) {
  builder.setLinearSolveStrategyFactory(fetiDpStrategy(), name);
}

void enableBddc(Stratimikos::DefaultLinearSolverBuilder& builder,
                const RCP<const linear::UnassembledOperator>& k, const std::string& name) {
  builder.setPreconditioningStrategyFactory(bddcStrategy(k), name);
}

RCP<LinearSolveStrategy> linearSolveStrategy(const RCP<Teuchos::ParameterList>& list,
                                             const RCP<const linear::UnassembledOperator>& k) {
  Stratimikos::DefaultLinearSolverBuilder builder;
  enableFetiDp(builder);
  enableBddc(builder, k);
  builder.setParameterList(list);
  return Thyra::createLinearSolveStrategy(builder);
}

} // namespace epafi::adapters
