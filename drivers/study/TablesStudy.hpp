#pragma once

/// Tables 1 and 2 of the paper: dimensions and iterations of the model problem, ours beside the paper's.

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// Solves the 18 cells (with `quick` those with H/h ≤ 8) with the default parameters and writes tables.csv
/// and tables.md. Returns false if a cell did not converge. Collective.
bool studyTables(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
