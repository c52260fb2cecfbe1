#pragma once

/// `epafi-study accuracy`: what each digit takes, by mesh, tolerance and method.

#include "epafi/base/Types.hpp"

#include <filesystem>

namespace epafi::drivers {

/// Writes accuracy.csv, accuracy_effectivity.csv and accuracy.md (tables to read) into `directory`. Rows of other solvers are
/// added where AccuracyPeers.hpp finds them there. Collective. \throws InputError, Error; the same on all ranks.
/// \param quick  few and coarse meshes
/// \returns whether all runs converged
bool studyAccuracy(const std::filesystem::path& directory, bool quick, const RCP<const Comm>& comm);

} // namespace epafi::drivers
