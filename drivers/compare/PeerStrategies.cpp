#include "PeerStrategies.hpp"

#include "epafi/adapters/Stratimikos.hpp"

#include <Tpetra_Vector.hpp> // FROSch's header names Tpetra's node without including it

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Stratimikos_FROSch_def.hpp>
#include <Stratimikos_MueLuHelpers.hpp>

namespace epafi::drivers {

RCP<adapters::LinearSolveStrategy> strategyAmongPeers(const RCP<Teuchos::ParameterList>& list,
                                                      const RCP<const linear::UnassembledOperator>& k) {
  Stratimikos::DefaultLinearSolverBuilder builder;
  adapters::enableFetiDp(builder);
  adapters::enableBddc(builder, k);
  Stratimikos::enableMueLu<LocalOrdinal, GlobalOrdinal, Vector::node_type>(builder);
  Stratimikos::enableFROSch<LocalOrdinal, GlobalOrdinal, Vector::node_type>(builder, "FROSch");
  builder.setParameterList(list);
  return Thyra::createLinearSolveStrategy(builder);
}

} // namespace epafi::drivers
