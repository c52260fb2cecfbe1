#pragma once

/// The report of a run as a file.

#include "epafi/base/Types.hpp"

#include <Teuchos_ParameterList.hpp>

#include <filesystem>

namespace epafi::output {

/// Writes rank 0's list as Teuchos XML; the file appears complete or not at all, its directory is created.
/// Collective. \throws InputError if the directory cannot be made or written to, Error if writing fails.
void writeReport(const Teuchos::ParameterList& report, const std::filesystem::path& file, const Comm& comm);

} // namespace epafi::output
