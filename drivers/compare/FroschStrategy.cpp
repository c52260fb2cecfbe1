#include "FroschStrategy.hpp"

#include "epafi/base/Types.hpp"

#include <Tpetra_Vector.hpp> // FROSch's header names Tpetra's node without including it

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Stratimikos_FROSch_def.hpp>

namespace epafi::drivers {

void enableFrosch(Stratimikos::DefaultLinearSolverBuilder& builder) {
  Stratimikos::enableFROSch<LocalOrdinal, GlobalOrdinal, Vector::node_type>(builder, "FROSch");
}

} // namespace epafi::drivers
