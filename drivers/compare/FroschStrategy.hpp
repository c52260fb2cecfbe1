#pragma once

#include "epafi/base/StratimikosCompatibility.hpp"

namespace epafi::drivers {

/// Makes "FROSch" a "Preconditioner Type".
void enableFrosch(Stratimikos::DefaultLinearSolverBuilder& builder);

} // namespace epafi::drivers
