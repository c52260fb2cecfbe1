#pragma once

/// One run of the scaling study, measured.

#include "ScalingTable.hpp"

#include "epafi/base/Types.hpp"

namespace epafi::drivers {

/// Solves the model problem with the settings of `row` (scalingSettings) on the communicator's ranks and
/// fills in the rest; times are medians of up to 7 runs, as many as fit into some seconds. Returns whether it
/// converged. Collective.
bool measureRun(Row& row, const RCP<const Comm>& comm);

} // namespace epafi::drivers
