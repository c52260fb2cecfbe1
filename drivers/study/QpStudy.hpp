#pragma once

/// What MPRGP's variants, preconditioners and starts cost on problems with bounds.

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// Solves journal bearing, obstacle and torsion with 100², 200² and 400² unknowns (with `quick` 50² and 100²) and
/// writes qp.csv, qp.md and qp_traffic.csv. Returns false if a run with the default expansion and release did not
/// converge. Collective.
bool studyQp(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
