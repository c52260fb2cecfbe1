#pragma once

/// Load steps that an earlier run has left in a file.

#include "epafi/output/FieldWriter.hpp"
#include "epafi/simulation/RunResult.hpp"

#include <filesystem>
#include <vector>

namespace epafi::output {

/// Which of the first load steps of a scene have their fields in an HDF5 file, by names, numbers and
/// energies; none if it is no such file. Rank 0 looks. Collective.
std::vector<FieldStep> stepsIn(const std::filesystem::path& file,
                               const std::vector<simulation::StepResult>& steps, const Comm& comm);

} // namespace epafi::output
