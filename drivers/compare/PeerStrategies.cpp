#include "PeerStrategies.hpp"

#include "FroschStrategy.hpp"

#include "epafi/adapters/Stratimikos.hpp"

#include <Tpetra_Vector.hpp>

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Stratimikos_MueLuHelpers.hpp>

namespace epafi::drivers {

RCP<adapters::LinearSolveStrategy> strategyAmongPeers(const RCP<Teuchos::ParameterList>& list,
                                                      const RCP<const linear::UnassembledOperator>& k) {
  Stratimikos::DefaultLinearSolverBuilder builder;
  adapters::enableFetiDp(builder);
  adapters::enableBddc(builder, k);
  Stratimikos::enableMueLu<LocalOrdinal, GlobalOrdinal, Vector::node_type>(builder);
  enableFrosch(builder);
  builder.setParameterList(list);
  return Thyra::createLinearSolveStrategy(builder);
}

} // namespace epafi::drivers
