#pragma once

/// The files of a run of the driver.

#include "Options.hpp"
#include "RunWatch.hpp"
#include "SceneRun.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace epafi::drivers {

/// DIR/report.xml and the file of --report, as far as they were asked for; not twice the same.
std::vector<std::filesystem::path> reportsOf(const Options& options);

struct WrittenFiles {
  std::string lines;                 ///< for people: what was written where
  std::vector<std::string> failures; ///< sentences about what could not be written
};

/// Writes what was asked for: checkpoint, history, fields, reports, the smallest first; enters Time/Output and Time/Total in
/// the run's report. A file that cannot be written does not keep the others from it. Collective; the same on all ranks.
WrittenFiles writeFiles(const Options& options, const RunWatch& watch, SceneRun& run, const Comm& comm);

} // namespace epafi::drivers
