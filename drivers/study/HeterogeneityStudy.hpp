#pragma once

/// Products with F and condition numbers where the stiffness jumps by up to 10⁶, along the cut and across it, without and with
/// adaptive constraints.

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// Writes heterogeneity.csv. \param quick  jumps of 1 and 10⁶ on fewer subdomains. Returns false if a run with the defaults
/// did not converge. Collective.
bool studyHeterogeneity(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
