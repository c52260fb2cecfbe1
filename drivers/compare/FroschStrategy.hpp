#pragma once

namespace Stratimikos { // NOLINT(readability-identifier-naming): it is theirs
class DefaultLinearSolverBuilder;
} // namespace Stratimikos

namespace epafi::drivers {

/// Makes "FROSch" a "Preconditioner Type".
void enableFrosch(Stratimikos::DefaultLinearSolverBuilder& builder);

} // namespace epafi::drivers
