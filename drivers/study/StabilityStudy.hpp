#pragma once

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// Runs the hard cases of study/stability, each with its expected outcome, and writes stability.csv and stability.md into
/// `directory`. Cases run on rank 0 alone while the others sleep, but those that ask for a number of ranks: such run if
/// there are as many. Returns whether every outcome was as expected or is known to be otherwise. Collective. \throws InputError if a file cannot be
/// written.
bool studyStability(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
