#pragma once

/// How time, memory and messages grow with the number of subdomains, their size and the number of ranks.

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// Solves the model problem in several series and writes scaling.csv and scaling.md. On one rank: growing 1/H and H/h,
/// forms of F and preconditioners, and, as tables of their own, dense products beside the memory's speed
/// (scaling_blocks.csv), the expectations of the cost model (scaling_costs.csv) and an iteration on up to 10⁵ ranks
/// (scaling_coarse.csv, scaling_prediction.csv). On several ranks: strong and weak scaling; rows of other numbers of
/// ranks that DIR/scaling.csv holds are kept. `quick` makes all of it small.
/// Returns false if a run did not converge. Collective.
/// \throws InputError if DIR/scaling.csv is there and not of this study.
bool studyScaling(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
